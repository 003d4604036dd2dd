"""Torsion damper: between two bodies, or a body and the ground."""

from typing import ClassVar

from eomgen.model.forces.element import Element
from eomgen.model.forces.load import LoadContext
from eomgen.model.forces.turning import Turning
from eomgen.model.kinds import AngularDamping
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class TorsionDamper(Turning):
    """A torsion damper: couple - c theta'.

    Args:
        bodies: theta is the angle of the second against the first.
        body: alone: theta is its angle against the ground's axes.
        damping: c [N m s].
    """

    kind: ClassVar[str] = "torsion_damper"
    damping: AngularDamping

    @property
    def element(self) -> Element:
        return Element(bodies=self.bodies or (None, self.body), damping=self.damping)

    def couple(self, scene: LoadContext) -> AnyScalar:
        """- c theta'"""
        return -scene.value(self.damping) * self.relative(scene.angle_rate)
