"""Kinetic: an energy of the motion that belongs to no body."""

from typing import ClassVar

from eomgen.model.forces.base import Force
from eomgen.model.forces.element import Act, GivenEnergy
from eomgen.model.kinds import MotionEnergy
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression


@dataclass(frozen=True, kw_only=True)
class Kinetic(Force):
    """A kinetic energy given as an expression of coordinates, rates, speeds, parameters and time [J].

    Its inertia forces -(d/dt dT/dq' - dT/dq) enter M and c: a model that has its energies alone, or what moves with
    the bodies and is none, as the water round a hull.

    Args:
        energy: T.
    """

    kind: ClassVar[str] = "kinetic"
    placeless: ClassVar[bool] = True
    energy: MotionEnergy

    @property
    def acts(self) -> tuple[Act, ...]:
        return (GivenEnergy(kinetic=self.energy),)

    @property
    def kinetic(self) -> Expression:
        return self.energy
