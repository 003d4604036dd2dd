"""Output functions: the seam of the functions of the motion that outputs may call.

Adding one is one class, next to its kin or in a file of its own, and one name here.
"""

from eomgen.model.outputs.base import OutputFunction
from eomgen.model.outputs.energies import GENERALIZED_FORCE, KINETIC_ENERGY, MOMENTUM, POTENTIAL_ENERGY, POWER
from eomgen.model.outputs.forces import (
    CONTACT_REACTION,
    COUPLE,
    DRIVE,
    FRICTION_OF_JOINT,
    IMPULSE,
    IMPULSE_OF_FORCES,
    MULTIPLIER,
    ONE_REACTION_COUPLE,
    PULL,
    REACTION_COUPLE,
    REACTION_FORCE,
    SECTION_FORCES,
    TENSION,
)
from eomgen.model.outputs.masses import (
    ANGULAR_MOMENTUM,
    INERTIA_AXIS,
    INERTIA_PLANE,
    INERTIA_POINT,
    INERTIA_PRODUCT,
    INERTIA_TENSOR,
    MASS_OF,
    PRINCIPAL_MOMENT,
)
from eomgen.model.outputs.points import (
    ACCELERATION,
    CURVATURE_RADIUS,
    MAGNITUDE_OF_ACCELERATION,
    NORMAL_ACCELERATION,
    POSITION,
    SPEED,
    TANGENTIAL_ACCELERATION,
    VELOCITY,
)
from eomgen.model.outputs.runs import ALONG_A_RUN, ENTRIES, FREQUENCY
from eomgen.model.outputs.turning import (
    ACCELERATION_POLE,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_VELOCITY,
    EPSILON,
    LEAST_SPEED,
    OMEGA,
    OWN_ANGULAR_ACCELERATION,
    OWN_ANGULAR_VELOCITY,
    PARTS_OF_MOTION,
    ROTATION_CENTER,
)

ALL: tuple[OutputFunction, ...] = (
    POSITION,
    VELOCITY,
    ACCELERATION,
    SPEED,
    MAGNITUDE_OF_ACCELERATION,
    TANGENTIAL_ACCELERATION,
    NORMAL_ACCELERATION,
    CURVATURE_RADIUS,
    *PARTS_OF_MOTION,
    LEAST_SPEED,
    ROTATION_CENTER,
    ACCELERATION_POLE,
    ANGLE,
    OMEGA,
    ANGULAR_VELOCITY,
    OWN_ANGULAR_VELOCITY,
    EPSILON,
    ANGULAR_ACCELERATION,
    OWN_ANGULAR_ACCELERATION,
    KINETIC_ENERGY,
    POTENTIAL_ENERGY,
    POWER,
    GENERALIZED_FORCE,
    MOMENTUM,
    REACTION_FORCE,
    REACTION_COUPLE,
    ONE_REACTION_COUPLE,
    CONTACT_REACTION,
    TENSION,
    IMPULSE,
    IMPULSE_OF_FORCES,
    MULTIPLIER,
    DRIVE,
    FRICTION_OF_JOINT,
    PULL,
    COUPLE,
    *SECTION_FORCES,
    MASS_OF,
    INERTIA_POINT,
    INERTIA_AXIS,
    INERTIA_PLANE,
    INERTIA_PRODUCT,
    INERTIA_TENSOR,
    PRINCIPAL_MOMENT,
    ANGULAR_MOMENTUM,
    *ENTRIES,
    FREQUENCY,
    *ALONG_A_RUN,
)
FUNCTIONS = {name: function for function in ALL for name in function.names}
"""The functions of the motion, by name."""

__all__ = ["ALL", "FUNCTIONS", "OutputFunction"]
