"""Door of the folder: what other folders may import from `eomgen.symbolic.expression`."""

# Number of operations that an evaluation takes
from eomgen.symbolic.expression.derivatives import Count as Count

# The symbols of one derivation
from eomgen.symbolic.expression.derivatives import Symbols as Symbols
from eomgen.symbolic.expression.derivatives import depends_on as depends_on

# dx/dsymbol
from eomgen.symbolic.expression.derivatives import derivative as derivative

# (dx/dsymbol for each symbol), in one sweep from the result back to the symbols
from eomgen.symbolic.expression.derivatives import gradient as gradient

# True if a number with all its digits, as of a double, occurs in a scalar: that is a number and no formula
from eomgen.symbolic.expression.derivatives import holds_many_digits as holds_many_digits

# The matrix d outputs / d symbols, one row an output, by whichever sweeps are fewer, or meet far fewer nodes
from eomgen.symbolic.expression.derivatives import jacobian as jacobian

# The operations in the outputs, each sub-expression once
from eomgen.symbolic.expression.derivatives import operations as operations

# Every node that the outputs need, arguments before results; what is `given` is not looked into
from eomgen.symbolic.expression.derivatives import order as order

# (sum over the outputs of weight d output/dsymbol, for each symbol), in one sweep: A^T w of the Jacobian A
from eomgen.symbolic.expression.derivatives import pullback as pullback

# The outputs with nodes replaced by scalars of the same graph, all at once; other outputs are unchanged
from eomgen.symbolic.expression.derivatives import substituted as substituted

# The symbols that the outputs hold, in the order of their making
from eomgen.symbolic.expression.derivatives import symbols_of as symbols_of

# The derivative of the outputs along a direction: sum over x of (d output / dx) seeds[x]
from eomgen.symbolic.expression.derivatives import tangent as tangent

# The derivatives of the outputs by each symbol, in a sweep for each, through what depends on it alone
from eomgen.symbolic.expression.derivatives import tangents as tangents

# (graph, outputs) with the constants that have no graph of their own taken into that of the others
from eomgen.symbolic.expression.derivatives import united as united

# The expression of a number or a text; a float means the decimal that it is written as (0.1 is 1/10)
# A function that a model declares by a table of values
from eomgen.symbolic.expression.formula import AS_WRITTEN as AS_WRITTEN

# The functions of the grammar, and how many arguments each takes
from eomgen.symbolic.expression.formula import NAMES as NAMES

# A function of the outputs at its arguments: `speed(bar.end)`, `frequency(1)`
from eomgen.symbolic.expression.formula import Call as Call

# A formula of the model file, as a tree of our own that any scalar can evaluate
from eomgen.symbolic.expression.formula import Expression as Expression

# A name as an argument: of a constraint (`B`), a body, a point (`arm.end`), a member (`n1-n2`), a coordinate
from eomgen.symbolic.expression.formula import Reference as Reference
from eomgen.symbolic.expression.formula import TableFunction as TableFunction
from eomgen.symbolic.expression.formula import cos as cos
from eomgen.symbolic.expression.formula import function as function
from eomgen.symbolic.expression.formula import inner as inner

# True for whole numbers and fractions
from eomgen.symbolic.expression.formula import is_exact as is_exact
from eomgen.symbolic.expression.formula import over as over

# if_below where a <= bound, else if_above: a piecewise law over any scalar
from eomgen.symbolic.expression.formula import selected as selected
from eomgen.symbolic.expression.formula import sin as sin
from eomgen.symbolic.expression.formula import sqrt as sqrt
from eomgen.symbolic.expression.formula import through_samples as through_samples

# of a node, when it stays a whole power
from eomgen.symbolic.expression.graph import LARGEST_POWER as LARGEST_POWER

# The owner of a set of expressions, each held once
from eomgen.symbolic.expression.graph import Graph as Graph

# an operation of its own: most roots are of numbers
from eomgen.symbolic.expression.node import ROOT_OF_SUM as ROOT_OF_SUM
from eomgen.symbolic.expression.node import SUMS as SUMS

# One expression of a graph: an operation on nodes and exact numbers
from eomgen.symbolic.expression.node import Node as Node

# Interface of the graph that owns a node, as the node uses it
from eomgen.symbolic.expression.node import Owner as Owner
from eomgen.symbolic.expression.node import Scalar as Scalar
from eomgen.symbolic.expression.node import ScalarRow as ScalarRow
from eomgen.symbolic.expression.node import ScalarRows as ScalarRows
from eomgen.symbolic.expression.node import SparseRow as SparseRow
from eomgen.symbolic.expression.node import State as State

