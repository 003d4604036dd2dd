"""Door of the folder: what other folders may import from `eomgen.mechanics.free_bodies`."""

# All equations of all bodies
# All equations of all bodies
from eomgen.mechanics.free_bodies.balance import DIRECTIONS as DIRECTIONS
from eomgen.mechanics.free_bodies.balance import Balance as Balance

# One scalar equation of one body: sum of coefficients * reactions + applied = inertia
from eomgen.mechanics.free_bodies.balance import BodyEquation as BodyEquation

# The equations of every body; those that say 0 = 0 are left out
from eomgen.mechanics.free_bodies.balance import balance_of as balance_of

# The labels of rows that say 0 = Q_k of coordinates that move no mass: nothing else acts along these, lam = 0
from eomgen.mechanics.free_bodies.balance import balances_of_nodes as balances_of_nodes

# True if the residuals that no unknown or reaction can change vanish wherever the constraints are satisfied
from eomgen.mechanics.free_bodies.balance import is_balanced as is_balanced

# Refuses friction at rest: it may have any value up to its limit, so that the balance determines no force
from eomgen.mechanics.free_bodies.balance import refuse_friction as refuse_friction

# Refuse loads that act at no place, or on a point that a coordinate moves in its body: a balance would lack them
from eomgen.mechanics.free_bodies.balance import refuse_placeless as refuse_placeless

# d(applied)/dP
from eomgen.mechanics.free_bodies.balance import slope as slope

# Rates and accelerations at rest
from eomgen.mechanics.free_bodies.balance import still as still

# Error: no equilibrium, as there are more degrees of freedom than the unknowns can hold
from eomgen.mechanics.free_bodies.balance import unbalanced as unbalanced

# A contact with friction
from eomgen.mechanics.free_bodies.friction import FrictionContact as FrictionContact

# The equations of motion of a system in their shortest form, friction in Q and forcing
from eomgen.mechanics.free_bodies.friction import equations_of_motion as equations_of_motion

# Every contact with friction, in the order of the components
from eomgen.mechanics.free_bodies.friction import friction_contacts as friction_contacts

# (contact, the friction of a unit of N, the sliding velocity) of every contact with friction
from eomgen.mechanics.free_bodies.friction import frictions as frictions

# True if any contact has friction
from eomgen.mechanics.free_bodies.friction import has_friction as has_friction

# |N| of every bilateral contact with friction, as a function of q, u and t; {} where there is none
from eomgen.mechanics.free_bodies.friction import push_sizes as push_sizes

# A symbol for |N| of every bilateral contact with friction, by its name
from eomgen.mechanics.free_bodies.friction import round_symbols as round_symbols

# The equations of motion, friction in Q and forcing, and the accelerations explicit; the same without friction
from eomgen.mechanics.free_bodies.friction import with_friction as with_friction

# Scalars in which Coulomb's friction on surfaces, v/|v|, is 0 where v is: as sign(v) of friction along a line
from eomgen.mechanics.free_bodies.friction import with_rest as with_rest

# sum of combination * components + given
from eomgen.mechanics.free_bodies.names_of_reactions import NamedReaction as NamedReaction

# An argument of a call as it was written
from eomgen.mechanics.free_bodies.names_of_reactions import argument_name as argument_name

# Name in a table that a call means: the ends of a member may be in either order
from eomgen.mechanics.free_bodies.names_of_reactions import name_of as name_of

# Every reaction by its name, in the order of the components
from eomgen.mechanics.free_bodies.names_of_reactions import named_reactions as named_reactions

# Unit of a component: FORCE, or COUPLE if it has no force on any body
from eomgen.mechanics.free_bodies.names_of_reactions import unit_of as unit_of

# The model and the modes of the phase after the constraint has ended; the coordinates keep their names
from eomgen.mechanics.free_bodies.release import released as released

# True if each displacement that releases the constraint is along its own push, whatever else is released
from eomgen.mechanics.free_bodies.release import stays_straight as stays_straight

# the largest rank of what vanishes at no state: numbers, products of parameters that are not 0
from eomgen.mechanics.free_bodies.solution import SURE as SURE
from eomgen.mechanics.free_bodies.solution import Combination as Combination

# A reaction that the equations of the rigid bodies do not determine
from eomgen.mechanics.free_bodies.solution import Indeterminate as Indeterminate

# sum of k_j x_j
from eomgen.mechanics.free_bodies.solution import combined_reaction as combined_reaction

# The reactions, and unknowns of the loads, that balance all bodies
from eomgen.mechanics.free_bodies.solution import solution_of_balance as solution_of_balance

# Values at the first generic state at which all entries have one
from eomgen.mechanics.free_bodies.solution import values_at_a_state as values_at_a_state
from eomgen.mechanics.free_bodies.wrenches import EACH_AXIS as EACH_AXIS
from eomgen.mechanics.free_bodies.wrenches import PLANE_ROWS as PLANE_ROWS
from eomgen.mechanics.free_bodies.wrenches import SPACE_ROWS as SPACE_ROWS

# The axes of each body's equations: the ground's in the plane, the body's own in space
from eomgen.mechanics.free_bodies.wrenches import Axes as Axes

# One scalar reaction
from eomgen.mechanics.free_bodies.wrenches import Component as Component

# Force and couple of a unit of a reaction on one body, at a place, in the axes of the body's equations
from eomgen.mechanics.free_bodies.wrenches import Effect as Effect

# All components: those of the joints, of the drives of given motions, and of the constraints
from eomgen.mechanics.free_bodies.wrenches import components_of as components_of

# A load on its body; none on the ground
from eomgen.mechanics.free_bodies.wrenches import effects_of_load as effects_of_load

# Effects of drive, spring, damper and rotor of a body's joint, on the body first; () for a constraint
from eomgen.mechanics.free_bodies.wrenches import efforts_of as efforts_of

# Effects of drives, springs, dampers and rotors of all joints, on both bodies of each
from eomgen.mechanics.free_bodies.wrenches import joint_effects as joint_effects
