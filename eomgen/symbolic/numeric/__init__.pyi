"""Door of the folder: what other folders may import from `eomgen.symbolic.numeric`."""

# Linear systems of numbers -> solutions, where rows and columns have units of their own
from eomgen.symbolic.numeric import dense as dense

# Every tolerance of the package: its value, what it is a share of, and why it is that large
from eomgen.symbolic.numeric import tolerances as tolerances
from eomgen.symbolic.numeric.arithmetic import Ball as Ball

# Balls around numbers of so many digits
from eomgen.symbolic.numeric.arithmetic import balls as balls

# True if the row is a combination of the others, modulo the prime
from eomgen.symbolic.numeric.arithmetic import follows as follows

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

# scalars -> their values at the state, with 50 digits
from eomgen.symbolic.numeric.evaluation import digits_at as digits_at

# The outputs' values
from eomgen.symbolic.numeric.evaluation import evaluate as evaluate

# The same for a state or two, for which no plan is made
from eomgen.symbolic.numeric.evaluation import evaluate_once as evaluate_once

# Real numbers with 50 decimal digits; a function outside its real domain raises NoValue
from eomgen.symbolic.numeric.evaluation import fifty_digits as fifty_digits

# Numbers of many digits as floats
from eomgen.symbolic.numeric.evaluation import floats_of as floats_of

# x of as many rows [A | b] as unknowns, with 50 digits; None where they are few, or A is nearly singular
from eomgen.symbolic.numeric.evaluation import solved_quickly as solved_quickly

# (row column, |row| |column|) with 50 digits, for each row, in a list for each column
from eomgen.symbolic.numeric.evaluation import sums_of_products as sums_of_products

# The scalars with each symbol replaced by what its name means in another graph
from eomgen.symbolic.numeric.evaluation import transplanted as transplanted
from eomgen.symbolic.numeric.isolation import JUMPS as JUMPS

# A function, resolved
from eomgen.symbolic.numeric.isolation import ChebyshevPieces as ChebyshevPieces

# The roots of as many equations as unknowns in the box from `low` to `high`; None where they have jumps
from eomgen.symbolic.numeric.isolation import isolated as isolated

# The extremes of T_n in each piece, both ends among them: pieces x (n + 1), ascending
from eomgen.symbolic.numeric.isolation import nodes_between as nodes_between

# A function between the edges, halved until polynomials are it; nan where it has no value in a piece
from eomgen.symbolic.numeric.isolation import resolved_curve as resolved_curve

# Values at the nodes -> coefficients
from eomgen.symbolic.numeric.isolation import transform as transform
from eomgen.symbolic.numeric.pieces import PIECEWISE as PIECEWISE
from eomgen.symbolic.numeric.pieces import Choices as Choices

# A quantity, and the values of it at which something changes its form
from eomgen.symbolic.numeric.pieces import Switch as Switch

# The scalars as they are where the nodes choose so: without pieces
from eomgen.symbolic.numeric.pieces import as_chosen as as_chosen

# The choice of each node at a state; None where it lies between two pieces of one
from eomgen.symbolic.numeric.pieces import choices_at as choices_at

# The two sides that are compared where x chooses; of samples their argument and 0
from eomgen.symbolic.numeric.pieces import compared_sides as compared_sides

# The nodes whose form changes with something that moves, in the order of evaluation
from eomgen.symbolic.numeric.pieces import piecewise_nodes as piecewise_nodes

# Every switch in the scalars that something that moves can throw
from eomgen.symbolic.numeric.pieces import switches_of as switches_of

# Equations in some unknowns
from eomgen.symbolic.numeric.roots import Descent as Descent

# Settings of the search for a root
from eomgen.symbolic.numeric.roots import Newton as Newton

# The roots to which the starts lead, each once, the nearest first
from eomgen.symbolic.numeric.roots import all_roots as all_roots

# The place nearby where |f|^2 is least, in floats: a root, or how near the equations come to one
from eomgen.symbolic.numeric.roots import least_left as least_left

# The number of an exact form to double precision; nan where it has none
from eomgen.symbolic.numeric.sure_numbers import number_of as number_of

# The numbers of several exact forms, as of `number_of`
from eomgen.symbolic.numeric.sure_numbers import numbers_of as numbers_of

# [rad] off a place where a description is locked
from eomgen.symbolic.numeric.tolerances import ASIDE_STEP as ASIDE_STEP

# of a derivative so far from it: a root of order 5 is known to 8 digits where f is to 40
from eomgen.symbolic.numeric.tolerances import AT_A_MULTIPLE_ROOT as AT_A_MULTIPLE_ROOT