# a with its like terms collected: (theta1 - pi/2) + (theta2 - theta1) -> theta2 - pi/2
from eomgen.symbolic.expression.node import collected as collected

# True if one of the operations occurs in x
from eomgen.symbolic.expression.node import holds_op as holds_op

# True where a is the number 0 (a node never is: what folds to 0 folds on construction)
from eomgen.symbolic.expression.node import is_zero as is_zero

# a as a sum of numbers times nodes that are no sums: {node: coefficient}, None for the number
from eomgen.symbolic.expression.node import linear_terms as linear_terms
from eomgen.symbolic.expression.numbers import Number as Number

# a, a whole one as int
from eomgen.symbolic.expression.numbers import tidy as tidy
from eomgen.symbolic.expression.rational import Fraction as Fraction

# The number that a text spells ("3", "0.1", "1e-6", "1/180")
from eomgen.symbolic.expression.rational import fraction_of as fraction_of

# Has sympy take the compiled rationals as the exact numbers that they are: it would make floats of them
from eomgen.symbolic.expression.rational import known_to_sympy as known_to_sympy

# Three rows of three: A + B, k * A; `R @ a`, `A @ B`, `R.T`
from eomgen.symbolic.expression.spatial import Matrix as Matrix

# Position and orientation of frame B in frame A
from eomgen.symbolic.expression.spatial import Pose as Pose

# Mass properties of a rigid body about its frame's origin, in its axes
from eomgen.symbolic.expression.spatial import SpatialInertia as SpatialInertia

# Velocity of a rigid body, at one of its points
from eomgen.symbolic.expression.spatial import Twist as Twist

# Three scalars: a + b, a - b, -a, k * a; `a @ b` is the scalar product a . b, `a.cross(b)` is a x b
from eomgen.symbolic.expression.spatial import Vector as Vector

# Force and couple on a rigid body, at one of its points
from eomgen.symbolic.expression.spatial import Wrench as Wrench

# Samples as they were given, and the way between them: what proofs look at
from eomgen.symbolic.expression.splines import DeclaredSamples as DeclaredSamples

# A function through samples, which the graph holds as one operation on t
from eomgen.symbolic.expression.splines import Sampled as Sampled

# The function through samples: "cubic" (f'' continuous), "pchip" (cubics, monotone between samples), "linear"
from eomgen.symbolic.expression.splines import spline_of as spline_of

# of ten, in a decimal: what a double can hold
from eomgen.symbolic.expression.text import LARGEST_EXPONENT as LARGEST_EXPONENT

# characters
from eomgen.symbolic.expression.text import LONGEST as LONGEST

# of a text in which parts have names, each of at most LONGEST
from eomgen.symbolic.expression.text import LONGEST_WITH_PARTS as LONGEST_WITH_PARTS
from eomgen.symbolic.expression.text import MOST_DIGITS as MOST_DIGITS

# what dT/dq' is read as: slope_of(T, q'), of an energy by a coordinate or its rate
from eomgen.symbolic.expression.text import SLOPE as SLOPE
from eomgen.symbolic.expression.text import as_expression as as_expression

# (phi, how many dots, where it ends) of diff(phi, t), ddot(phi); None of others
from eomgen.symbolic.expression.text import called_rate as called_rate

# The fix of an angle in degrees: "angles are in rad here: write pi/2", or ""
from eomgen.symbolic.expression.text import degrees as degrees

# The fix of a character that looks like a blank, or like nothing; "" of a visible one
from eomgen.symbolic.expression.text import invisible as invisible

# True where text can name a parameter or a coordinate: letters (Greek too), digits, `_`; no prime
from eomgen.symbolic.expression.text import is_name as is_name

# The correct spelling of phi_dot (phi'), π (pi), θ (theta) among the allowed names; "" if none is recognized
from eomgen.symbolic.expression.text import meant_name as meant_name

# The names here, among the known ones, of what other programs call `word`
from eomgen.symbolic.expression.text import other_words as other_words

# The expression that a text writes
from eomgen.symbolic.expression.text import parse as parse

# Both sides of `left = right`
from eomgen.symbolic.expression.text import parse_equation as parse_equation

# The fix of diff(phi, t), ddot(phi), phi(t) or pow(phi, 2), or ""
from eomgen.symbolic.expression.text import rate_of_call as rate_of_call

# A Greek letter by its name ("theta"), "" of others
from eomgen.symbolic.expression.text import spelled as spelled

# The token that begins at or after this position
from eomgen.symbolic.expression.text import token_at as token_at
