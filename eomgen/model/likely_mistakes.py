"""Model -> what is read and not built yet, and likely mistakes.

Model -> the kinds in it that are read and checked but that this version does not derive yet.
"""

import math
import re
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

from eomgen.model.catalog import SYMBOL_TABLES, Catalog, owner_of
from eomgen.model.diagnostics import Diagnostic, whereabouts
from eomgen.model.fields import STATEMENT, Leaf, NameRule, StatementRule, WrittenEquation
from eomgen.model.positions import DocumentPath
from eomgen.model.sampled_laws import laws_through_samples
from eomgen.model.shapes.base import InertiaMatrix
from eomgen.model.units import inferred
from eomgen.model.values import AnyNumber, in_order
from eomgen.symbolic.expression import Expression, Fraction
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.print import Symbol


def unbuilt(model: Any) -> tuple[tuple[str, str], ...]:
    """(where, kind) of every joint, constraint, force and table that waits for a later version, in the model's
    order."""
    return (*unbuilt_bodies(model), *unbuilt_constraints(model), *_unbuilt_forces(model))


def unbuilt_bodies(model: Any) -> tuple[tuple[str, str], ...]:
    """(where, kind) of the joints that wait for a later version."""
    waiting = []
    for name, body in model.bodies.items():
        if body.joint is not None and not body.joint.works_in(model.space):
            waiting.append((f"bodies.{name}.joint", f"{body.joint.kind} joint"))
    return tuple(waiting)


def unbuilt_constraints(model: Any) -> tuple[tuple[str, str], ...]:
    """(where, kind) of the constraints that wait for a later version: they cannot be counted."""
    constraints = model.constraints.items()
    return tuple(
        (f"constraints.{name}", constraint.kind)
        for name, constraint in constraints
        if not constraint.works_in(model.space)
    )


def _unbuilt_forces(model: Any) -> tuple[tuple[str, str], ...]:
    return tuple((f"forces.{name}", force.kind) for name, force in model.forces.items() if not force.works)


# -------- warnings --------------------------------------------------------------------------------------------
# Model -> what is allowed but hardly intended: an angle of 90 rad, weight that rises, a stiffness below zero, ...


TURN = 2 * math.pi
DWELL = Fraction(1, 1000)  # of what samples span: by so much a cubic leaves equal ones unseen


def warnings_of(model: Any) -> tuple[Diagnostic, ...]:
    """Warnings: what a user should look at again."""
    catalog = Catalog(model, ())
    values = _assumed(catalog)
    checks = (_angles(catalog, values), _signs(catalog, values), _weights(catalog, values))
    more = (_impossible(catalog, values), _unheld(catalog), _masses(catalog, values), _symbols_twice(catalog))
    hardly = (_unused(catalog), _guessed(catalog), _overshoots(catalog))
    return (*inferred(catalog).warnings, *(diagnostic for check in (*checks, *more, *hardly) for diagnostic in check))


def _assumed(catalog: Catalog) -> dict[str, AnyNumber]:
    """The value of every parameter; one that nobody gave is taken as 1, for the sake of its sign."""
    values: dict[str, AnyNumber] = {"pi": math.pi}
    given = {name: part.value for name, part in catalog.table("parameters").items()}
    for name in in_order(given)[0]:
        found = None if given[name] is None else given[name].value_at(values)
        values[name] = 1 if found is None else found
    return values


def _angles(catalog: Catalog, values: Mapping[str, AnyNumber]) -> Iterator[Diagnostic]:
    """Diagnostics of plain numbers of more than a turn among the terms of an angle."""
    for leaf, expression in catalog.expressions:
        if getattr(leaf.rule, "unit", None) != "rad" or getattr(leaf.rule, "in_own_unit", False):
            continue
        for number, column in _terms(expression):
            size = abs(number)
            if size > TURN:
                what = f"{size:g} in {leaf.whereabouts} is {size:g} rad: {size / TURN:.1f} turns"
                yield Diagnostic(leaf.path, what, f"for degrees write {_of_pi(size)}", column, len(f"{size:g}"))


def _terms(expression: Expression) -> Iterator[tuple[float, int]]:
    """(number, column) of the terms of a sum that are plain numbers."""
    stack: list[tuple[list[tuple[float, int]], bool]] = []
    for (kind, what), column in zip(expression.code, expression.columns, strict=True):
        if kind == "number":
            stack.append(([(float(what), column)] if column >= 0 else [], True))
        elif kind in ("name", "call", "part"):
            stack.append(([], False))
        elif kind == "under":
            del stack[-1 - len(what) : -1]
        elif kind in ("+", "-"):
            (b, _), (a, _) = stack.pop(), stack.pop()
            stack.append(([*a, *b], False))
        else:
            count = what[1] if kind == "function" else 1 if kind in ("neg", "sampled") else 2
            inner = [stack.pop() for _ in range(count)]
            stack.append((inner[0][0] if kind == "neg" else [], False))
    yield from stack[0][0]


