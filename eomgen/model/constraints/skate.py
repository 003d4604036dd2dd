"""Skate: a knife edge."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.plane import left
from eomgen.model.constraints.row import TieRow, direction_of
from eomgen.model.forces.load import PointForce, Scene
from eomgen.model.kinds import Direction, PointName


@dataclass(frozen=True, kw_only=True)
class Skate(Constraint):
    """No velocity of the point across `along` (body axes); the reaction acts along the left normal."""

    kind: ClassVar[str] = "skate"
    spaces: ClassVar[tuple[str, ...]] = ("plane",)
    point: PointName
    along: Direction

    def rows(self, scene: Scene) -> tuple[TieRow, ...]:
        """n . v = 0, n the left normal of `along`; a row of velocities alone, which no gap has for a rate."""
        place = scene.place(self.point)
        n = left(direction_of(scene, scene.vector(self.along)))
        return (TieRow((PointForce(place, n, axes=place[0]),), None, component="n"),)
