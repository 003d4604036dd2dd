"""Cylindrical: the child turns about an axis and slides along it."""

from dataclasses import dataclass
from typing import Any, ClassVar

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
from eomgen.model.kinds import Angle, Displacement, Force, SpaceDirection, Torque
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import cos, sin
from eomgen.symbolic.expression.spatial import Pose, Vector, rotation, times


@dataclass(frozen=True, kw_only=True)
class Cylindrical(Joint):
    """A sleeve on a shaft: s = (d, angle), X = (Rot(n, angle), d n), S = (0, n), (n, 0); W: all across n.

    Args:
        axis: n, in the turned axes; need not have unit length; None: z.
        displacement, angle: along n [m] and about it [rad].
        force, torque: along n and about it on the child, minus on the parent [N, N m].
    """

    kind: ClassVar[str] = "cylindrical"
    axis: SpaceDirection | None = None
    displacement: Displacement
    angle: Angle
    force: Force | None = None
    torque: Torque | None = None

    def works_in(self, space: str) -> bool:
        return space == "space"

    def turns(self) -> tuple[Expression, ...]:
        return (self.angle,)

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.displacement, self.angle)

    def pose(self, s: Scalars, value: Value) -> Pose:
        n = self._normal(value)
        return Pose(rotation(n, cos(s[1]), sin(s[1])), times(s[0], n))

    def subspace(self, s: Scalars, value: Value) -> tuple[Column, ...]:
        n = self._normal(value)
        return (linear(n), angular(n))

    def complement(self, s: Scalars, value: Value) -> tuple[Column, ...]:
        sideways = across(self._normal(value))
        return (*map(angular, sideways), *map(linear, sideways))

    def efforts(self) -> tuple[Effort | None, ...]:
        return (Effort(self.force), Effort(self.torque))

    def _normal(self, value: Value) -> Vector:
        return unit(vector(self.axis, value, Z))

    def turn(self, s: Scalars, value: Value) -> Any:
        return s[1]
