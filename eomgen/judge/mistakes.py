"""Contributions -> what people make of them by mistake: each a change of the equations that can be named.

A whole contribution (a body's rotation, a weight, a spring) with a wrong factor, several together, or terms of its
derivatives; with one place of it changed, before it is derived (`edits`) or in its terms (`wrong_terms`). What an
equation differs by is then sought among them (`diagnosis`): the lists hold no equation, only what may go wrong.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field, replace
from functools import cached_property
from itertools import combinations, islice
from typing import Any

from eomgen.errors import DerivationError, EomgenError
from eomgen.frozen import dataclass
from eomgen.judge.diagnosis import (
    EXCHANGED,
    PIECES,
    PLACED,
    PLAIN,
    PLAINEST,
    SHARED,
    SHORTER,
    Explanation,
    Mistake,
    Share,
)
from eomgen.judge.terms import FEW, Edits, Term, WrongTerms, term_text, terms_of, wrong_parameters
from eomgen.mechanics.dynamics import Contribution, Contributions
from eomgen.model import Leaf, Model, Table
from eomgen.symbolic.expression import (
    Expression,
    Fraction,
    Node,
    Scalar,
    ScalarRow,
    Vector,
    depends_on,
    gradient,
    is_zero,
    over,
    parse,
    substituted,
    symbols_of,
)
from eomgen.symbolic.print import to_text

MOST = 3000  # mistakes of one equation
MOST_SPEEDS = 12  # of a model whose products of speeds are looked at one by one
GROUPS = ("all rotations", "the whole potential energy", "all that is applied")  # whose members are stated
MOST_REPORTED = 3  # members of a group that are stated
MOST_NODES = 100_000  # of expressions that are made for them


@dataclass(frozen=True)
class Mistakes:
    """Possible mistakes in equations, energies or forces of a system.

    Args:
        parts: the contributions.
        what: "motion": the equations of motion; "T", "V", "energy": T + V; "Q": the generalized forces.
        of: only of these bodies or forces; () of all.
        start: q and u there: of an energy what it has changed by since.
    """

    parts: Contributions
    what: str
    of: tuple[str, ...] = ()
    start: Mapping[Node, Scalar] = field(default_factory=dict)

    @property
    def _edits(self) -> Edits:
        return Edits.of_system(self.parts.system)

    def rows(self, part: Contribution) -> ScalarRow:
        """The share of a contribution in the requested quantity."""
        operator = self.parts.operator
        if self.what == "T":
            return (operator.energy(part.T),)
        if self.what == "V":
            return (part.V,)
        if self.what == "energy":
            energy = operator.energy(part.T) + part.V
            return (energy - substituted((energy,), self.start)[0] if self.start else energy,)
        if self.what == "Q":
            return tuple(-x for x in operator.rows(replace(part, T=0)))
        return operator.rows(part)

    @cached_property
    def all(self) -> tuple[Mistake, ...]:
        """All of them that change something, the most believable first."""
        found: list[Mistake] = []
        graph = self.parts.system.scope.graph
        most = len(graph) + MOST_NODES
        for each in self._sought():
            if not all(map(is_zero, each.rows)):
                found.append(each)
            if len(found) >= MOST or len(graph) > most:
                break
        return tuple(sorted(found, key=lambda each: each.rank))

    @cached_property
    def whole(self) -> tuple[Contribution, ...]:
        """The contributions that matter here."""
        known = (part for part in self.parts.elementary if self.what != "V" or part.kind != "constant")
        mine = (part for part in known if not self.of or {part.body, part.force} & {*self.of})
        return tuple(part for part in mine if not all(map(is_zero, self.rows(part))))

    def _sought(self) -> Iterator[Mistake]:
        alike: dict[tuple[str, ScalarRow], list[Contribution]] = {}
        for part in self.whole:
            alike.setdefault((part.kind, self._edits.written(self.rows(part))), []).append(part)
        for members in alike.values():
            for part in members:  # of several that do the same all are rather wrong than one
                rank, squares = 2 * SHORTER if len(members) > 1 else PLAIN, not is_zero(part.T)
                yield Mistake(part.name, "factor", self.rows(part), rank, part.body, part.force, squares=squares)
            if len(members) > 1:
                name, squares = " and ".join(part.name for part in members), not is_zero(members[0].T)
                yield Mistake(name, "factor", self._sum(members), SHORTER, squares=squares)
        yield from self._together()
        if self.what == "motion":
            yield from self._pieces()
        if self.what in ("motion", "T", "energy"):
            yield from self._products()
        for part in self.whole if self.what != "energy" else ():
            yield from self._wrong_terms(part).in_rows(self.rows(part))
        for part in self.whole:
            yield from self._edited(part)

    # -- a formula with a mistake in it --------------------------------------------------------------

    @cached_property
    def terms(self) -> frozenset[Term]:
        """(row, term) of every contribution, multiplied out."""
        if self.what == "energy":
            return frozenset()  # what it has changed by since the start is no sum of terms changed one by one
        positive = frozenset(self._edits.positive)
        return frozenset(
            (k, term)
            for part in self.whole
            for k, row in enumerate(self.rows(part))
            for term in terms_of(row, positive)
        )

    def _wrong_terms(self, part: Contribution) -> WrongTerms:
        symbols = self.parts.system.symbols
        parameters, rates = tuple(symbols.parameters.values()), (*symbols.u, *symbols.a)
        return WrongTerms(self._edits, parameters, rates, part.name, part.body, part.force)

    def _edited(self, part: Contribution) -> Iterator[Mistake]:
        """A contribution with one place of its energy or its forces changed, carried through the derivation."""
        edits = self._edits
        forms: list[tuple[ScalarRow, Callable[[ScalarRow], Contribution]]] = [
            ((part.T,), lambda x: replace(part, T=x[0], V=0, Q=(), row=None)),
            ((part.V,), lambda x: replace(part, T=0, V=x[0], Q=(), row=None)),
            (part.Q, lambda x: replace(part, T=0, V=0, Q=x, row=None)),
            (part.row or (), lambda x: replace(part, row=x)),
        ]
        for formulas, changed in forms:
            for each in edits.of(formulas):
                by = tuple(x - y for x, y in zip(each.to, formulas, strict=True))
                text = f"in {part.name} {each.text}"
                with suppress(DerivationError):  # it has no value at the start
                    rows = self.rows(changed(by))
                    yield Mistake(part.name, each.kind, rows, each.rank, part.body, part.force, False, text)

    # -- contributions together --------------------------------------------------------------------

    def _together(self) -> Iterator[Mistake]:
        groups: dict[tuple[str, str, str], list[Contribution]] = {}
        for part in self.whole:
            kinetic = not is_zero(part.T)
            if kinetic:
                groups.setdefault((f"the kinetic energy of {part.body}", part.body, ""), []).append(part)
                groups.setdefault(("the whole kinetic energy", "", ""), []).append(part)
            elif part.force:
                groups.setdefault((f"the force {part.force}", "", part.force), []).append(part)
            if not kinetic and not is_zero(part.V):
                groups.setdefault(("the whole potential energy", "", ""), []).append(part)
            if not kinetic:
                groups.setdefault(("all that is applied", "", ""), []).append(part)
            if part.kind == "rotation":
                groups.setdefault(("all rotations", "", ""), []).append(part)
            if part.body:
                groups.setdefault((f"all that belongs to {part.body}", part.body, ""), []).append(part)
        seen: set[tuple[str, ...]] = set()
        for (name, body, force), members in groups.items():
            key = tuple(part.name for part in members)
            if len(members) > 1 and key not in seen:
                seen.add(key)
                whose = ", ".join(part.body if part.kind == "rotation" else part.name for part in members)
                reported = f"{name} ({whose})" if name in GROUPS and len(members) <= MOST_REPORTED else name
                squares = all(not is_zero(part.T) for part in members)
                rows = self._sum(members)
                yield Mistake(reported, "factor", rows, SHARED, body, force, squares=squares)

    def _sum(self, members: Sequence[Contribution]) -> ScalarRow:
        rows = [self.rows(part) for part in members]
        return tuple(sum(column, start=0) for column in zip(*rows, strict=True))

    # -- terms of the derivatives --------------------------------------------------------------------

    @property
    def _kinetic(self) -> tuple[Contribution, ...]:
        return tuple(part for part in self.whole if not is_zero(part.T))

    def _pieces(self) -> Iterator[Mistake]:
        """Accelerations, products of speeds and dT/dq of every kinetic energy."""
        operator, u, a = self.parts.operator, self.parts.system.symbols.u, self.parts.system.symbols.a
        sums = [(part, part.T) for part in self._kinetic]
        if len(sums) > 1:
            whole = Contribution("the whole kinetic energy", T=sum((part.T for part in self._kinetic), start=0))
            sums.append((whole, whole.T))
        for part, T in sums:
            accelerated, carried, held = operator.inertia(T)
            of = part.name.removeprefix("the ")
            moving = [x + y for x, y in zip(carried, held, strict=True)]
            slopes = [gradient(value, a) for value in accelerated]
            for k, x in enumerate(a):
                row = tuple(each[k] * x for each in slopes)
                name = f"the term with {x.name} of the {of}"
                yield Mistake(name, "factor", row, PIECES, part.body, squares=True)
            first = [gradient(value, u) for value in moving] if len(u) <= MOST_SPEEDS else []
            for i, j in [*combinations(range(len(u)), 2), *((k, k) for k in range(len(u)))] if first else ():
                row = tuple(
                    gradient(row[i], (u[j],))[0] * u[i] * u[j] * (1 if i != j else Fraction(1, 2)) for row in first
                )
                name = f"{u[i].name}*{u[j].name}" if i != j else f"{u[i].name}^2"
                kind = "coriolis" if i != j else "factor"
                title = f"the Coriolis term with {name}" if i != j else f"the term with {name}"
                yield Mistake(f"{title} of the {of}", kind, row, PIECES, part.body)
            mixed = len(u) > 1 and any(depends_on(x, (v,)) for row in first for x, v in zip(row, u, strict=True))
            kind = "coriolis" if mixed else "factor"
            yield Mistake(f"-dT/dq of the {of}", "factor", held, PIECES + SHORTER, part.body)
            name = f"what d/dt dT/dq' of the {of} holds beside accelerations"
            yield Mistake(name, kind, carried, PIECES + SHORTER, part.body)
            yield Mistake(f"all products of speeds in the {of}", kind, tuple(moving), PIECES + SHORTER, part.body)

    def _products(self) -> Iterator[Mistake]:
        """The product of two speeds in a kinetic energy, which is lost where only their squares are added."""
        for part in self._kinetic:
            held = symbols_of((part.T,))
            moving = [u for u in self.parts.operator.base.symbols.u if u in held]
            for u, w in combinations(moving, 2) if len(moving) <= MOST_SPEEDS else ():
                mixed = gradient(gradient(part.T, (u,))[0], (w,))[0] * u * w
                name = f"the product {u.name}*{w.name} in the square of the velocity of {part.body}"
                row = self.rows(replace(part, T=mixed, V=0, Q=(), row=None))
                yield Mistake(name, "factor", row, SHARED, part.body)


# -------- model edits -----------------------------------------------------------------------------------------
# Model, equation of somebody -> the one change of the model file with which the equation would be right.
#
# A formula of the file (a length, an angle, a mass, a component of a force) has another sign, is left out, or holds
# another parameter or coordinate; an angle is counted from another axis; one point of a body stands for another; a
# mass
# sits in one point, an inertia is taken about another point or is that of another shape; a force is left out; a
# coordinate stands still. Each such model is derived again, and the equation is decided for it, whatever it is about:
# motion, energy, a reaction, an answer.


MOST_EDITED = 80  # models that are derived
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
    """The models with one change each, the most believable first, at most MOST_EDITED.

    Args:
        model: as its file has it.
        parts: the contributions to its equations.
    """
    found = sorted(_Editor(model.requesting({}), parts).edits(), key=lambda each: each.mistake.rank)
    return tuple(found[:MOST_EDITED])


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
        made = body.altered(
            shape=None,
            parts=None,
            mass=_formula(mass),
            center=tuple(map(_formula, com[:size])),
            inertia=tuple(map(_formula, inertia)),
            points=Table(own),
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
