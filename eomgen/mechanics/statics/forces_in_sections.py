"""Reactions, body -> SectionForces: normal force, shear force and bending moment along a body that is a beam.

The forces before the section at x have the resultant R and the moment T about the section, counter-clockwise; t is
along the axis, n to its left:

    N = -R . t,   V = R . n,   M = -T;        dN/dx = -q_t,   dV/dx = q_n,   dM/dx = V

N is positive as tension, V where it turns the piece on which it acts clockwise, M where it stretches the right-hand
fibre: of a beam drawn from left to right the lower one. The weight of a rod, and its inertia, is spread along it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.free_bodies import Axes, Component, Effect, Reactions
from eomgen.mechanics.statics.member_axis import Leg, MemberAxis, Sizes, axis_of, sizes_of
from eomgen.model import Couple, PointForce
from eomgen.symbolic.exact import vanishes
from eomgen.symbolic.expression import Fraction, Node, Scalar, Vector, is_zero, over, sqrt
from eomgen.symbolic.numeric import FLOAT, evaluate
from eomgen.symbolic.print import to_text

HALF, SIXTH = Fraction(1, 2), Fraction(1, 6)


@dataclass(frozen=True)
class Action:
    """A force and a couple at one place of the axis, body axes."""

    x: Scalar
    force: Vector
    couple: Vector


@dataclass(frozen=True)
class Spread:
    """A load per length from x = start to x = end, body axes: q = at_start + (x - start) slope."""

    start: Scalar
    end: Scalar
    at_start: Vector
    slope: Vector

    def at(self, x: Scalar) -> Vector:
        return self.at_start + (x - self.start) * self.slope


@dataclass(frozen=True)
class SectionPiece:
    """The section forces between two stations, polynomials in s = x - start.

    Args:
        start, end: along the axis [m].
        leg: on which it lies.
        series: coefficients of 1, s, s^2, ..., by KINDS, in space by SPACE_KINDS.
    """

    start: Scalar
    end: Scalar
    leg: Leg
    series: Mapping[str, tuple[Scalar, ...]]

    def value(self, kind: str, x: Scalar) -> Scalar:
        """One of the section forces at x."""
        total: Scalar = 0
        for c in reversed(self.series[kind]):
            total = total * (x - self.start) + c
        return total

    def points(self, kind: str, values: Mapping[Node, float], count: int) -> tuple[np.ndarray, np.ndarray]:
        """(x, one of the section forces there) at so many places of the piece, in numbers."""
        start, end, *coefficients = map(float, evaluate((self.start, self.end, *self.series[kind]), values, FLOAT))
        s = np.linspace(0.0, end - start, count)
        return start + s, np.asarray(sum(c * s**k for k, c in enumerate(coefficients)))


@dataclass(frozen=True)
class Extreme:
    """Extreme of the bending moment within a piece, where V = 0."""

    x: Scalar
    M: Scalar


@dataclass(frozen=True)
class SectionForces:
    """N, V and M along one body; in space N, V_y, V_z, T, M_y and M_z.

    Args:
        reactions: of the bodies.
        axis: of the body.
        pieces: from station to station.
    """

    KINDS = ("axial_force", "shear_force", "bending_moment")

    reactions: Reactions

    axis: MemberAxis
    pieces: tuple[SectionPiece, ...]

    @property
    def sizes(self) -> Sizes:
        return self.axis.sizes

    @property
    def kinds(self) -> tuple[str, ...]:
        """KINDS, in space SPACE_KINDS."""
        return tuple(self.pieces[0].series)

    @property
    def loads(self) -> MemberLoads:
        """All that acts on the body."""
        return MemberLoads(self.reactions, self.axis.body, self.sizes)

    def triad(self, piece: SectionPiece) -> tuple[Vector, Vector, Vector]:
        """t, e_y, e_z of a piece in space, body axes."""
        return triad(piece.leg, self.sizes)

    def value(self, kind: str, x: Scalar, side: str = "") -> Scalar:
        """One of the section forces at a distance from the start.

        Args:
            side: "before" or "after", where it jumps.
        Raises:
            DerivationError: x is beyond the ends, or a place where it jumps and no side is given.
        """
        before = [p for p in self.pieces if self.sizes.sign(x - p.start) > 0 and self.sizes.sign(p.end - x) >= 0]
        after = [p for p in self.pieces if self.sizes.sign(x - p.start) >= 0 and self.sizes.sign(p.end - x) > 0]
        found = {
            name: self.sizes.shortest(pieces[0].value(kind, x))
            for name, pieces in (("before", before), ("after", after))
            if pieces
        }
        if not found:
            ends = " to ".join(to_text(x) for x in self.axis.ends)
            raise DerivationError(
                f"{kind}({self.axis.body}, {to_text(x)}): the body goes from x = {ends}",
                fix="ask at a place of the body",
            )
        if side and side not in found:
            raise DerivationError(
                f"{kind}({self.axis.body}, {to_text(x)}, {side}): there is nothing {side} its end",
                fix="ask at a place of the body",
            )
        values = [found[side]] if side else list(found.values())
        if len(values) == 2 and not vanishes(values[0] - values[1]):
            requested, jump = f"{kind}({self.axis.body}, {to_text(x)}", " to ".join(map(to_text, values))
            raise DerivationError(
                f"{requested}) jumps there from {jump}", fix=f"write {requested}, before) or {requested}, after)"
            )
        return values[0]

    @cached_property
    def extremes(self) -> tuple[Extreme, ...]:
        """The zeros of V within the pieces, those that have a closed form and whose place is known."""
        return tuple(e for piece in self.pieces for e in self._zeros(piece))

    def _zeros(self, piece: SectionPiece) -> Iterable[Extreme]:
        for root in _roots(piece.series["shear_force"], self.sizes):
            try:
                inside = self.sizes.sign(root) > 0 and self.sizes.sign(piece.end - piece.start - root) > 0
            except DerivationError:
                continue
            if inside:
                x = self.sizes.shortest(piece.start + root)
                yield Extreme(x, self.sizes.shortest(piece.value("bending_moment", x)))

    @staticmethod
    def of(reactions: Reactions, body: str) -> SectionForces:
        """N, V and M along a body in the plane.

        Raises:
            DerivationError: something acts off its axis, or at no place; its mass is no rod's; a reaction is
                indeterminate.
        """
        if reactions.balance.system.motion.scope.model.space != "plane":
            raise DerivationError(
                "section forces are found in the plane", f"bodies.{body}", fix="fix the beam in a model of the plane"
            )
        axis, placed, spread = _acting_along(reactions, body)
        return SectionForces(reactions, axis, tuple(_pieces(axis, placed, spread)))

    @staticmethod
    def in_space(reactions: Reactions, body: str) -> SectionForces:
        """N, V_y, V_z, T, M_y and M_z along a body.

        Raises:
            DerivationError: as of `of`.
        """
        axis, placed, spread = _acting_along(reactions, body)
        return SectionForces(reactions, axis, tuple(_pieces_in_space(axis, placed, spread)))


# -- along the axis ----------------------------------------------------------------------------------


def _acting_along(reactions: Reactions, body: str) -> tuple[MemberAxis, list[Action], list[Spread]]:
    """(the axis of a body, what acts at places of it, what is spread over it)."""
    motion = reactions.balance.system.motion
    sizes = sizes_of(motion, {**reactions.at, **reactions.unknowns})
    loads = MemberLoads(reactions, body, sizes)
    actions, spreads = loads.actions, loads.spreads
    axis = axis_of(motion, body, [place for place, _, _ in actions] + [p for s in spreads for p in s[:2]], sizes)
    placed = [Action(on_axis(axis, place), force, couple) for place, force, couple in actions]
    return axis, placed, [part for line in spreads for part in spread_along(axis, line)]


def on_axis(axis: MemberAxis, place: Vector) -> Scalar:
    x = axis.distance(place)
    if x is None:
        where = ", ".join(to_text(component) for component in place[:2])
        raise DerivationError(
            f"something acts on '{axis.body}' at ({where}), off the line along which it is a beam",
            f"bodies.{axis.body}",
            "let its points, or its `line`, follow the bar",
        )
    return x


def spread_along(axis: MemberAxis, line: MemberLoad) -> Iterable[Spread]:
    """A line load as a function of x, from its first place to its last along the axis."""
    a, b = on_axis(axis, line[0]), on_axis(axis, line[1])
    length = axis.sizes.simple(b - a)
    if axis.sizes.sign(length) < 0:
        a, b, length, line = b, a, -length, (line[1], line[0], line[3], line[2])
    r = line[1] - line[0]
    if not vanishes(axis.sizes.simple(r @ r - length * length)):
        raise DerivationError(
            f"a line load on '{axis.body}' cuts a corner of its axis",
            f"bodies.{axis.body}",
            "give a load for each straight part",
        )
    slope = Vector(axis.sizes.simple(over(y - x, length)) for x, y in zip(line[2], line[3], strict=True))
    yield Spread(a, b, line[2], slope)


def _pieces(axis: MemberAxis, actions: Sequence[Action], spreads: Sequence[Spread]) -> Iterable[SectionPiece]:
    """Pieces from station to station; all forces before a piece are summed to one force and one moment."""
    sizes = axis.sizes
    stations = stations_of(axis, actions, spreads)
    R: Vector = Vector.ZERO
    T: Scalar = 0
    for start, end in pairwise(stations):
        leg = leg_at(axis, start, end)
        for action in actions:
            if sizes.sign(action.x - start) == 0:
                R, T = R + action.force, T + action.couple[2]
        over_it = [s for s in spreads if sizes.sign(start - s.start) >= 0 and sizes.sign(s.end - end) >= 0]
        q, slope = Vector.ZERO, Vector.ZERO
        for s in over_it:
            q, slope = q + s.at(start), slope + s.slope
        piece = _piece(sizes, (start, end), leg, (R, T, q, slope))
        yield piece
        length = end - start
        R = Vector(
            sizes.simple(r + length * a + HALF * length * length * b) for r, a, b in zip(R, q, slope, strict=True)
        )
        T = sizes.simple(-piece.value("bending_moment", end))


def _piece(
    sizes: Sizes, ends: tuple[Scalar, Scalar], leg: Leg, acting: tuple[Vector, Scalar, Vector, Vector]
) -> SectionPiece:
    """N, V, M from the resultant R and moment T before, and the load q + slope s."""
    R, T, q, slope = acting
    t, n = leg.along, leg.left
    N = (-(R @ t), -(q @ t), -HALF * (slope @ t))
    V = (R @ n, q @ n, HALF * (slope @ n))
    M = (-T, R @ n, HALF * (q @ n), SIXTH * (slope @ n))
    found = (tuple(sizes.simple(c) for c in series) for series in (N, V, M))
    return SectionPiece(*ends, leg, dict(zip(SectionForces.KINDS, found, strict=True)))


def stations_of(axis: MemberAxis, actions: Sequence[Action], spreads: Sequence[Spread]) -> list[Scalar]:
    """Distances at which a force, a load or a leg begins or ends, in order."""
    sizes = axis.sizes
    places = [*axis.ends, *(leg.x for leg in axis.legs), *(a.x for a in actions)]
    places += [x for s in spreads for x in (s.start, s.end)]
    found: list[Scalar] = []
    for x in places:
        k = 0
        while k < len(found) and sizes.sign(x - found[k]) > 0:
            k += 1
        if k == len(found) or sizes.sign(found[k] - x) > 0:
            found.insert(k, x)
    return found


def leg_at(axis: MemberAxis, start: Scalar, end: Scalar) -> Leg:
    """The leg on which a piece lies."""
    before = [leg for leg in axis.legs if axis.sizes.sign(start - leg.x) >= 0]
    return before[-1] if before else axis.legs[0]


def _roots(V: tuple[Scalar, ...], sizes: Sizes) -> list[Scalar]:
    """Zeros of c0 + c1 s + c2 s^2, as far as its coefficients are not 0 at the model's values."""
    c0, c1, c2 = V
    if _is_nothing(c2, sizes):
        return [] if _is_nothing(c1, sizes) else [sizes.simple(over(-c0, c1))]
    square = sizes.simple(c1 * c1 - 4 * c0 * c2)
    try:
        if sizes.sign(square) < 0:
            return []
    except DerivationError:
        return []
    return [sizes.simple(over(-c1 + k * sqrt(square), 2 * c2)) for k in (1, -1)]


