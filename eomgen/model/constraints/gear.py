"""Gear: two bodies turn in a fixed ratio."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.plane import same_turn
from eomgen.model.constraints.row import TieRow
from eomgen.model.forces.load import Scene
from eomgen.model.kinds import Pure, TwoBodies


@dataclass(frozen=True, kw_only=True)
class Gear(Constraint):
    """The rates of the two bodies' angles are in the ratio: omega of the first = ratio * omega of the second."""

    kind: ClassVar[str] = "gear"
    spaces: ClassVar[tuple[str, ...]] = ("plane",)
    bodies: TwoBodies
    ratio: Pure

    def rows(self, scene: Scene) -> tuple[TieRow, ...]:
        """theta_1 - ratio theta_2 stays; a couple 1 on the first body, - ratio on the second, none on the ground."""
        first, second = self.bodies
        return (same_turn(scene, first, second, scene.value(self.ratio)),)
