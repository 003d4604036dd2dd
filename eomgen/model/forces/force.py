"""Force: at a point."""

from typing import ClassVar

from eomgen.model.forces import load
from eomgen.model.forces.base import Force
from eomgen.model.forces.element import Act, PushAt
from eomgen.model.kinds import AxesName, ForceVector, PointName
from eomgen.records import dataclass


@dataclass(frozen=True, kw_only=True)
class PointForce(Force):
    """A force at a point of a body.

    Args:
        point: where it acts.
        force: its components, 2 or 3 [N].
        axes: "ground", or the body whose axes the components are in.
    """

    kind: ClassVar[str] = "force"
    point: PointName
    force: ForceVector
    axes: AxesName = "ground"

    @property
    def acts(self) -> tuple[Act, ...]:
        return (PushAt(self.point, self.force, self.axes),)

    def loads(self, scene: load.LoadContext) -> tuple[load.Load, ...]:
        axes = None if self.axes == "ground" else self.axes
        return (load.PointForce(scene.place(self.point), scene.vector(self.force), axes),)
