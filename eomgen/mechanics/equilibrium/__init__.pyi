"""Door of the folder: what other folders may import from `eomgen.mechanics.equilibrium`."""

# The balance of a system at rest
from eomgen.mechanics.equilibrium.equations import StaticEquations as StaticEquations

# The system over its rates, where a declared speed is not 0 at rest; else as it is
from eomgen.mechanics.equilibrium.equations import over_rates as over_rates

# The system of `over_rates`, with everything that moves with t held where it is at t = 0
from eomgen.mechanics.equilibrium.equations import standing_system as standing_system

# Every equilibrium that is found
from eomgen.mechanics.equilibrium.places import places_of_rest as places_of_rest
from eomgen.mechanics.equilibrium.reactions import ReactionsOrWhy as ReactionsOrWhy

# One reaction at an equilibrium
from eomgen.mechanics.equilibrium.reactions import RestingReaction as RestingReaction

# The unknowns of the loads for which the system is at rest where it starts
from eomgen.mechanics.equilibrium.reactions import holding_of as holding_of

# (reactions, each of them, why there are none)
from eomgen.mechanics.equilibrium.reactions import reactions_or_why as reactions_or_why

# Curve of equilibria
from eomgen.mechanics.equilibrium.search import Curve as Curve

# The equilibria of a system
from eomgen.mechanics.equilibrium.search import Equilibria as Equilibria

# One equilibrium
from eomgen.mechanics.equilibrium.search import Equilibrium as Equilibrium

# Verdict on the stability of an equilibrium, with its reason
from eomgen.mechanics.equilibrium.stability import Stability as Stability
