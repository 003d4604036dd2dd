"""Prismatic: the child slides along one axis."""

from dataclasses import dataclass
from typing import Any, ClassVar

from eomgen.model.joints.base import (
    Column,
    Effort,
    Joint,
    Scalars,
    Value,
    X,
    Y,
    Z,
    across,
    angular,
    linear,
    unit,
    vector,
)
from eomgen.model.kinds import (
    ConstantAngle,
    Direction,
    Displacement,
    Force,
    Law,
    LinearStiffness,
    RestLength,
    RotorInertia,
)
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import cos, sin
from eomgen.symbolic.expression.spatial import Matrix, Pose, apply, rotation, times, transposed


@dataclass(frozen=True, kw_only=True)
class Prismatic(Joint):
    """A slide: s = displacement, X = (Rot(angle), s n), S = (0, R^T n); W: every torque and the forces across n.

    Args:
        axis: n, in the turned axes; need not have unit length.
        displacement: along n [m].
        angle: the constant angle of the child's axes (about z in the plane, about n in space) [rad].
        force: on the child, minus on the parent [N].
        stiffness, damping, rest, armature: - k (s - rest), - d s', and armature s'^2 / 2 to T.
    """

    kind: ClassVar[str] = "prismatic"
    axis: Direction
    displacement: Displacement
    angle: ConstantAngle | None = None
    force: Force | None = None
    stiffness: LinearStiffness | None = None
    damping: Law | None = None
    rest: RestLength | None = None
    armature: RotorInertia | None = None

    def turns(self) -> tuple[Expression, ...]:
        return ()

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.displacement,)

    def turn(self, s: Scalars, value: Value) -> Any:
        return 0 if self.angle is None else value(self.angle)

    def pose(self, s: Scalars, value: Value) -> Pose:
        return Pose(self._rotation(s, value), times(s[0], unit(vector(self.axis, value))))

    def subspace(self, s: Scalars, value: Value) -> tuple[Column, ...]:
        R_CP = transposed(self._rotation(s, value))
        return (linear(apply(R_CP, unit(vector(self.axis, value)))),)

    def complement(self, s: Scalars, value: Value) -> tuple[Column, ...]:
        R_CP = transposed(self._rotation(s, value))
        sideways = (apply(R_CP, e) for e in across(unit(vector(self.axis, value))))
        return (*map(angular, (X, Y, Z)), *map(linear, sideways))

    def efforts(self) -> tuple[Effort | None, ...]:
        return (Effort(self.force, self.stiffness, self.damping, self.rest, self.armature),)

    def _rotation(self, s: Scalars, value: Value) -> Matrix:
        angle = self.turn(s, value)
        about = Z if len(self.axis) == 2 else unit(vector(self.axis, value))
        return rotation(about, cos(angle), sin(angle))
