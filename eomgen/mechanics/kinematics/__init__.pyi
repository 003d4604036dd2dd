"""Door of the folder: what other folders may import from `eomgen.mechanics.kinematics`."""

# The parts of one body's kinetic energy
from eomgen.mechanics.kinematics.inertia import BodyEnergy as BodyEnergy

# Kinetic energies of a motion, and the inertia in it that belongs to no body
from eomgen.mechanics.kinematics.inertia import Inertia as Inertia

# One named force of the model
from eomgen.mechanics.kinematics.loads import Applied as Applied

# A scalar force on a joint's variable: drive, spring and damper of the joint
from eomgen.mechanics.kinematics.loads import JointEffort as JointEffort

# All that is applied to the system
from eomgen.mechanics.kinematics.loads import Loads as Loads

# Every applied force of the model, as loads and potentials
from eomgen.mechanics.kinematics.loads import loads_of as loads_of
from eomgen.mechanics.kinematics.motion import GROUND as GROUND

# One body in the tree
from eomgen.mechanics.kinematics.motion import BodyLink as BodyLink

# Gimbal lock of the three angles of a body: the determinant of their axes is zero there
from eomgen.mechanics.kinematics.motion import Lock as Lock

# Poses and twists of all bodies, parents before children
from eomgen.mechanics.kinematics.motion import Motion as Motion

# The motion of one rigid body at a state, ground axes
from eomgen.mechanics.kinematics.motion import VelocityField as VelocityField

# Poses and twists of every body of the model
from eomgen.mechanics.kinematics.motion import motion_of as motion_of

# Angular velocity in body axes from a rotation and its time derivative: w~ = R^T R'
from eomgen.mechanics.kinematics.motion import spin_between as spin_between

# A state in numbers, by which exact values are recognised, never made
from eomgen.mechanics.kinematics.places import Located as Located

# The unknowns that the equations determine in closed form, functions of the parameters alone
from eomgen.mechanics.kinematics.places import places_of as places_of
from eomgen.mechanics.kinematics.scene import CLOSED as CLOSED

# State of one contact
from eomgen.mechanics.kinematics.scene import ContactMode as ContactMode
from eomgen.mechanics.kinematics.scene import ContactModes as ContactModes

# Quantities of a system in motion from which force laws and constraints are built
from eomgen.mechanics.kinematics.scene import SystemScene as SystemScene

# The friction of a unit of N along the tangent; None without friction, or while it sticks
from eomgen.mechanics.kinematics.scene import friction_factor as friction_factor

# The rows that a constraint has in a mode: none while it is open, one more while it sticks (on a surface two)
from eomgen.mechanics.kinematics.scene import rows_in_mode as rows_in_mode

# The symbols of a model and its kinematic equations
from eomgen.mechanics.kinematics.symbols import Scope as Scope

# The integral of f from 0 to t in closed form; zero: as of `primitive`
from eomgen.mechanics.kinematics.symbols import integral_from_zero as integral_from_zero

# A function of x whose derivative is f, or None where no closed form was found
from eomgen.mechanics.kinematics.symbols import primitive as primitive

# `primitive`, of functions with bends too, continuous over these; None where no closed form was found
from eomgen.mechanics.kinematics.symbols import primitive_over_bends as primitive_over_bends

# The symbols of a model, its kinematic equations, and the meaning of its names
from eomgen.mechanics.kinematics.symbols import scope_of as scope_of

# x as one quotient without common factors, where that takes fewer operations and x is not long
from eomgen.mechanics.kinematics.symbols import shorter as shorter

# A velocity multiplied out, where that halves its operations: cos^2 + sin^2 of a spin that no contact sees
from eomgen.mechanics.kinematics.symbols import shorter_row as shorter_row

# The scope in which declared speeds, and their derivatives, stand for what they are in its own speeds
from eomgen.mechanics.kinematics.symbols import with_speeds_named as with_speeds_named

# One body as the recursions see it, in its working axes, at its origin: the joint point
from eomgen.mechanics.kinematics.tree import Branch as Branch

# Forces and couples at bodies, as wrenches on branches in working axes about the joint point
from eomgen.mechanics.kinematics.tree import applied_wrenches as applied_wrenches

# Generalized forces that the motion takes: M a + c - Q of the wrenches, the ground accelerating up for weight
from eomgen.mechanics.kinematics.tree import bias_forces as bias_forces

# The tree of bodies for the recursions, parents first
from eomgen.mechanics.kinematics.tree import branches_of as branches_of

# M by composite bodies: the wrench that a unit acceleration of a joint takes, felt down the tree
from eomgen.mechanics.kinematics.tree import composite_mass_matrix as composite_mass_matrix

# Force m acc + U h and moment h x acc + vee(U J - J U^T) that the motion of a body takes
from eomgen.mechanics.kinematics.tree import inertia_wrench as inertia_wrench

# U = wd~ + w~ w~: points at r accelerate by U r against the origin
from eomgen.mechanics.kinematics.tree import rate_matrix as rate_matrix
