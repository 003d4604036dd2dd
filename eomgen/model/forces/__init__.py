"""Forces: the seam of applied forces.

Adding one is one class, next to its kin or in a file of its own, and one name here.
"""

from eomgen.model.forces.applied import CoupleForce, Generalized, PointForce
from eomgen.model.forces.base import Force
from eomgen.model.forces.bumper import Bumper
from eomgen.model.forces.cylinders import HydraulicCylinder, PneumaticCylinder
from eomgen.model.forces.dry import Belt, Brake, Clutch
from eomgen.model.forces.elements import Between, Damper, Spring
from eomgen.model.forces.energies import Kinetic, Potential
from eomgen.model.forces.fluid import AddedMass, Buoyancy, Drag, Plate
from eomgen.model.forces.gear_mesh import GearMesh
from eomgen.model.forces.mass_flow import MassFlow
from eomgen.model.forces.rope import Rope
from eomgen.model.forces.torsion import TorsionDamper, TorsionSpring
from eomgen.model.forces.tyre import Tyre
from eomgen.model.forces.weights import Distributed, Gravity

ALL = (
    Gravity,
    PointForce,
    CoupleForce,
    Distributed,
    Spring,
    Damper,
    TorsionSpring,
    TorsionDamper,
    Between,
    Bumper,
    HydraulicCylinder,
    PneumaticCylinder,
    Rope,
    GearMesh,
    Clutch,
    Brake,
    Belt,
    MassFlow,
    Drag,
    Plate,
    Buoyancy,
    AddedMass,
    Tyre,
    Potential,
    Kinetic,
    Generalized,
)

__all__ = [
    "ALL",
    "AddedMass",
    "Belt",
    "Between",
    "Brake",
    "Bumper",
    "Buoyancy",
    "Clutch",
    "CoupleForce",
    "Damper",
    "Distributed",
    "Drag",
    "Force",
    "GearMesh",
    "Generalized",
    "Gravity",
    "HydraulicCylinder",
    "Kinetic",
    "MassFlow",
    "Plate",
    "PneumaticCylinder",
    "PointForce",
    "Potential",
    "Rope",
    "Spring",
    "TorsionDamper",
    "TorsionSpring",
    "Tyre",
]
