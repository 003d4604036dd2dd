"""Forces: the seam of what is applied. Adding one is one file and one name here."""

from eomgen.model.forces.base import Force
from eomgen.model.forces.between import Between
from eomgen.model.forces.couple import CoupleForce
from eomgen.model.forces.damper import Damper
from eomgen.model.forces.distributed import Distributed
from eomgen.model.forces.force import PointForce
from eomgen.model.forces.generalized import Generalized
from eomgen.model.forces.gravity import Gravity
from eomgen.model.forces.kinetic import Kinetic
from eomgen.model.forces.potential import Potential
from eomgen.model.forces.spring import Spring
from eomgen.model.forces.torsion_damper import TorsionDamper
from eomgen.model.forces.torsion_spring import TorsionSpring

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
    Potential,
    Kinetic,
    Generalized,
)

__all__ = [
    "ALL",
    "Between",
    "CoupleForce",
    "Damper",
    "Distributed",
    "Force",
    "Generalized",
    "Gravity",
    "Kinetic",
    "PointForce",
    "Potential",
    "Spring",
    "TorsionDamper",
    "TorsionSpring",
]
