"""Door of the folder: what other folders may import from `eomgen.mechanics.integrals`."""

# A momentum of the whole system that stays constant, or the square of one
from eomgen.mechanics.integrals.first_integrals import Constant as Constant

# Quantities that stay constant along every motion of a system
from eomgen.mechanics.integrals.first_integrals import FirstIntegrals as FirstIntegrals

# A function of the motion that stays constant
from eomgen.mechanics.integrals.first_integrals import Integral as Integral

# State at which a condition is satisfied, in closed form
from eomgen.mechanics.integrals.laws import ClosedInstant as ClosedInstant

# q(t) and u(t) of every coordinate and speed that has a law in closed form
from eomgen.mechanics.integrals.laws import laws_of_motion as laws_of_motion

# Expressions of positions that vanish: gaps of the constraints, and rates integrated from the start
from eomgen.mechanics.integrals.laws import position_equations as position_equations

# Every speed by one of them: u_j = share_j u_s + constant_j
from eomgen.mechanics.integrals.speeds import Relations as Relations

# (the same, in which pieces the integrals hold that give it)
from eomgen.mechanics.integrals.speeds import rates_and_extent as rates_and_extent
