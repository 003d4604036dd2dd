"""Clamp: a point of a body is built in."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.pin import across_from, held_together, others_of
from eomgen.model.constraints.plane import same_turn
from eomgen.model.constraints.row import TieRow
from eomgen.model.forces.load import Scene
from eomgen.model.kinds import PointName, Points
from eomgen.symbolic.spatial import IDENTITY


@dataclass(frozen=True, kw_only=True)
class Clamp(Constraint):
    """A body is built into the ground at `point`, or bodies are welded together at `points`."""

    kind: ClassVar[str] = "clamp"
    point: PointName | None = None
    points: Points | None = None

    def rows(self, scene: Scene) -> tuple[TieRow, ...]:
        """The rows of a pin, and no turning against the start; in space e_i . e_j = 0 of axes in either body."""
        first, *_ = named = [scene.place(p) for p in (*(self.points or ()), self.point) if p is not None]
        rows: list[TieRow] = []
        for other in others_of(scene, named):
            rows += held_together(scene, first, other)
            if scene.plane:
                rows.append(same_turn(scene, first[0], other[0]))
            else:  # y x z = x: the couples about x, y and z
                x, y, z = IDENTITY
                rows += [across_from(scene, (first[0], other[0]), e, n) for e, n in ((y, z), (z, x), (x, y))]
        return tuple(rows)
