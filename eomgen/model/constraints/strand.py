"""Strands of a string: their directions, what they pull, and the row of one tension."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from eomgen.errors import ModelError
from eomgen.frozen import dataclass
from eomgen.model.constraints.plane import angle_of, left
from eomgen.model.constraints.row import ConstraintRow, normals_of
from eomgen.model.forces.load import BodyPoint, Couple, LoadContext, PointForce, Push
from eomgen.model.joints.base import Z
from eomgen.model.kinds import Wrap
from eomgen.symbolic.expression import Scalar, Vector, over, sqrt
from eomgen.symbolic.numeric import tolerances

AXES: tuple[Vector, ...] = (Vector((0, 1, 0)), Vector((0, -1, 0)), Vector((-1, 0, 0)), Vector((1, 0, 0)))


@dataclass(frozen=True)
class Stop:
    """A point of the string's path, or a round thing that it lies on.

    Args:
        place: the point or the centre.
        offset: a: the string touches at centre + a left(d); the radius where one travels round clockwise, minus the
            radius counter-clockwise, 0 at a point [m].
        axis: in space, about which it is round, and turned counter-clockwise: unit, ground axes; left(d) = axis x d.
    """

    scene: LoadContext
    place: BodyPoint
    offset: Scalar = 0
    axis: Vector = Z

    @staticmethod
    def of(scene: LoadContext, item: str | Wrap) -> Stop:
        """A point, or a wrap about a body's origin or a place on the ground."""
        if isinstance(item, str):
            return Stop(scene, scene.place(item))
        place = (None, scene.ground_place(item.at)) if item.body is None else scene.own_place(item.body, None)
        radius = scene.radius(str(item.body)) if item.radius is None else scene.value(item.radius)
        axis = Z if item.axis is None else scene.vector(item.axis).unit
        n = axis if item.body is None or scene.plane else scene.orientation(item.body) @ axis
        return Stop(scene, place, radius if item.turn == "cw" else -radius, n)

    @property
    def body(self) -> str | None:
        return self.place[0]

    @property
    def center(self) -> Vector:
        return self.scene.position(self.place)

    @property
    def round(self) -> bool:
        return not _zero(self.offset)

    @property
    def winds(self) -> bool:
        """True if rotation of the body, which has no single angle in space, pays out string."""
        return self.round and self.body is not None and not self.scene.plane

    @property
    def wound(self) -> Scalar:
        """a theta: string that rotation of the body pays out at the strand's start [m]."""
        return self.offset * angle_of(self.scene, self.body) if self.round else 0

    def left(self, d: Vector) -> Vector:
        """d turned by a quarter, counter-clockwise about the axis."""
        return left(d) if self.scene.plane else self.axis.cross(d)

    def touched(self, d: Vector) -> Vector:
        """Point at which a strand of direction d touches, ground axes."""
        return self.center + self.offset * self.left(d) if self.round else self.center

    def pulled(self, d: Vector, sense: int) -> tuple[Push, ...]:
        """A force sense * d at centre + a left(d): at the centre, with the moment - a * sense."""
        force = PointForce(self.place, sense * d)
        if self.body is None or not self.round:
            return (force,)
        return force, Couple(self.body, -sense * self.offset * self.axis)


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
        """Points at which it leaves the one stop and reaches the other: centre + a left(d)."""
        return self.first.touched(self.d), self.second.touched(self.d)

    @property
    def pulls(self) -> tuple[Push, ...]:
        """A unit of tension: + d on what the strand leaves, - d on what it reaches."""
        return (*self.first.pulled(self.d, 1), *self.second.pulled(self.d, -1))

    @classmethod
    def between(cls, scene: LoadContext, first: Stop, second: Stop) -> Strand:
        """The strand that touches both: with D = c_2 - c_1, h = a_1 - a_2 and l = sqrt(D . D - h^2) it is

            d = (l D - h left(D)) / D . D,   for then d . D = l and left(d) . D = h.

        Raises:
            ModelError: at the start there is no such line; in space, it is not across the axis of what it lies on.
        """
        D = second.center - first.center
        _refuse_out_of_plane(scene, first, second, D)
        h = first.offset - _same_way_round(first, second) * second.offset
        side = (first if first.round else second).left
        straight = _straight(scene, D, h, side)
        if straight is not None:
            return cls(first, second, *straight)
        square = D @ D
        rest = square if _zero(h) else square - h * h
        span = scene.value_at_start(rest)
        if span is not None and span <= 0:
            raise ModelError(
                f"there is no straight strand between {_names(first, second)} at the start",
                scene.where,
                "put them apart"
                if scene.where.startswith("forces")
                else "put them apart, or give the directions in 'strands'",
            )
        length = sqrt(rest)
        if _zero(h):
            return cls(first, second, _over(D, length), length)
        return cls(first, second, _over(length * D - h * side(D), square), None)


def strand_along(scene: LoadContext, first: Stop, second: Stop, d: Vector) -> Strand:
    """The strand that keeps the direction d: its length grows with d . (c_2 - c_1).

    Raises:
        ModelError: at the start it runs against d.
    """
    _refuse_out_of_plane(scene, first, second, d)
    length = d @ (second.center - first.center)
    run = scene.value_at_start(length)
    if run is not None and run < -tolerances.COMPUTED:
        raise _against(scene, first, second)
    return Strand(first, second, d, length)


