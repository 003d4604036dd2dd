"""Torsion spring: between two bodies, or a body and the ground."""

from typing import ClassVar

from eomgen.model.forces.element import Element
from eomgen.model.forces.load import LoadContext
from eomgen.model.forces.turning import Turning
from eomgen.model.kinds import AngularStiffness, RestAngle
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class TorsionSpring(Turning):
    """A torsion spring: V = k (theta - rest)^2 / 2.

    Args:
        bodies: theta is the angle of the second against the first.
        body: alone: theta is its angle against the ground's axes.
        stiffness: k [N m].
        rest: the angle at which it is slack (None: 0) [rad].
    """

    kind: ClassVar[str] = "torsion_spring"
    elastic: ClassVar[bool] = True
    stiffness: AngularStiffness
    rest: RestAngle | None = None

    @property
    def element(self) -> Element:
        return Element(bodies=self.bodies or (None, self.body), stiffness=self.stiffness, slack=self.rest)

    def couple(self, scene: LoadContext) -> AnyScalar:
        """- k (theta - rest)"""
        return -scene.value(self.stiffness) * self._twist(scene)

    def potential(self, scene: LoadContext) -> AnyScalar | None:
        """V = k (theta - rest)^2 / 2"""
        twist = self._twist(scene)
        return Fraction(1, 2) * scene.value(self.stiffness) * twist * twist

    def _twist(self, scene: LoadContext) -> AnyScalar:
        return self.relative(scene.angle) - scene.value(self.rest)
