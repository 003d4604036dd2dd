"""Spring: between two points."""

from typing import ClassVar

from eomgen.model.forces.base import Force
from eomgen.model.forces.element import Element
from eomgen.model.forces.load import Load, LoadContext
from eomgen.model.forces.reach import reach
from eomgen.model.kinds import Direction, LinearStiffness, NaturalLength, TwoPoints
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class Spring(Force):
    """A straight spring: V = k (l - l0)^2 / 2, l the distance of its points.

    Args:
        points: its two ends.
        stiffness: k [N/m].
        length: natural length l0 [m], or "start": the distance at the start.
        along: a fixed direction along which the stretch is measured instead, ground axes, 2 or 3.
    """

    kind: ClassVar[str] = "spring"
    elastic: ClassVar[bool] = True
    points: TwoPoints
    stiffness: LinearStiffness
    length: NaturalLength
    along: Direction | None = None

    @property
    def element(self) -> Element:
        return Element(points=self.points, along=self.along, stiffness=self.stiffness, slack=self.length)

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """A pull k (l - l0)."""
        line = reach(scene, self.points, self.along)
        return line.pulled(scene.value(self.stiffness) * self._stretch(scene, line.length))

    def potential(self, scene: LoadContext) -> AnyScalar | None:
        """V = k (l - l0)^2 / 2"""
        stretch = self._stretch(scene, reach(scene, self.points, self.along).length)
        return Fraction(1, 2) * scene.value(self.stiffness) * stretch * stretch

    def _stretch(self, scene: LoadContext, length: AnyScalar) -> AnyScalar:
        return length - (scene.start(length) if self.length == "start" else scene.value(self.length))
