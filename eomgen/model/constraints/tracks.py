"""What a round body rolls on: a plane (in the plane a line), a ball or pipe (in the plane a circle)."""

from typing import ClassVar

from eomgen.errors import ModelError
from eomgen.model.constraints.plane import right
from eomgen.model.constraints.round_bodies import RollingBall, Round, Wheel, laid_in, turned_over
from eomgen.model.constraints.row import direction_of
from eomgen.model.forces.load import BodyPoint, LoadContext
from eomgen.model.joints.base import unit
from eomgen.model.kinds import Direction, Flag, GroundPlace, Length, SpaceDirection
from eomgen.model.part import Part
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, AnyScalar, Vector, apply, cross, dot, minus, plus, times, vector_of


@dataclass(frozen=True, kw_only=True)
class Track(Part):
    """A line or a plane: through `at`, `normal` towards the rolling body; in the axes of `on`."""

    title: ClassVar[str] = "a line or plane"
    at: GroundPlace
    normal: Direction


@dataclass(frozen=True, kw_only=True)
class Circle(Part):
    """A circle about `at`, in space a ball or with `axis` a pipe, in the axes of `on`; rolled on outside or inside."""

    title: ClassVar[str] = "a circle"
    at: GroundPlace
    radius: Length
    inside: Flag = False
    axis: SpaceDirection | None = None


@dataclass(frozen=True)
class TrackContact:
    """A round body against its track.

    Args:
        n: from the track towards the body, of unit length where they touch.
        gap: between them [m].
        reach: from the body's centre to the contact, ground axes [m].
        anchor: a place of the track that does not move in its body.
        arm: from the anchor to the contact, ground axes [m].
        tangents: one direction along the contact, in space two.
    """

    n: Vector
    gap: AnyScalar
    reach: Vector
    anchor: BodyPoint
    arm: Vector
    tangents: tuple[Vector, ...]


@dataclass(frozen=True)
class Curved:
    """A ball, a pipe about `axis` (ground axes), or in the plane a circle, about `anchor`.

    Args:
        r: its radius [m].
        side: 1: it is rolled on outside, -1: inside.
    """

    anchor: BodyPoint
    r: AnyScalar
    side: int = 1
    axis: Vector | None = None


def on_level(scene: LoadContext, on: str | None, track: Track, center: Vector, body: Round) -> TrackContact:
    """gap = n . (c - at) - height, n and `at` fixed in the track's body."""
    own = direction_of(scene, scene.vector(track.normal))
    tangents = (right(own),) if scene.plane else laid_in(scene, own)
    n, *along = (_carried(scene, on, e) for e in (own, *tangents))
    anchor = anchor_of(scene, on, track.at)
    out, near = minus(center, scene.position(anchor)), body.nearest(scene, n)
    return TrackContact(n, dot(n, out) - near.height, near.reach, anchor, plus(out, near.reach), tuple(along))


def normal_of(scene: LoadContext, on: str | None, track: Track) -> Vector:
    """Its unit normal in ground axes."""
    return _carried(scene, on, direction_of(scene, scene.vector(track.normal)))


def _carried(scene: LoadContext, on: str | None, e: Vector) -> Vector:
    """A direction of the ground, or of the body `on`, in ground axes."""
    return e if on is None else apply(scene.orientation(on), e)


def on_curved(scene: LoadContext, track: Curved, center: Vector, ball: RollingBall) -> TrackContact:
    """gap = (d . d - D^2) / 2D, n = d / D, d from the circle's centre (the pipe's axis) to the ball's.

    d and D = r + R where they touch; inside, D = r - R and both signs turn. No root stands in it: to first order the
    gap is the distance.
    """
    D = _apart(scene, track, ball.R)
    out = minus(center, scene.position(track.anchor))
    along = ZERO if track.axis is None else times(dot(track.axis, out), track.axis)
    d = out if track.axis is None else minus(out, along)
    n = vector_of(track.side * over(x, D) for x in d)
    arm = plus(along, times(track.side * track.r, n))
    return TrackContact(n, _gap(track, d, D), times(-ball.R, n), track.anchor, arm, _around(scene, track, n))


def wheel_on_ball(scene: LoadContext, track: Curved, center: Vector, wheel: Wheel) -> TrackContact:
    """A wheel on a ball, or in it: a ball of the tyre's radius at the place of its centre line that comes nearest."""
    D, out = _apart(scene, track, wheel.tube), minus(center, scene.position(track.anchor))
    rim = wheel.nearest_to_ball(scene, out, track.side)
    d = plus(out, rim)
    n = vector_of(track.side * over(x, D) for x in d)
    reach = minus(rim, times(wheel.tube, n))
    return TrackContact(n, _gap(track, d, D), reach, track.anchor, plus(out, reach), _around(scene, track, n))


def _gap(track: Curved, d: Vector, D: AnyScalar) -> AnyScalar:
    return Fraction(1, 2) * track.side * (over(dot(d, d), D) - D)


def _apart(scene: LoadContext, track: Curved, R: AnyScalar) -> AnyScalar:
    """How far the centre of a ball is from that of its track where they touch [m]."""
    inside = track.side < 0
    D = track.r - R if inside else track.r + R
    if inside and (scene.vanishes(D) or (scene.worth(D) or 1) < 0):
        raise ModelError(
            "the body is as large as the circle in which it should roll", scene.where, "give the circle a larger radius"
        )
    return D


def _around(scene: LoadContext, track: Curved, n: Vector) -> tuple[Vector, ...]:
    """Directions across n: of a pipe its axis k and n x k."""
    if scene.plane:
        return (right(n),)
    return turned_over(scene, n) if track.axis is None else (track.axis, cross(n, track.axis))


def curved(scene: LoadContext, on: str | None, circle: Circle) -> Curved:
    """The circle of a model as it stands."""
    axis = None if circle.axis is None else _carried(scene, on, unit(scene.vector(circle.axis)))
    return Curved(anchor_of(scene, on, circle.at), scene.value(circle.radius), -1 if circle.inside else 1, axis)


def anchor_of(scene: LoadContext, on: str | None, at: tuple[Expression, ...] | str) -> BodyPoint:
    """A place of the track: of the ground, or in the axes of the body `on`."""
    return (None, scene.ground_place(at)) if on is None else (on, scene.vector(at))
