"""Contributions -> what people make of them by mistake: each a change of the equations that can be named.

Three levels, none of which knows of the others: a whole contribution (a body's rotation, a weight, a spring) with a
wrong factor; a contribution derived from a wrong place, angle, velocity or parameter; a single term of the result. What
an equation differs by is then sought among them (`diagnosis`): the lists hold no equation, only what may go wrong.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations

from eomgen.judge.contributions import Contribution, Contributions
from eomgen.mechanics.bodies.inertia import HALF, body_energies, mass_properties
from eomgen.mechanics.bodies.kinematics import velocity_of
from eomgen.mechanics.equations.work import load_row
from eomgen.model.catalog import Catalog
from eomgen.model.dimensions import inferred
from eomgen.model.forces.load import BodyPoint, PointForce
from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.normal_form import TooLarge
from eomgen.symbolic.exact.writing import Writer
from eomgen.symbolic.expression.derivative import depends_on, gradient, substituted, symbols_of
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Graph, Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow, linear_terms
from eomgen.symbolic.expression.spatial import Vector, cross, dot, minus, vector_of
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.work import Work

MOST_TERMS = 60  # of an equation that is looked at term by term
MOST = 1400  # corruptions of one equation
MOST_NODES = 100_000  # of expressions that are made for them

# how readily a mistake is believed, the smaller the sooner
PLAIN, PLACED, SHARED, PIECES, TERMS, EXCHANGED, ODD = range(7)
EVERYTHING = "everything"
SHORTER = 0.3  # of what a shorter name tells as well


@dataclass(frozen=True)
class Corruption:
    """One thing that may have gone wrong.

    Args:
        name: what it concerns, in words; of a wrong factor the contribution.
        kind: of the cause: "factor" where the factor is open, else as in `CAUSES`.
        rows: what one unit of it adds to each equation.
        rank: how readily it is believed.
        body, force: whose it is.
        open: whether any simple factor is possible; else it is there once.
        text: the sentence, of what is there once.
        tidy: what the sentence names where the factor is open.
    """

    name: str
    kind: str
    rows: ScalarRow
    rank: float
    body: str = ""
    force: str = ""
    open: bool = True
    text: str = ""


@dataclass(frozen=True)
class Corruptions:
    """What may be wrong in equations, energies or forces of a system.

    Args:
        parts: the contributions.
        what: "motion": the equations of motion; "T", "V"; "Q": the generalized forces.
        of: only of these bodies or forces; () of all.
    """

    parts: Contributions
    what: str
    of: tuple[str, ...] = ()

    def rows(self, part: Contribution) -> ScalarRow:
        """What a contribution adds to what is asked."""
        operator = self.parts.operator
        if self.what == "T":
            return (operator.energy(part.T),)
        if self.what == "V":
            return (part.V,)
        if self.what == "Q":
            return tuple(-x for x in operator.rows(replace(part, T=0)))
        return operator.rows(part)

    @cached_property
    def all(self) -> tuple[Corruption, ...]:
        """All of them that change something, the most believable first."""
        found: list[Corruption] = []
        graph = self.parts.system.scope.graph
        most = len(graph) + MOST_NODES
        for each in self._sought():
            if not all(map(is_zero, each.rows)):
                found.append(each)
            if len(found) >= MOST or len(graph) > most:
                break
        return tuple(sorted(found, key=lambda each: each.rank))

    @cached_property
    def _whole(self) -> tuple[Contribution, ...]:
        """The contributions that matter here."""
        mine = (part for part in self.parts.elementary if not self.of or {part.body, part.force} & {*self.of})
        return tuple(part for part in mine if not all(map(is_zero, self.rows(part))))

    def _sought(self) -> Iterator[Corruption]:
        for part in self._whole:
            yield Corruption(part.name, "factor", self.rows(part), PLAIN, part.body, part.force)
        yield from self._together()
        if self.what == "motion":
            yield from self._pieces()
        yield from self._wrong_points()
        yield from self._wrong_angles()
        yield from self._wrong_velocities()
        yield from self._wrong_parameters()

    # -- contributions together --------------------------------------------------------------------

    def _together(self) -> Iterator[Corruption]:
        groups: dict[tuple[str, str, str], list[Contribution]] = {}
        for part in self._whole:
            kinetic = not is_zero(part.T)
            if kinetic:
                groups.setdefault((f"the kinetic energy of {part.body}", part.body, ""), []).append(part)
                groups.setdefault(("the whole kinetic energy", "", ""), []).append(part)
            elif part.kind == "weight":
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
                yield Corruption(name, "factor", self._sum(members), SHARED, body, force)

    def _sum(self, members: Sequence[Contribution]) -> ScalarRow:
        rows = [self.rows(part) for part in members]
        return tuple(sum(column, start=0) for column in zip(*rows, strict=True))

    # -- terms of the derivatives --------------------------------------------------------------------

    def _pieces(self) -> Iterator[Corruption]:
        """Accelerations, products of speeds and dT/dq of every kinetic energy."""
        operator, u, a = self.parts.operator, self.parts.system.symbols.u, self.parts.system.symbols.a
        kinetic = [part for part in self._whole if not is_zero(part.T)]
        sums = [(part, part.T) for part in kinetic]
        if len(kinetic) > 1:
            whole = Contribution("the whole kinetic energy", T=sum((part.T for part in kinetic), start=0))
            sums.append((whole, whole.T))
        for part, T in sums:
            accelerated, carried, held = operator.inertia(T)
            of = part.name.removeprefix("the ")
            moving = [x + y for x, y in zip(carried, held, strict=True)]
            for x in a:
                row = tuple(gradient(value, (x,))[0] * x for value in accelerated)
                yield Corruption(f"the term with {x.name} of the {of}", "factor", row, PIECES, part.body)
            first = [gradient(value, u) for value in moving]
            for i, j in [*combinations(range(len(u)), 2), *((k, k) for k in range(len(u)))]:
                row = tuple(gradient(row[i], (u[j],))[0] * u[i] * u[j] * (1 if i != j else HALF) for row in first)
                name = f"{u[i].name}*{u[j].name}" if i != j else f"{u[i].name}^2"
                kind = "coriolis" if i != j else "factor"
                title = f"the Coriolis term with {name}" if i != j else f"the term with {name}"
                yield Corruption(f"{title} of the {of}", kind, row, PIECES, part.body)
            mixed = len(u) > 1 and any(depends_on(x, (v,)) for row in first for x, v in zip(row, u, strict=True))
            kind = "coriolis" if mixed else "factor"
            yield Corruption(f"-dT/dq of the {of}", "factor", held, PIECES + SHORTER, part.body)
            name = f"what d/dt dT/dq' of the {of} holds beside accelerations"
            yield Corruption(name, kind, carried, PIECES + SHORTER, part.body)
            yield Corruption(f"all products of speeds in the {of}", kind, tuple(moving), PIECES + SHORTER, part.body)

    # -- wrong points ----------------------------------------------------------------------------------

    def _wrong_points(self) -> Iterator[Corruption]:
        base = self.parts.operator.base
        motion = base.motion
        for link, energy in zip(motion.links, body_energies(motion), strict=True):
            mass = mass_properties(motion.scope, link.name)
            if is_zero(mass.m):
                continue
            places = self._places(link.name, mass.com)
            translation = next((p for p in self._whole if p.body == link.name and p.kind == "translation"), None)
            weights = [p for p in self._whole if p.body == link.name and isinstance(p.load, PointForce)]
            if translation is not None and any(not is_zero(x) for x in mass.com):
                for factor, how in ((2, "twice"), (HALF, "half")):
                    place = (link.name, vector_of(factor * x for x in mass.com))
                    v = velocity_of(motion, place)
                    T = HALF * mass.m * dot(v, v) - translation.T + (factor * factor - 1) * energy.rotation
                    text = f"{link.name} is treated as if it were {how} as long"
                    longer = Contribution("", T=T, V=self._raised(weights, place))
                    yield self._once(f"the length of {link.name}", "wrong_point", longer, SHARED, link.name, text=text)
            for point, r in places.items():
                if any(not is_zero(x) for x in energy.spin) and self.what in ("motion", "T"):
                    arm = minus(r, mass.com)
                    swept = cross(energy.spin, arm)
                    T = HALF * mass.m * dot(swept, swept)
                    text = (
                        f"the moment of inertia of {link.name} about {point} stands where that about its mass centre"
                        " is needed: what the mass centre does is counted in the translation already"
                    )
                    yield self._once(
                        f"the moment of inertia of {link.name}",
                        "wrong_point",
                        Contribution("", T=T),
                        PLACED,
                        link.name,
                        text=text,
                    )
                    text = (
                        f"the moment of inertia of {link.name} about its mass centre stands where that about {point} is"
                        " needed (Steiner)"
                    )
                    yield self._once(
                        f"the moment of inertia of {link.name}",
                        "wrong_point",
                        Contribution("", T=-T),
                        PLACED,
                        link.name,
                        text=text,
                    )
                if translation is not None and link.name in motion.index:
                    v = velocity_of(motion, (link.name, r))
                    T = HALF * mass.m * dot(v, v) - translation.T
                    if not is_zero(energy.rotation):
                        text = f"the mass of {link.name} is taken as if all of it were at its {point}"
                        there = Contribution("", T=T - energy.rotation)
                        name = f"the kinetic energy of {link.name}"
                        yield self._once(name, "wrong_point", there, PLACED, link.name, text=text)
                    text = f"the velocity of {link.name}.{point} stands where that of its mass centre is needed"
                    yield self._once(
                        f"the translation of {link.name}",
                        "wrong_point",
                        Contribution("", T=T),
                        PLACED,
                        link.name,
                        text=text,
                    )
                    if weights:
                        V = self._raised(weights, (link.name, r))
                        text = f"{link.name} is treated as if its mass centre were at its {point}"
                        yield self._once(
                            f"the mass centre of {link.name}",
                            "wrong_point",
                            Contribution("", T=T, V=V),
                            PLACED,
                            link.name,
                            text=text,
                        )
            for part in weights:
                yield from self._other_place(part, places)

    def _raised(self, weights: Sequence[Contribution], place: BodyPoint) -> Scalar:
        """What the potential energy of weights changes by where they act at another place."""
        motion, V = self.parts.operator.base.motion, list[Scalar]()
        for part in weights:
            if isinstance(part.load, PointForce) and not is_zero(part.V):
                V.append(-dot(part.load.force, minus(motion.position(place), motion.position(part.load.place))))
        return sum(V, start=0)

    def _places(self, body: str, com: Vector) -> dict[str, Vector]:
        """The points of a body that are not its mass centre."""
        points = self.parts.operator.base.motion.points[body]
        different = {
            name: r for name, r in points.items() if any(not is_zero(x - y) for x, y in zip(r, com, strict=True))
        }
        return {name: r for k, (name, r) in enumerate(different.items()) if r not in list(different.values())[:k]}

    def _other_place(self, part: Contribution, places: Mapping[str, Vector]) -> Iterator[Corruption]:
        """A force of a body at another point of it."""
        load, base = part.load, self.parts.operator.base
        if not isinstance(load, PointForce) or load.place[0] is None:
            return
        everywhere = {**places}
        for point, r in everywhere.items():
            moved = replace(load, place=(load.place[0], r))
            row = tuple(x - y for x, y in zip(load_row(base.loads, moved), load_row(base.loads, load), strict=True))
            V: Scalar = 0
            if not is_zero(part.V):
                gap = minus(base.motion.position(moved.place), base.motion.position(load.place))
                V, row = -dot(load.force, gap), ()
            text = f"{part.name} acts at {load.place[0]}.{point} in the equation: its lever arm is wrong"
            yield self._once(
                part.name, "wrong_point", Contribution("", V=V, Q=row), PLACED, part.body, part.force, text
            )

    def _once(
        self,
        name: str,
        kind: str,
        part: Contribution,
        rank: float,
        body: str = "",
        force: str = "",
        text: str = "",
    ) -> Corruption:
        return Corruption(name, kind, self.rows(part), rank, body, force, False, text)

    # -- wrong angles ----------------------------------------------------------------------------------

    def _groups(self) -> list[Contribution]:
        """Every contribution, and all of one body together."""
        found = [part for part in self._whole if part.row is None]
        bodies: dict[str, list[Contribution]] = {}
        for part in found:
            if part.body:
                bodies.setdefault(part.body, []).append(part)
        for body, members in bodies.items():
            if len(members) > 1:
                found.append(_joined(f"all that belongs to {body}", members, body))
        if len(found) > 1:
            found.append(_joined(EVERYTHING, [part for part in self._whole if part.row is None]))
        return found

    def _wrong_angles(self) -> Iterator[Corruption]:
        for part in self._groups():
            for angle in _angles((part.T, part.V, *part.Q)):
                told = _text(angle)
                for kind, mapping, what in _turned(angle):
                    rank = PLACED if is_zero(part.T) else EXCHANGED
                    rank = ODD if part.name == EVERYTHING else max(rank, TERMS) if kind == "other" else rank
                    text = f"in {part.name} {what.format(told)}"
                    yield self._once(part.name, kind, _changed(part, mapping), rank, part.body, part.force, text)

    # -- wrong velocities and coordinates ----------------------------------------------------------------

    def _wrong_velocities(self) -> Iterator[Corruption]:
        base = self.parts.operator.base
        symbols = base.symbols
        for part in self._groups():
            held = symbols_of((part.T, part.V, *part.Q))
            for u in symbols.u:
                if u in symbols_of((part.T,)):
                    text = f"the velocity in {part.name} leaves out what {u.name} does"
                    still = replace(part, T=substituted((part.T,), {u: 0})[0] - part.T, V=0, Q=())
                    yield self._once(part.name, "missing_term", still, SHARED, part.body, text=text)
            for q, rate in zip(symbols.q, _rates(symbols.q, symbols.u), strict=True):
                if q in held or rate in held:
                    yield from self._wrong_coordinate(part, q, rate)

    def _wrong_coordinate(self, part: Contribution, q: Node, u: Node | None) -> Iterator[Corruption]:
        """A coordinate in the opposite direction, relative for absolute, or another one in its place."""
        symbols = self.parts.operator.base.symbols

        def changed(kind: str, mapping: dict[Node, Scalar], what: str) -> Corruption:
            text = f"in {part.name} {what}"
            change = _changed(part, mapping)
            return self._once(part.name, kind, change, EXCHANGED, part.body, part.force, text)

        opposite: dict[Node, Scalar] = {q: -q} if u is None else {q: -q, u: -u}
        yield changed("sign", opposite, f"{q.name} is taken in the opposite direction")
        if part.name == EVERYTHING or u is None:
            return
        for p, w in zip(symbols.q, _rates(symbols.q, symbols.u), strict=True):
            if p is q or w is None or not self._alike(p.name, q.name):
                continue
            told = f"stands where {q.name} alone is meant"
            yield changed("other", {q: q + p, u: u + w}, f"{q.name} + {p.name} {told}: it is no relative one")
            yield changed("other", {q: q - p, u: u - w}, f"{q.name} - {p.name} {told}: it is a relative one")
            yield changed("other", {q: p, u: w}, f"{p.name} stands where {q.name} is meant")

    # -- wrong parameters --------------------------------------------------------------------------------

    @cached_property
    def _dimensions(self) -> dict[str, str]:
        found = inferred(Catalog(self.parts.system.scope.model, ())).found
        return {name: str(dimension) for name, dimension in found.items()}

    def _alike(self, a: str, b: str) -> bool:
        """Whether two names stand for the same kind of quantity."""
        return self._dimensions.get(a, a) == self._dimensions.get(b, b)

    def _wrong_parameters(self) -> Iterator[Corruption]:
        parameters = self.parts.system.symbols.parameters
        for part in self._groups():
            held = [x for x in symbols_of((part.T, part.V, *part.Q)) if x.name in parameters]
            for x in held:
                for factor, how in ((2, f"2*{x.name}"), (HALF, f"{x.name}/2")):
                    kind = "wrong_point" if self._dimensions.get(x.name) == "m" else "factor"
                    text = f"in {part.name} {how} stands where {x.name} is meant"
                    yield self._once(
                        part.name, kind, _changed(part, {x: factor * x}), EXCHANGED + 1, part.body, part.force, text
                    )
                for name, y in parameters.items():
                    if y is not x and self._alike(name, x.name):
                        text = f"in {part.name} {name} stands where {x.name} is meant"
                        yield self._once(
                            part.name, "other", _changed(part, {x: y}), EXCHANGED, part.body, part.force, text
                        )


# -- single terms ------------------------------------------------------------------------------------


def terms_of(x: Scalar, positive: frozenset[Node]) -> tuple[Scalar, ...]:
    """The terms of a sum multiplied out, as they are written; () where they are too many."""
    if type(x) is not Node:
        return () if x == 0 else (x,)
    expansion = Expansion(x.graph, Work.FORMULA, positive)
    writer = Writer(expansion)
    try:
        written = writer.written(expansion.of(x))
    except TooLarge:
        return ()
    return tuple(writer.term(*each) for each in written) if len(written) <= MOST_TERMS else ()


def corrupted_terms(
    rows: Sequence[Scalar], parameters: Iterable[Node], positive: frozenset[Node], rates: frozenset[Node]
) -> Iterator[Corruption]:
    """What may be wrong with single terms of each row."""
    parameters = tuple(parameters)
    for k, row in enumerate(rows):
        terms = terms_of(row, positive)

        def at(x: Scalar, k: int = k) -> ScalarRow:
            return tuple(x if j == k else 0 for j in range(len(rows)))

        for term in terms:
            told = _text(term)
            squared = [u for u in rates if depends_on(term, (u,))]
            kind = "coriolis" if len(squared) == 2 else "factor"
            yield Corruption(f"the term {told}", kind, at(term), TERMS)
        for term in terms:
            told, graph = _text(term), _graph_of(term)
            if graph is None:
                continue
            for angle in _angles((term,)):
                for kind, mapping, what in _turned(angle):
                    changed = substituted((term,), mapping)[0] - term
                    text = f"in the term {told} {what.format(_text(angle))}"
                    yield Corruption(f"the term {told}", kind, at(changed), TERMS, open=False, text=text)
            angles = _angles((term,))
            if len(angles) > 1:
                for cause, mapping, what in _all_turned(angles):
                    changed = substituted((term,), mapping)[0]
                    text = f"in the term {told} {what}"
                    yield Corruption(f"the term {told}", cause, at(changed - term), TERMS, open=False, text=text)
            for x in parameters:
                for changed, how in ((term * x, "too many"), (graph.div(term, x), "missing")):
                    text = f"in the term {told} a factor {x.name} is {how}"
                    yield Corruption(f"the term {told}", "factor", at(changed - term), ODD, open=False, text=text)
                for y in parameters:
                    if y is not x and depends_on(term, (x,)):
                        text = f"in the term {told} {y.name} stands where {x.name} is meant"
                        changed = substituted((term,), {x: y})[0]
                        yield Corruption(
                            f"the term {told}", "other", at(changed - term), EXCHANGED, open=False, text=text
                        )
            for u in rates:
                if depends_on(term, (u,)):
                    for changed, how in ((term * u, "once too often"), (graph.div(term, u), "once too few")):
                        text = f"in the term {told} {u.name} stands {how}"
                        yield Corruption(f"the term {told}", "other", at(changed - term), ODD, open=False, text=text)
                    for w in rates:
                        if w is not u:
                            text = f"in the term {told} {w.name} stands where {u.name} is meant"
                            changed = substituted((term,), {u: w})[0]
                            yield Corruption(
                                f"the term {told}", "other", at(changed - term), ODD, open=False, text=text
                            )
            for angle in _angles((term,)):
                for name in ("sin", "cos"):
                    wave = graph.call(name, angle)
                    for changed, how in ((term * wave, "too many"), (graph.div(term, wave), "missing")):
                        text = f"in the term {told} a factor {name}({_text(angle)}) is {how}"
                        yield Corruption(f"the term {told}", "factor", at(changed - term), ODD, open=False, text=text)


# -- helpers -----------------------------------------------------------------------------------------


def _graph_of(x: Scalar) -> Graph | None:
    return x.graph if type(x) is Node else None  # type: ignore[return-value]


def _text(x: Scalar) -> str:
    from eomgen.symbolic.exact.normal_form import readable
    from eomgen.symbolic.print.text import readable_text

    return readable_text(readable(x, Work.FORMULA)) or "that is too long to be shown"


def _joined(name: str, members: Sequence[Contribution], body: str = "") -> Contribution:
    """Several contributions as one."""
    T = sum((part.T for part in members), start=0)
    V = sum((part.V for part in members), start=0)
    rows = [part.Q for part in members if part.Q]
    return Contribution(name, body, "", T, V, tuple(sum(x, start=0) for x in zip(*rows, strict=True)))


def _changed(part: Contribution, mapping: Mapping[Node, Scalar]) -> Contribution:
    """What a contribution changes by where nodes are replaced in it."""
    T, V, *Q = substituted((part.T, part.V, *part.Q), mapping)
    return Contribution(
        "", part.body, part.force, T - part.T, V - part.V, tuple(x - y for x, y in zip(Q, part.Q, strict=True))
    )


def _angles(scalars: Sequence[Scalar]) -> list[Node]:
    """What stands under sines and cosines."""
    found = [x.args[0] for x in order(scalars) if x.op in ("sin", "cos")]
    return list(dict.fromkeys(x for x in found if type(x) is Node))


def _turned(angle: Node) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    """What may happen to an angle: (kind of the cause, what replaces sine and cosine, in words)."""
    graph = angle.graph
    sin, cos = graph.held("sin", (angle,)), graph.held("cos", (angle,))
    yield "wrong_axis", {sin: cos, cos: sin}, "sin and cos of {0} are exchanged: the angle is taken from the other axis"
    yield "wrong_axis", {sin: cos, cos: -sin}, "{0} is taken from the other axis"
    yield "wrong_axis", {sin: -cos, cos: sin}, "{0} is taken from the other axis"
    yield "wrong_axis", {sin: cos}, "cos stands for sin({0}): the angle is taken from the other axis"
    yield "wrong_axis", {cos: sin}, "sin stands for cos({0}): the angle is taken from the other axis"
    yield "sign", {sin: -sin}, "the sign of sin({0}) is wrong"
    yield "sign", {cos: -cos}, "the sign of cos({0}) is wrong"
    for factor, how in ((over(graph.pi, 180), "degrees"), (over(180, graph.pi), "radians")):
        scaled = factor * angle
        mapping = {sin: graph.call("sin", scaled), cos: graph.call("cos", scaled)}
        yield "unit", mapping, f"{{0}} is taken in {how}"
    yield "other", {sin: angle, cos: 1}, "sin({0}) and cos({0}) are those of a small angle"
    yield "other", {sin: angle}, "sin({0}) is replaced by the angle"
    yield "other", {cos: 1}, "cos({0}) is left out"
    yield "other", {sin: 1}, "sin({0}) is left out"
    terms = linear_terms(angle)
    if len(terms) > 1:
        for atom in terms:
            if type(atom) is Node and atom.op == "symbol":
                other = substituted((angle,), {atom: -atom})[0]
                mapping = {sin: graph.call("sin", other), cos: graph.call("cos", other)}
                yield "sign", mapping, f"the sign of {atom.name} in the angle {{0}} is wrong"


def _all_turned(angles: Sequence[Node]) -> Iterator[tuple[str, dict[Node, Scalar], str]]:
    """The same for several angles at once."""
    graph = angles[0].graph
    sines, cosines = ([graph.held(op, (x,)) for x in angles] for op in ("sin", "cos"))
    exchanged: dict[Node, Scalar] = {**dict(zip(sines, cosines, strict=True)), **dict(zip(cosines, sines, strict=True))}
    yield "wrong_axis", exchanged, "sin and cos are exchanged: the angles are taken from the other axes"
    small: dict[Node, Scalar] = {**dict(zip(sines, angles, strict=True)), **dict.fromkeys(cosines, 1)}
    yield "other", small, "sines and cosines are those of small angles"
    for factor, how in ((over(graph.pi, 180), "degrees"), (over(180, graph.pi), "radians")):
        mapping: dict[Node, Scalar] = {
            graph.held(op, (x,)): graph.call(op, factor * x) for x in angles for op in ("sin", "cos")
        }
        yield "unit", mapping, f"the angles are taken in {how}"


def _rates(q: Sequence[Node], u: Sequence[Node]) -> list[Node | None]:
    """The speed of each coordinate where it has one of its own."""
    named = {x.name: x for x in u}
    return [named.get(f"{x.name}'") for x in q]