def _is_nothing(x: Scalar, sizes: Sizes) -> bool:
    """True if a scalar vanishes, identically or at the model's values."""
    try:
        return vanishes(x) or sizes.sign(x) == 0
    except DerivationError:  # it has no value
        return False


# -------- member loads ----------------------------------------------------------------------------------------
# Reactions, body -> MemberLoads: what acts along a beam, forces and couples at places, loads per length.
#
# Reactions with their values, loads, drives and springs of joints; the weight and inertia of a rod, m/L (g - a),
# which is a linear function of the place. All in the axes of the body.


def place_of(components: Sequence[Component], effect: Effect, owner: str) -> Vector | None:
    """Place of a reaction, body axes: of a couple that of the forces of the same constraint, None where it has none."""
    if effect.place is not None:
        return effect.place
    mine = (e for c in components if c.owner == owner for e in c.effects if e.link == effect.link)
    return next((e.place for e in mine if e.place is not None), None)


_At = tuple[Vector, Vector, Vector]
"""(place, force, couple), body axes."""
MemberLoad = tuple[Vector, Vector, Vector, Vector]
"""(start, end, load per length at the start, at the end), body axes."""


@dataclass(frozen=True)
class MemberLoads:
    """Everything that acts on one body, in its own axes, with the values of the reactions."""

    reactions: Reactions
    body: str
    sizes: Sizes

    @cached_property
    def actions(self) -> list[_At]:
        """Forces and couples at places; those at one place together."""
        found: list[_At] = []
        for place, force, couple in (self._at(effect) for effect in self._effects()):
            same = next((k for k, (p, _, _) in enumerate(found) if self._is_zero(p - place)), None)
            if same is None:
                found.append((place, force, couple))
            else:
                _, f, c = found[same]
                found[same] = (place, f + force, c + couple)
        return [(place, self._simple(f), self._simple(c)) for place, f, c in found]

    @cached_property
    def spreads(self) -> list[MemberLoad]:
        """Distributed loads, and the weight and inertia of a rod."""
        found = []
        for applied in self._system.loads.applied:
            for line in applied.spread:
                if line.start[0] == self.body:
                    found.append((line.start[1], line.end[1], self._turned(line.at_start), self._turned(line.at_end)))
        return found + self._of_mass()

    # -- forces and couples ------------------------------------------------------------------------

    def _effects(self) -> Iterable[Effect]:
        """Reactions with their values, loads, drives and springs: what acts at places of the body."""
        system, axes = self._system, Axes(self._system.motion)
        link = system.motion.index[self.body]
        for j, component in enumerate(self.reactions.components):
            for effect in (*component.effects, *component.friction_effects):
                if effect.link == link and not (effect.place is None and effect.beyond is not None):
                    place = self._place_of(effect, component.owner)
                    place = place if effect.beyond is None else place + effect.beyond
                    yield replace(effect, place=place).times(self.reactions.value(j))
        for force in system.loads.applied:
            if not force.spread and not system.scope.model.forces[force.name].by_mass:
                placed = [load for load in force.loads if isinstance(load, (PointForce, Couple))]
                effects = [e for load in placed for e in axes.effects_of(load) if e.link == link]
                yield from (self._placed(effect, f"the force '{force.name}'") for effect in effects)
        own = (*Effect.of_joints(system), *Effect.of_fluids(system).values())
        yield from (effect for effect in own if effect.link == link)

    def _place_of(self, effect: Effect, owner: str) -> Vector:
        """Place of a reaction: of a couple that of the forces of the same constraint."""
        place = place_of(self.reactions.components, effect, owner)
        return self._placed(replace(effect, place=place), f"the couple of '{owner}'").place or Vector.ZERO

    def _placed(self, effect: Effect, what: str) -> Effect:
        if effect.place is None:
            raise DerivationError(
                f"{what} acts on '{self.body}' at no point: its section forces depend on where",
                f"bodies.{self.body}",
                "give the couple its `point`",
            )
        return effect

    def _at(self, effect: Effect) -> _At:
        assert effect.place is not None, "placed before"
        if Axes(self._system.motion).plane:
            return effect.place, self._turned(effect.force), effect.couple
        return effect.place, effect.force, effect.couple

    # -- mass --------------------------------------------------------------------------------------

    def _of_mass(self) -> list[MemberLoad]:
        """m/L (g - a) along a rod; a linear function of the place."""
        system = self._system
        mass = system.scope.mass_properties(self.body)
        if is_zero(mass.m):
            return []
        ends = self._ends_of_rod()
        field, motion = system.motion.field(self.body), system.motion
        if ends is None:
            inertia = field.acceleration(motion.position((self.body, mass.com)))
            if self._is_zero((*(self._weight() - inertia), *field.e)):
                return []
            what = f"how the mass of '{self.body}' is spread along it is not known"
            raise DerivationError(
                what, f"bodies.{self.body}", 'give it the shape "rod", or no mass and a distributed load'
            )
        first, last = ends
        r = last - first
        per_length = over(mass.m, sqrt(self.sizes.simple(r @ r)))
        felt = [self._weight() - field.acceleration(motion.position((self.body, p))) for p in ends]
        at_first, at_last = (self._turned(per_length * g) for g in felt)
        return [] if self._is_zero((*at_first, *at_last)) else [(first, last, at_first, at_last)]

    def _ends_of_rod(self) -> tuple[Vector, Vector] | None:
        points = self._system.motion.points[self.body]
        shape = self._system.scope.model.bodies[self.body].shape
        names = () if shape is None else shape.point_names
        return (points["start"], points["end"]) if {"start", "end"} <= set(names) else None

    def _weight(self) -> Vector:
        """The acceleration fields that act on the body's mass, ground axes."""
        system = self._system
        total = system.loads.fields
        m = system.scope.mass_properties(self.body).m
        for force in system.loads.applied:
            if system.scope.model.forces[force.name].by_mass:
                for load in force.loads:
                    if isinstance(load, PointForce) and load.place[0] == self.body:
                        total = total + Vector(over(x, m) for x in load.force)
        return total

    # -- axes --------------------------------------------------------------------------------------

    @property
    def _system(self) -> System:
        return self.reactions.balance.system

    def _turned(self, vector: Vector) -> Vector:
        """Vector in body axes of one in ground axes."""
        return self._simple(self._system.motion.link(self.body).pose.R.T @ vector)

    def _simple(self, vector: Vector) -> Vector:
        return Vector(self.sizes.simple(x) for x in vector)

    def _is_zero(self, scalars: Sequence[Scalar]) -> bool:
        return all(vanishes(self.sizes.simple(x)) for x in scalars)


