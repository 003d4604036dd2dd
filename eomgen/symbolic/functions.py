"""The elementary functions over any scalar: float, exact number, graph node, sympy expression.

The laws of mechanics call these and never `math` or `sympy`, so one text of a law serves all scalars.
"""

from __future__ import annotations

import math
from fractions import Fraction

from eomgen.symbolic.graph import Node

NAMES = {
    "sin": 1, "cos": 1, "tan": 1, "asin": 1, "acos": 1, "atan": 1, "atan2": 2, "sinh": 1, "cosh": 1,
    "tanh": 1, "sqrt": 1, "exp": 1, "log": 1, "abs": 1, "sign": 1, "min": 2, "max": 2,
}  # fmt: skip
"""The functions of the model file's grammar and how many arguments each takes (min and max: two or more)."""


def function(name: str, *args):
    """The function of the table NAMES at its arguments, in the arithmetic of the arguments."""
    for a in args:
        if type(a) is Node:
            return a.graph.call(name, *args)
    if all(isinstance(a, (float, int)) and not isinstance(a, bool) for a in args):
        if name in ("min", "max"):
            return min(args) if name == "min" else max(args)
        if name == "abs":
            return abs(args[0])
        if name == "sign":
            return (args[0] > 0) - (args[0] < 0)
        return getattr(math, name)(*args)
    own = getattr(type(args[0]), f"scalar_{name}", None)
    if own is not None:
        return own(*args)
    return _sympy_function(name, *args)


def _sympy_function(name: str, *args):
    import sympy

    names = {"abs": "Abs", "min": "Min", "max": "Max"}
    return getattr(sympy, names.get(name, name))(*(sympy.sympify(a) for a in args))


def sin(a):
    return 0 if type(a) is int and a == 0 else function("sin", a)


def cos(a):
    return 1 if type(a) is int and a == 0 else function("cos", a)


def sqrt(a):
    """The square root; of an exact square it is exact."""
    if isinstance(a, (int, Fraction)):
        root = Fraction(math.isqrt(Fraction(a).numerator), math.isqrt(Fraction(a).denominator))
        if root * root == a:
            return root.numerator if root.denominator == 1 else root
    return function("sqrt", a)


def over(a, b):
    """a / b, exact when both are exact (Python's int / int would be a float)."""
    if isinstance(a, int) and isinstance(b, int):
        quotient = Fraction(a, b)
        return quotient.numerator if quotient.denominator == 1 else quotient
    return a / b
