"""Door of the folder: what other folders may import from `eomgen.mechanics.dynamics`."""

from eomgen.mechanics.dynamics.accelerations import PullBack as PullBack

# a from M a = forcing + J^T lam, J a + gamma = 0 at a state, right to double precision whatever the condition
from eomgen.mechanics.dynamics.accelerations import accelerations_at as accelerations_at

# Accelerations with more digits than doubles have: the residual of each solution is solved for again
from eomgen.mechanics.dynamics.accelerations import exact_accelerations as exact_accelerations

# The equations of motion with rows that pull
from eomgen.mechanics.dynamics.accelerations import stabilized as stabilized

# The equations with explicit accelerations, where articulated bodies give them
from eomgen.mechanics.dynamics.accelerations import with_accelerations as with_accelerations

# (rows, right side) of the equations for a, and lam of the kept rows: {index of the unknown: coefficient}
from eomgen.mechanics.dynamics.explicit_accelerations import bordered_rows as bordered_rows

# a and lam of the bordered equations at once; redundant rows are left out, their lam 0
from eomgen.mechanics.dynamics.explicit_accelerations import by_determinants as by_determinants

# (a, lam of the kept rows) of the equations, and then what each push, a force along the speeds, adds to them
from eomgen.mechanics.dynamics.explicit_accelerations import by_factors as by_factors

# a and lam by determinants of entries at their simplest, where constraints hold fixed ratios of rates; else None
from eomgen.mechanics.dynamics.explicit_accelerations import by_short_rows as by_short_rows

# The constraint rows that do not follow from others
from eomgen.mechanics.dynamics.explicit_accelerations import regular_rows as regular_rows

# a as functions of q, u, t and inputs; None where they are many, or the equations are singular
from eomgen.mechanics.dynamics.explicit_accelerations import short_accelerations as short_accelerations
from eomgen.mechanics.dynamics.formulations import ALL as ALL
from eomgen.mechanics.dynamics.formulations import LAGRANGE as LAGRANGE
from eomgen.mechanics.dynamics.formulations import METHODS as METHODS

# The equations of motion by recursion over the tree; constraint rows by multipliers
from eomgen.mechanics.dynamics.formulations import assembled_by_recursion as assembled_by_recursion

# The equations by the way of a method, friction left out
from eomgen.mechanics.dynamics.formulations import derived_by as derived_by

# The speeds of the free system by those that are left: N u + nu without the driven coordinates
from eomgen.mechanics.dynamics.formulations import free_rates as free_rates

# (M, c) by derivatives of the kinetic energy
from eomgen.mechanics.dynamics.formulations import inertia_by_energies as inertia_by_energies

# M a + c - Q by recursive Newton-Euler, weight as an upward acceleration of the ground
from eomgen.mechanics.dynamics.formulations import inverse_residual as inverse_residual

# M by composite bodies, armatures included
from eomgen.mechanics.dynamics.formulations import mass as mass

# Sentences that state the assumption of such a model
from eomgen.mechanics.dynamics.formulations import reported_of_nodes as reported_of_nodes

# The model with the balance of every massless node as a constraint, from which its coordinate follows
from eomgen.mechanics.dynamics.formulations import with_nodes_balanced as with_nodes_balanced
from eomgen.mechanics.dynamics.pieces import EVERYWHERE as EVERYWHERE
from eomgen.mechanics.dynamics.pieces import NOWHERE as NOWHERE
from eomgen.mechanics.dynamics.pieces import SMOOTH as SMOOTH

# Extent of a property: everywhere, under conditions, or nowhere
from eomgen.mechanics.dynamics.pieces import Extent as Extent

# The pieces of the scalars; None where they have none
from eomgen.mechanics.dynamics.pieces import division_of as division_of

# Refuse a state at which a force jumps with the sign of a rate
from eomgen.mechanics.dynamics.pieces import refuse_jump as refuse_jump

# Arguments of sign(...) in the forces that depend on speeds
from eomgen.mechanics.dynamics.pieces import signs_of_rates as signs_of_rates

# The equations of motion: q' = N u + nu, M a + c = Q + J^T lam, J a + gamma = 0
from eomgen.mechanics.dynamics.system import EquationsOfMotion as EquationsOfMotion

# Motion, loads and constraints from which every formulation assembles the equations; none of them uses another
from eomgen.mechanics.dynamics.system import System as System

# Motion, loads and constraints of a model in which dependent coordinates are as free as others
from eomgen.mechanics.dynamics.system import free_system_of as free_system_of

# The system over its independent speeds: N = [1; A], nu = [0; b] of dependent coordinates, then as declared
from eomgen.mechanics.dynamics.system import reduced_system as reduced_system

# Motion, loads and constraints of a model, dependent coordinates eliminated
from eomgen.mechanics.dynamics.system import system_of as system_of

# Part of a model that has no value in a state
from eomgen.mechanics.dynamics.wellposed import Valueless as Valueless

# True if T + V is conserved: nothing moves as prescribed, and Q is -N^T dV/dq alone, in every piece
from eomgen.mechanics.dynamics.wellposed import is_conservative as is_conservative

# The motions that move no mass; () where every acceleration is determined
from eomgen.mechanics.dynamics.wellposed import massless_motions as massless_motions

# The largest part of a system in a state, where that is too large to be calculated with; None where none is
from eomgen.mechanics.dynamics.wellposed import overlarge as overlarge

# Reason why scalars have no finite value, and where; "" where they have one, or need an unknown of the state
from eomgen.mechanics.dynamics.wellposed import reason_without_value as reason_without_value

# Refuses free coordinates that move no mass, alone or together: they have no acceleration
from eomgen.mechanics.dynamics.wellposed import refuse_massless as refuse_massless

# The first part of a system that has no finite value in a state; None where each has one
from eomgen.mechanics.dynamics.wellposed import valueless as valueless

# Extent, in pieces of min, max, abs, sign, cases and samples, in which T + V is conserved
from eomgen.mechanics.dynamics.wellposed import where_conservative as where_conservative

# Reason in words why T + V is not conserved everywhere; "" where it is
from eomgen.mechanics.dynamics.wellposed import why_not_conservative as why_not_conservative
