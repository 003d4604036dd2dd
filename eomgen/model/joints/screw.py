"""Screw: the child turns about an axis and advances with it. Read and checked; not derived yet."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

from eomgen.model.fields import FormulaRule
from eomgen.model.joints.base import Joint
from eomgen.model.kinds import Angle, SpaceDirection, Torque
from eomgen.symbolic.expressions import Expression

Pitch = Annotated[Expression, FormulaRule("m")]


@dataclass(frozen=True, kw_only=True)
class Screw(Joint):
    """A nut on a thread: angle about `axis`, advance pitch * angle (pitch: per radian) [m]."""

    kind: ClassVar[str] = "screw"
    works: ClassVar[bool] = False
    axis: SpaceDirection
    angle: Angle
    pitch: Pitch
    torque: Torque | None = None

    def turns(self) -> tuple[Expression, ...]:
        return (self.angle,)
