"""Planar: the child moves in a plane of its parent."""

from typing import Any, ClassVar

from eomgen.model.joints.base import Column, Effort, Joint, Scalars, X, Y, Z, angular, linear
from eomgen.model.joints.moves import Move, SlideAlong, TurnAbout
from eomgen.model.kinds import Angle, Displacement, ValueOf
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import cos, sin
from eomgen.symbolic.expression.spatial import Pose, apply, rotation, transposed


@dataclass(frozen=True, kw_only=True)
class Planar(Joint):
    """Motion in the x-y plane of the turned axes: s = (x, y, angle), X = ((x, y, 0), Rot(z, angle)).

    S = (0, R^T e_x), (0, R^T e_y), (e_z, 0); W: the torques about x and y, and the force along z.

    Args:
        x, y: of `point` in the turned axes [m].
        angle: of the child against the parent [rad].
    """

    kind: ClassVar[str] = "planar"
    x: Displacement
    y: Displacement
    angle: Angle

    def turns(self) -> tuple[Expression, ...]:
        return (self.angle,)

    def moves(self) -> tuple[Move, ...]:
        return (SlideAlong(X, self.x), SlideAlong(Y, self.y), TurnAbout(None, self.angle))

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.x, self.y, self.angle)

    def turn(self, s: Scalars, value: ValueOf) -> Any:
        return s[2]

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        return in_plane(s)

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return plane_subspace(s)

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return PLANE_COMPLEMENT

    def efforts(self) -> tuple[Effort | None, ...]:
        return (None, None, None)


PLANE_COMPLEMENT = (angular(X), angular(Y), linear(Z))


def in_plane(s: Scalars) -> Pose:
    """The pose at s = (x, y, angle)."""
    x, y, angle = s
    return Pose(rotation(Z, cos(angle), sin(angle)), (x, y, 0))


def plane_subspace(s: Scalars) -> tuple[Column, ...]:
    """The columns of S of (x, y, angle), in the turned axes."""
    R_CP = transposed(in_plane(s).R)
    return (linear(apply(R_CP, X)), linear(apply(R_CP, Y)), angular(Z))
