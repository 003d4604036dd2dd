"""Damper: between two points."""

from typing import ClassVar

from eomgen.model.forces.element import Element
from eomgen.model.forces.load import LoadContext
from eomgen.model.forces.reach import Reach
from eomgen.model.forces.straight import Straight
from eomgen.model.kinds import Direction, LinearDamping
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class Damper(Straight):
    """A straight damper: pull c l', l the distance of its points.

    Args:
        points: its two ends.
        damping: c [N s/m].
        along: a fixed direction along which the rate is measured instead, ground axes, 2 or 3.
    """

    kind: ClassVar[str] = "damper"
    damping: LinearDamping
    along: Direction | None = None

    @property
    def element(self) -> Element:
        return Element(points=self.points, along=self.along, damping=self.damping)

    def law(self, scene: LoadContext, line: Reach) -> AnyScalar:
        """c l'"""
        return scene.value(self.damping) * line.rate
