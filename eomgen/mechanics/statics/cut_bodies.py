"""The forces and couples on bodies and beams that are cut free, inertia forces among them, and their balances."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from itertools import combinations

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Axes, Balance, Component, Effect
from eomgen.mechanics.kinematics import BodyLink
from eomgen.mechanics.statics.forces_in_sections import SectionForces
from eomgen.mechanics.statics.member_axis import MemberAxis
from eomgen.model import Couple, PointForce, SpreadLoad, UniformField, is_node
from eomgen.symbolic.exact import readable
from eomgen.symbolic.expression import Call, Fraction, Node, Scalar, Vector, is_zero, over, symbols_of
from eomgen.symbolic.numeric import Work, tolerances

# -------- acting ----------------------------------------------------------------------------------------------
# System -> ActingForces: what acts on its bodies in the plane, each by its name: reactions, loads, inertia forces.


@dataclass(frozen=True)
class PlacedPush:
    """Force and couple on one body, ground axes.

    Args:
        body: its index.
        place: where it acts; None of a couple of which nobody said it.
        unit: of a reaction, what one unit of it is.
        part: what is cut free with it: the body, or a part of it that has an index of its own.
    """

    body: int
    force: Vector
    couple: Scalar
    place: Vector | None
    unit: Vector | None
    part: int

    @property
    def is_couple(self) -> bool:
        return all(map(is_zero, self.force))

    @property
    def moment(self) -> Scalar:
        """About the ground's origin."""
        return self.couple if self.place is None else self.couple + self.place.cross(self.force)[2]


@dataclass(frozen=True)
class ActingForce:
    """One thing that acts.

    Args:
        name: in words.
        pushes: on each body; an inner force acts on two.
        force: the load or the constraint that it is.
        symbol: of a component of a reaction.
        spread: of a line load where it is.
        kind: "reaction", "load" or "inertia".
        follows: it is friction by that component.
    """

    name: str
    pushes: tuple[PlacedPush, ...]
    force: str = ""
    symbol: Node | None = None
    spread: tuple[SpreadLoad, ...] = ()
    kind: str = "load"
    follows: bool = False

    def on(self, parts: frozenset[int]) -> tuple[PlacedPush, ...]:
        """The forces and couples on them together; () of an inner force."""
        mine = tuple(push for push in self.pushes if push.part in parts)
        return () if self.kind == "reaction" and len({push.part for push in mine}) > 1 else mine


def what_acts(system: System) -> tuple[ActingForce, ...]:
    """All of it."""
    return (*_reactions(system), *_loads(system), *_inertia(system))


def _reactions(system: System) -> Iterator[ActingForce]:
    balance = Balance.of(system)
    for symbol, c in zip(balance.symbols, balance.components, strict=False):
        yield ActingForce(_in_words(c), _pushes(system, c.effects, symbol), c.owner, symbol, kind="reaction")
        if c.friction_effects:
            pushes = _pushes(system, c.friction_effects, symbol)
            yield ActingForce(f"the friction of {c.owner}", pushes, c.owner, symbol, (), "reaction", follows=True)


def _in_words(c: Component) -> str:
    if c.label == "tension":
        return f"the {'member force' if c.side else 'tension'} {c.name}"
    what = {"drive": "drive", "t": "friction"}.get(c.label, "couple" if c.label.startswith("couple") else "reaction")
    return f"the {what} {c.name}"


def _loads(system: System) -> Iterator[ActingForce]:
    axes = Axes(system.motion)
    for force in system.loads.applied:
        for load in (load for load in force.loads if isinstance(load, UniformField)):
            for link, mass in zip(system.motion.links, axes.masses, strict=True):
                weight = PointForce((link.name, mass.com), mass.m * load.acceleration)
                if not is_zero(mass.m):
                    pushes = _pushes(system, axes.effects_of(weight))
                    yield ActingForce(f"the weight of {link.name}", pushes, force.name)
        acts = [load for load in force.loads if isinstance(load, (PointForce, Couple))]
        pushes = tuple(push for load in acts for push in _pushes(system, axes.effects_of(load)))
        if pushes:
            pushes = resultant(pushes) if force.spread else pushes
            held = {*symbols_of([x for push in pushes for x in (*push.force, push.couple)])}
            symbol = next((x for x in system.symbols.unknowns.values() if x in held), None)
            yield ActingForce(f"the force {force.name}", pushes, force.name, symbol, force.spread)
    for link in system.motion.links:
        if efforts := Effect.of_joint(system, link.name):
            yield ActingForce(f"what acts in the joint of {link.name}", _pushes(system, efforts), link.name)
    for name, effect in Effect.of_fluids(system).items():
        yield ActingForce(f"the inertia of the fluid {name}", _pushes(system, (effect,)), name, kind="inertia")