# [1] of what vanishes at the edge of a domain (1 - x under an arccosine): a motion ends there
from eomgen.symbolic.numeric.tolerances import AT_AN_EDGE as AT_AN_EDGE

# of a change: how far from a state that is known in doubles a corner is looked for
from eomgen.symbolic.numeric.tolerances import BESIDE as BESIDE

# of coordinates against their size and 1: what vanishes at a place does not so far from it
from eomgen.symbolic.numeric.tolerances import BESIDE_A_PLACE as BESIDE_A_PLACE

# [of the unknown] for a search that shall go as far as doubles do
from eomgen.symbolic.numeric.tolerances import BEST as BEST

# of a shape: so far what is round reaches beyond places on a grid inside it
from eomgen.symbolic.numeric.tolerances import BETWEEN_PLACES as BETWEEN_PLACES

# of the largest singular value: two branches meet so near that nothing distinguishes them
from eomgen.symbolic.numeric.tolerances import BRANCHES_MEET as BRANCHES_MEET

# what a run in time carried along, or what was searched twice
from eomgen.symbolic.numeric.tolerances import CARRIED as CARRIED

# [1] above it the sign of a constant is known; a step of Newton's method that ends it
from eomgen.symbolic.numeric.tolerances import CERTAIN_AT_50 as CERTAIN_AT_50

# [m or rad] a gap that Newton's method has closed
from eomgen.symbolic.numeric.tolerances import CLOSED_AT_50 as CLOSED_AT_50

# of a coefficient of a polynomial, made free of units
from eomgen.symbolic.numeric.tolerances import COEFFICIENT_AT_50 as COEFFICIENT_AT_50

# several solutions one after another: forces from accelerations from coordinates
from eomgen.symbolic.numeric.tolerances import COMPUTED as COMPUTED

# [SI] a coordinate or speed after the last step in 50 digits: it is 0
from eomgen.symbolic.numeric.tolerances import COORDINATE_AT_50 as COORDINATE_AT_50

# of a determinant, length or diagonal entry that a description divides by
from eomgen.symbolic.numeric.tolerances import DEGENERATE as DEGENERATE

# of J A^-1 J^T, added to its diagonal where no pivot may be sought: ten times a squared sine
from eomgen.symbolic.numeric.tolerances import DEPENDENT_EASE as DEPENDENT_EASE

# of a central difference with a step of 1e-15; scaled equations at a root
from eomgen.symbolic.numeric.tolerances import DIFFERENCE_AT_50 as DIFFERENCE_AT_50

# of a first derivative in doubles, near the cube root of rounding
from eomgen.symbolic.numeric.tolerances import DIFFERENCE_STEP as DIFFERENCE_STEP

# of the size of a picture: so far a place may be off that is drawn, of states between rows
from eomgen.symbolic.numeric.tolerances import DRAWN as DRAWN

# of an entry against the largest of its row, after an elimination
from eomgen.symbolic.numeric.tolerances import ELIMINATED_AT_50 as ELIMINATED_AT_50

# of a run to one instant, where a finer one does not come across
from eomgen.symbolic.numeric.tolerances import FAIR_RUN as FAIR_RUN

# of a run whose end is printed as a number
from eomgen.symbolic.numeric.tolerances import FINE_RUN as FINE_RUN

# of a run that is continued across a singular place; the finest that is useful
from eomgen.symbolic.numeric.tolerances import FINEST_RUN as FINEST_RUN

# of a column over its largest entry, with 50 digits: what is left of one that follows
from eomgen.symbolic.numeric.tolerances import FOLLOWS_AT_50 as FOLLOWS_AT_50

# the same to four digits
from eomgen.symbolic.numeric.tolerances import FOUR_DIGITS as FOUR_DIGITS

# [m or rad] a gap that an iteration in doubles has closed
from eomgen.symbolic.numeric.tolerances import GAP_CLOSED as GAP_CLOSED

# i h of a derivative Im f(s + i h) / h, which has no difference and so no rounding
from eomgen.symbolic.numeric.tolerances import IMAGINARY_STEP as IMAGINARY_STEP

# an eigenvalue problem, differences of near numbers, an extremum
from eomgen.symbolic.numeric.tolerances import ITERATED as ITERATED

# [SI] a coordinate or speed: beyond it a difference with a step of 1e-15 is lost
from eomgen.symbolic.numeric.tolerances import LARGEST_AT_50 as LARGEST_AT_50

# [SI] of what is multiplied in doubles: beyond it its square has no value
from eomgen.symbolic.numeric.tolerances import LARGEST_SQUARED as LARGEST_SQUARED

