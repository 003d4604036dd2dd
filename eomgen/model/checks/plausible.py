"""Model -> what of it cannot be, which is an error, and what is hardly meant, which is a warning.

Errors: bodies and joints without what they need, numbers that a body cannot have, bodies that form no tree."""

import math
import re
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

from eomgen.errors import ExpressionError
from eomgen.model.catalog import SYMBOL_TABLES, Catalog, owner_of
from eomgen.model.composite import Composite, sources
from eomgen.model.diagnostics import Diagnostic, shown, whereabouts
from eomgen.model.fields import STATEMENT, Leaf, NameRule, StatementRule, VectorRule, WrittenEquation
from eomgen.model.positions import DocumentPath
from eomgen.model.sampled_laws import laws_through_samples
from eomgen.model.shapes.base import InertiaMatrix
from eomgen.model.units import inferred
from eomgen.model.values import AnyNumber, in_order
from eomgen.symbolic.expression import Expression, Fraction, Vector
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.print import Symbol

MEASURES = {1: "mass by length", 2: "mass by area", 3: "mass by volume"}


def bodies(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of masses given twice or not at all, of missing inertias, incomplete joints, rings of bodies."""
    for name, body in catalog.table("bodies").items():
        if body is not None:
            yield from _mass(catalog, name, body)
            if body.joint is not None:
                yield from _joint(catalog, name, body.joint)
    yield from _rings(catalog)


def _mass(catalog: Catalog, name: str, body: Any) -> Iterator[Diagnostic]:
    path: DocumentPath = ("bodies", name)
    alone = "shape" if body.shape is not None else "parts" if body.parts is not None else ""
    others = {"shape": ("mass", "center", "inertia", "parts"), "parts": ("center", "inertia"), "": ()}[alone]
    for other in others:
        if getattr(body, other) is not None:
            what = f"body '{name}' has both '{alone}' and '{other}'"
            yield Diagnostic((*path, other), what, f"'{alone}' gives the mass already: leave out '{other}'", key=True)
    if body.shape is not None and body.shape.mass is None and (*path, "shape", "mass") not in catalog.broken:
        what = f"the shape of body '{name}' has no 'mass'"
        yield Diagnostic((*path, "shape"), what, "give 'mass' (0 for a massless body)")
    if body.parts is not None and (*path, "parts") not in catalog.broken and (*path, "mass") not in catalog.broken:
        yield from _sharing((*path, "parts"), name, body)
    yield from _changing_parts(catalog, name, body)
    if _needs_inertia(body) and (*path, "inertia") not in catalog.broken and _turns(catalog, name):
        what = f"body '{name}' can turn but has no 'inertia'"
        yield Diagnostic(path, what, "give 'inertia' about the mass centre (0 for a point)", key=True)


def _sharing(path: DocumentPath, name: str, body: Any) -> Iterator[Diagnostic]:
    """Diagnostics of parts without a mass of their own: there must be a rest to share, and one common density."""
    sharing = [k for k, piece in enumerate(body.parts) if piece.shape.mass is None]
    for k in sharing:
        piece = body.parts[k]
        if piece.shape.dimension == 0:
            yield Diagnostic((*path, k), f"a particle among the parts of body '{name}' has no 'mass'", "give its mass")
        elif body.mass is None and not piece.hole:
            what = f"part {k + 1} of body '{name}' has no 'mass', and neither has the body"
            yield Diagnostic((*path, k), what, "give the net mass of the body, or a mass to each part")
        elif body.mass is None and len(of := sources(body.parts, k)) != 1:
            what = f"the mass of the hole, part {k + 1} of body '{name}', is not known: "
            what += f"it may be cut out of {len(of)} parts" if of else "no part is of its kind"
            yield Diagnostic((*path, k), what, "give its mass (what it takes away), or the net mass of the body")
    kinds = {body.parts[k].shape.dimension: body.parts[k].shape.kind for k in sharing}
    if body.mass is not None and len(kinds) > 1 and 0 not in kinds:
        listed = " and ".join(f"{kind} ({MEASURES[d]})" for d, kind in sorted(kinds.items()))
        what = f"the parts of body '{name}' have no common density: {listed}"
        yield Diagnostic(path, what, "give a mass to the parts of one kind: the others share the rest", key=True)


def _changing_parts(catalog: Catalog, name: str, body: Any) -> Iterator[Diagnostic]:
    """Diagnostics of masses among parts that change, which would move the mass centre in the body."""
    changes = {"t", *catalog.table("states")}
    for k, piece in enumerate(body.parts or ()):
        mass = None if piece is None or piece.shape is None else piece.shape.mass
        if mass is not None and mass.names & changes:
            what = f"the mass of part {k + 1} of body '{name}' changes, and moves the mass centre in the body"
            yield Diagnostic(("bodies", name, "parts", k), what, "make the part a body of its own, fixed to it")


def _needs_inertia(body: Any) -> bool:
    """True if it has a mass but no inertia, and is neither a shape nor composed of parts."""
    without = body.parts is None and body.shape is None and body.inertia is None
    return without and body.mass is not None and body.mass.literal != 0


def _turns(catalog: Catalog, name: str) -> bool:
    """True if a body can rotate relative to the ground: its joint, or one of its ancestors', has a variable angle."""
    seen: set[str] = set()
    constant = frozenset(["pi", *catalog.table("parameters"), *catalog.table("unknowns")])
    while name not in seen and catalog.table("bodies").get(name) is not None:
        seen.add(name)
        joint = catalog.table("bodies")[name].joint
        if joint is None:
            return False
        if any(e is not None and not e.names <= constant for e in joint.turns()):
            return True
        name = joint.parent or ""
    return False


def _joint(catalog: Catalog, name: str, joint: Any) -> Iterator[Diagnostic]:
    path: DocumentPath = ("bodies", name, "joint")
    space = catalog.model.space
    if joint.on is not None and joint.at is not None:
        if "." in joint.on:
            what = f"the joint of body '{name}' sits at the point '{joint.on}' and has an 'at' too"
            yield Diagnostic((*path, "at"), what, "leave out one of them", key=True)
        elif isinstance(joint.at, str):
            what = f"'{joint.at}' is a point of the ground, but the joint of body '{name}' hangs on '{joint.on}'"
            yield Diagnostic((*path, "at"), what, f'write on = "{joint.on}.point", or give coordinates in its axes')
    if space == "plane" and joint.only_space:
        yield Diagnostic(
            (*path, "kind"),
            f"a {joint.kind} joint needs space, but the model is in the plane",
            'use "revolute", "prismatic" or "free"',
        )
    else:
        yield from joint.diagnostics(path, catalog)
        for _, field, law in joint.frictions:
            yield from law.diagnostics((*path, "friction", *([field] if len(joint.limited) > 1 else [])))


def _rings(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of a body that hangs on itself, directly or through others (each ring once, at its first body)."""
    table = catalog.table("bodies")
    parents = {n: body.joint.parent for n, body in table.items() if body is not None and body.joint is not None}
    done: set[str] = set()
    for first in parents:
        trail: list[str] = []
        name: str | None = first
        while name is not None and name in parents and name not in done and name not in trail:
            trail.append(name)
            name = parents[name]
        if name in trail:
            ring = trail[trail.index(name) :]
            listed = " -> ".join([*ring, ring[0]])
            what = f"body '{name}' hangs on itself"
            what = what if len(ring) == 1 else f"bodies hang on one another in a ring: {listed}"
            yield Diagnostic(("bodies", ring[0], "joint", "on"), what, "one of them must hang on the ground")
        done.update(trail)


# -------- made ------------------------------------------------------------------------------------------------
# Shapes and bodies made of parts, wherever all their numbers are known: that such a body exists.


def made(catalog: Catalog, values: Mapping[str, AnyNumber]) -> Iterator[Diagnostic]:
    """Diagnostics of impossible shapes, parts heavier than the whole, holes larger than what they are cut out of."""
    for name, body in catalog.table("bodies").items():
        if body is None or ("bodies", name) in catalog.broken or not _signed_right(body, values):
            continue  # reported already
        path: DocumentPath = ("bodies", name)
        shapes = [((*path, "shape"), f"the shape of body '{name}'", body.shape)] if body.shape is not None else []
        shapes += [
            ((*path, "parts", k), f"part {k + 1} of body '{name}'", piece.shape)
            for k, piece in enumerate(body.parts or ())
        ]
        wrong = [_impossible(where, what, shape, values) for where, what, shape in shapes]
        yield from filter(None, wrong)
        if body.parts is not None and not any(wrong) and _complete(body) and all(map(_placed, body.parts)):
            yield from _whole((*path, "parts"), name, body, values)


def _impossible(path: DocumentPath, what: str, shape: Any, values: Mapping[str, AnyNumber]) -> Diagnostic | None:
    if not _known(shape, values):
        return None
    try:
        why = shape.impossible(lambda e: float(e.evaluate(values)))
    except ExpressionError:  # reported where the expression stands
        return None
    return Diagnostic(path, f"{what} ({shape.kind}) cannot be: {why}") if why else None


def _signed_right(body: Any, values: Mapping[str, AnyNumber]) -> bool:
    """True if every mass, length and radius of a body that is known has its sign."""
    signed = [leaf for leaf in body.leaves(()) if getattr(leaf.rule, "sign", "")]
    known = [(leaf.rule.sign, leaf.value.value_at(values)) for leaf in signed if isinstance(leaf.value, Expression)]
    return all(x is None or x > 0 or (x == 0 and sign == "nonnegative") for sign, x in known)


def _known(part: Any, values: Mapping[str, AnyNumber]) -> bool:
    """True if every expression in a part has names with values only."""
    leaves = (leaf.value for leaf in part.leaves(()))
    return all(e.names <= values.keys() for e in leaves if isinstance(e, Expression))


def _complete(body: Any) -> bool:
    """True if the masses of all parts follow (else it is reported where masses are checked)."""
    sharing = [piece for piece in body.parts if piece.shape.mass is None]
    return not sharing or (body.mass is not None and len({piece.shape.dimension for piece in sharing}) == 1)


def _placed(piece: Any) -> bool:
    """True if no vector of a piece has more components than space (reported where references are checked)."""
    vectors = [leaf.value for leaf in piece.leaves(()) if isinstance(leaf.rule, VectorRule)]
    return all(len(components) <= 3 for components in vectors)


def _whole(path: DocumentPath, name: str, body: Any, values: Mapping[str, AnyNumber]) -> Iterator[Diagnostic]:
    """Diagnostics of a composite body all of whose numbers are known."""
    expressions = [body.mass] if body.mass is not None else []
    if not all(_known(piece, values) for piece in body.parts) or any(e.names - values.keys() for e in expressions):
        return

    def value(expression: Expression) -> float:
        return float(expression.evaluate(values))

    try:
        measures = [_signed(piece, value) for piece in body.parts if piece.shape.mass is None]
        cut = body.mass is not None and any(measure > 0 for measure in measures)
        if cut and sum(measures) <= tolerances.SOLVED * max(map(abs, measures)):
            yield Diagnostic(path, f"the holes of body '{name}' are as large as its parts, or larger", key=True)
            return
        composite = Composite.of(body.parts, body.mass, value)
    except (ExpressionError, ZeroDivisionError):
        return
    yield from _masses(path, name, body, composite)


def _signed(piece: Any, value: Any) -> Any:
    return (-1 if piece.hole else 1) * piece.shape.measure(value)


def _masses(path: DocumentPath, name: str, body: Any, composite: Composite) -> Iterator[Diagnostic]:
    total = sum(placed.sign * placed.mass.m for placed in composite.pieces)
    largest = max(placed.mass.m for placed in composite.pieces)
    negative = [k for k, placed in enumerate(composite.pieces) if placed.mass.m < 0]
    if negative:
        given = sum(p.sign * p.mass.m for p in composite.pieces if p.piece.shape.mass is not None)
        what = f"the parts of body '{name}' with a mass of their own weigh {float(given):g} kg, its 'mass' is "
        what += f"{float(composite.whole.m):g} kg: that leaves no mass for the others"
        yield Diagnostic(path, what, "'mass' is that of the net whole", key=True)
    elif abs(total - composite.whole.m) > tolerances.SOLVED * (largest or 1):
        what = f"the parts of body '{name}' weigh {float(total):g} kg, its 'mass' is {float(composite.whole.m):g} kg"
        yield Diagnostic(path, what, "leave out 'mass', or the mass of a part", key=True)
    elif total < -tolerances.SOLVED * largest or (abs(total) <= tolerances.SOLVED * largest and largest > 0):
        weight = "negative" if total < -tolerances.SOLVED * largest else "zero"
        what = f"the mass of body '{name}' is {weight}: its holes take away {_of_holes(composite):g} kg"
        yield Diagnostic(path, what, "a hole cannot weigh more than what it is cut out of", key=True)
    else:
        yield from _inertia(path, name, composite)


def _of_holes(composite: Composite) -> float:
    return _float(sum(placed.mass.m for placed in composite.pieces if placed.sign < 0))


def _float(x: Any) -> float:
    return float(x)


def _inertia(path: DocumentPath, name: str, composite: Composite) -> Iterator[Diagnostic]:
    I = composite.whole.I
    moments = [_float(x) for x in (I[0][0], I[1][1], I[2][2], I[0][1], I[1][2], I[2][0])]
    size = max(abs(_float(x)) for p in composite.pieces for row in p.mass.about(composite.whole.com) for x in row)
    if not InertiaMatrix.of_moments(*moments).is_possible(size):
        listed = ", ".join(f"{x:g}" for x in moments)
        what = f"no body has the inertia of '{name}': [{listed}] breaks the triangle inequality"
        yield Diagnostic(
            path, what, "a hole lies inside the other parts, and is no heavier than what it is cut out of", key=True
        )


# -------- numbers ---------------------------------------------------------------------------------------------
# Numbers: a mass, length, radius or inertia has its sign; an inertia obeys the triangle inequality.


def numbers(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of impossible numbers, wherever an expression has a value (literals, parameters with values)."""
    values: dict[str, AnyNumber] = {"pi": math.pi}
    for name in in_order({n: p.value if p else None for n, p in catalog.table("parameters").items()})[0]:
        yield from _parameter(catalog, name, values)
    for leaf, expression in catalog.expressions:
        yield from _value(leaf, expression, values)
        sign = getattr(leaf.rule, "sign", "")
        if sign:
            yield from _sign(leaf, expression, expression.value_at(values))
    yield from _directions(catalog, values)
    yield from _crossing(catalog, values)
    yield from _positive(catalog, values)
    yield from _inertias(catalog, values)
    yield from made(catalog, values)


def _parameter(catalog: Catalog, name: str, values: dict[str, AnyNumber]) -> Iterator[Diagnostic]:
    """Adds the value of a parameter to the values, or reports why it has none."""
    part = catalog.table("parameters")[name]
    if part is None or part.value is None or not part.value.names <= values.keys():
        return
    try:
        values[name] = part.value.evaluate(values)
    except ExpressionError as error:
        path, what = ("parameters", name, "value"), f"parameter '{name}': {error.what}"
        yield Diagnostic(path, what, error.fix, error.column, error.length)


def _value(leaf: Leaf, expression: Expression, values: dict[str, AnyNumber]) -> Iterator[Diagnostic]:
    """Diagnostics of an expression without a value, such as asin(2); those of parameters are reported above."""
    elsewhere = leaf.path[0] == "parameters" or leaf.value is not expression or expression.calls
    if elsewhere or not expression.names <= values.keys():
        return
    try:
        expression.evaluate(values)
    except ExpressionError as error:
        yield Diagnostic(leaf.path, f"{leaf.whereabouts}: {error.what}", error.fix, error.column, error.length)


def _sign(leaf: Leaf, expression: Expression, number: Any) -> Iterator[Diagnostic]:
    if number is None or number > 0 or (number == 0 and leaf.rule.sign == "nonnegative"):
        return
    what = "negative" if number < 0 else "zero"
    key = next((str(k) for k in reversed(leaf.path) if isinstance(k, str)), "")
    text = shown(expression.text) if expression.literal is None else expression.text
    valued = f"{text} = {float(number):g}" if expression.literal is None else text
    where = whereabouts(leaf.path[:-1] if len(leaf.path) > 2 else leaf.path)
    yield Diagnostic(leaf.path, f"'{key}' in {where} is {what}: {valued}")


def _directions(catalog: Catalog, values: dict[str, AnyNumber]) -> Iterator[Diagnostic]:
    """Diagnostics of a direction that its parameters make zero (literal zeros are reported with the vectors)."""
    for leaf in catalog.leaves:
        if not getattr(leaf.rule, "nonzero", False) or isinstance(leaf.value, str):
            continue
        named = any(component.literal is None for component in leaf.value)
        if named and all(component.value_at(values) == 0 for component in leaf.value):
            yield Diagnostic(leaf.path, f"{leaf.whereabouts}: a direction cannot be zero", "give a direction")


def _crossing(catalog: Catalog, values: dict[str, AnyNumber]) -> Iterator[Diagnostic]:
    """Diagnostics of a universal joint whose numbers make its two axes parallel, so that it turns about one alone."""
    for name, body in catalog.table("bodies").items():
        axes = getattr(getattr(body, "joint", None), "axes", None)
        if axes is None or len(axes) != 2 or any(len(axis) != 3 for axis in axes):
            continue
        a, b = (list[Any](component.value_at(values) for component in axis) for axis in axes)
        if None not in (*a, *b) and any(a) and any(b) and not any(Vector(a).cross(Vector(b))):
            what = f"the two axes of the universal joint of body '{name}' are parallel"
            yield Diagnostic(("bodies", name, "joint", "axes"), what, "give axes that cross, or a revolute joint")


def _positive(catalog: Catalog, values: dict[str, AnyNumber]) -> Iterator[Diagnostic]:
    for name, part in catalog.table("parameters").items():
        if part is not None and part.positive and name in values and values[name] <= 0:
            what = f"parameter '{name}' is declared positive but is {float(values[name]):g}"
            yield Diagnostic(("parameters", name, "value"), what)


def _inertias(catalog: Catalog, values: dict[str, AnyNumber]) -> Iterator[Diagnostic]:
    for name, body in catalog.table("bodies").items():
        if body is None or body.inertia is None:
            continue
        path: DocumentPath = ("bodies", name, "inertia")
        moments = [e.value_at(values) for e in body.inertia]
        negative = [k for k, x in enumerate(moments[:3]) if x is not None and x < 0]
        for k in negative:
            what = f"a moment of inertia of body '{name}' is negative: {body.inertia[k].text}"
            yield Diagnostic(path if len(moments) == 1 else (*path, k), what)


# -------- warnings --------------------------------------------------------------------------------------------
# Model -> what is allowed but hardly intended: an angle of 90 rad, weight that rises, a stiffness below zero, ...


TURN = 2 * math.pi
DWELL = Fraction(1, 1000)  # of what samples span: by so much a cubic leaves equal ones unseen


def warnings_of(model: Any) -> tuple[Diagnostic, ...]:
    """Warnings: what a user should look at again."""
    catalog = Catalog(model, ())
    values = _assumed(catalog)
    checks = (_angles(catalog, values), _signs(catalog, values), _weights(catalog, values))
    more = (
        _bodiless(catalog, values),
        _unheld(catalog),
        _limits(catalog),
        _masses_apart(catalog, values),
        _symbols_twice(catalog),
    )
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


def _limits(catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of plain limits that are taken in SI though coordinates in what they limit are in another unit."""
    coordinates = catalog.table("coordinates")
    for body, part in catalog.table("bodies").items():
        joint: Any = None if part is None else part.joint
        for field, limits in () if joint is None else joint.given_limits:
            units = joint.units_in(field, coordinates)
            plain = [x for x in limits.plain if x.literal != 0]
            if units and plain and joint.unit_of_limits(field, coordinates) is None:
                (name, unit), si, text = next(iter(units.items())), joint.unit_of(field), plain[0].text
                what = f"limits of '{body}': {text} is in {si}, though '{name}' is in {unit.text}: "
                what += f"'{joint.variable_of(field).text}' is no a*{name} + b"
                fix = f'write the unit, {{ value = {text}, unit = "{unit.text}" }} or unit = "{si}"'
                yield Diagnostic(("bodies", body, "joint", "limits"), what, fix)


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


def _bodiless(catalog: Catalog, values: Mapping[str, AnyNumber]) -> Iterator[Diagnostic]:
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


def _masses_apart(catalog: Catalog, values: Mapping[str, AnyNumber]) -> Iterator[Diagnostic]:
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
