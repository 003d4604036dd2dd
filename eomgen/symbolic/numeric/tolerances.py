"""Every tolerance of the package: its value, what it is a share of, and why it is that large.

A number without a unit is a share of what it is compared with (the largest entry of a row, the size of the terms
of a sum, 1 + |value| for a value); a unit stands in brackets. No module holds a tolerance of its own: one that means
the same has the same name here, and one that means something else has its own reason.
"""

# What is left of 0 in doubles (16 digits), by how the number was made; each step of the ladder loses a digit or two.
ROUNDING = 1e-14  # one evaluation: an entry against the largest of its matrix or row, or against its terms
SUMMED = 1e-13  # a sum or product of many such entries; a smallest singular value; a step of an iteration
SOLVED = 1e-12  # the solution of linear equations, or a place found by Newton's method
ITERATED = 1e-10  # an eigenvalue problem, differences of near numbers, an extremum
NINE_DIGITS = 1e-8  # a number that is printed to nine digits, of itself
SEVEN_DIGITS = 1e-6  # the same to seven digits
FOUR_DIGITS = 6e-4  # the same to four digits
COMPUTED = 1e-9  # several solutions one after another: forces from accelerations from coordinates
CARRIED = 1e-8  # what a run in time carried along, or what was searched twice
BEST = 1e-15  # [of the unknown] for a search that shall go as far as doubles do
OUTWARDS = 5e-16  # of an end of an interval, by which it is moved outwards: two units in the last place
ROUNDING_SQUARED = 1e-28  # of a largest pivot that is the square of a length
SLOPE_AT_REST = 1e-30  # added to the square of a length of order 1, whose root has no slope at 0: no double sees it
TINIEST = 1e-300  # instead of 0 in a divisor
FELT = 1e-100  # [of a scaled row] its largest entry: compared with one above it what underflows in doubles is nothing
SLOW = 1e-4  # [of a unit, a second] a rate of this part of 1 is compared as 1 is: smaller ones are mostly rounding

# In single precision (7 digits).
SINGLE_ROUNDING = 6e-8  # of a number, half a unit in the last place: states so near are one
SINGLE = 1e-6  # one evaluation, in addition to the rounding of its arguments; of a run, the tolerance of a step

# What is left of 0 in numbers of 50 digits.
ZERO_AT_50 = 1e-25  # [1] of what would be of the order of 1: half of the digits are left for what cancels
CERTAIN_AT_50 = 1e-30  # [1] above it the sign of a constant is known; a step of Newton's method that ends it
CLOSED_AT_50 = 1e-28  # [m or rad] a gap that Newton's method has closed
ELIMINATED_AT_50 = 1e-20  # of an entry against the largest of its row, after an elimination
DIFFERENCE_AT_50 = 1e-18  # of a central difference with a step of 1e-15; scaled equations at a root
REFINED_AT_50 = 1e-16  # of accelerations: their last correction, after which they are right beyond doubles
COEFFICIENT_AT_50 = 1e-36  # of a coefficient of a polynomial, made free of units
MET_AT_50 = 1e-40  # of scaled equations: what is left is the rounding of their evaluation
SQUARED_AT_50 = 1e-60  # of an entry of the diagonal of M: a sum of squares that cancel
VANISHED = 1e-100  # [SI] of a number of 480 digits: what is smaller is 0; a root of a root of nothing is 1e-120 wide
SQUARED_SINE = 1e-24  # of a mass: the square of a sine that is 0 but for rounding; a shift that changes nothing else

# Ranks: singular values of rows brought to length 1 (or balanced), below which a row follows from the others.
RANK = 1e-9  # at a place that is known as well as doubles allow
RANK_NEARBY = 1e-7  # at a place that was found in doubles, or is met on the way: its own error makes rows differ
LEAST_CHANGE = 1e-11  # of the least change that closes gaps: near a singular place it must still be made
REGULAR = 1e-12  # of a scaled mass matrix, 1 / condition number, below which it is singular
PIVOT = 1e-11  # of a row's pivot in emitted code: the squared sine of its angle to the rows before it
SURE_PIVOT = 1e-3  # of the same: above it a row need not wait for one that is farther from those before it
DEPENDENT_EASE = 1e-10  # of J A^-1 J^T, added to its diagonal where no pivot may be sought: ten times a squared sine
NEARLY_SINGULAR = 1e-5  # at a place that is known to half of the digits only, or where constraints resist too little
BRANCHES_MEET = 1e-4  # of the largest singular value: two branches meet so near that nothing distinguishes them
WIDE_SPECTRUM = 1e-4  # of the smallest eigenvalue against the largest, below which more digits are used
BESIDE = 1e-14  # of a change: how far from a state that is known in doubles a corner is looked for
DEGENERATE = 1e-6  # of a determinant, length or diagonal entry that a description divides by