def _inertia(system: System) -> Iterator[ActingForce]:
    rows: dict[str, dict[int, Scalar]] = {}
    for equation in Balance.of(system).equations:
        rows.setdefault(equation.body, {})[equation.direction] = -equation.inertia
    for i, (link, mass) in enumerate(zip(system.motion.links, Axes(system.motion).masses, strict=True)):
        own, center = rows.get(link.name, {}), link.pose.point(mass.com)
        force: Vector = Vector((own.get(0, 0), own.get(1, 0), 0))
        for what, F, n in (("force", force, 0), ("couple", Vector.ZERO, own.get(5, 0))):
            push = PlacedPush(i, F, n, center, None, i)
            if not (push.is_couple and is_zero(n)):
                yield ActingForce(f"the inertia {what} of {link.name}", (push,), kind="inertia")


def _pushes(system: System, effects: Sequence[Effect], k: Scalar | None = None) -> tuple[PlacedPush, ...]:
    """The effects, of a reaction k times."""
    links, found = system.motion.links, []
    for e in effects:
        F, n = (e.force, e.couple[2]) if k is None else (k * e.force, k * e.couple[2])
        place = None if e.place is None else links[e.link].pose.point(e.place)
        found.append(PlacedPush(e.link, F, n, place, None if k is None else e.force, e.link))
    return tuple(found)


def resultant(pushes: tuple[PlacedPush, ...]) -> tuple[PlacedPush, ...]:
    """Parallel forces on one body as one, at p = sum p_k (F_k . F)/(F . F); as they are where that is none."""
    total = Vector(map(sum, zip(*(push.force for push in pushes), strict=True)))
    square, places = total @ total, [push.place for push in pushes if push.place is not None]
    if is_zero(square) or len({push.part for push in pushes}) > 1 or len(places) < len(pushes):
        return pushes
    shares = [over(push.force @ total, square) * p for push, p in zip(pushes, places, strict=True)]
    place = Vector.ZERO
    for share in shares:
        place = place + share
    total, place = (Vector(readable(x, Work.FORMULA) for x in v) for v in (total, place))
    return (PlacedPush(pushes[0].body, total, 0, place, None, pushes[0].part),)


# -------- free bodies -----------------------------------------------------------------------------------------
# What acts -> the balances of bodies that are cut free, in the plane.
#
#     sum of F . e = 0,   sum of (M_O - (p x F)) = 0 about a named point p;   inertia forces -m a stand among the F
#
# An equation for each body, for bodies that hang together, for the whole, and of a truss for each node and each part
# that a straight cut separates; along x and y, along and across what pulls in one direction, along the bodies' own
# axes.


MOST_BODIES = 6  # of a system whose connected parts are all cut free
MOST_CUT = 3  # members through which a part of a truss is cut
CUTS = 12  # directions of straight cuts
GENERIC = ("origin", "center", "start", "end")  # names that points of several bodies have


@dataclass(frozen=True)
class CutBalance:
    """One equation: the balance of forces along e, or of moments about p, of parts that are cut free."""

    parts: frozenset[int]
    name: str
    along: Vector | None = None
    about: Vector | None = None

    def value(self, push: PlacedPush) -> Scalar:
        """The share of a force or couple in the sum."""
        if self.along is not None:
            found: Scalar = push.force[0] * self.along[0] + push.force[1] * self.along[1]
            return found
        return push.moment - (0 if self.about is None else self.about.cross(push.force)[2])


@dataclass(frozen=True)
class Spot:
    """A place that has a name, and the bodies of which it is a point."""

    name: str
    place: Vector
    numbers: np.ndarray
    bodies: set[int]


