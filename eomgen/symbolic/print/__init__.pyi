"""Door of the folder: what other folders may import from `eomgen.symbolic.print`."""

# 0.93 of the lines of a paper, of LaTeX and of a wide page
from eomgen.symbolic.print.breaking import PAPER as PAPER

# of a page that is 360 pixels wide
from eomgen.symbolic.print.breaking import PHONE as PHONE

# Line that formulas are broken for
from eomgen.symbolic.print.breaking import SetLine as SetLine

# Typesetting of the names of a model
from eomgen.symbolic.print.latex import Notation as Notation

# A typeset formula: its LaTeX, the precedence of its outermost operation
from eomgen.symbolic.print.latex import Set as Set

# Sets graph scalars, with one notation for all of them
from eomgen.symbolic.print.latex import Setter as Setter

# Plain text for LaTeX outside formulas
from eomgen.symbolic.print.latex import latex_escaped as latex_escaped

# coefficient * (product of base ^ exponent) / (product of base ^ exponent), exponents whole and positive
from eomgen.symbolic.print.layout import Product as Product

# (digits, power of ten) with c = digits * 10^power exactly; None where a fraction or a whole number reads better
from eomgen.symbolic.print.layout import decimal_of as decimal_of

# True where a sum in a quotient has quotients itself, (a + b/c)/d, functions not looked into
from eomgen.symbolic.print.layout import has_nested_quotient as has_nested_quotient

# True for what is no sum, product or whole power: a symbol, pi, a function, a broken power
from eomgen.symbolic.print.layout import is_base as is_base

# x as a sum of products, in the order of `terms`; k*(1 - l/r) rather than -k*(l/r - 1)
from eomgen.symbolic.print.layout import products_of as products_of

# x as a sum of number * term, the term None for a plain number
from eomgen.symbolic.print.layout import terms as terms

# The number of visible marks that the scalars have when they are typeset, names by their letters
from eomgen.symbolic.print.length import length_of as length_of

# A symbol as it is set: \theta with the index A, and what is over it
from eomgen.symbolic.print.names import Symbol as Symbol

# Words in an index, one style for all: letters slanted, words upright, max -> \mathrm{max}
from eomgen.symbolic.print.names import index_latex as index_latex

# A word in roman type inside a formula
from eomgen.symbolic.print.names import upright as upright

# A sympy expression as a scalar of the symbols' graph
from eomgen.symbolic.print.sympy_form import scalar_from_sympy as scalar_from_sympy

# The outputs as sympy expressions over real symbols, their common parts made once
from eomgen.symbolic.print.sympy_form import to_sympy as to_sympy

# characters of an exact result
from eomgen.symbolic.print.text import LONGEST_RESULT as LONGEST_RESULT

# The sub-expressions to be named so that no text is much longer than `limit`, in evaluation order
from eomgen.symbolic.print.text import named_parts as named_parts

# The text of a result; None where it would be longer than anybody reads: a shared graph is far smaller
from eomgen.symbolic.print.text import readable_text as readable_text

# A lower bound of the length of to_text(x), at the cost of the graph: nothing is printed
from eomgen.symbolic.print.text import text_size as text_size

# x as text; nodes with a name of their own are printed by it
from eomgen.symbolic.print.text import to_text as to_text

# (definitions, texts): the expressions as text, long and repeated parts named z1, z2, ... before use
from eomgen.symbolic.print.text import with_definitions as with_definitions
