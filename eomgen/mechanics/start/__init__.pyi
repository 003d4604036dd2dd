"""Door of the folder: what other folders may import from `eomgen.mechanics.start`."""

# The ways to close the loops of a model at its start
from eomgen.mechanics.start.assembly_modes import Branches as Branches

# Start of a motion; each result is computed at its first use
from eomgen.mechanics.start.exact import ExactStart as ExactStart

# Values of scalars at the model's parameters
from eomgen.mechanics.start.exact import ScalarValues as ScalarValues
from eomgen.mechanics.start.exact import Seeds as Seeds

# The scalars as numbers, None where something in one has no value; nan where it has none itself
from eomgen.mechanics.start.exact import shown_numbers as shown_numbers

# Derivatives of coordinates and speeds at the start with respect to parameters, or to the start of one of them
from eomgen.mechanics.start.exact import start_seeds as start_seeds

# Values of t, q, u, a at rest at the start: exact scalars of the parameters
from eomgen.mechanics.start.exact import values_where_at_rest as values_where_at_rest

# Start of a motion in numbers, and the changes that the constraints made necessary
from eomgen.mechanics.start.state import Start as Start
