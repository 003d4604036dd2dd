"""Generalized: a force that belongs to a coordinate and to no point."""

from typing import ClassVar

from eomgen.model.forces.base import Force
from eomgen.model.forces.element import Act, PushOnCoordinate
from eomgen.model.forces.load import GeneralizedForce, Load, LoadContext
from eomgen.model.kinds import CoordinateName, WorkingForce
from eomgen.records import dataclass


@dataclass(frozen=True, kw_only=True)
class Generalized(Force):
    """A generalized force: virtual work value * delta q.

    Args:
        coordinate: its q.
        value: the force [N] or couple [N m] that does work on q.
    """

    kind: ClassVar[str] = "generalized"
    coordinate: CoordinateName
    value: WorkingForce

    @property
    def acts(self) -> tuple[Act, ...]:
        return (PushOnCoordinate(self.coordinate, self.value),)

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        return (GeneralizedForce(self.coordinate, scene.value(self.value)),)
