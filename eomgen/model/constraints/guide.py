"""Guide: a body slides without turning."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.plane import left, same_turn
from eomgen.model.constraints.row import TieRow, direction_of
from eomgen.model.forces.load import PointForce, Scene
from eomgen.model.kinds import Direction, PointName
from eomgen.symbolic.spatial import dot


@dataclass(frozen=True, kw_only=True)
class Guide(Constraint):
    """The point moves along `along` (ground axes) and its body does not turn: a normal force and a couple."""

    kind: ClassVar[str] = "guide"
    spaces: ClassVar[tuple[str, ...]] = ("plane",)
    point: PointName
    along: Direction

    def rows(self, scene: Scene) -> tuple[TieRow, ...]:
        """n . (p - p_start) = 0, n the left normal of `along`; theta - theta_start = 0."""
        n = left(direction_of(scene, scene.vector(self.along)))
        place = scene.place(self.point)
        height = dot(n, scene.position(place))
        normal = TieRow((PointForce(place, n),), height - scene.start(height), component="n")
        return (normal, same_turn(scene, place[0], None))
