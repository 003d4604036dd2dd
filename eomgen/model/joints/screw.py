"""Screw: the child turns about an axis and advances with it."""

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from eomgen.model.fields import FormulaRule
from eomgen.model.joints.base import (
    Column,
    Effort,
    Joint,
    Scalars,
    Value,
    Z,
    across,
    angular,
    linear,
    unit,
    vector,
)
from eomgen.model.kinds import Angle, AngularStiffness, Law, RestAngle, RotorInertia, SpaceDirection, Torque
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import cos, sin
from eomgen.symbolic.expression.spatial import Pose, Vector, rotation, times

Pitch = Annotated[Expression, FormulaRule("m")]


@dataclass(frozen=True, kw_only=True)
class Screw(Joint):
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
    axis: SpaceDirection | None = None
    angle: Angle
    pitch: Pitch
    torque: Torque | None = None
    stiffness: AngularStiffness | None = None
    damping: Law | None = None
    rest: RestAngle | None = None
    armature: RotorInertia | None = None

    def works_in(self, space: str) -> bool:
        return space == "space"

    def turns(self) -> tuple[Expression, ...]:
        return (self.angle,)

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.angle,)

    def pose(self, s: Scalars, value: Value) -> Pose:
        n, h = self._thread(value)
        return Pose(rotation(n, cos(s[0]), sin(s[0])), times(h * s[0], n))

    def subspace(self, s: Scalars, value: Value) -> tuple[Column, ...]:
        n, h = self._thread(value)
        return ((*n, *times(h, n)),)

    def complement(self, s: Scalars, value: Value) -> tuple[Column, ...]:
        n, h = self._thread(value)
        sideways = across(n)
        return (*map(angular, sideways), *map(linear, sideways), (*times(-h, n), *n))

    def efforts(self) -> tuple[Effort | None, ...]:
        return (Effort(self.torque, self.stiffness, self.damping, self.rest, self.armature),)

    def _thread(self, value: Value) -> tuple[Vector, Any]:
        """The unit axis n and the pitch h."""
        return unit(vector(self.axis, value, Z)), value(self.pitch)

    def turn(self, s: Scalars, value: Value) -> Any:
        return s[0]
