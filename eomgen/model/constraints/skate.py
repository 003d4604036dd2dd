"""Skate: a knife edge."""

from collections.abc import Iterator
from typing import ClassVar

from eomgen.model.catalog import Catalog, not_in_the_plane
from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.meeting import Groove, Meeting, TouchingPoint
from eomgen.model.constraints.plane import left
from eomgen.model.constraints.round_bodies import complement
from eomgen.model.constraints.row import TieRow, direction_of
from eomgen.model.findings import Finding
from eomgen.model.forces.load import LoadContext, PointForce
from eomgen.model.kinds import Direction, PointName, SpaceDirection
from eomgen.model.positions import DocumentPath
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.spatial import apply, cross, dot, times


@dataclass(frozen=True, kw_only=True)
class Skate(Constraint):
    """No velocity of the point across `along` (body axes); the reaction acts along the left normal.

    Args:
        point: of the edge.
        along: the edge, body axes.
        normal: in space, of the ice on which it cuts, ground axes; None: z.
    """

    kind: ClassVar[str] = "skate"
    point: PointName
    along: Direction
    normal: SpaceDirection | None = None

    def findings(self, path: DocumentPath, catalog: Catalog) -> Iterator[Finding]:
        """The ice has no normal in the plane."""
        yield from not_in_the_plane(catalog, path, self, ("normal",))

    def meeting(self) -> Meeting:
        """The point, in the groove that it cuts."""
        return Meeting(
            TouchingPoint(self.point), Groove(self.point.rpartition(".")[0] or None, self.along, self.normal)
        )

    def rows(self, scene: LoadContext) -> tuple[TieRow, ...]:
        """n . v = 0; a row of velocities alone, which no gap has for a rate.

        n is the left normal of `along`; in space, on ice of the normal e and with the edge d, n = e x d / |e x d|.
        """
        place = scene.place(self.point)
        along = direction_of(scene, scene.vector(self.along))
        if scene.plane:
            return (TieRow((PointForce(place, left(along), axes=place[0]),), None, component="n"),)
        e = (0, 0, 1) if self.normal is None else direction_of(scene, scene.vector(self.normal))
        d = along if place[0] is None else apply(scene.orientation(place[0]), along)
        n = times(over(1, complement(scene, dot(e, d))), cross(e, d))
        return (TieRow((PointForce(place, n),), None, component="n"),)