def _of_pi(degrees: float) -> str:
    """90 degrees as pi/2."""
    share = math.gcd(int(degrees), 180) if degrees == int(degrees) else 0
    if not share:
        return f"{degrees:g}*pi/180"
    above, below = int(degrees) // share, 180 // share
    return f"{'' if above == 1 else f'{above}*'}pi{'' if below == 1 else f'/{below}'}"


def _signs(catalog: Catalog, values: Mapping[str, AnyNumber]) -> Iterator[Diagnostic]:
    """Diagnostics of values that drive apart or give energy, where they ought to hold or take it."""
    for leaf, expression in catalog.expressions:
        law = getattr(leaf.rule, "usually", "")
        number = expression.value_at(values) if law else None
        if number is not None and number < 0:
            what = f"'{leaf.path[-1]}' of {whereabouts(leaf.path[:2])} is below zero: {law}"
            yield Diagnostic(leaf.path, what, "leave out the minus, if it is meant to resist")


def _weights(catalog: Catalog, values: Mapping[str, AnyNumber]) -> Iterator[Diagnostic]:
    """Diagnostics of gravity upward."""
    for leaf in catalog.leaves:
        if getattr(leaf.rule, "downward", False) and not leaf.part.axis_down:
            parts = [component.value_at(values) for component in leaf.value]
            *across, up = parts
            if up is not None and up > 0 and not any(across):
                axis = "xyz"[len(parts) - 1]
                fix = f'write "-{leaf.value[-1].text}"; where {axis} points down, axis_down = true says so'
                yield Diagnostic(leaf.path, f"gravity pulls upward, along {axis}", fix)


def _impossible(catalog: Catalog, values: Mapping[str, AnyNumber]) -> Iterator[Diagnostic]:
    """Diagnostics of an inertia in space that no body has, unless declared as measured: published data may be so."""
    for name, body in catalog.table("bodies").items():
        if catalog.model.space != "space" or body.inertia is None or body.measured or len(body.inertia) not in (3, 6):
            continue
        if not all(x.names <= _valued(catalog) for x in body.inertia):
            continue
        moments = [float(x) for e in body.inertia if (x := e.value_at(values)) is not None]
        if len(moments) == len(body.inertia) and not InertiaMatrix.of_moments(*moments).is_possible():
            shown = ", ".join(f"{x:g}" for x in moments)
            what = f"no body has the inertia of '{name}': [{shown}] breaks the triangle inequality"
            fix = "a principal moment is at most the sum of the others; measured = true says that it is published data"
            yield Diagnostic(("bodies", name, "inertia"), what, fix)


