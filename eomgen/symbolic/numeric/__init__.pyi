"""Door of the folder: what other folders may import from `eomgen.symbolic.numeric`."""

# Linear systems of numbers -> solutions, where rows and columns have units of their own
from eomgen.symbolic.numeric import dense as dense

# Every tolerance of the package: its value, what it is a share of, and why it is that large
from eomgen.symbolic.numeric import tolerances as tolerances

# True if the row is a combination of the others, modulo the prime
from eomgen.symbolic.numeric.arithmetic import follows as follows

# Values at a state of numbers of 50 digits, in balls
from eomgen.symbolic.numeric.arithmetic import in_balls as in_balls

# The number of an exact form to double precision; nan where it has none
from eomgen.symbolic.numeric.arithmetic import number_of as number_of

# The numbers of several exact forms, as of `number_of`
from eomgen.symbolic.numeric.arithmetic import numbers_of as numbers_of

# (D A E, D, E) with the largest entry of every row and column of D A E near 1
from eomgen.symbolic.numeric.dense import balanced as balanced

# The entries of rows of 50 digits at a place that Newton's method closed; those that are only left of 0 are 0
from eomgen.symbolic.numeric.dense import closed_entries as closed_entries

# True if a row of numbers of 50 digits is a combination of others (`arithmetic.follows` in the reals)
from eomgen.symbolic.numeric.dense import follows_in_digits as follows_in_digits

# The rows that do not follow from those before them: what these leave of a row is more than `smallest` of it
from eomgen.symbolic.numeric.dense import independent_rows as independent_rows

# Euclidean lengths of the columns (axis 0), of the rows (axis 1) or of all together, at any size
from eomgen.symbolic.numeric.dense import lengths_of as lengths_of

# The rows brought to length 1; those that are rounding are 0
from eomgen.symbolic.numeric.dense import of_one_length as of_one_length

# Number of singular values of the scaled A above `smallest`
from eomgen.symbolic.numeric.dense import rank as rank

# Number of independent rows {column: number of 50 digits}
from eomgen.symbolic.numeric.dense import sparse_rank as sparse_rank

# The matrix; entries below that share of the largest, or with axis 1 of the largest in their row, are 0
from eomgen.symbolic.numeric.dense import without_noise as without_noise

# (w, V) of A V = V diag(w), or of A V = M V diag(w) where both are symmetric; found with 50 digits
from eomgen.symbolic.numeric.digits import eigenpairs_in_digits as eigenpairs_in_digits

# x of as many rows [A | b] as unknowns, with 50 digits; None where they are few, or A is nearly singular
from eomgen.symbolic.numeric.digits import solved_quickly as solved_quickly

# (row column, |row| |column|) with 50 digits, for each row, in a list for each column
from eomgen.symbolic.numeric.digits import sums_of_products as sums_of_products
from eomgen.symbolic.numeric.evaluation import ARRAYS as ARRAYS
from eomgen.symbolic.numeric.evaluation import FLOAT as FLOAT

# 61 bits, 7 mod 8; 2, 3, 5, ..., 37 are squares modulo it
from eomgen.symbolic.numeric.evaluation import PRIME as PRIME
from eomgen.symbolic.numeric.evaluation import PRIME_FIELD as PRIME_FIELD

# Numbers of one kind
from eomgen.symbolic.numeric.evaluation import Arithmetic as Arithmetic

# Expressions whose values are sought at many states
from eomgen.symbolic.numeric.evaluation import Layers as Layers

# A function or constant has no meaning in this arithmetic at any state: take another arithmetic
from eomgen.symbolic.numeric.evaluation import NoMeaning as NoMeaning

# This state has no value in this arithmetic (a root that is not there, a zero divisor): take another state
from eomgen.symbolic.numeric.evaluation import NoValue as NoValue

# The outputs' values
from eomgen.symbolic.numeric.evaluation import evaluate as evaluate

# Real numbers with 50 decimal digits; a function outside its real domain raises NoValue
from eomgen.symbolic.numeric.evaluation import fifty_digits as fifty_digits

# Numbers of many digits as floats
from eomgen.symbolic.numeric.evaluation import floats_of as floats_of

# The scalars with each symbol replaced by what its name means in another graph
from eomgen.symbolic.numeric.evaluation import transplanted as transplanted
from eomgen.symbolic.numeric.pieces import Choices as Choices

# Nodes whose form changes with something that moves, in the order of evaluation
from eomgen.symbolic.numeric.pieces import PiecewiseNodes as PiecewiseNodes

# A quantity, and the values of it at which something changes its form
from eomgen.symbolic.numeric.pieces import Switch as Switch

# True if a formula consists of several pieces
from eomgen.symbolic.numeric.pieces import has_pieces as has_pieces

# Every switch in the scalars that something that moves can throw
from eomgen.symbolic.numeric.pieces import switches_of as switches_of
from eomgen.symbolic.numeric.roots import JUMPS as JUMPS

# Equations in some unknowns
from eomgen.symbolic.numeric.roots import Descent as Descent

# Settings of the search for a root
from eomgen.symbolic.numeric.roots import Newton as Newton

# The roots to which the starts lead, each once, the nearest first
from eomgen.symbolic.numeric.roots import all_roots as all_roots

# The roots of as many equations as unknowns in the box from `low` to `high`; None where they have jumps
from eomgen.symbolic.numeric.roots import isolated as isolated

# The place nearby where |f|^2 is least, in floats: a root, or how near the equations come to one
from eomgen.symbolic.numeric.roots import least_left as least_left

# commands, numbers and letters of the formulas of one page that are read back
from eomgen.symbolic.numeric.work import READ_BACK as READ_BACK

# Products of terms that may be formed for one expression; one that needs more stays as it came
from eomgen.symbolic.numeric.work import Work as Work
