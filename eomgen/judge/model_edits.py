"""Model, equation of somebody -> the one change of the model file with which the equation would be right.

A formula of the file (a length, an angle, a mass, a component of a force) has another sign, is left out, or holds
another parameter or coordinate; an angle is counted from another axis; one point of a body stands for another; a mass
sits in one point, an inertia is taken about another point or is that of another shape; a force is left out; a
coordinate stands still. Each such model is derived again, and the equation is decided for it, whatever it is about:
motion, energy, a reaction, an answer.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import islice
from typing import Any

from eomgen.errors import EomgenError
from eomgen.frozen import dataclass
from eomgen.judge.diagnosis import EXCHANGED, PLACED, PLAINEST, SHARED, SHORTER, Explanation, Mistake, Share
from eomgen.judge.terms import FEW, Edits, term_text, wrong_parameters
from eomgen.mechanics.dynamics import Contributions
from eomgen.model import Body, Leaf, Model, Table
from eomgen.symbolic.expression import (
    Expression,
    Fraction,
    Node,
    Scalar,
    Vector,
    is_zero,
    over,
    parse,
    substituted,
    symbols_of,
)
from eomgen.symbolic.print import to_text

MOST = 80  # models that are derived
EDITED = ("bodies", "forces", "constraints")  # tables of the file whose values are changed
MOST_STATED = 2  # changes that are stated: the first, and one that explains the equation as well
MOST_HELD = 6  # coordinates of a model that are held, one by one
SHAPES = (  # I / (m r^2)
    (Fraction(1), "a thin hoop"),
    (Fraction(1, 2), "a disc"),
    (Fraction(2, 5), "a solid ball"),
    (Fraction(2, 3), "a thin shell"),
    (Fraction(1, 3), "a rod about its end"),
    (Fraction(1, 12), "a rod about its middle"),
)


@dataclass(frozen=True)
class ModelEdit:
    """A model in which one thing of the file is another.

    Args:
        mistake: what is changed, in words; it is no term of an equation: its row is 0.
        of: the model.
        changes: the tables that are others.
        still: names of rates that are 0 in it: no equation that holds one is of this model.
    """

    mistake: Mistake
    of: Model
    changes: Mapping[str, Any]
    still: frozenset[str] = frozenset()

    @property
    def model(self) -> Model:
        """The model with the change.

        Raises:
            ModelError: there can be no such model.
        """
        return replace(self.of, **self.changes)


@dataclass(frozen=True)
class ModelEdits:
    """An equation of somebody, looked at as one that is right for another model.

    Args:
        edits: gives the other models, the most believable first.
        names: those that stand in the equation.
        is_right: decides the equation for one of them; it may raise where such a model has no answer.
    """

    edits: Callable[[], Sequence[ModelEdit]]
    names: Collection[str]
    is_right: Callable[[Model], bool]

    def explained(self, number: int) -> list[Explanation]:
        """The most believable single changes with which the equation is right."""
        known = (each for each in (self.edits() if number == 1 else ()) if not each.still & {*self.names})
        found = (each.mistake for each in known if self._explains(each))
        return [Explanation((Share(x, Fraction(1)),), 0, PLAINEST + x.rank) for x in islice(found, MOST_STATED)]

    def difference(self, explanation: Explanation) -> str:
        """The empty text: the equations of the two models are not compared term by term."""
        return ""

    def _explains(self, edit: ModelEdit) -> bool:
        with suppress(EomgenError, ArithmeticError):  # there is no such model, or it has no value: a rod of length 0
            return self.is_right(edit.model)
        return False


def edited_models(model: Model, parts: Contributions) -> tuple[ModelEdit, ...]:
    """The models with one change each, the most believable first, at most MOST.

    Args:
        model: as its file has it.
        parts: the contributions to its equations.
    """
    found = sorted(_Editor(model.requesting({}), parts).edits(), key=lambda each: each.mistake.rank)
    return tuple(found[:MOST])


@dataclass(frozen=True)
class _Editor:
    """Makes the changes of one model."""

    model: Model
    parts: Contributions

    def edits(self) -> Iterator[ModelEdit]:
        for leaf in self.model.leaves(()):
            if leaf.path[0] in EDITED and isinstance(leaf.value, Expression):
                yield from self._of_formula(leaf)
            elif leaf.path[0] in EDITED and isinstance(leaf.value, str):
                yield from self._of_point(leaf)
        for name in self.model.forces:
            rest = Table({other: force for other, force in self.model.forces.items() if other != name})
            yield self._edit("missing_term", f"the force {name} is missing", PLACED, force=name, forces=rest)
        for name in self.model.bodies:
            yield from self._of_body(name)
        yield from self._held()

    def _edit(self, kind: str, text: str, rank: float, body: str = "", force: str = "", **changes: Any) -> ModelEdit:
        """A change of whole tables of the model."""
        mistake = Mistake(text, kind, (0,), rank, body, force, open=False, text=text)
        return ModelEdit(mistake, self.model, changes)

    def _at(self, leaf: Leaf, value: Any, kind: str, text: str, rank: float) -> Iterator[ModelEdit]:
        """The change of one value of the file."""
        table, name = str(leaf.path[0]), str(leaf.path[1])
        of = {"bodies": {"body": name}, "forces": {"force": name}}.get(table, {})
        with suppress(EomgenError):
            changed = with_leaf(getattr(self.model, table), leaf.path[1:], value)
            yield self._edit(kind, text, rank, **of, **{table: changed})

    # -- formulas ------------------------------------------------------------------------------------

    def _of_formula(self, leaf: Leaf) -> Iterator[ModelEdit]:
        """A formula of the file with one mistake in it."""
        with suppress(EomgenError):
            x = self.parts.system.scope.value(leaf.value)
            where = f"{leaf.whereabouts}, {term_text(x)},"
            seen: list[Scalar] = [x]
            for kind, other, text, rank in self._others(x, leaf.path[-1] == "angle"):
                if other not in seen:
                    seen.append(other)
                    yield from self._at(leaf, _formula(other), kind, f"{where} {text}", rank)

    def _others(self, x: Scalar, is_angle: bool) -> Iterator[tuple[str, Scalar, str, float]]:
        """(kind of the cause, formula, what is wrong, rank) of what people write for a formula."""
        if is_zero(x):
            return
        yield "sign", -x, "has the wrong sign", SHARED
        if type(x) is not Node:
            return
        symbols = self.parts.operator.base.symbols
        yield "missing_term", 0, "is left out", SHARED
        if is_angle:
            quarter = over(x.graph.pi, 2)
            for turned in (x + quarter, x - quarter):
                yield "wrong_axis", turned, "is counted from the other axis", SHARED
        moving = [q for q in symbols.q if q in symbols_of((x,))]
        for q in moving:
            yield "sign", substituted((x,), {q: -q})[0], f"has {q.name} in the opposite direction", SHARED
            yield "missing_term", substituted((x,), {q: 0})[0], f"leaves out {q.name}", SHARED + SHORTER
            for p in (p for p in symbols.q if p is not q and self._dimension(p) == self._dimension(q)):
                other = substituted((x,), {q: q + p})[0]
                yield "wrong_quantity", other, f"has {q.name} + {p.name} for {q.name}: it is no relative one", EXCHANGED
        for kind, mapping, text in wrong_parameters(symbols_of((x,)), tuple(symbols.parameters.values())):
            p, y = next(iter(mapping.items()))
            if kind != "wrong_quantity" or self._dimension(p) == self._dimension(y):
                yield kind, substituted((x,), mapping)[0], f"is wrong: {text}", EXCHANGED

    def _dimension(self, x: Scalar) -> str:
        if type(x) is not Node or x.op != "symbol":
            return ""
        return str(Edits.of_system(self.parts.system).dimensions.get(x.name, x.name))

    # -- points and bodies ---------------------------------------------------------------------------

    def _of_point(self, leaf: Leaf) -> Iterator[ModelEdit]:
        """Another point of the same body, or the body's origin, in the place of one."""
        points, given = self.model.named_points, str(leaf.value)
        body = given.partition(".")[0]
        if given not in points and not (leaf.path[-1] == "on" and given in self.model.bodies):
            return
        for other in points:
            if other != given and other.partition(".")[0] == body and "." in other:
                text = f"{leaf.whereabouts} is {other}, and not {given}: the lever arm is wrong"
                yield from self._at(leaf, other, "wrong_point", text, PLACED)

    def _of_body(self, name: str) -> Iterator[ModelEdit]:
        """Its mass at a point, its inertia about a point, or of another shape."""
        mass, plane = self.parts.system.scope.mass_properties(name), self.model.space == "plane"
        if is_zero(mass.m):
            return
        I = mass.I
        own = (I[2][2],) if plane else (I[0][0], I[1][1], I[2][2], I[0][1], I[1][2], I[2][0])
        nothing = (0,) * len(own)
        if any(not is_zero(x) for x in own):
            text = f"the moment of inertia of {name} is missing: its mass is taken as that of a particle"
            yield self._massive("missing_term", text, name, mass.com, nothing)
        for point, r in self.parts.operator.base.motion.points[name].items():
            d = r - mass.com
            if all(map(is_zero, d)):
                continue
            text = f"{name} is treated as if its mass centre were at its {point}"
            yield self._massive("wrong_point", text, name, r, own)
            text = f"the mass of {name} is taken as if all of it were at its {point}"
            yield self._massive("wrong_point", text, name, r, nothing)
            if plane:
                text = f"the moment of inertia of {name} about its {point} stands where that about its mass centre is"
                about = (own[0] + mass.m * (d @ d),)
                yield self._massive("wrong_point", f"{text} needed (Steiner)", name, mass.com, about)
        yield from self._other_shapes(name) if plane else ()

    def _other_shapes(self, name: str) -> Iterator[ModelEdit]:
        """The body with the moment of inertia c m r^2 of another shape, in the plane."""
        shape, mass = self.model.bodies[name].shape, self.parts.system.scope.mass_properties(name)
        sizes = [x for x in vars(shape).values() if isinstance(x, Expression)] if shape is not None else []
        for c, what in SHAPES:
            for r in (x for x in map(self.parts.system.scope.value, sizes) if x is not mass.m):
                inertia = c * mass.m * r * r
                taken, true = (term_text(x) for x in (inertia, mass.I[2][2]))
                text = f"in the rotation of {name} the moment of inertia is that of {what}, {taken}, where it is {true}"
                yield self._massive("factor", text, name, mass.com, (inertia,))

    def _massive(self, kind: str, text: str, name: str, com: Vector, inertia: Sequence[Scalar]) -> ModelEdit:
        """The model with a body whose mass centre and inertia are others, its points where they were."""
        body, size = self.model.bodies[name], 2 if self.model.space == "plane" else 3
        mass, points = self.parts.system.scope.mass_properties(name).m, self.parts.operator.base.motion.points[name]
        own = {x: tuple(map(_formula, r[:size])) for x, r in points.items() if x not in ("origin", "center")}
        made = Body(
            mass=_formula(mass),
            center=tuple(map(_formula, com[:size])),
            inertia=tuple(map(_formula, inertia)),
            points=Table(own),
            joint=body.joint,
            line=body.line,
        )
        return self._edit(kind, text, PLACED, name, bodies=Table({**self.model.bodies, name: made}))

    # -- what stands still -----------------------------------------------------------------------------

    def _held(self) -> Iterator[ModelEdit]:
        """The model with each of its coordinates held, and with all."""
        free = [name for name, q in self.model.coordinates.items() if not q.driven and not q.dependent]
        if len(free) > MOST_HELD or self.model.speeds:
            return
        for names in ([free] if free else []) + ([[name] for name in free] if len(free) > 1 else []):
            held = {n: q.held if n in names else q for n, q in self.model.coordinates.items()}
            moved = self._moved_by(names[0]) if len(names) == 1 else []
            what = "everything that moves" if names == free else names[0]
            what = f"{what} ({', '.join(moved)})" if 0 < len(moved) <= FEW else what
            text = f"what the motion of {what} does is missing: it is as if {what} stood still"
            still = frozenset(f"{name}{dots}" for name in names for dots in ("'", "''"))
            rank = SHARED + SHORTER
            yield replace(self._edit("missing_term", text, rank, coordinates=Table(held)), still=still)

    def _moved_by(self, coordinate: str) -> list[str]:
        """The bodies whose joints are moved by a coordinate, or placed with it."""
        joints = {name: body.joint for name, body in self.model.bodies.items() if body.joint is not None}
        space = self.model.space
        return [name for name, x in joints.items() if any(coordinate in s.names for s in x.variables(space))]


def _formula(x: Scalar) -> Expression:
    text = to_text(x) if type(x) is Node else str(x)
    return parse(text, longest=len(text) + 1, references=True)


def with_leaf(part: Any, path: Sequence[Any], value: Any) -> Any:
    """A table or a part with another value at a path of the file."""
    if not path:
        return (value,) if isinstance(part, tuple) else value
    key, *rest = path
    if isinstance(part, tuple) and not isinstance(key, int):  # one table in the place of a list of them
        return (with_leaf(part[0], path, value),)
    if isinstance(part, tuple):
        return (*part[:key], with_leaf(part[key], rest, value), *part[key + 1 :])
    if isinstance(part, Table):
        return Table({**part, key: with_leaf(part[key], rest, value)})
    for slot in type(part).slots():
        inner = getattr(part, slot.name)
        if slot.key == key:
            return replace(part, **{slot.name: with_leaf(inner, rest, value)})
        if slot.inline and inner is not None:
            with suppress(KeyError):
                return replace(part, **{slot.name: with_leaf(inner, path, value)})
    raise KeyError(key)