# Places, instants and shapes.
DRAWN = 1e-5  # of the size of a picture: so far a place may be off that is drawn, of states between rows
SAME_ARROW = 1e-3  # of an arrow's length and direction against others of its kind: nobody sees less
BETWEEN_PLACES = 0.03  # of a shape: so far what is round reaches beyond places on a grid inside it
STANDS_FOR_A_MASS = 0.13  # of the largest half-axis of an ellipsoid of inertia: flat ones are drawn thicker
WRITTEN_BY_HAND = 0.01  # of a direction, and of a place against the size of all: a person writes two digits
SAME_PLACE = 1e-6  # of coordinates against their size and 1: so near, two places are one (a double root is so wide)
BESIDE_A_PLACE = 1e-4  # of coordinates against their size and 1: what vanishes at a place does not so far from it
AT_A_MULTIPLE_ROOT = 1e-4  # of a derivative so far from it: a root of order 5 is known to 8 digits where f is to 40
SAME_PERIOD = 0.05  # of a time between passages: more, and what is damped or modulated has no one period
SAME_EIGENVALUE = 1e-7  # of two eigenvalues: a double one comes out as two, the root of rounding apart
NEAR_ROOT = 1e-7  # of scaled equations: so near, Newton's method has a root; a box that is not halved again
SHARE = 1e-6  # of a row, multiplier or coordinate in a combination: what has a smaller part is not named
OPEN_GAP = 1e-6  # of a gap or its rate against its terms: more is not the rounding of what a user typed
UNBALANCED = 1e-6  # of the forces: what least squares leave, above which constraints do not carry them
MASSES_APART = 1e11  # of the least mass: compared with a larger one the least is lost in a difference of doubles
AT_AN_EDGE = 1e-5  # [1] of what vanishes at the edge of a domain (1 - x under an arccosine): a motion ends there
LOWEST_FLIGHT = 1e-10  # [of the coordinates, at least 1 m] between two impacts; ten times what an instant is known to
GAP_CLOSED = 1e-11  # [m or rad] a gap that an iteration in doubles has closed
SOON = 1e-6  # [s] after the start, when a motion that begins between two pieces is in one
LARGEST_AT_50 = 1e15  # [SI] a coordinate or speed: beyond it a difference with a step of 1e-15 is lost
LARGEST_SQUARED = 1e150  # [SI] of what is multiplied in doubles: beyond it its square has no value
COORDINATE_AT_50 = 1e-18  # [SI] a coordinate or speed after the last step in 50 digits: it is 0
NOT_NEGATIVE = 1e-12  # [kg m^2] a moment of inertia in a robot's file below zero by no more is 0, by rounding
ROUNDED_AWAY = 1e-30  # [SI] a place, a sine or an inertia by 40 digits: what is smaller is its rounding
SAME_TURN = 1e-14  # [1 or rad] of ratios and angles that were doubles: so near, they are what a person writes
FOLLOWS_AT_50 = 1e-22  # of a column over its largest entry, with 50 digits: what is left of one that follows
LEAST_DENSITY = 1e-6  # of a body's own size: a thin one is taken as thick as this, so that all of it has mass
NEARLY_A_POINT = 1e-6  # [of its largest parameter] of a body whose extent is lost in that nothing is said
TOWARD_THE_MODEL = 1e-7  # of the forces: what pulls parameters to the model's where data do not determine them

# Accuracy that is requested of a run in time: rtol and atol of a step.
RUN = 1e-9  # of the user's runs, where nothing else is requested
FAIR_RUN = 1e-10  # of a run to one instant, where a finer one does not come across
FINE_RUN = 1e-12  # of a run whose end is printed as a number
FINEST_RUN = 1e-13  # of a run that is continued across a singular place; the finest that is useful
LEAST_RTOL = 2.3e-14  # below which rounding is larger: 100 units in the last place
RUNS_AGREE = 1e-7  # of the motion's size: two runs across a singular place differ by less

# Steps of differences [of the coordinate's size and 1].
DIFFERENCE_STEP = 1e-5  # of a first derivative in doubles, near the cube root of rounding
PARAMETER_STEP = 1e-3  # of a parameter, of a difference of fourth order: near the fifth root of rounding
IMAGINARY_STEP = 1e-30  # i h of a derivative Im f(s + i h) / h, which has no difference and so no rounding
ASIDE_STEP = 1e-6  # [rad] off a place where a description is locked
WIDE_STEP = 1e-4  # of a second difference, near the fourth root of rounding; of what is drawn

# Of what is printed.
SMALLEST_PLAIN = 1e-6  # numbers below it are printed with a power of ten
