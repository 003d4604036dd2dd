"""Strands of a string: their directions, what they pull, and the row of one tension."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from eomgen.errors import ModelError
from eomgen.model.constraints.plane import Push, angle_of, left
from eomgen.model.constraints.row import TieRow
from eomgen.model.forces.load import Couple, Place, PointForce, Scalar, Scene, Vector
from eomgen.symbolic.functions import over, sqrt
from eomgen.symbolic.spatial import dot, minus, plus, times

AXES: tuple[Vector, ...] = ((0, 1, 0), (0, -1, 0), (-1, 0, 0), (1, 0, 0))
BACKWARDS = -1e-9  # a strand that is shorter runs against its direction [m]


@dataclass(frozen=True)
class Stop:
    """A point of the string's path, or a round thing that it lies on.

    Args:
        place: the point or the centre.
        offset: a: the string touches at centre + a left(d); the radius where one travels round clockwise, minus the
            radius counter-clockwise, 0 at a point [m].
    """

    scene: Scene
    place: Place
    offset: Scalar = 0

    @property
    def body(self) -> str | None:
        return self.place[0]

    @property
    def center(self) -> Vector:
        return self.scene.position(self.place)

    @property
    def wound(self) -> Scalar:
        """a theta: what a turn of the body gives out at the strand's beginning [m]."""
        return 0 if _zero(self.offset) else self.offset * angle_of(self.scene, self.body)

    def touched(self, d: Vector) -> Vector:
        """Where a strand of direction d touches, ground axes."""
        return plus(self.center, times(self.offset, left(d)))

    def pulled(self, d: Vector, sense: int) -> tuple[Push, ...]:
        """A force sense * d at centre + a left(d): at the centre, with the moment - a * sense."""
        force = PointForce(self.place, times(sense, d))
        if self.body is None or _zero(self.offset):
            return (force,)
        return force, Couple(self.body, (0, 0, -sense * self.offset))


@dataclass(frozen=True)
class Strand:
    """The straight string between two stops.

    Args:
        d: unit direction of travel.
        length: l of the straight piece, where no turn of the strand lets it grow on something round; else None [m].
    """

    first: Stop
    second: Stop
    d: Vector
    length: Scalar | None

    @property
    def ends(self) -> tuple[Vector, Vector]:
        """Where it leaves the one stop and reaches the other: centre + a left(d)."""
        return self.first.touched(self.d), self.second.touched(self.d)

    @property
    def pulls(self) -> tuple[Push, ...]:
        """A unit of tension: + d on what the strand leaves, - d on what it reaches."""
        return (*self.first.pulled(self.d, 1), *self.second.pulled(self.d, -1))


def strand_along(scene: Scene, first: Stop, second: Stop, d: Vector) -> Strand:
    """The strand that keeps the direction d: its length grows with d . (c_2 - c_1).

    Raises:
        ModelError: at the start it runs against d.
    """
    length = dot(d, minus(second.center, first.center))
    run = scene.worth(length)
    if run is not None and run < BACKWARDS:
        raise _against(scene, first, second)
    return Strand(first, second, d, length)


def common_tangent(scene: Scene, first: Stop, second: Stop) -> Strand:
    """The strand that touches both: with D = c_2 - c_1, h = a_1 - a_2 and l = sqrt(D . D - h^2) it is

        d = (l D - h left(D)) / D . D,   for then d . D = l and left(d) . D = h.

    Raises:
        ModelError: at the start there is no such line.
    """
    D, h = minus(second.center, first.center), first.offset - second.offset
    straight = _straight(scene, D, h)
    if straight is not None:
        return Strand(first, second, *straight)
    square = dot(D, D)
    rest = square if _zero(h) else square - h * h
    span = scene.worth(rest)
    if span is not None and span <= 0:
        raise ModelError(f"there is no straight strand between {_names(first, second)} at the start", scene.where,
                         "put them apart, or give the directions in 'strands'")  # fmt: skip
    length = sqrt(rest)
    if _zero(h):
        return Strand(first, second, _over(D, length), length)
    return Strand(first, second, _over(minus(times(length, D), times(h, left(D))), square), None)


def _straight(scene: Scene, D: Vector, h: Scalar) -> tuple[Vector, Scalar] | None:
    """Direction and length of a strand that stays along an axis: left(d) . D = h for good, d . D > 0 at the start."""
    for d in AXES:
        length = dot(d, D)
        run = scene.worth(length)
        forwards = run is not None and run > 0 if _zero(h) else run is None or run >= 0
        if forwards and scene.vanishes(dot(left(d), D) - h):
            return d, length
    return None


def rope_row(scene: Scene, strands: Sequence[Strand]) -> TieRow:
    """The row of one tension through strands that are joined by what slips: the sum of their rows.

    Its gap is what the string has left at the start, - sum l - a_1 theta_1 + a_2 theta_2 + ..., where the lengths are
    known; on a round thing that slips the turns cancel. Where no body is pulled there is nothing to restrict.
    """
    pushes = tuple(push for strand in strands for push in strand.pulls)
    if all(isinstance(push, PointForce) and push.place[0] is None for push in pushes):
        return TieRow((), None, 0, component="tension")
    return TieRow(pushes, _gap(scene, strands), component="tension")


def _gap(scene: Scene, strands: Sequence[Strand]) -> Scalar | None:
    used: Scalar = 0
    for strand in strands:
        if strand.length is None:
            return None
        used = used + strand.length + strand.first.wound - strand.second.wound
    return scene.start(used) - used


def side_row(scene: Scene, strand: Strand) -> TieRow | None:
    """The restriction that a strand keeps its direction: left(d) . (p_1 - p_2) = 0 of its ends; None where it holds.

    Raises:
        ModelError: the ends stand beside one another, and nothing moves that.
    """
    n = left(strand.d)
    gap = dot(n, minus(strand.first.center, strand.second.center)) + strand.first.offset - strand.second.offset
    if scene.vanishes(gap):
        return None
    if not scene.moves((gap,)):
        what = f"the strand between {_names(strand.first, strand.second)} cannot have the direction given"
        raise ModelError(f"{what}: its ends are not in line", scene.where,
                         "move one of them across the strand, or exchange 'cw' and 'ccw'")  # fmt: skip
    ends = PointForce(strand.first.place, n), PointForce(strand.second.place, times(-1, n))
    return TieRow(ends, gap, component="n")


def _against(scene: Scene, first: Stop, second: Stop) -> ModelError:
    what = f"the strand between {_names(first, second)} runs against the direction given at the start"
    return ModelError(what, scene.where, "directions are those of travel along 'path'")


def _names(first: Stop, second: Stop) -> str:
    return " and ".join("the ground" if stop.body is None else f"'{stop.body}'" for stop in (first, second))


def _over(a: Vector, b: Scalar) -> Vector:
    return (over(a[0], b), over(a[1], b), 0)


def _zero(x: Any) -> bool:
    return type(x) is int and x == 0
