"""Rolling: a round body on a line, a circle, a plane or another body. Read and checked; not derived yet."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

from eomgen.model.constraints.base import Constraint
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


@dataclass(frozen=True, kw_only=True)
class Track(Part):
    """A line or a plane: through `at`, `normal` towards the rolling body."""

    title: ClassVar[str] = "a line or plane"
    at: GroundPlace
    normal: Direction


@dataclass(frozen=True, kw_only=True)
class Circle(Part):
    """A circle about `at`; the body rolls on its outside, or on its inside."""

    title: ClassVar[str] = "a circle"
    at: GroundPlace
    radius: Length
    inside: Flag = False


TrackField = Annotated[Track, PartRule(Track)]
CircleField = Annotated[Circle, PartRule(Circle)]


@dataclass(frozen=True, kw_only=True)
class Rolling(Constraint):
    """The contact (a normal row) and no slip (its other rows).

    Args:
        body: what rolls.
        line, plane: on which it rolls, in the ground, or with `on` in that body's axes.
        on: the other body (alone: a round one).
        circle: on which it rolls.
        slip: True leaves the contact row only.
        unilateral: it can only push.
        friction: with slip.
        radius: None: the shape's [m].
        center: the point of the body about which it is round; None: its origin.
        axis: in space, of a thin disc, body axes; without it a sphere.
        ellipsoid: in space, semiaxes of an ellipsoid, 3 [m].
    """

    kind: ClassVar[str] = "rolling"
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