@dataclass(frozen=True)
class FreeBodies:
    """The parts that can be cut free, and their balances.

    Args:
        acting: what acts on it.
        beams: the balances of parts of beams.
        sections: what the section forces are.
        numbers: values of scalars at states at which directions and places are compared, (k, n).
    """

    system: System
    acting: tuple[ActingForce, ...]
    beams: tuple[CutBalance, ...]
    sections: Mapping[Node, Scalar]
    numbers: Callable[[Sequence[Scalar]], np.ndarray] = field(repr=False)

    @staticmethod
    def of(
        system: System, numbers: Callable[[Sequence[Scalar]], np.ndarray], requested: Sequence[RequestedSection] = ()
    ) -> FreeBodies:
        """The bodies of a system, and beams cut where section forces are requested.

        Raises:
            DerivationError: as of `cut_beam`.
        """
        acting, cuts, sections = what_acts(system), list[CutBalance](), dict[Node, Scalar]()
        for each in requested:
            beam = cut_beam(system, each, acting, len(system.motion.links) + len(cuts))
            acting, cuts = beam.acting, [*cuts, *beam.cuts]
            sections |= beam.true
        return FreeBodies(system, acting, tuple(cuts), sections, numbers)

    def cuts(self, requested: Sequence[Node]) -> Iterator[CutBalance]:
        """The balances in which something that is requested may stand."""
        mine = [each for each in self.acting if each.symbol in requested]
        for bodies in self._parts():
            if any(each.on(bodies) for each in mine):
                name = self._called(bodies)
                for reported, e in self._directions(bodies):
                    yield CutBalance(bodies, f"the balance of forces {reported} of {name}", along=e)
                around = bodies | (self._beyond(bodies) if self.is_truss(bodies) else set())
                for spot in self.spots:
                    if spot.bodies & around:
                        reported = f"the balance of moments about {spot.name} of {name}"
                        yield CutBalance(bodies, reported, about=spot.place)
        yield from self.beams

    def _beyond(self, bodies: frozenset[int]) -> set[int]:
        """The bodies that reactions join to them."""
        return {
            push.body for each in self.acting if each.kind == "reaction" and each.on(bodies) for push in each.pushes
        }

    @cached_property
    def spots(self) -> tuple[Spot, ...]:
        """All points that have a name, each once."""
        motion, found = self.system.motion, list[Spot]()
        named = [(x, i, r) for i, link in enumerate(motion.links) for x, r in motion.points[link.name].items()]
        for name, i, r in sorted(named, key=lambda each: each[0] in GENERIC):
            link = motion.links[i]
            place = link.pose.point(r)
            numbers = self._numbers(place)
            near = (
                x for x in found if np.allclose(numbers, x.numbers, rtol=tolerances.CARRIED, atol=tolerances.CARRIED)
            )
            if (spot := next(near, None)) is None:
                body = _short(link.name)
                reported = name if name not in GENERIC else body if is_node(link.name) else f"{body}.{name}"
                found.append(spot := Spot(reported, place, numbers, set()))
            spot.bodies.add(i)
        return tuple(found)

    def is_truss(self, bodies: frozenset[int]) -> bool:
        """True if they are nodes of a truss."""
        links = self.system.motion.links
        return all(i < len(links) and is_node(links[i].name) for i in bodies)

    def _numbers(self, vector: Vector) -> np.ndarray:
        """The first two components at all samples, (2, n)."""
        return self.numbers(vector[:2])

    # -- what is cut free --------------------------------------------------------------------------------

    def _parts(self) -> Iterator[frozenset[int]]:
        links = self.system.motion.links
        n, truss = len(links), any(is_node(link.name) for link in links)
        sizes = range(1, n + 1) if n <= MOST_BODIES else (1, n) if truss else (1, 2, n)
        found = {frozenset(some): None for size in sizes for some in combinations(range(n), size)}
        yield from (bodies for bodies in found if self._hangs_together(bodies))
        for bodies in self._separated() if truss else ():
            if bodies not in found and sum(self._is_cut(each, bodies) for each in self.acting) <= MOST_CUT:
                found[bodies] = None
                yield bodies

    @staticmethod
    def _is_cut(acting: ActingForce, bodies: frozenset[int]) -> bool:
        """True if it acts between these bodies and others."""
        return acting.kind == "reaction" and 0 < len(acting.on(bodies)) < len(acting.pushes)

    def _hangs_together(self, bodies: frozenset[int]) -> bool:
        reached, joined = {min(bodies)}, [{push.body for push in each.pushes} & bodies for each in self.acting]
        for _ in bodies:
            reached |= {i for some in joined if some & reached for i in some}
        return reached == bodies

    def _separated(self) -> Iterator[frozenset[int]]:
        """The sets of bodies on one side of a straight line."""
        places = [self._numbers(link.pose.p)[:, 0] for link in self.system.motion.links]
        for angle in np.arange(CUTS) * np.pi / CUTS:
            far = [x * np.cos(angle) + y * np.sin(angle) for x, y in places]
            for level in sorted(far)[1:]:
                yield frozenset(i for i, x in enumerate(far) if x < level - tolerances.CARRIED)

    def _called(self, bodies: frozenset[int]) -> str:
        links = self.system.motion.links
        names = [_short(links[i].name) for i in sorted(bodies)]
        if len(names) == len(links) > 1:
            return "the whole"
        if not self.is_truss(bodies):
            return " and ".join(names)
        return f"node {names[0]}" if len(names) == 1 else f"the part with {', '.join(names)}"

    def _directions(self, bodies: frozenset[int]) -> Iterator[tuple[str, Vector]]:
        """The directions of balances of forces, each once, those of the structure first."""
        own: list[tuple[str, Vector]] = [
            (each.name, push.unit)
            for each in self.acting
            for push in each.on(bodies)[:1]
            if push.unit is not None and not push.is_couple
        ]
        links = [self.system.motion.links[i] for i in sorted(bodies)]
        own += [(f"the axis of {x.name}", Vector(row[0] for row in x.pose.R)) for x in links if not is_node(x.name)]
        axes: list[tuple[str, Vector]] = [("along x", Vector((1, 0, 0))), ("along y", Vector((0, 1, 0)))]
        known = [self._numbers(e) for _, e in axes]
        for reported, along in own:
            for how, e in (("along", along), ("across", Vector((-along[1], along[0], 0)))):
                numbers = self._numbers(e)
                numbers = numbers / np.maximum(np.linalg.norm(numbers, axis=0), tolerances.CARRIED)
                if all(np.abs(np.sum(numbers * x, axis=0)).min() < 1 - tolerances.CARRIED for x in known):
                    known.append(numbers)
                    yield f"{how} {reported}", e
        yield from axes


