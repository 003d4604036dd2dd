"""Door of the folder: what other folders may import from `eomgen.mechanics.instant`."""

# The motion of one body at one state, exactly
from eomgen.mechanics.instant.kinematic_state import BodyMotion as BodyMotion

# Velocities and accelerations of a system at one instant, as scalars of the parameters
from eomgen.mechanics.instant.kinematic_state import KinematicState as KinematicState

# Values at a state, in readable form; what is very long stays as it is
from eomgen.mechanics.instant.kinematic_state import Readable as Readable

# Rigid bodies in motion in the plane, at one configuration
from eomgen.mechanics.instant.mechanism import Mechanism as Mechanism

# The centre of rotation of one body as its motion goes on
from eomgen.mechanics.instant.motion_kind import Centrodes as Centrodes

# The kinds of motion of the bodies of a system
from eomgen.mechanics.instant.motion_kind import Kinds as Kinds

# Values of the output functions in one system: the scene in which the functions are written
from eomgen.mechanics.instant.quantities import Quantities as Quantities

# A system at one configuration
from eomgen.mechanics.instant.velocity_analysis import InstantKinematics as InstantKinematics
