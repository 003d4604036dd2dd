"""Door of the folder: what other folders may import from `eomgen.mechanics.free_bodies`."""

# All equations of all bodies
from eomgen.mechanics.free_bodies.balance import Balance as Balance

# One scalar equation of one body: sum of coefficients * reactions + applied = inertia
from eomgen.mechanics.free_bodies.balance import BodyEquation as BodyEquation

# A force, or a couple, on a body
from eomgen.mechanics.free_bodies.cut import CutForce as CutForce

# Kinds of what acts on a body that is cut free
from eomgen.mechanics.free_bodies.cut import ForceKind as ForceKind

# Description of what is out of balance at a state; "" where nothing is. Reactions left open take random values
from eomgen.mechanics.free_bodies.equilibrium import imbalance as imbalance

# The components, by their number, that one side of their joint or constraint gives; none where there is friction
from eomgen.mechanics.free_bodies.equilibrium import reactions_by_sides as reactions_by_sides

# A contact with friction
from eomgen.mechanics.free_bodies.friction import FrictionContact as FrictionContact

# Friction of a system that depends on its own reactions
from eomgen.mechanics.free_bodies.friction import SystemFriction as SystemFriction

# The equations of motion of a system in their shortest form, friction in Q and forcing
from eomgen.mechanics.free_bodies.friction import equations_of_motion as equations_of_motion

# Extent of a property of scalars, by their form in each piece and a state there; None where no pieces are known
from eomgen.mechanics.free_bodies.friction import where_in_pieces as where_in_pieces

# The equations of motion, friction in Q and forcing, and the accelerations explicit; the same without friction
from eomgen.mechanics.free_bodies.friction import with_friction as with_friction

# Forces along what is driven, and multipliers of constraints, of given motions
from eomgen.mechanics.free_bodies.inverse import DrivingForces as DrivingForces

# Inverse dynamics: tau as functions of t, q, u, a, parameters, and of inputs that are no actuators
from eomgen.mechanics.free_bodies.inverse import Inverse as Inverse

# a and lam, where the constraints leave few degrees of freedom; redundant rows are left out, their lam 0
from eomgen.mechanics.free_bodies.inverse import by_independent as by_independent

# sum of combination * components + given
from eomgen.mechanics.free_bodies.names_of_reactions import NamedReaction as NamedReaction

# All reactions of a system
from eomgen.mechanics.free_bodies.reactions import Reactions as Reactions

# A reaction that the equations of the rigid bodies do not determine
from eomgen.mechanics.free_bodies.solution import Indeterminate as Indeterminate

# Values at the first generic state at which all entries have one
from eomgen.mechanics.free_bodies.solution import values_at_a_state as values_at_a_state

# Bodies and the reactions on them, at one configuration
from eomgen.mechanics.free_bodies.structure import Structure as Structure

# A field of velocities of rigid bodies, a velocity plan
from eomgen.mechanics.free_bodies.velocity_plan import VelocityPlan as VelocityPlan

# The axes of each body's equations: the ground's in the plane, the body's own in space
from eomgen.mechanics.free_bodies.wrenches import Axes as Axes

# One scalar reaction
from eomgen.mechanics.free_bodies.wrenches import Component as Component

# Force and couple of a unit of a reaction on one body, at a place, in the axes of the body's equations
from eomgen.mechanics.free_bodies.wrenches import Effect as Effect
