"""Slider: a point stays on the line of a body."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, ClassVar

from eomgen.errors import ModelError
from eomgen.model.catalog import Catalog, owner_of
from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.meeting import BodyLine, Meeting, TouchingPoint
from eomgen.model.constraints.plane import Touch, opposite
from eomgen.model.constraints.row import TieRow, direction_of, normals_of
from eomgen.model.findings import Finding
from eomgen.model.forces.load import LoadContext
from eomgen.model.friction import FrictionLaw
from eomgen.model.kinds import BodyName, Flag, PointName
from eomgen.model.positions import DocumentPath
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import apply, dot, minus


@dataclass(frozen=True, kw_only=True)
class Slider(Constraint):
    """The point stays on the line (`line = ["A", "B"]`) of body `on`.

    Args:
        point: what slides.
        on: the body whose line it is.
        unilateral: it can only push (in the plane).
        friction: in the contact.
    """

    kind: ClassVar[str] = "slider"
    holds_ground: ClassVar[bool] = True
    on_line: ClassVar[bool] = True
    point: PointName
    on: BodyName
    unilateral: Flag = False
    friction: FrictionLaw | None = None

    def findings(self, path: DocumentPath, catalog: Catalog) -> Iterator[Finding]:
        """The body needs a line, another than that of the point; in space the slider cannot end."""
        if _lacks_line(catalog, self.on):
            what = f"'{path[1]}' slides on the line of body '{self.on}', which has none"
            yield Finding((*path, "on"), what, f'give body \'{self.on}\' its line = ["A", "B"]')
        if self.unilateral and catalog.model.space == "space":
            what = f"'{path[1]}' holds its point on a line in space from all sides: it cannot end"
            yield Finding((*path, "unilateral"), what, "leave it out, or use a support", key=True)
        if self.point is not None and owner_of(self.point) == self.on:
            what = f"the point '{self.point}' of '{path[1]}' is on the body along which it should slide"
            yield Finding((*path, "point"), what)

    def meeting(self) -> Meeting:
        """The point, on the body's line."""
        return Meeting(TouchingPoint(self.point), BodyLine(self.on))

    def rows(self, scene: LoadContext) -> tuple[TieRow, ...]:
        """n . (p - p_A) = 0 for each n across A -> B in the body; the line pushes along n, friction along A -> B.

        In the plane n is the left normal; in space there are two, and |N| = sqrt(N_1^2 + N_2^2). A point of the ground
        pushes the body: then n and friction are what acts on the body.
        """
        (_, A), (_, B) = line = scene.line(self.on)
        if scene.moves((*A, *B)):
            raise ModelError(f"the line of body '{self.on}' moves in the body", scene.where, "choose points that stay")
        d, R = direction_of(scene, minus(B, A)), scene.orientation(self.on)
        place = scene.place(self.point)
        arm = minus(scene.position(place), scene.position(line[0]))
        touch, sense = (Touch(place), Touch(line[0], arm)), 1
        if place[0] is None:
            touch, sense = (touch[1], touch[0]), -1
        rows = [
            TieRow(opposite(*touch, apply(R, n)), sense * dot(apply(R, n), arm), component=name)
            for name, n in normals_of(scene, d)
        ]
        rows[-1] = replace(rows[-1], tangent=opposite(*touch, apply(R, d)), round=not scene.plane)
        return tuple(rows)


def _lacks_line(catalog: Catalog, body: Any) -> bool:
    part = catalog.table("bodies").get(body)
    return part is not None and part.line is None and ("bodies", body, "line") not in catalog.broken
