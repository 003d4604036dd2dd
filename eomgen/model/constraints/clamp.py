"""Clamp: a point of a body is built in."""

from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.pin import alike, held_together, not_turning, others_of
from eomgen.model.constraints.plane import same_turn
from eomgen.model.constraints.row import TieRow
from eomgen.model.forces.load import LoadContext
from eomgen.model.kinds import PointName, Points
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.spatial import IDENTITY


@dataclass(frozen=True, kw_only=True)
class Clamp(Constraint):
    """A body is built into the ground at `point`, or bodies are welded together at `points`.

    Args:
        point: that stays where it stands, with its body.
        points: one of each body instead.
    """

    kind: ClassVar[str] = "clamp"
    one_of: ClassVar[tuple[str, ...]] = ("point", "points")
    point: PointName | None = None
    points: Points | None = None

    def stays(self, component: str) -> bool:
        return self.point is not None or component == "couple"

    def rows(self, scene: LoadContext) -> tuple[TieRow, ...]:
        """The rows of a pin, and no turning against the start; in space e_i . e_j = 0 of axes in either body."""
        first, *_ = named = [scene.place(p) for p in (*(self.points or ()), self.point) if p is not None]
        rows: list[TieRow] = []
        for other in others_of(scene, named):
            rows += held_together(scene, first, other)
            bodies = first[0], other[0]
            rows += [same_turn(scene, *bodies)] if scene.plane else not_turning(scene, bodies)
        return tuple(rows)

    def agreeing(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """In space e_i . e_i of the axes in either body."""
        if scene.plane:
            return ()
        first, *_ = named = [scene.place(p) for p in (*(self.points or ()), self.point) if p is not None]
        return tuple(alike(scene, (first[0], other[0]), e) for other in others_of(scene, named) for e in IDENTITY)
