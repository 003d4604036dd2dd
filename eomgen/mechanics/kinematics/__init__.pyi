"""Door of the folder: what other folders may import from `eomgen.mechanics.kinematics`."""

# The parts of one body's kinetic energy
from eomgen.mechanics.kinematics.inertia import HALF as HALF

# The parts of one body's kinetic energy
from eomgen.mechanics.kinematics.inertia import BodyEnergy as BodyEnergy

# Terms added to c: armature D_k (d/dt s' at a = 0), and those of given energies at a = 0
from eomgen.mechanics.kinematics.inertia import armature_bias as armature_bias

# Energy of rotors behind gears: armature * s'^2 / 2 [J]
from eomgen.mechanics.kinematics.inertia import armature_energy as armature_energy

# Entries (k, l, value) that are added to M: armature D_k D_l, and those of given energies
from eomgen.mechanics.kinematics.inertia import armature_mass as armature_mass
from eomgen.mechanics.kinematics.inertia import armatures as armatures

# Kinetic energy of every body, T = m v.v / 2 + w.I w / 2, from derivatives of its pose
from eomgen.mechanics.kinematics.inertia import body_energies as body_energies

# T of the energies that are given, in the speeds [J]
from eomgen.mechanics.kinematics.inertia import given_energy as given_energy

# Share of given energies in M a + c, along each speed
from eomgen.mechanics.kinematics.inertia import given_inertia as given_inertia

# p = dT/dq' of the energies that are given, one for each coordinate
from eomgen.mechanics.kinematics.inertia import given_momenta as given_momenta

# Row of D: how the joint's rate depends on each speed
from eomgen.mechanics.kinematics.inertia import joint_row as joint_row

# T of the whole system [J]
from eomgen.mechanics.kinematics.inertia import kinetic_energy as kinetic_energy

# Mass properties of one body; a body without mass has zeros
from eomgen.mechanics.kinematics.inertia import mass_properties as mass_properties

# Angular velocity of one body in body axes, from the derivative of its pose [rad/s]
from eomgen.mechanics.kinematics.inertia import spin_of as spin_of

# One named force of the model
from eomgen.mechanics.kinematics.loads import Applied as Applied

# A scalar force on a joint's variable: drive, spring and damper of the joint
from eomgen.mechanics.kinematics.loads import JointEffort as JointEffort

# All that is applied to the system
from eomgen.mechanics.kinematics.loads import Loads as Loads

# A load as a wrench at its body's origin in body axes (None: it acts on the ground)
from eomgen.mechanics.kinematics.loads import body_wrench as body_wrench

# A vector given in the axes of the ground (None) or of a body, in the axes of `body`
from eomgen.mechanics.kinematics.loads import in_body_axes as in_body_axes

# A vector given in the axes of a body, in the ground's
from eomgen.mechanics.kinematics.loads import in_ground_axes as in_ground_axes

# The effort of a joint as wrenches at the origins of child and parent, each in its own axes
from eomgen.mechanics.kinematics.loads import joint_wrenches as joint_wrenches

# Every applied force of the model, as loads and potentials
from eomgen.mechanics.kinematics.loads import loads_of as loads_of

# The uniform fields as forces m g at the mass centres
from eomgen.mechanics.kinematics.loads import weights as weights
from eomgen.mechanics.kinematics.motion import GROUND as GROUND

# One body in the tree
from eomgen.mechanics.kinematics.motion import BodyLink as BodyLink

# Gimbal lock of the three angles of a body: the determinant of their axes is zero there
from eomgen.mechanics.kinematics.motion import Lock as Lock

# Poses and twists of all bodies, parents before children
from eomgen.mechanics.kinematics.motion import Motion as Motion

# The motion of one rigid body at a state, ground axes
from eomgen.mechanics.kinematics.motion import VelocityField as VelocityField

# Acceleration pole in the plane, the point without acceleration
from eomgen.mechanics.kinematics.motion import acceleration_pole as acceleration_pole

# Point of the screw axis nearest to the origin of the body, p_O + omega x v_O / omega.omega, in space
from eomgen.mechanics.kinematics.motion import axis_point as axis_point

# The field of a body of the model; of the ground it is zero
from eomgen.mechanics.kinematics.motion import field_of as field_of

# A place on the ground: coordinates, or the name of a ground point [m]
from eomgen.mechanics.kinematics.motion import ground_place as ground_place

# The centre of the circle through the centre of rotation on which the points are whose path is straight there
from eomgen.mechanics.kinematics.motion import inflection_center as inflection_center

# The least speed of the points between two points of the body
from eomgen.mechanics.kinematics.motion import least_speed as least_speed

# Gimbal locks of the bodies that turn by three angles, at least one of them free to change
from eomgen.mechanics.kinematics.motion import locks_of as locks_of

# The pieces of a body and the whole of them, each formula in readable form; made once for a scope
from eomgen.mechanics.kinematics.motion import made_of as made_of

# Poses and twists of every body of the model
from eomgen.mechanics.kinematics.motion import motion_of as motion_of

# Instantaneous centre of rotation in the plane, the body's point without velocity: p_O + omega x v_O / omega^2
from eomgen.mechanics.kinematics.motion import rotation_center as rotation_center

# Velocity of a place against its own body, ground axes: R r', 0 where it is fixed in the body [m/s]
from eomgen.mechanics.kinematics.motion import slide_of as slide_of

# Angular velocity in body axes from a rotation and its time derivative: w~ = R^T R'
from eomgen.mechanics.kinematics.motion import spin_between as spin_between

# Velocity of a place of a body in ground axes, from the twist: R (v + w x r + r') [m/s]
from eomgen.mechanics.kinematics.motion import velocity_of as velocity_of

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

# A driven coordinate without what drives it: one like others, which starts where it is driven from
from eomgen.mechanics.kinematics.scene import let_go as let_go

# The rows that a constraint has in a mode: none while it is open, one more while it sticks (on a surface two)
from eomgen.mechanics.kinematics.scene import rows_in_mode as rows_in_mode

# Start value of a coordinate, as an expression of the parameters
from eomgen.mechanics.kinematics.scene import start_value as start_value

# Start values of coordinates, as expressions of the parameters; of all of them for None
from eomgen.mechanics.kinematics.scene import start_values as start_values

# Start values with every quaternion over its norm
from eomgen.mechanics.kinematics.scene import with_unit_quaternions as with_unit_quaternions

# The symbols of a model and its kinematic equations
from eomgen.mechanics.kinematics.symbols import Scope as Scope

# Rates that declared speeds determine together; where the determinant vanishes they are not determined
from eomgen.mechanics.kinematics.symbols import Solved as Solved

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

# The scope over the declared speeds, and what must stay regular
from eomgen.mechanics.kinematics.symbols import with_declared_speeds as with_declared_speeds

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
