"""Between: a pull between two points as a law of their distance."""

from typing import ClassVar

from eomgen.model.forces.element import Element
from eomgen.model.forces.load import LoadContext
from eomgen.model.forces.reach import Reach
from eomgen.model.forces.straight import Straight
from eomgen.model.kinds import Pull
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class Between(Straight):
    """Two points pull each other with f(r, r'), r their distance; attraction positive [N].

    Args:
        points: the two points.
        pull: the law; `r` and `r'` mean the distance and its rate here.
    """

    kind: ClassVar[str] = "between"
    pull: Pull

    @property
    def element(self) -> Element:
        return Element(points=self.points, pull=self.pull)

    def law(self, scene: LoadContext, line: Reach) -> AnyScalar:
        """f(r, r')"""
        return scene.value_at(self.pull, {"r": line.length, "r'": line.rate})

    def potential(self, scene: LoadContext) -> AnyScalar | None:
        """V = integral of f dr where f holds r and parameters only; None where it has no closed form."""
        return scene.primitive(self.pull, "r", self.line(scene).length)
