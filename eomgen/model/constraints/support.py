"""Support: a point stays on a line or a plane."""

from dataclasses import replace
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.meeting import FlatSurface, Meeting, TouchingPoint
from eomgen.model.constraints.round_bodies import laid_in
from eomgen.model.constraints.row import TieRow, direction_of
from eomgen.model.forces.load import LoadContext, PointForce
from eomgen.model.friction import FrictionLaw
from eomgen.model.kinds import Direction, Flag, GroundPlace, PointName
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import Vector, dot, minus, vector_of


@dataclass(frozen=True, kw_only=True)
class Support(Constraint):
    """The point stays on the line (plane) across `normal` through `at`; the support pushes along `normal`.

    Args:
        point: what is supported.
        normal: ground axes, 2 or 3.
        at: a place on the line, or a ground point's name (None: where the point stands).
        unilateral: it can only push.
        friction: in the contact.
    """

    kind: ClassVar[str] = "support"
    point: PointName
    normal: Direction
    at: GroundPlace | None = None
    unilateral: Flag = False
    friction: FrictionLaw | None = None

    def meeting(self) -> Meeting:
        """The point, on its line or plane."""
        return Meeting(TouchingPoint(self.point), FlatSurface(None, self.at, self.normal))

    def rows(self, scene: LoadContext) -> tuple[TieRow, ...]:
        """n . (p - p_0) = 0, n of unit length; the support pushes along n; friction along t, with t, n as x, y.

        In space along t and s, as those of a rolling body.
        """
        n = direction_of(scene, scene.vector(self.normal))
        place = scene.place(self.point)
        position = scene.position(place)
        origin = vector_of(map(scene.start, position)) if self.at is None else scene.ground_place(self.at)
        along: tuple[Vector, ...] = ((n[1], -n[0], 0),) if scene.plane else laid_in(scene, n)
        tangents = [(PointForce(place, t),) for t in along]
        gap = dot(n, minus(position, origin))
        row = TieRow((PointForce(place, n),), gap, component="n", tangent=tangents[0])
        return (row if scene.plane else replace(row, cross_tangent=tangents[1]),)
