"""Cylindrical: the child turns about an axis and slides along it. Read and checked; not derived yet."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.joints.base import Joint
from eomgen.model.kinds import Angle, Displacement, Force, SpaceDirection, Torque
from eomgen.symbolic.expressions import Expression


@dataclass(frozen=True, kw_only=True)
class Cylindrical(Joint):
    """A sleeve on a shaft: displacement along `axis` and angle about it; `force` and `torque` act on the child."""

    kind: ClassVar[str] = "cylindrical"
    works: ClassVar[bool] = False
    axis: SpaceDirection
    displacement: Displacement
    angle: Angle
    force: Force | None = None
    torque: Torque | None = None

    def turns(self) -> tuple[Expression, ...]:
        return (self.angle,)
