"""Fixed: the child does not move against its parent."""

from typing import Any, ClassVar

from eomgen.model.joints.base import Column, Joint, Scalars, X, Y, Z, angular, linear, unit, vector
from eomgen.model.joints.moves import Move, TurnAbout
from eomgen.model.kinds import ConstantAngle, SpaceDirection, ValueOf
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import cos, sin
from eomgen.symbolic.expression.spatial import Pose, rotation


@dataclass(frozen=True, kw_only=True)
class Fixed(Joint):
    """Welded on: f = 0, W = 1.

    Args:
        angle: at which it is welded, constant [rad].
        axis: about which; None: z.
    """

    kind: ClassVar[str] = "fixed"
    angle: ConstantAngle | None = None
    axis: SpaceDirection | None = None

    def turns(self) -> tuple[Expression, ...]:
        return ()

    def moves(self) -> tuple[Move, ...]:
        return (TurnAbout(self.axis, self.angle),)

    def variables(self, space: str) -> tuple[Expression, ...]:
        return ()

    def turn(self, s: Scalars, value: ValueOf) -> Any:
        return 0 if self.angle is None else value(self.angle)

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        angle = self.turn(s, value)
        return Pose(rotation(unit(vector(self.axis, value, Z)), cos(angle), sin(angle)))

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return ()

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return (*map(angular, (X, Y, Z)), *map(linear, (X, Y, Z)))
