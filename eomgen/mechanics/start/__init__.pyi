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

# Start of a motion in numbers, and the changes that the constraints made necessary
from eomgen.mechanics.start.state import Start as Start
