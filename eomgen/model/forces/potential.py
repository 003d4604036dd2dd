"""Potential: an energy of the coordinates."""

from typing import ClassVar

from eomgen.model.forces.base import Force
from eomgen.model.forces.element import Act, GivenEnergy
from eomgen.model.forces.load import LoadContext
from eomgen.model.kinds import Energy
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class Potential(Force):
    """A potential energy given as an expression of coordinates, parameters and time [J].

    Args:
        energy: V.
    """

    kind: ClassVar[str] = "potential"
    placeless: ClassVar[bool] = True
    energy: Energy

    @property
    def acts(self) -> tuple[Act, ...]:
        return (GivenEnergy(potential=self.energy),)

    def potential(self, scene: LoadContext) -> AnyScalar | None:
        return scene.value(self.energy)