def _straight(
    scene: LoadContext, D: Vector, h: Scalar, side: Callable[[Vector], Vector]
) -> tuple[Vector, Scalar] | None:
    """Direction and length of a strand that stays along an axis: left(d) . D = h for good, d . D > 0 at the start."""
    for d in AXES if scene.plane else (*AXES, Z, -Z):
        length = d @ D
        run = scene.value_at_start(length)
        forwards = run is not None and run > 0 if _zero(h) else run is None or run >= 0
        if forwards and all(map(scene.vanishes, _off(scene, d, D, h, side))):
            return d, length
    return None


def _off(scene: LoadContext, d: Vector, D: Vector, h: Scalar, side: Callable[[Vector], Vector]) -> tuple[Scalar, ...]:
    """Quantities that vanish if D is along d and h to its left."""
    if scene.plane:
        return (side(d) @ D - h,)
    return d.cross(D) if _zero(h) else (side(d) @ D - h,)


def _same_way_round(first: Stop, second: Stop) -> int:
    """1, or -1 where the axes of two round stops are opposite."""
    return 1 if first.scene.plane or not (first.round and second.round) else _along(first, second)


def _along(first: Stop, second: Stop) -> int:
    """The sense of the second axis along the first one: 1 or -1.

    Raises:
        ModelError: the axes are not parallel.
    """
    for sense in (1, -1):
        if all(map(first.scene.vanishes, first.axis - sense * second.axis)):
            return sense
    raise ModelError(
        f"the axes of {_names(first, second)} are not parallel",
        first.scene.where,
        "lead the string over an eyelet, a point, between them",
    )


def _refuse_out_of_plane(scene: LoadContext, first: Stop, second: Stop, d: Vector) -> None:
    """Refuses a strand in space that is not in the plane of what it touches: n . d = 0.

    Raises:
        ModelError: it is not.
    """
    for stop in (first, second):
        if not scene.plane and stop.round and not scene.vanishes(stop.axis @ d):
            what = f"the strand between {_names(first, second)} is not in the plane of the wrap, across its axis"
            raise ModelError(what, scene.where, "turn the axis, or lead the string over an eyelet, a point, there")


def rope_row(scene: LoadContext, strands: Sequence[Strand]) -> ConstraintRow:
    """The row of one tension through strands that are joined where the string slides: the sum of their rows.

    Its gap is what the string has left at the start, - sum l - a_1 theta_1 + a_2 theta_2 + ..., where the lengths are
    known; on a round thing that slips the turns cancel. Where no body is pulled there is nothing to restrict.
    """
    pushes = tuple(push for strand in strands for push in strand.pulls)
    if all(isinstance(push, PointForce) and push.place[0] is None for push in pushes):
        return ConstraintRow((), None, 0, component="tension")
    return ConstraintRow(pushes, _gap(scene, strands), component="tension")


def _gap(scene: LoadContext, strands: Sequence[Strand]) -> Scalar | None:
    used: Scalar = 0
    for strand in strands:
        if strand.length is None or strand.first.winds or strand.second.winds:
            return None
        used = used + strand.length + strand.first.wound - strand.second.wound
    return scene.start(used) - used


def side_rows(scene: LoadContext, strand: Strand) -> list[ConstraintRow]:
    """The constraints that keep a strand's direction: n . (p_1 - p_2) = 0 of its ends, for each n across it.

    In the plane n = left(d). Those that hold by themselves are left out.

    Raises:
        ModelError: the ends are offset across the strand, and nothing moves that.
    """
    first, second = strand.first, strand.second
    rows = []
    for name, n, offset in _sides(scene, strand):
        gap = n @ (first.center - second.center) + offset
        if scene.vanishes(gap):
            continue
        if not scene.moves((gap,)):
            what = f"the strand between {_names(first, second)} cannot have the direction given"
            raise ModelError(
                f"{what}: its ends are not in line",
                scene.where,
                "move one of them across the strand, or exchange 'cw' and 'ccw'",
            )
        rows.append(ConstraintRow((PointForce(first.place, n), PointForce(second.place, -n)), gap, component=name))
    return rows


def _sides(scene: LoadContext, strand: Strand) -> list[tuple[str, Vector, Scalar]]:
    """(name, n, how far apart along n the strand's centres are) for each n across it."""
    first, second = strand.first, strand.second
    if not (first.round or second.round) or scene.plane:
        return [(name, n, first.offset - second.offset) for name, n in normals_of(scene, strand.d)]
    stop = first if first.round else second
    apart = first.offset - _same_way_round(first, second) * second.offset
    return [("n 1", stop.left(strand.d), apart), ("n 2", stop.axis, 0)]


def _against(scene: LoadContext, first: Stop, second: Stop) -> ModelError:
    what = f"the strand between {_names(first, second)} runs against the direction given at the start"
    return ModelError(what, scene.where, "directions are those of travel along 'path'")


def _names(first: Stop, second: Stop) -> str:
    return " and ".join("the ground" if stop.body is None else f"'{stop.body}'" for stop in (first, second))


def _over(a: Vector, b: Scalar) -> Vector:
    return Vector((over(a[0], b), over(a[1], b), over(a[2], b)))


def _zero(x: Any) -> bool:
    return type(x) is int and x == 0