def _short(body: str) -> str:
    """A body, or a node without its truss."""
    return body.rpartition(".")[2]


# -------- cut beams -------------------------------------------------------------------------------------------
# A section force that is requested -> the beam cut there: what acts on the part before it and on the part after.
#
# Line loads are cut, too: of each part the resultant of what stands on it.


SIXTH = Fraction(1, 6)


@dataclass(frozen=True)
class RequestedSection:
    """A section force that is requested.

    Args:
        call: its function, shear_force(beam, x, before).
        forces: the section forces along the body.
        x: the distance of the section.
    """

    call: Call
    forces: SectionForces
    x: Scalar


@dataclass(frozen=True)
class CutBeam:
    """A beam, cut.

    Args:
        acting: the section forces, and all that acts, on the two parts as well.
        cuts: the balances of both.
        true: what the section forces are.
    """

    acting: tuple[ActingForce, ...]
    cuts: tuple[CutBalance, ...]
    true: dict[Node, Scalar]


def cut_beam(system: System, requested: RequestedSection, acting: Sequence[ActingForce], part: int) -> CutBeam:
    """The beam cut where a section force is requested.

    Args:
        part: the index of the part before the section; that after it has the next one.
    Raises:
        DerivationError: something acts off its axis or at no place, or what it weighs is spread along it.
    """
    call, section, x = requested.call, requested.forces, requested.x
    body, side = call.name_at(0), call.name_at(2) if len(call.args) > 2 else ""
    axis, motion = section.axis, system.motion
    i, link = motion.index[body], motion.link(body)
    leg = [leg for leg in axis.legs if leg.x == 0 or axis.sizes.sign(x - leg.x) >= 0][-1]
    place, t, n = link.pose.point(leg.place(x)), link.pose.R @ leg.along, link.pose.R @ leg.left
    found, true = list[ActingForce](), dict[Node, Scalar]()
    for kind, e in zip(SectionForces.KINDS, (t, -n, Vector.ZERO), strict=True):
        name = str(replace(call, name=kind))
        symbol = system.scope.graph.symbol(name)
        true[symbol] = section.value(kind, x, side or ("before" if kind != "bending_moment" else ""))
        couple = symbol if kind == "bending_moment" else 0
        pushes = (PlacedPush(i, k * (symbol * e), k * couple, place, k * e, p) for k, p in ((1, part), (-1, part + 1)))
        found.append(ActingForce(f"the {kind.replace('_', ' ')} {name}", tuple(pushes), body, symbol, kind="reaction"))
    cutting = _Cutting(link, axis, x, side, part)
    for each in acting:
        found.append(replace(each, pushes=(*each.pushes, *cutting.pushes(each, i))))
    ways = (
        ("forces along the beam at the section", t, None),
        ("forces across the beam at the section", n, None),
        ("moments about the section", None, place),
    )
    cuts = tuple(
        CutBalance(frozenset((p,)), f"the balance of {reported} of {body} (the part {of} it)", along, about)
        for p, of in ((part, "before"), (part + 1, "after"))
        for reported, along, about in ways
    )
    return CutBeam(tuple(found), cuts, true)


