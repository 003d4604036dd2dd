"""Door of the folder: what other folders may import from `eomgen.mechanics.reactions`."""

# Description of what is out of balance at a state; "" where nothing is. Reactions left open take random values
from eomgen.mechanics.reactions.equilibrium import imbalance as imbalance

# The components, by their number, that one side of their joint or constraint gives; none where there is friction
from eomgen.mechanics.reactions.equilibrium import reactions_by_sides as reactions_by_sides

# degrees of freedom
from eomgen.mechanics.reactions.inverse import FEW as FEW

# Inverse dynamics: tau as functions of t, q, u, a, parameters, and of inputs that are no actuators
from eomgen.mechanics.reactions.inverse import Inverse as Inverse

# a and lam, where the constraints leave few degrees of freedom; redundant rows are left out, their lam 0
from eomgen.mechanics.reactions.inverse import by_independent as by_independent

# The force (of an angle: torque) along a driven coordinate that keeps it moving as given, linear in a and lam
from eomgen.mechanics.reactions.inverse import drive as drive

# tau that moves the system with accelerations a; where constraints close, J a + gamma = 0 must hold of them
from eomgen.mechanics.reactions.inverse import inverse_of as inverse_of

# M a + c - Q by recursive Newton-Euler, weight as an upward acceleration of the ground
from eomgen.mechanics.reactions.inverse import inverse_residual as inverse_residual

# lam of a constraint of one row in the equations of motion; a symbol where it closes
from eomgen.mechanics.reactions.inverse import multiplier as multiplier

# The system with a driven coordinate free, which starts where it is driven from
from eomgen.mechanics.reactions.inverse import with_drive_let_go as with_drive_let_go

# All reactions of a system
from eomgen.mechanics.reactions.reactions import Reactions as Reactions

# Sums of indeterminate reactions that have a single value: sum of k_i r_i with sum of k_i s_i = 0
from eomgen.mechanics.reactions.reactions import determinate_sums as determinate_sums

# Every reaction, linear in the accelerations; or at one configuration, for which everything is solved anew
from eomgen.mechanics.reactions.reactions import reactions_of as reactions_of
