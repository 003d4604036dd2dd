"""Joints of one axis: the child turns about it, slides along it, or both."""

from abc import abstractmethod
from typing import Any

from eomgen.model.joints.base import Column, Joint, Scalars, X, Y, Z, across, angular, linear
from eomgen.model.kinds import ValueOf
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import cos, sin
from eomgen.symbolic.expression.spatial import (
    IDENTITY,
    Matrix,
    Pose,
    Vector,
    apply,
    product,
    rotation,
    times,
    transposed,
)


@dataclass(frozen=True, kw_only=True)
class AxisJoint(Joint):
    """X = (Rot(n, sum a_k s_k) R_0, sum b_k s_k n): each variable s_k turns by a_k about n, advances by b_k along it.

    S has the columns (a_k n, b_k n). W: the torques across n, and n where nothing turns; the forces across n, and n
    where nothing advances; of a thread the force a n with the torque -b n, which does no work.
    """

    @abstractmethod
    def normal(self, value: ValueOf) -> Vector:
        """The unit axis n, parent's (turned) axes."""

    @abstractmethod
    def steps(self, value: ValueOf) -> tuple[tuple[Any, Any], ...]:
        """(a, b) of each variable: the turn [1 or rad] and the advance [1 or m] by a unit of it."""

    def mounting(self, value: ValueOf) -> Matrix:
        """R_0, the child's axes at s = 0."""
        return IDENTITY

    def turn(self, s: Scalars, value: ValueOf) -> Any:
        return sum((a * x for (a, _), x in zip(self.steps(value), s, strict=True)), start=0)

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        n, steps = self.normal(value), self.steps(value)
        R, angle = self.mounting(value), sum((a * x for (a, _), x in zip(steps, s, strict=True)), start=0)
        advance = sum((b * x for (_, b), x in zip(steps, s, strict=True)), start=0)
        return Pose(product(rotation(n, cos(angle), sin(angle)), R), times(advance, n))

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        n = self._seen_from_child(value)
        return tuple((*times(a, n), *times(b, n)) for a, b in self.steps(value))

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        n, steps = self._seen_from_child(value), self.steps(value)
        turns, slides = any(a != 0 for a, _ in steps), any(b != 0 for _, b in steps)
        sideways = self._across(value)
        torques = map(angular, sideways if turns else (X, Y, Z))
        forces = map(linear, sideways if slides else (X, Y, Z))
        thread = [(*times(-b, n), *times(a, n)) for a, b in steps] if len(steps) == 1 and turns and slides else []
        return (*torques, *forces, *thread)

    def _across(self, value: ValueOf) -> tuple[Vector, ...]:
        """Two directions across the axis, child's axes."""
        R_CP = transposed(self.mounting(value))
        return tuple(apply(R_CP, e) for e in across(self.normal(value)))

    def _seen_from_child(self, value: ValueOf) -> Vector:
        """n in the child's axes; turning about it does not change it."""
        return apply(transposed(self.mounting(value)), self.normal(value))
