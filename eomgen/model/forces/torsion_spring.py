"""Torsion spring: between two bodies, or a body and the ground."""

from typing import ClassVar

from eomgen.model.forces.base import Force
from eomgen.model.forces.element import Element
from eomgen.model.forces.load import Load, LoadContext
from eomgen.model.forces.twist import relative, turned
from eomgen.model.kinds import AngularStiffness, BodyName, RestAngle, TwoBodies
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class TorsionSpring(Force):
    """A torsion spring: V = k (theta - rest)^2 / 2.

    Args:
        bodies: theta is the angle of the second against the first.
        body: alone: theta is its angle against the ground's axes.
        stiffness: k [N m].
        rest: the angle at which it is slack (None: 0) [rad].
    """

    kind: ClassVar[str] = "torsion_spring"
    elastic: ClassVar[bool] = True
    one_of: ClassVar[tuple[str, ...]] = ("bodies", "body")
    bodies: TwoBodies | None = None
    body: BodyName | None = None
    stiffness: AngularStiffness
    rest: RestAngle | None = None

    @property
    def element(self) -> Element:
        return Element(bodies=self.bodies or (None, self.body), stiffness=self.stiffness, slack=self.rest)

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """A couple - k (theta - rest) on the second body, the opposite on the first."""
        return turned(self.bodies, self.body, -scene.value(self.stiffness) * self._twist(scene))

    def potential(self, scene: LoadContext) -> AnyScalar | None:
        """V = k (theta - rest)^2 / 2"""
        twist = self._twist(scene)
        return Fraction(1, 2) * scene.value(self.stiffness) * twist * twist

    def _twist(self, scene: LoadContext) -> AnyScalar:
        return relative(self.bodies, self.body, scene.angle) - scene.value(self.rest)
