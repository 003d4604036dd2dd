"""Revolute: the child turns about one axis."""

from typing import Any, ClassVar

from eomgen.model.joints.axis import AxisJoint
from eomgen.model.joints.base import Effort, Z, unit, vector
from eomgen.model.joints.moves import Move, PushAlong, TurnAbout
from eomgen.model.kinds import (
    Angle,
    AngularDamping,
    AngularStiffness,
    RestAngle,
    RotorInertia,
    SpaceDirection,
    Torque,
    ValueOf,
)
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.spatial import Vector


@dataclass(frozen=True, kw_only=True)
class Revolute(AxisJoint):
    """A hinge: s = angle, X = Rot(n, s), S = (n, 0); W: the torques across n and every force.

    Args:
        angle: of the child against the parent, 0 = axes agree [rad].
        axis: in the turned axes; need not have unit length; None: z.
        torque: on the child, minus on the parent [N m].
        stiffness, damping, rest, armature: - k (s - rest), - d s', and armature s'^2 / 2 to T.
    """

    kind: ClassVar[str] = "revolute"
    angle: Angle
    axis: SpaceDirection | None = None
    torque: Torque | None = None
    stiffness: AngularStiffness | None = None
    damping: AngularDamping | None = None
    rest: RestAngle | None = None
    armature: RotorInertia | None = None

    def turns(self) -> tuple[Expression, ...]:
        return (self.angle,)

    def moves(self) -> tuple[Move, ...]:
        return (TurnAbout(self.axis, self.angle),)

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.angle,)

    def normal(self, value: ValueOf) -> Vector:
        return unit(vector(self.axis, value, Z))

    def steps(self, value: ValueOf) -> tuple[tuple[Any, Any], ...]:
        return ((1, 0),)

    def efforts(self) -> tuple[Effort | None, ...]:
        return (Effort(self.torque, self.stiffness, self.damping, self.rest, self.armature),)

    def pushes(self) -> tuple[PushAlong, ...]:
        return (
            PushAlong(
                way=self.angle,
                push=self.torque,
                stiffness=self.stiffness,
                damping=self.damping,
                rest=self.rest,
                armature=self.armature,
            ),
        )
