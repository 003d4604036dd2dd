"""Door of the folder: what other folders may import from `eomgen.symbolic.exact`."""

# Square linear equations over the graph -> their solution by determinants
from eomgen.symbolic.exact import cramer as cramer

# M, F -> a with M a = F, written out: the factors of M and of J M^-1 J^T, their zeros left out
from eomgen.symbolic.exact import factorization as factorization

# Expressions with a symbol for each square root of a sum
from eomgen.symbolic.exact.book_forms import Rooted as Rooted

# x as the author of a textbook prints it; x itself where that takes more than `limit` products of terms
from eomgen.symbolic.exact.book_forms import book_form as book_form

# Groups that need one another, each after the groups that it needs (Tarjan's strongly connected components)
from eomgen.symbolic.exact.cramer import components as components

# det of a small matrix, by its minors
from eomgen.symbolic.exact.cramer import determinant as determinant

# Result of a comparison of pairs of expressions
from eomgen.symbolic.exact.equality import Equality as Equality

# Combination of rows that a row is; undecided where too few states give values
from eomgen.symbolic.exact.equality import combined as combined

# True if a row of numbers of 50 digits is a combination of others
from eomgen.symbolic.exact.equality import combines as combines

# Decides if the two of each pair are the same function of the symbols
from eomgen.symbolic.exact.equality import equal_at_random_states as equal_at_random_states

# The same at real states with 50 digits
from eomgen.symbolic.exact.equality import equal_at_real_states as equal_at_real_states

# Equality of each group's pairs, decided in a prime field; None for a group that the field cannot decide
from eomgen.symbolic.exact.equality import equal_in_field as equal_in_field

# A random state for the outputs in an exact arithmetic
from eomgen.symbolic.exact.equality import exact_state as exact_state

# Values at a random real state
from eomgen.symbolic.exact.equality import real_values as real_values

# True if scalars change at a state 1e-30 away, as with 0/0 or 1/0: their values here are only rounding errors
from eomgen.symbolic.exact.equality import rounding_decides as rounding_decides

# Places of the factors' entries that are not zero
from eomgen.symbolic.exact.factorization import Zeros as Zeros

# The accelerations a of M a = F, as expressions
from eomgen.symbolic.exact.factorization import factor_solution as factor_solution

# sum over j of rows[i][j] x_j = right[i]
from eomgen.symbolic.exact.linear import LinearSystem as LinearSystem

# Rules for pivots: what may be divided by, and in which order
from eomgen.symbolic.exact.linear import Pivots as Pivots

# x of  A x = b,  as far as the rows determine it
from eomgen.symbolic.exact.linear import Solution as Solution
from eomgen.symbolic.exact.linear import ValuesAt as ValuesAt

# Scalars as a person writes them, each made so once
from eomgen.symbolic.exact.normal_forms import Legibly as Legibly

# x as one readable quotient without common factors; x itself where that takes too much work
from eomgen.symbolic.exact.normal_forms import cancelled as cancelled

# x = sum of coefficient * symbol + rest, as {symbol: coefficient, None: rest}, readable; zeros are left out
from eomgen.symbolic.exact.normal_forms import collected_in as collected_in

# (number, product): the rational number and the powers of parameters and coordinates that every term holds
from eomgen.symbolic.exact.normal_forms import common_factor as common_factor

# True if a and b are the same function
from eomgen.symbolic.exact.normal_forms import equal as equal

# x at its simplest; as it came where that is more than `long` characters, and longer than it came
from eomgen.symbolic.exact.normal_forms import legible as legible

# True if x is positive, or negative, wherever it has a value, for positive constants: M + m*sin(alpha)^2
from eomgen.symbolic.exact.normal_forms import never_vanishes as never_vanishes

# x multiplied out and written shortly: 27/2*M*R^2*cos(theta)^2*theta'^2, cos(theta1 - theta2)
from eomgen.symbolic.exact.normal_forms import readable as readable

# `readable` of several expressions that share their parts; those beyond the limit stay as they are
from eomgen.symbolic.exact.normal_forms import readable_all as readable_all

# 1 or -1 where all terms of x are positive or all negative, 0 where there are none; None where that is unknown
from eomgen.symbolic.exact.normal_forms import sign_of_terms as sign_of_terms

# The shortest of x multiplied out, x as one quotient without common factors, and that with its factors outside
from eomgen.symbolic.exact.normal_forms import simplest as simplest

# The terms of x multiplied out, each as it is written
from eomgen.symbolic.exact.normal_forms import written_terms as written_terms

# Conditions of stability: expressions that must be positive
from eomgen.symbolic.exact.one_variable import Conditions as Conditions

# c0 + c1 s + c2 s^2 + ...: coefficients in that order, of the parameters, or floats
from eomgen.symbolic.exact.one_variable import Polynomial as Polynomial

# True if equation(x + period) is the same function as equation(x)
from eomgen.symbolic.exact.solving import has_period as has_period

# The real x with equation(x) = 0 that have a closed form; of an equation in angles those of one turn
from eomgen.symbolic.exact.solving import roots as roots

# True if x is 0 at all values of its symbols; False where it has a value at no state that was tried
from eomgen.symbolic.exact.solving import vanishes as vanishes

# marks that a sum may be longer in factors: (M + m)*g is M*g + m*g
from eomgen.symbolic.exact.sums import BRACKETS as BRACKETS

# The work or size needed is beyond its limit
from eomgen.symbolic.exact.terms import TooLarge as TooLarge
