"""Door of the folder: what other folders may import from `eomgen.mechanics.equilibrium`."""

# The balance of a system at rest
from eomgen.mechanics.equilibrium.equations import StaticEquations as StaticEquations

# Every equilibrium that is found
from eomgen.mechanics.equilibrium.places import places_of_rest as places_of_rest

# Reactions at an equilibrium: their law, each of them, and why they do not follow
from eomgen.mechanics.equilibrium.reactions import RestingReactions as RestingReactions

# The unknowns of the loads for which the system is at rest where it starts
from eomgen.mechanics.equilibrium.reactions import holding_of as holding_of

# The equilibria of a system
from eomgen.mechanics.equilibrium.search import Equilibria as Equilibria

# One equilibrium
from eomgen.mechanics.equilibrium.search import Equilibrium as Equilibrium