def _unheld(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of a body without a joint that no constraint touches, in a model that moves by coordinates."""
    if not catalog.table("coordinates"):
        return
    held = set()
    for name, constraint in catalog.table("constraints").items():
        held |= {_body(leaf) for leaf in constraint.leaves(("constraints", name)) if isinstance(leaf.rule, NameRule)}
        held |= {
            argument.name.partition(".")[0]
            for leaf in constraint.leaves(("constraints", name))
            if isinstance(leaf.value, Expression)
            for call in leaf.value.calls
            for argument in call.args
            if not isinstance(argument, Expression)
        }
    held |= {body.joint.parent for body in catalog.table("bodies").values() if body.joint is not None}
    for name, body in catalog.table("bodies").items():
        if body.joint is None and name not in held:
            what = f"body '{name}' has no joint, and no constraint holds it"
            fix = 'give it a joint: joint = { kind = "revolute", on = ..., angle = ... }'
            yield Diagnostic(("bodies", name), what, fix, key=True)


def _guessed(catalog: Catalog) -> Iterator[Diagnostic]:
    """Constraints whose place follows from a guess: `near` is where a coordinate is sought, and says nothing of
    geometry."""
    coordinates, bodies = catalog.table("coordinates"), catalog.table("bodies")
    guessed = {name for name, q in coordinates.items() if q is not None and q.dependent and q.start is None}
    for name, constraint in catalog.table("constraints").items():
        if constraint is None or not constraint.lies_by_start:
            continue
        leaves = constraint.leaves(("constraints", name))
        waiting = [owner_of(x) for leaf in leaves for x in _NAME.findall(_written(leaf.value)) if owner_of(x) in bodies]
        carried: set[str] = set()
        while waiting:
            body = bodies[waiting.pop()]
            if body is not None and body.joint is not None:
                joint = body.joint.leaves(())
                carried |= {x for leaf in joint for x in _NAME.findall(_written(leaf.value))} & guessed
                waiting += [body.joint.parent] if body.joint.parent in bodies else []
        for q in sorted(carried):
            what = f"where '{name}' lies follows from where '{q}' starts, and of that there is only the guess `near`"
            yield Diagnostic(
                ("coordinates", q), what, f"give '{q}' a `start`, or the constraint its own place", key=True
            )


def _overshoots(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of cubics that leave a dwell: they are not constant between two equal samples."""
    for path, law, given in laws_through_samples((leaf.path, leaf.value) for leaf in catalog.leaves):
        if given.way != "cubic":
            continue
        size = max(given.values) - min(given.values)
        for (t, y), (later, other) in pairwise(zip(given.times, given.values, strict=True)):
            away = abs(law.spline.at((t + later) / 2) - y * given.factor) if y == other else 0
            if away > DWELL * size * abs(given.factor):
                when = f"between the equal samples at {float(t):g} and {float(later):g} s"
                what = f"{when} {whereabouts(path)} goes elsewhere, by {float(away):.3g} [SI]"
                yield Diagnostic(path, what, 'write between = "pchip" for what is to dwell')
                break


PROSE = ("about", "source", "name", "text", "unit", "symbol")
_NAME = re.compile(r"[^\W\d]\w*(?:\.\w+)?")


def _unused(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of parameters and points of the ground that nothing names."""
    named: dict[str, set[DocumentPath]] = {}
    for leaf in catalog.leaves:
        if isinstance(leaf.rule, StatementRule):  # of the words of a problem the names in braces
            for found in STATEMENT.finditer(leaf.value):
                named.setdefault((found["name"] or "").strip(), set()).add(leaf.path[:2])
        elif leaf.path[-1] not in PROSE:
            for name in _NAME.findall(_written(leaf.value)):
                named.setdefault(name, set()).add(leaf.path[:2])
    joints = (body.joint for body in catalog.table("bodies").values() if body is not None)
    seats = [getattr(joint, "at", None) for joint in joints]  # of a checked model the place stands for the point's name
    for table, what in (("parameters", "parameter"), ("points", "point")):
        for name in catalog.table(table):
            seated = table == "points" and catalog.table(table)[name] in seats
            if not seated and name not in catalog.model.counts and not named.get(name, set()) - {(table, name)}:
                yield Diagnostic(
                    (table, name), f"nothing uses the {what} '{name}'", "use it, or leave it out", key=True
                )


def _written(value: Any) -> str:
    """The texts of a value in which names can stand, joined."""
    if isinstance(value, (Expression, WrittenEquation)):
        return value.text
    return " ".join(map(_written, value)) if isinstance(value, tuple) else value if isinstance(value, str) else ""


def _body(leaf: Leaf) -> str:
    return owner_of(leaf.value) or str(leaf.value)


def _masses(catalog: Catalog, values: Mapping[str, AnyNumber]) -> Iterator[Diagnostic]:
    """Diagnostics of masses so far apart that doubles lose the smaller one."""
    found = []
    for leaf, expression in catalog.expressions:
        if (
            getattr(leaf.rule, "unit", None) == "kg"
            and leaf.path[0] == "bodies"
            and expression.names <= _valued(catalog)
        ):
            number = expression.value_at(values)
            if number is not None and number > 0:
                found.append((float(number), leaf))
    if not found:
        return
    (least, _), (most, leaf) = min(found, key=lambda pair: pair[0]), max(found, key=lambda pair: pair[0])
    if most > tolerances.MASSES_APART * least:
        what = f"{leaf.whereabouts} is {most:g} kg, and the least mass {least:g} kg: {most / least:.0e} times less"
        yield Diagnostic(leaf.path, what, "look at the units; what does not move needs no body")


def _symbols_twice(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of two things with the same symbol in formulas, because one of them declares it."""
    declared = dict(_declared(catalog))
    looks = {symbol.tex: path for path, symbol in declared.items()}
    for table in SYMBOL_TABLES:
        for name in catalog.table(table):
            path: DocumentPath = (table, name, "symbol")
            if path not in declared and (other := looks.get(Symbol.of(name).tex)) is not None:
                yield _alike(other, declared[other], whereabouts((table, name)))
    for path, symbol in declared.items():
        if looks[symbol.tex] != path:
            yield _alike(path, symbol, whereabouts(looks[symbol.tex][:-1]))


def _declared(catalog: Catalog) -> Iterator[tuple[DocumentPath, Symbol]]:
    """Every symbol that is declared for a quantity, with its place; indices are no symbols by themselves."""
    for leaf in catalog.leaves:
        if isinstance(leaf.value, Symbol) and (leaf.path[0] in SYMBOL_TABLES or leaf.path[-1] != "symbol"):
            yield leaf.path, leaf.value


def _alike(path: DocumentPath, symbol: Symbol, other: str) -> Diagnostic:
    return Diagnostic(path, f"{symbol.tex} stands for {other} too", "give one of them another symbol")


def _valued(catalog: Catalog) -> set[str]:
    return {name for name, part in catalog.table("parameters").items() if part.value is not None} | {"pi"}
