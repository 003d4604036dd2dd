"""Output functions: the seam of what outputs may ask. Adding one is one file and one name here."""

from eomgen.model.outputs import of_a_run, relative_motion, section_forces, small_motions
from eomgen.model.outputs.acceleration import ACCELERATION, MAGNITUDE_OF_ACCELERATION
from eomgen.model.outputs.along_coordinates import GENERALIZED_FORCE, MOMENTUM
from eomgen.model.outputs.angular_momentum import ANGULAR_MOMENTUM
from eomgen.model.outputs.base import OutputFunction
from eomgen.model.outputs.centers import ACCELERATION_POLE, ROTATION_CENTER
from eomgen.model.outputs.efforts import COUPLE, DRIVE, MULTIPLIER, PULL
from eomgen.model.outputs.energies import KINETIC_ENERGY, POTENTIAL_ENERGY, POWER
from eomgen.model.outputs.least_speed import LEAST_SPEED
from eomgen.model.outputs.mass_of import MASS_OF
from eomgen.model.outputs.moments_of_inertia import (
    INERTIA_AXIS,
    INERTIA_PLANE,
    INERTIA_POINT,
    INERTIA_PRODUCT,
    INERTIA_TENSOR,
    PRINCIPAL_MOMENT,
)
from eomgen.model.outputs.path import CURVATURE_RADIUS, NORMAL_ACCELERATION, TANGENTIAL_ACCELERATION
from eomgen.model.outputs.position import POSITION
from eomgen.model.outputs.reactions import (
    CONTACT_REACTION,
    ONE_REACTION_COUPLE,
    REACTION_COUPLE,
    REACTION_FORCE,
)
from eomgen.model.outputs.tension import TENSION
from eomgen.model.outputs.turning import ANGLE, ANGULAR_ACCELERATION, ANGULAR_VELOCITY, EPSILON, OMEGA
from eomgen.model.outputs.velocity import SPEED, VELOCITY

ALL: tuple[OutputFunction, ...] = (
    POSITION,
    VELOCITY,
    ACCELERATION,
    SPEED,
    MAGNITUDE_OF_ACCELERATION,
    TANGENTIAL_ACCELERATION,
    NORMAL_ACCELERATION,
    CURVATURE_RADIUS,
    *relative_motion.PARTS_OF_MOTION,
    LEAST_SPEED,
    ROTATION_CENTER,
    ACCELERATION_POLE,
    ANGLE,
    OMEGA,
    ANGULAR_VELOCITY,
    EPSILON,
    ANGULAR_ACCELERATION,
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
    MULTIPLIER,
    DRIVE,
    PULL,
    COUPLE,
    *section_forces.SECTION_FORCES,
    MASS_OF,
    INERTIA_POINT,
    INERTIA_AXIS,
    INERTIA_PLANE,
    INERTIA_PRODUCT,
    INERTIA_TENSOR,
    PRINCIPAL_MOMENT,
    ANGULAR_MOMENTUM,
    *small_motions.ENTRIES,
    small_motions.FREQUENCY,
    *of_a_run.ALONG_A_RUN,
)
FUNCTIONS = {name: function for function in ALL for name in function.names}
"""The functions of the motion, by name."""

__all__ = ["ALL", "FUNCTIONS", "OutputFunction"]