@dataclass(frozen=True)
class _Cutting:
    """Distribution of loads over the two parts of a beam that is cut."""

    link: BodyLink
    axis: MemberAxis
    x: Scalar
    side: str
    part: int

    def pushes(self, acting: ActingForce, body: int) -> Iterator[PlacedPush]:
        """The forces and couples on the parts."""
        mine = [push for push in acting.pushes if push.part == body]
        if mine and (acting.kind == "inertia" or acting.name.startswith("the weight")):
            raise DerivationError("what a beam weighs is spread along it", fix="declare its weight as a line load")
        if mine and acting.spread:
            for part in (self.part, self.part + 1):
                lines = [push for line in acting.spread for push in self._of_line(line, body, part)]
                yield from resultant(tuple(lines)) if lines else ()
            return
        for push in mine:
            if push.place is None:
                raise DerivationError("a couple acts at no place", fix="give it a point")
            where = self.link.pose.R.T @ (push.place - self.link.pose.p)
            after = self.axis.sizes.sign(self._far(where) - self.x) >= (1 if self.side == "after" else 0)
            yield replace(push, part=self.part + after)

    def _far(self, where: Vector) -> Scalar:
        """Distance of a place of the body along the beam."""
        far = self.axis.distance(where)
        if far is None:
            raise DerivationError("something acts off the axis", fix="let it act on the axis of the beam")
        return far

    def _of_line(self, line: SpreadLoad, body: int, part: int) -> Iterator[PlacedPush]:
        """A line load on one part, as forces at the ends of what stands there: L (2 q_1 + q_2)/6, L (q_1 + 2 q_2)/6."""
        sizes, wanted = self.axis.sizes, 1 if part == self.part else -1
        ends = [(self._far(r), r, q) for (_, r), q in ((line.start, line.at_start), (line.end, line.at_end))]
        sides = [sizes.sign(self.x - far) for far, _, _ in ends]
        if wanted not in sides:
            return
        if -wanted in sides:
            (x_1, a, q_1), (x_2, b, q_2) = ends
            f = over(self.x - x_1, x_2 - x_1)
            between = ((1 - f) * u + f * v for u, v in ((a, b), (q_1, q_2)))
            ends[sides.index(-wanted)] = (self.x, next(between), next(between))
        length = sizes.simple(ends[1][0] - ends[0][0])
        for (_, r, q), (_, _, other) in (ends, ends[::-1]):
            force = sizes.sign(length) * length * SIXTH * (2 * q + other)
            yield PlacedPush(body, force, 0, self.link.pose.point(r), None, part)
