"""Screw: the child turns about an axis and advances with it."""

from typing import Annotated, Any, ClassVar

from eomgen.model.fields import FormulaRule
from eomgen.model.joints.axis import AxisJoint
from eomgen.model.joints.base import Effort, Z, unit, vector
from eomgen.model.joints.moves import Move, PushAlong, SlideAlong, TurnAbout
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

Pitch = Annotated[Expression, FormulaRule("m")]


@dataclass(frozen=True, kw_only=True)
class Screw(AxisJoint):
    """A nut on a thread of pitch h: s = angle, X = (Rot(n, s), h s n), S = (n, h n).

    W: torques and forces across n, and the thread's thrust: a force n with the torque -h n.

    Args:
        axis: n, in the turned axes; need not have unit length; None: z.
        angle: about n [rad].
        pitch: h, advance per radian [m].
        torque: about n on the child, minus on the parent [N m].
        stiffness, damping, rest, armature: - k (s - rest), - d s', and armature s'^2 / 2 to T.
    """

    kind: ClassVar[str] = "screw"
    only_space: ClassVar[bool] = True
    axis: SpaceDirection | None = None
    angle: Angle
    pitch: Pitch
    torque: Torque | None = None
    stiffness: AngularStiffness | None = None
    damping: AngularDamping | None = None
    rest: RestAngle | None = None
    armature: RotorInertia | None = None

    def turns(self) -> tuple[Expression, ...]:
        return (self.angle,)

    def moves(self) -> tuple[Move, ...]:
        return (SlideAlong(self.axis, self.pitch * self.angle), TurnAbout(self.axis, self.angle))

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.angle,)

    def normal(self, value: ValueOf) -> Vector:
        return unit(vector(self.axis, value, Z))

    def steps(self, value: ValueOf) -> tuple[tuple[Any, Any], ...]:
        return ((1, value(self.pitch)),)

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
