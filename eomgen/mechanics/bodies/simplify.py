"""Scalar -> the same in a shorter form: what is divided by what dependent rates or declared speeds bring in."""

from __future__ import annotations

from eomgen.symbolic.exact.normal_form import cancelled, readable
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.traversal import operations
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.text import text_size

LONGEST_ROW = 2000  # characters of a velocity row that is multiplied out
LONGEST = 600  # characters of a scalar that is made readable
MOST = 9  # symbols in it


def shorter(x: Scalar) -> Scalar:
    """x as one quotient without common factors, where that takes fewer operations and x is not long."""
    if type(x) is not Node or text_size(x) > LONGEST or len(symbols_of((x,))) > MOST:
        return x
    short = cancelled(x, Work.ENTRY)
    return short if operations((short,)).total <= operations((x,)).total else x


def shorter_row(x: Scalar) -> Scalar:
    """A velocity multiplied out, where that halves its operations: cos^2 + sin^2 of a spin that no contact sees."""
    if type(x) is not Node or text_size(x) > LONGEST_ROW or len(symbols_of((x,))) > 2 * MOST:
        return x
    short = readable(x, Work.ENTRY)
    return short if 2 * operations((short,)).total <= operations((x,)).total else x
