"""Spherical: a ball joint. Read and checked; not derived yet."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.joints.base import Joint
from eomgen.model.joints.orientation import Angles, Omega, Quaternion, Sequence
from eomgen.symbolic.expressions import Expression, as_expression


@dataclass(frozen=True, kw_only=True)
class Spherical(Joint):
    """The child turns about the joint point.

    Args:
        orientation: "zxz", "xyz", ... with `angles`, turned about the body's own successive axes, zxz:
            R = Rz(psi) Rx(theta) Rz(phi), child to parent; or "quaternion" with `quaternion`, scalar first.
        omega: names of the speeds: the child's angular velocity against the parent, child's axes [rad/s].
    """

    kind: ClassVar[str] = "spherical"
    works: ClassVar[bool] = False
    orientation: Sequence
    angles: Angles | None = None
    quaternion: Quaternion | None = None
    omega: Omega | None = None

    def turns(self) -> tuple[Expression, ...]:
        return self.angles or tuple(as_expression(name) for name in self.quaternion or ())