# -------- sections in space -------------------------------------------------------------------------------------------
# Reactions, body -> SectionForces: force and moment in each section of a beam in space.
#
# What stands before the section at x has the resultant R and the moment T about the section; what stands behind pushes
# it with
#
#     S = -R,   C = -T;        dS/dx = -q,   dC/dx = -t x S
#
# along t, the axis, e_y and e_z = t x e_y: N, V_y, V_z of S, and the torque T, the bending moments M_y, M_z of C. Of a
# beam along x of its body e_y and e_z are y and z; else e_y is across z, and of one along z it is y.


SPACE_KINDS = ("N", "V_y", "V_z", "T", "M_y", "M_z")
Y, Z = Vector((0, 1, 0)), Vector((0, 0, 1))


def triad(leg: Leg, sizes: Sizes) -> tuple[Vector, Vector, Vector]:
    """t, e_y, e_z of a leg, body axes."""
    t = leg.along
    across = Z.cross(t)
    if all(is_zero(sizes.simple(x)) for x in across):
        e_y: Vector = Y
    else:
        length = sqrt(sizes.simple(across @ across))
        e_y = Vector(sizes.simple(over(x, length)) for x in across)
    return t, e_y, t.cross(e_y)


def _pieces_in_space(axis: MemberAxis, actions: Sequence[Action], spreads: Sequence[Spread]) -> Iterator[SectionPiece]:
    """Pieces from station to station; all that stands before a piece is summed to one force and one moment."""
    sizes = axis.sizes
    R: Vector = Vector.ZERO
    T: Vector = Vector.ZERO
    for start, end in pairwise(stations_of(axis, actions, spreads)):
        leg = leg_at(axis, start, end)
        for action in actions:
            if sizes.sign(action.x - start) == 0:
                R, T = R + action.force, T + action.couple
        over_it = [s for s in spreads if sizes.sign(start - s.start) >= 0 and sizes.sign(s.end - end) >= 0]
        q, slope = Vector.ZERO, Vector.ZERO
        for s in over_it:
            q, slope = q + s.at(start), slope + s.slope
        t, e_y, e_z = triad(leg, sizes)
        force = (-R, -q, Fraction(-1, 2) * slope)
        moment = (-T, t.cross(R), Fraction(1, 2) * t.cross(q), Fraction(1, 6) * t.cross(slope))
        axes = {"N": t, "V_y": e_y, "V_z": e_z}, {"T": t, "M_y": e_y, "M_z": e_z}
        found = {
            kind: tuple(sizes.simple(c @ e) for c in series)
            for series, own in zip((force, moment), axes, strict=True)
            for kind, e in own.items()
        }
        yield SectionPiece(start, end, leg, found)
        length = end - start
        R, T = (_simple_vector(sizes, -1 * _polynomial(series, length)) for series in (force, moment))


def _polynomial(series: Sequence[Vector], s: Scalar) -> Vector:
    """c_0 + c_1 s + c_2 s^2 + ..."""
    total = Vector.ZERO
    for c in reversed(series):
        total = s * total + c
    return total


def _simple_vector(sizes: Sizes, v: Vector) -> Vector:
    return Vector(sizes.simple(x) for x in v)
