"""Door of the folder: what other folders may import from `eomgen.mechanics.constraints`."""

# Positions and speeds that constraints put together from those given, and places where branches of motion meet
from eomgen.mechanics.constraints.assembly import Assembly as Assembly

# A position in which branches meet
from eomgen.mechanics.constraints.assembly import Fork as Fork

# |x|, where it is more than rounding: against its terms, and against what the symbols would have to move
from eomgen.mechanics.constraints.assembly import open_by as open_by
from eomgen.mechanics.constraints.closure import CLOSING as CLOSING

# States in which constraints hold, phi = 0 and J u + sigma = 0, with 50 digits
from eomgen.mechanics.constraints.closure import Closure as Closure

# The nearest state at which the scalars vanish, as `closed`
from eomgen.mechanics.constraints.closure import nearest_root as nearest_root

# Dependent coordinates that some rows determine together
from eomgen.mechanics.constraints.elimination import DependentBlock as DependentBlock

# Result of the elimination of dependent coordinates
from eomgen.mechanics.constraints.elimination import Elimination as Elimination

# Degrees of freedom of a model
from eomgen.mechanics.constraints.rank import Freedom as Freedom

# Which constraint rows are independent: at a generic configuration in which the constraints hold
from eomgen.mechanics.constraints.rank import Rank as Rank

# All rows of all constraints, and the matrices of those that close
from eomgen.mechanics.constraints.rows import Constraints as Constraints

# One scalar row of a constraint
from eomgen.mechanics.constraints.rows import Row as Row

# True for each scalar that is zero at all values of its symbols; shared parts are evaluated once
from eomgen.mechanics.constraints.rows import hold_identically as hold_identically

# True if the scalar is zero at all values of its symbols (exactly, at random states)
from eomgen.mechanics.constraints.rows import holds_identically as holds_identically
