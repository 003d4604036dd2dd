"""Guide: a body slides without turning."""

from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.pin import alike, not_turning
from eomgen.model.constraints.plane import same_turn
from eomgen.model.constraints.row import TieRow, direction_of, normals_of
from eomgen.model.forces.load import LoadContext, PointForce
from eomgen.model.kinds import Direction, PointName
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.spatial import IDENTITY, dot


@dataclass(frozen=True, kw_only=True)
class Guide(Constraint):
    """The point moves along `along` (ground axes) and its body does not turn.

    A normal force and a couple; in space two forces across `along` and three couples.

    Args:
        point: what is guided.
        along: direction of the guide, ground axes.
    """

    kind: ClassVar[str] = "guide"
    point: PointName
    along: Direction

    def stays(self, component: str) -> bool:
        return True

    @property
    def lies_by_start(self) -> bool:
        return True

    def rows(self, scene: LoadContext) -> tuple[TieRow, ...]:
        """n . (p - p_start) = 0 for each n across `along`; theta - theta_start = 0, in space as a clamp."""
        place = scene.place(self.point)
        rows = []
        for name, n in normals_of(scene, direction_of(scene, scene.vector(self.along))):
            height = dot(n, scene.position(place))
            rows.append(TieRow((PointForce(place, n),), height - scene.start(height), component=name))
        turns = [same_turn(scene, place[0], None)] if scene.plane else not_turning(scene, (place[0], None))
        return (*rows, *turns)

    def agreeing(self, scene: LoadContext) -> tuple[Scalar, ...]:
        """In space e_i . e_i of the ground's axes and those that the body carries."""
        body = scene.place(self.point)[0]
        return () if scene.plane else tuple(alike(scene, (body, None), e) for e in IDENTITY)
