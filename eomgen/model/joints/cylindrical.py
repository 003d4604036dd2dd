"""Cylindrical: the child turns about an axis and slides along it."""

from typing import Any, ClassVar

from eomgen.model.joints.axis import AxisJoint
from eomgen.model.joints.base import Effort, Z, unit, vector
from eomgen.model.joints.moves import Move, PushAlong, SlideAlong, TurnAbout
from eomgen.model.kinds import Angle, Displacement, ForceFormula, SpaceDirection, Torque, ValueOf
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.spatial import Vector


@dataclass(frozen=True, kw_only=True)
class Cylindrical(AxisJoint):
    """A sleeve on a shaft: s = (d, angle), X = (Rot(n, angle), d n), S = (0, n), (n, 0); W: all across n.

    Args:
        axis: n, in the turned axes; need not have unit length; None: z.
        displacement, angle: along n [m] and about it [rad].
        force, torque: along n and about it on the child, minus on the parent [N, N m].
    """

    kind: ClassVar[str] = "cylindrical"
    only_space: ClassVar[bool] = True
    axis: SpaceDirection | None = None
    displacement: Displacement
    angle: Angle
    force: ForceFormula | None = None
    torque: Torque | None = None

    def turns(self) -> tuple[Expression, ...]:
        return (self.angle,)

    def moves(self) -> tuple[Move, ...]:
        return (SlideAlong(self.axis, self.displacement), TurnAbout(self.axis, self.angle))

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.displacement, self.angle)

    def normal(self, value: ValueOf) -> Vector:
        return unit(vector(self.axis, value, Z))

    def steps(self, value: ValueOf) -> tuple[tuple[Any, Any], ...]:
        return ((0, 1), (1, 0))

    def efforts(self) -> tuple[Effort | None, ...]:
        return (Effort(self.force), Effort(self.torque))

    def pushes(self) -> tuple[PushAlong, ...]:
        along, about = self.displacement, self.angle
        return (PushAlong(way=along, push=self.force), PushAlong(way=about, push=self.torque))
