"""Reactions, body -> SectionsInSpace: force and moment in each section of a beam in space.

What stands before the section at x has the resultant R and the moment T about the section; what stands behind pushes
it with

    S = -R,   C = -T;        dS/dx = -q,   dC/dx = -t x S

along t, the axis, e_y and e_z = t x e_y: N, V_y, V_z of S, and the torque T, the bending moments M_y, M_z of C. Of a
beam along x of its body e_y and e_z are y and z; else e_y is across z, and of one along z it is y.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from eomgen.frozen import dataclass
from eomgen.mechanics.free_bodies import Reactions
from eomgen.mechanics.statics.forces_in_sections import (
    Action,
    MemberLoads,
    Spread,
    leg_at,
    on_axis,
    spread_along,
    stations_of,
)
from eomgen.mechanics.statics.member_axis import Leg, MemberAxis, Sizes, axis_of, sizes_of
from eomgen.symbolic.expression import Fraction, Scalar, Vector, is_zero, over, sqrt

SPACE_KINDS = ("N", "V_y", "V_z", "T", "M_y", "M_z")
Y, Z = Vector((0, 1, 0)), Vector((0, 0, 1))


@dataclass(frozen=True)
class PieceInSpace:
    """The section forces between two stations.

    Args:
        start, end: along the axis [m].
        leg: on which it lies.
        coefficients: of 1, s, s^2, ..., s = x - start, by SPACE_KINDS.
    """

    start: Scalar
    end: Scalar
    leg: Leg
    coefficients: dict[str, tuple[Scalar, ...]]


@dataclass(frozen=True)
class SectionsInSpace:
    """N, V, T and M along one body in space."""

    axis: MemberAxis
    pieces: tuple[PieceInSpace, ...]

    @staticmethod
    def of(reactions: Reactions, body: str) -> SectionsInSpace:
        """The section forces of a body.

        Raises:
            DerivationError: as of `SectionForces.of`.
        """
        motion = reactions.balance.system.motion
        sizes = sizes_of(motion, {**reactions.at, **reactions.unknowns})
        loads = MemberLoads(reactions, body, sizes)
        actions, spreads = loads.actions, loads.spreads
        axis = axis_of(motion, body, [place for place, _, _ in actions] + [p for s in spreads for p in s[:2]], sizes)
        placed = [Action(on_axis(axis, place), force, couple) for place, force, couple in actions]
        spread = [part for line in spreads for part in spread_along(axis, line)]
        return SectionsInSpace(axis, tuple(_pieces(axis, placed, spread)))


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


def _pieces(axis: MemberAxis, actions: Sequence[Action], spreads: Sequence[Spread]) -> Iterator[PieceInSpace]:
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
        yield PieceInSpace(start, end, leg, found)
        length = end - start
        R, T = (_simple(sizes, -1 * _at(series, length)) for series in (force, moment))


def _at(series: Sequence[Vector], s: Scalar) -> Vector:
    """c_0 + c_1 s + c_2 s^2 + ..."""
    total = Vector.ZERO
    for c in reversed(series):
        total = s * total + c
    return total


def _simple(sizes: Sizes, v: Vector) -> Vector:
    return Vector(sizes.simple(x) for x in v)
