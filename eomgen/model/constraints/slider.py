"""Slider: a point stays on the line of a body."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.errors import ModelError
from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.plane import Touch, left, opposite
from eomgen.model.constraints.row import TieRow, direction_of
from eomgen.model.forces.load import Scene
from eomgen.model.friction import FrictionLaw
from eomgen.model.kinds import BodyName, Flag, PointName
from eomgen.symbolic.spatial import apply, dot, minus


@dataclass(frozen=True, kw_only=True)
class Slider(Constraint):
    """The point stays on the line (`line = ["A", "B"]`) of body `on`.

    Args:
        point: what slides.
        on: the body whose line it is.
        unilateral: it can only push.
        friction: in the contact.
    """

    kind: ClassVar[str] = "slider"
    spaces: ClassVar[tuple[str, ...]] = ("plane",)
    point: PointName
    on: BodyName
    unilateral: Flag = False
    friction: FrictionLaw | None = None

    def rows(self, scene: Scene) -> tuple[TieRow, ...]:
        """n . (p - p_A) = 0, n the left normal of A -> B; the line pushes the point along n, friction along A -> B.

        A point of the ground pushes the body: then n and friction are what acts on the body.
        """
        (_, A), (_, B) = line = scene.line(self.on)
        if scene.moves((*A, *B)):
            raise ModelError(f"the line of body '{self.on}' moves in the body", scene.where, "choose points that stay")
        along = apply(scene.orientation(self.on), direction_of(scene, minus(B, A)))
        place = scene.place(self.point)
        arm = minus(scene.position(place), scene.position(line[0]))
        n, touch = left(along), (Touch(place), Touch(line[0], arm))
        height = dot(n, arm)
        if place[0] is None:
            touch, height = (touch[1], touch[0]), -height
        return (TieRow(opposite(*touch, n), height, component="n", tangent=opposite(*touch, along)),)
