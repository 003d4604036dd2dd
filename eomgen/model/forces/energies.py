"""Energies that are declared as functions of the coordinates and speeds."""

from collections.abc import Iterator
from typing import ClassVar

from eomgen.frozen import dataclass
from eomgen.model.forces.base import Act, Force, ForceTrial
from eomgen.model.forces.load import LoadContext
from eomgen.model.kinds import Energy, MotionEnergy
from eomgen.symbolic.expression import Expression, Scalar

# -------- potential -------------------------------------------------------------------------------------------
# Potential: an energy of the coordinates.


@dataclass(frozen=True, kw_only=True)
class Potential(Force):
    """A potential energy given as an expression of coordinates, parameters and time [J].

    Args:
        energy: V.
    """

    kind: ClassVar[str] = "potential"
    placeless: ClassVar[bool] = True
    energy: Energy

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        yield Act(moving=(here.scalar(self.energy),), force=(-1,))

    def potential(self, scene: LoadContext) -> Scalar | None:
        return scene.value(self.energy)


# -------- kinetic ---------------------------------------------------------------------------------------------
# Kinetic: an energy of the motion that belongs to no body.


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
    moving: ClassVar[bool] = True
    energy: MotionEnergy

    def acts(self, here: ForceTrial) -> Iterator[Act]:
        yield Act(kinetic=here.scalar(self.energy))

    @property
    def kinetic(self) -> Expression:
        return self.energy
