"""Free: nothing holds the child."""

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from eomgen.model.fields import CONFIGURATION, FormulaRule, VectorRule
from eomgen.model.joints.base import Column, Effort, Joint, Scalars, Value
from eomgen.model.joints.orientation import Angles, Omega, Quaternion, Sequence
from eomgen.model.joints.planar import PLANE_COMPLEMENT, in_plane, plane_subspace
from eomgen.model.kinds import Angle, Displacement
from eomgen.symbolic.expressions import Expression, as_expression
from eomgen.symbolic.spatial import Pose

Position = Annotated[tuple[Expression, ...], VectorRule(FormulaRule("m", "", CONFIGURATION), length=3)]


@dataclass(frozen=True, kw_only=True)
class Free(Joint):
    """In the plane s = (x, y, angle), as `planar` but with no wrench left in it. In space: read, not derived yet.

    Args:
        x, y, angle: of `point` in the parent's axes [m], and of the child [rad] (plane).
        position: of `point` in the parent's axes, 3 [m] (space).
        orientation, angles, quaternion, omega: as of `spherical` (space).
    """

    kind: ClassVar[str] = "free"
    x: Displacement | None = None
    y: Displacement | None = None
    angle: Angle | None = None
    position: Position | None = None
    orientation: Sequence | None = None
    angles: Angles | None = None
    quaternion: Quaternion | None = None
    omega: Omega | None = None

    def works_in(self, space: str) -> bool:
        return space == "plane"

    def turns(self) -> tuple[Expression, ...]:
        if self.angles is not None:
            return self.angles
        names = self.quaternion or ()
        return tuple(as_expression(name) for name in names) or (() if self.angle is None else (self.angle,))

    def variables(self, space: str) -> tuple[Expression, ...]:
        return tuple(e or Expression.number(0) for e in (self.x, self.y, self.angle))

    def turn(self, s: Scalars, value: Value) -> Any:
        return s[2]

    def pose(self, s: Scalars, value: Value) -> Pose:
        return in_plane(s)

    def subspace(self, s: Scalars, value: Value) -> tuple[Column, ...]:
        return plane_subspace(s)

    def complement(self, s: Scalars, value: Value) -> tuple[Column, ...]:
        return PLANE_COMPLEMENT

    def efforts(self) -> tuple[Effort | None, ...]:
        return (None, None, None)