# of the least change that closes gaps: near a singular place it must still be made
from eomgen.symbolic.numeric.tolerances import LEAST_CHANGE as LEAST_CHANGE

# of a body's own size: a thin one is taken as thick as this, so that all of it has mass
from eomgen.symbolic.numeric.tolerances import LEAST_DENSITY as LEAST_DENSITY

# below which rounding is larger: 100 units in the last place
from eomgen.symbolic.numeric.tolerances import LEAST_RTOL as LEAST_RTOL

# of the least mass: compared with a larger one the least is lost in a difference of doubles
from eomgen.symbolic.numeric.tolerances import MASSES_APART as MASSES_APART

# of scaled equations: what is left is the rounding of their evaluation
from eomgen.symbolic.numeric.tolerances import MET_AT_50 as MET_AT_50

# of scaled equations: so near, Newton's method has a root; a box that is not halved again
from eomgen.symbolic.numeric.tolerances import NEAR_ROOT as NEAR_ROOT

# [of its largest parameter] of a body whose extent is lost in that nothing is said
from eomgen.symbolic.numeric.tolerances import NEARLY_A_POINT as NEARLY_A_POINT

# at a place that is known to half of the digits only, or where constraints resist too little
from eomgen.symbolic.numeric.tolerances import NEARLY_SINGULAR as NEARLY_SINGULAR

# a number that is printed to nine digits, of itself
from eomgen.symbolic.numeric.tolerances import NINE_DIGITS as NINE_DIGITS

# [kg m^2] a moment of inertia in a robot's file below zero by no more is 0, by rounding
from eomgen.symbolic.numeric.tolerances import NOT_NEGATIVE as NOT_NEGATIVE

# of a gap or its rate against its terms: more is not the rounding of what a user typed
from eomgen.symbolic.numeric.tolerances import OPEN_GAP as OPEN_GAP

# of a parameter, of a difference of fourth order: near the fifth root of rounding
from eomgen.symbolic.numeric.tolerances import PARAMETER_STEP as PARAMETER_STEP

# of a row's pivot in emitted code: the squared sine of its angle to the rows before it
from eomgen.symbolic.numeric.tolerances import PIVOT as PIVOT

# at a place that is known as well as doubles allow
from eomgen.symbolic.numeric.tolerances import RANK as RANK

# at a place that was found in doubles, or is met on the way: its own error makes rows differ
from eomgen.symbolic.numeric.tolerances import RANK_NEARBY as RANK_NEARBY

# of accelerations: their last correction, after which they are right beyond doubles
from eomgen.symbolic.numeric.tolerances import REFINED_AT_50 as REFINED_AT_50

# of a scaled mass matrix, 1 / condition number, below which it is singular
from eomgen.symbolic.numeric.tolerances import REGULAR as REGULAR

# [SI] a place, a sine or an inertia by 40 digits: what is smaller is its rounding
from eomgen.symbolic.numeric.tolerances import ROUNDED_AWAY as ROUNDED_AWAY

# one evaluation: an entry against the largest of its matrix or row, or against its terms
from eomgen.symbolic.numeric.tolerances import ROUNDING as ROUNDING

# of a largest pivot that is the square of a length
from eomgen.symbolic.numeric.tolerances import ROUNDING_SQUARED as ROUNDING_SQUARED

# of the user's runs, where nothing else is requested
from eomgen.symbolic.numeric.tolerances import RUN as RUN

# of the motion's size: two runs across a singular place differ by less
from eomgen.symbolic.numeric.tolerances import RUNS_AGREE as RUNS_AGREE

# of an arrow's length and direction against others of its kind: nobody sees less
from eomgen.symbolic.numeric.tolerances import SAME_ARROW as SAME_ARROW

# of two eigenvalues: a double one comes out as two, the root of rounding apart
from eomgen.symbolic.numeric.tolerances import SAME_EIGENVALUE as SAME_EIGENVALUE

# of a time between passages: more, and what is damped or modulated has no one period
from eomgen.symbolic.numeric.tolerances import SAME_PERIOD as SAME_PERIOD

# of coordinates against their size and 1: so near, two places are one (a double root is so wide)
from eomgen.symbolic.numeric.tolerances import SAME_PLACE as SAME_PLACE

# [1 or rad] of ratios and angles that were doubles: so near, they are what a person writes
from eomgen.symbolic.numeric.tolerances import SAME_TURN as SAME_TURN

# the same to seven digits
from eomgen.symbolic.numeric.tolerances import SEVEN_DIGITS as SEVEN_DIGITS

