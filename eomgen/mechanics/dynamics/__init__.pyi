"""Door of the folder: what other folders may import from `eomgen.mechanics.dynamics`."""

# Accelerations with more digits than doubles have: the residual of each solution is solved for again
from eomgen.mechanics.dynamics.accelerations import exact_accelerations as exact_accelerations

# The equations with explicit accelerations, where articulated bodies give them
from eomgen.mechanics.dynamics.accelerations import with_accelerations as with_accelerations

# One part of energies and equations
from eomgen.mechanics.dynamics.contributions import Contribution as Contribution

# All contributions of a system
from eomgen.mechanics.dynamics.contributions import Contributions as Contributions

# Accelerations and multipliers of equations of motion as explicit functions
from eomgen.mechanics.dynamics.explicit_accelerations import Explicit as Explicit
from eomgen.mechanics.dynamics.formulations import METHODS as METHODS

# The equations of motion by recursion over the tree; constraint rows by multipliers
from eomgen.mechanics.dynamics.formulations import assembled_by_recursion as assembled_by_recursion

# The equations by the way of a method, friction left out
from eomgen.mechanics.dynamics.formulations import derived_by as derived_by

# (M, c) by derivatives of the kinetic energy
from eomgen.mechanics.dynamics.formulations import inertia_by_energies as inertia_by_energies

# M a + c - Q by recursive Newton-Euler, weight as an upward acceleration of the ground
from eomgen.mechanics.dynamics.formulations import inverse_residual as inverse_residual

# M by composite bodies, armatures included
from eomgen.mechanics.dynamics.formulations import mass as mass

# The model with the balance of every massless node as a constraint, from which its coordinate follows
from eomgen.mechanics.dynamics.formulations import with_nodes_balanced as with_nodes_balanced

# Extent of a property: everywhere, under conditions, or nowhere
from eomgen.mechanics.dynamics.pieces import Extent as Extent

# Forces of a system that jump with the sign of a rate
from eomgen.mechanics.dynamics.pieces import ForceJumps as ForceJumps

# The pieces of the scalars; None where they have none
from eomgen.mechanics.dynamics.pieces import division_of as division_of

# The equations of motion: q' = N u + nu, M a + c = Q + J^T lam, J a + gamma = 0
from eomgen.mechanics.dynamics.system import EquationsOfMotion as EquationsOfMotion

# Motion, loads and constraints from which every formulation assembles the equations; none of them uses another
from eomgen.mechanics.dynamics.system import System as System

# Part of a model that has no value in a state
from eomgen.mechanics.dynamics.wellposed import Valueless as Valueless

# Properties of equations of motion known before anything moves: conservation of energy, motions without mass
from eomgen.mechanics.dynamics.wellposed import WellPosed as WellPosed
