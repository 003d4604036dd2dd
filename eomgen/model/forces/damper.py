"""Damper: between two points."""

from typing import ClassVar

from eomgen.model.forces.base import Force
from eomgen.model.forces.element import Element
from eomgen.model.forces.load import Load, LoadContext
from eomgen.model.forces.reach import reach
from eomgen.model.kinds import Direction, LinearDamping, TwoPoints
from eomgen.records import dataclass


@dataclass(frozen=True, kw_only=True)
class Damper(Force):
    """A straight damper: pull c l', l the distance of its points.

    Args:
        points: its two ends.
        damping: c [N s/m].
        along: a fixed direction along which the rate is measured instead, ground axes, 2 or 3.
    """

    kind: ClassVar[str] = "damper"
    points: TwoPoints
    damping: LinearDamping
    along: Direction | None = None

    @property
    def element(self) -> Element:
        return Element(points=self.points, along=self.along, damping=self.damping)

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """A pull c l'."""
        line = reach(scene, self.points, self.along)
        return line.pulled(scene.value(self.damping) * line.rate)
