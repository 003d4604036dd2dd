"""Pin: a hinge of points."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.row import TieRow, axes_of
from eomgen.model.forces.load import Place, Scene
from eomgen.model.kinds import Points, SpaceDirection
from eomgen.symbolic.spatial import dot, minus, times


@dataclass(frozen=True, kw_only=True)
class Pin(Constraint):
    """One point: held to the ground where it stands; two or more: one hinge of them all.

    Args:
        points: the hinge's points, one of each body.
        axis: in space, the hinge's axis in the ground's axes at the start (None: a ball joint).
    """

    kind: ClassVar[str] = "pin"
    works: ClassVar[bool] = True
    points: Points
    axis: SpaceDirection | None = None

    def rows(self, scene: Scene) -> tuple[TieRow, ...]:
        """For each further point P of the hinge, e . (p_first - p_P) = 0 along each axis; alone, against its start."""
        first, *others = (scene.place(point) for point in self.points)
        if not others:
            position = scene.position(first)
            others = [(None, tuple(scene.start(x) for x in position))]  # type: ignore[list-item]
        return tuple(row for other in others for row in _held_together(scene, first, other))


def _held_together(scene: Scene, first: Place, other: Place) -> tuple[TieRow, ...]:
    gap = minus(scene.position(first), scene.position(other))
    return tuple(
        TieRow(((first, e), (other, times(-1, e))), dot(e, gap)) for e in axes_of(scene)
    )  # fmt: skip
