"""Rolling: a round body on a line, a circle or another body; on planes in space it is read and not derived yet."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Annotated, ClassVar

from eomgen.errors import ModelError
from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.plane import Touch, opposite, right
from eomgen.model.constraints.row import TieRow, direction_of
from eomgen.model.forces.load import Place, Scalar, Scene, Vector
from eomgen.model.friction import FrictionLaw
from eomgen.model.kinds import (
    BodyName,
    Direction,
    Flag,
    GroundPlace,
    Length,
    OwnPointName,
    Size,
    SpaceDirection,
)
from eomgen.model.part import Part, PartRule
from eomgen.symbolic.functions import over
from eomgen.symbolic.spatial import apply, dot, minus, times


@dataclass(frozen=True, kw_only=True)
class Track(Part):
    """A line or a plane: through `at`, `normal` towards the rolling body; in the axes of `on`."""

    title: ClassVar[str] = "a line or plane"
    at: GroundPlace
    normal: Direction


@dataclass(frozen=True, kw_only=True)
class Circle(Part):
    """A circle about `at`, in the axes of `on`; the body rolls on its outside, or on its inside."""

    title: ClassVar[str] = "a circle"
    at: GroundPlace
    radius: Length
    inside: Flag = False


@dataclass(frozen=True)
class Contact:
    """A round body against its track.

    Args:
        n: from the track towards the body, of unit length where they touch.
        gap: between them [m].
        anchor: a place of the track that does not move in its body.
        arm: from the anchor to the contact, ground axes [m].
    """

    n: Vector
    gap: Scalar
    anchor: Place
    arm: Vector


TrackField = Annotated[Track, PartRule(Track)]
CircleField = Annotated[Circle, PartRule(Circle)]


@dataclass(frozen=True, kw_only=True)
class Rolling(Constraint):
    """The contact (a normal row) and no slip (its other rows).

    Args:
        body: what rolls.
        line, plane, circle: on which it rolls, in the ground, or with `on` in that body's axes.
        on: the other body (alone: a round one).
        slip: True leaves the contact row only.
        unilateral: it can only push.
        friction: with slip.
        radius: None: the shape's [m].
        center: the point of the body about which it is round; None: its origin.
        axis: in space, of a thin disc, body axes; without it a sphere.
        ellipsoid: in space, semiaxes of an ellipsoid, 3 [m].
    """

    kind: ClassVar[str] = "rolling"
    spaces: ClassVar[tuple[str, ...]] = ("plane",)
    body: BodyName
    line: TrackField | None = None
    plane: TrackField | None = None
    circle: CircleField | None = None
    on: BodyName | None = None
    slip: Flag = False
    unilateral: Flag = False
    friction: FrictionLaw | None = None
    radius: Length | None = None
    center: OwnPointName | None = None
    axis: SpaceDirection | None = None
    ellipsoid: Size | None = None

    def rows(self, scene: Scene) -> tuple[TieRow, ...]:
        """The normal row, gap = 0, n pushing the body off its track; unless it slips, t . (v - v_track) = 0.

        Both velocities are those of the bodies' material points at the contact; t = n turned clockwise (x, where n
        is y). The no-slip row is one of velocities alone.
        """
        center = scene.own_place(self.body, self.center)
        R = scene.radius(self.body) if self.radius is None else scene.value(self.radius)
        contact = self._contact(scene, scene.position(center), R)
        touch = Touch(center, times(-R, contact.n)), Touch(contact.anchor, contact.arm)
        along = opposite(*touch, right(contact.n))
        normal = opposite(*touch, contact.n)
        if self.slip:
            return (TieRow(normal, contact.gap, component="n", tangent=along),)
        return TieRow(normal, contact.gap, component="n"), TieRow(along, None, component="t", material=True)

    def _contact(self, scene: Scene, center: Vector, R: Scalar) -> Contact:
        if self.line is not None:
            return _on_line(scene, self.on, self.line, center, R)
        if self.circle is not None:
            anchor = _anchor(scene, self.on, self.circle.at)
            return _on_circle(scene, anchor, (scene.value(self.circle.radius), self.circle.inside), center, R)
        assert self.on is not None, "one of line, circle and on is given"
        return _on_circle(scene, scene.own_place(self.on, None), (scene.radius(self.on), False), center, R)


def _anchor(scene: Scene, on: str | None, at: tuple | str) -> Place:
    return (None, scene.ground_place(at)) if on is None else (on, scene.vector(at))


def _on_line(scene: Scene, on: str | None, track: Track, center: Vector, R: Scalar) -> Contact:
    """gap = n . (c - at) - R; the contact is at c - R n."""
    n = direction_of(scene, scene.vector(track.normal))
    n = n if on is None else apply(scene.orientation(on), n)
    anchor = _anchor(scene, on, track.at)
    out = minus(center, scene.position(anchor))
    return Contact(n, dot(n, out) - R, anchor, minus(out, times(R, n)))


def _on_circle(scene: Scene, anchor: Place, circle: tuple[Scalar, bool], center: Vector, R: Scalar) -> Contact:
    """gap = (d . d - D^2) / 2D, n = d / D, d from the circle's centre to the body's: d and D = r + R where they touch.

    Inside, D = r - R and both signs turn. No root stands in it: to first order the gap is the distance.
    """
    r, inside = circle
    D, side = (r - R, -1) if inside else (r + R, 1)
    if inside and (scene.vanishes(D) or (scene.worth(D) or 1) < 0):
        raise ModelError("the body is as large as the circle in which it should roll", scene.where,
                         "give the circle a larger radius")  # fmt: skip
    d = minus(center, scene.position(anchor))
    n: Vector = tuple(side * over(x, D) for x in d)  # type: ignore[assignment]
    gap = Fraction(1, 2) * side * (over(dot(d, d), D) - D)
    return Contact(n, gap, anchor, times(side * r, n))
