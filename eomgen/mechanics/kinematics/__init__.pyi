"""Door of the folder: what other folders may import from `eomgen.mechanics.kinematics`."""

# The parts of one body's kinetic energy
from eomgen.mechanics.kinematics.inertia import BodyEnergy as BodyEnergy

# Kinetic energies of a motion, and the inertia in it that belongs to no body
from eomgen.mechanics.kinematics.inertia import SystemInertia as SystemInertia

# One named force of the model
from eomgen.mechanics.kinematics.loads import Applied as Applied

# A scalar force on a joint's variable: drive, spring and damper of the joint
from eomgen.mechanics.kinematics.loads import JointEffort as JointEffort

# All that is applied to the system
from eomgen.mechanics.kinematics.loads import Loads as Loads
from eomgen.mechanics.kinematics.motion import GROUND as GROUND

# One body in the tree
from eomgen.mechanics.kinematics.motion import BodyLink as BodyLink

# Gimbal lock of the three angles of a body: the determinant of their axes is zero there
from eomgen.mechanics.kinematics.motion import Lock as Lock

# Poses and twists of all bodies, parents before children
from eomgen.mechanics.kinematics.motion import Motion as Motion

# The motion of one rigid body at a state, ground axes
from eomgen.mechanics.kinematics.motion import VelocityField as VelocityField

# A state in numbers, by which exact values are recognised, never made
from eomgen.mechanics.kinematics.places import Located as Located

# The inertia of a sum of rows about a point
from eomgen.mechanics.kinematics.principal_axes import InertiaAbout as InertiaAbout

# The principal moments and axes of a tensor
from eomgen.mechanics.kinematics.principal_axes import Principal as Principal

# State of one contact
from eomgen.mechanics.kinematics.scene import ContactMode as ContactMode
from eomgen.mechanics.kinematics.scene import ContactModes as ContactModes

# Quantities of a system in motion from which force laws and constraints are built
from eomgen.mechanics.kinematics.scene import SystemScene as SystemScene

# The symbols of a model and its kinematic equations
from eomgen.mechanics.kinematics.symbols import Scope as Scope

# The integral of f from 0 to t in closed form; zero: as of `primitive`
from eomgen.mechanics.kinematics.symbols import integral_from_zero as integral_from_zero

# A function of x whose derivative is f, or None where no closed form was found
from eomgen.mechanics.kinematics.symbols import primitive as primitive

# x as one quotient without common factors, where that takes fewer operations and x is not long
from eomgen.mechanics.kinematics.symbols import shorter as shorter
