"""Spring: between two points."""

from typing import ClassVar

from eomgen.model.forces.element import Element
from eomgen.model.forces.load import LoadContext
from eomgen.model.forces.reach import Reach
from eomgen.model.forces.straight import Straight
from eomgen.model.kinds import Direction, LinearStiffness, NaturalLength
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class Spring(Straight):
    """A straight spring: V = k (l - l0)^2 / 2, l the distance of its points.

    Args:
        points: its two ends.
        stiffness: k [N/m].
        length: natural length l0 [m], or "start": the distance at the start.
        along: a fixed direction along which the stretch is measured instead, ground axes, 2 or 3.
    """

    kind: ClassVar[str] = "spring"
    elastic: ClassVar[bool] = True
    stiffness: LinearStiffness
    length: NaturalLength
    along: Direction | None = None

    @property
    def element(self) -> Element:
        return Element(points=self.points, along=self.along, stiffness=self.stiffness, slack=self.length)

    def law(self, scene: LoadContext, line: Reach) -> AnyScalar:
        """k (l - l0)"""
        return scene.value(self.stiffness) * self._stretch(scene, line.length)

    def by_length(self, scene: LoadContext, line: Reach) -> AnyScalar | None:
        """k where l0 = 0"""
        free = self.along is None and is_zero(self._natural(scene, line.length))
        return scene.value(self.stiffness) if free else None

    def potential(self, scene: LoadContext) -> AnyScalar | None:
        """V = k (l - l0)^2 / 2"""
        stretch = self._stretch(scene, self.line(scene).length)
        return Fraction(1, 2) * scene.value(self.stiffness) * stretch * stretch

    def _stretch(self, scene: LoadContext, length: AnyScalar) -> AnyScalar:
        return length - self._natural(scene, length)

    def _natural(self, scene: LoadContext, length: AnyScalar) -> AnyScalar:
        return scene.start(length) if self.length == "start" else scene.value(self.length)
