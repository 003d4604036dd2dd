"""Door of the folder: what other folders may import from `eomgen.symbolic.solve`."""

# Square linear equations over the graph -> their solution by determinants
from eomgen.symbolic.solve import cramer as cramer

# M, F -> a with M a = F, written out: the factors of M and of J M^-1 J^T, their zeros left out
from eomgen.symbolic.solve import factorization as factorization

# Groups that need one another, each after the groups that it needs (Tarjan's strongly connected components)
from eomgen.symbolic.solve.cramer import components as components

# det of a small matrix, by its minors
from eomgen.symbolic.solve.cramer import determinant as determinant
from eomgen.symbolic.solve.factorization import PlaceLists as PlaceLists

# Places of the factors' entries that are not zero
from eomgen.symbolic.solve.factorization import Zeros as Zeros

# The accelerations a of M a = F, as expressions
from eomgen.symbolic.solve.factorization import factor_solution as factor_solution

# Places of the entries that are not zero in the factors of M, eliminated in row order, and in L^-1 J^T
from eomgen.symbolic.solve.factorization import zeros_of as zeros_of

# The same of M + J^T W J with any diagonal W
from eomgen.symbolic.solve.factorization import zeros_with_constraints as zeros_with_constraints

# sum over j of rows[i][j] x_j = right[i]
from eomgen.symbolic.solve.linear import LinearSystem as LinearSystem

# Rules for pivots: what may be divided by, and in which order
from eomgen.symbolic.solve.linear import Pivots as Pivots

# x of A x = b, as far as the rows determine it
from eomgen.symbolic.solve.linear import Solution as Solution
from eomgen.symbolic.solve.linear import ValuesAt as ValuesAt

# x as far as the rows determine it, by elimination; common factors are divided out first where any are named
from eomgen.symbolic.solve.linear import general_solution as general_solution

# Solution by elimination: pivots are plain numbers if there are any; least fill-in comes first (Markowitz)
from eomgen.symbolic.solve.linear import sparse_solution as sparse_solution

# x of as many rows as unknowns: by minors where the unknowns are few, else by elimination
from eomgen.symbolic.solve.linear import unique_solution as unique_solution

# f = sum of part * atom^n, as {n: part}
from eomgen.symbolic.solve.solving import coefficients as coefficients

# True if equation(x + period) is the same function as equation(x)
from eomgen.symbolic.solve.solving import has_period as has_period

# The symbols that stand elsewhere than in the argument of a sine or cosine, times a whole number
from eomgen.symbolic.solve.solving import outside_of_turns as outside_of_turns

# The real x with equation(x) = 0 that have a closed form; of an equation in angles those of one turn
from eomgen.symbolic.solve.solving import roots as roots

# True if x is 0 at all values of its symbols; False where it has a value at no state that was tried
from eomgen.symbolic.solve.solving import vanishes as vanishes

# (f with symbols C, S for the cosine and sine of each angle and S^2 eliminated, {symbol: what it stands for})
from eomgen.symbolic.solve.solving import wave_free as wave_free