# of a row, multiplier or coordinate in a combination: what has a smaller part is not named
from eomgen.symbolic.numeric.tolerances import SHARE as SHARE

# one evaluation, in addition to the rounding of its arguments; of a run, the tolerance of a step
from eomgen.symbolic.numeric.tolerances import SINGLE as SINGLE

# of a number, half a unit in the last place: states so near are one
from eomgen.symbolic.numeric.tolerances import SINGLE_ROUNDING as SINGLE_ROUNDING

# added to the square of a length of order 1, whose root has no slope at 0: no double sees it
from eomgen.symbolic.numeric.tolerances import SLOPE_AT_REST as SLOPE_AT_REST

# [of a unit, a second] a rate of this part of 1 is compared as 1 is: smaller ones are mostly rounding
from eomgen.symbolic.numeric.tolerances import SLOW as SLOW

# numbers below it are printed with a power of ten
from eomgen.symbolic.numeric.tolerances import SMALLEST_PLAIN as SMALLEST_PLAIN

# the solution of linear equations, or a place found by Newton's method
from eomgen.symbolic.numeric.tolerances import SOLVED as SOLVED

# [s] after the start, when a motion that begins between two pieces is in one
from eomgen.symbolic.numeric.tolerances import SOON as SOON

# of an entry of the diagonal of M: a sum of squares that cancel
from eomgen.symbolic.numeric.tolerances import SQUARED_AT_50 as SQUARED_AT_50

# of a mass: the square of a sine that is 0 but for rounding; a shift that changes nothing else
from eomgen.symbolic.numeric.tolerances import SQUARED_SINE as SQUARED_SINE

# of the largest half-axis of an ellipsoid of inertia: flat ones are drawn thicker
from eomgen.symbolic.numeric.tolerances import STANDS_FOR_A_MASS as STANDS_FOR_A_MASS

# a sum or product of many such entries; a smallest singular value; a step of an iteration
from eomgen.symbolic.numeric.tolerances import SUMMED as SUMMED

# of the same: above it a row need not wait for one that is farther from those before it
from eomgen.symbolic.numeric.tolerances import SURE_PIVOT as SURE_PIVOT

# instead of 0 in a divisor
from eomgen.symbolic.numeric.tolerances import TINIEST as TINIEST

# of the forces: what pulls parameters to the model's where data do not determine them
from eomgen.symbolic.numeric.tolerances import TOWARD_THE_MODEL as TOWARD_THE_MODEL

# of the forces: what least squares leave, above which constraints do not carry them
from eomgen.symbolic.numeric.tolerances import UNBALANCED as UNBALANCED

# of the smallest eigenvalue against the largest, below which more digits are used
from eomgen.symbolic.numeric.tolerances import WIDE_SPECTRUM as WIDE_SPECTRUM

# of a second difference, near the fourth root of rounding; of what is drawn
from eomgen.symbolic.numeric.tolerances import WIDE_STEP as WIDE_STEP

# [1] of what would be of the order of 1: half of the digits are left for what cancels
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50 as ZERO_AT_50

# commands, numbers and letters of the formulas of one page that are read back
from eomgen.symbolic.numeric.work import READ_BACK as READ_BACK

# Ends all work inside `patience`
from eomgen.symbolic.numeric.work import PatienceEnded as PatienceEnded

# Products of terms that may be formed for one expression; one that needs more stays as it came
from eomgen.symbolic.numeric.work import Work as Work

# Restarts the time limit, for work whose finished steps remain: the next step may take the whole time again
from eomgen.symbolic.numeric.work import another_stretch as another_stretch

# Does nothing while there is time left
from eomgen.symbolic.numeric.work import check_patience as check_patience

# Names the activity inside, for the message that it was given up
from eomgen.symbolic.numeric.work import doing as doing

# Pauses the cycle collector while expressions are made that all stay: the search for cycles would take longer
from eomgen.symbolic.numeric.work import growing as growing

# Ends the time limit, so that what was found can be reported in full: nothing more is sought
from eomgen.symbolic.numeric.work import keep_what_there_is as keep_what_there_is

# Limits the time of what is done inside; None: no limit
from eomgen.symbolic.numeric.work import patience as patience

# Makes the cycle collector run rarely during one command; afterwards it runs as before
from eomgen.symbolic.numeric.work import seldom as seldom

# Makes the cycle collector run rarely, for one command in a process of its own
from eomgen.symbolic.numeric.work import seldom_from_now_on as seldom_from_now_on

# Seconds that are left; None without a time limit
from eomgen.symbolic.numeric.work import time_left as time_left
