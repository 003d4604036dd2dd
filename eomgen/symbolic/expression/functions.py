"""The elementary functions over any scalar: float, exact number, graph node, sympy expression.

The laws of mechanics call these and never `math` or `sympy`, so one text of a law serves all scalars.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any, overload

from eomgen.symbolic.expression.graph import CONSTANTS, Node, Scalar, is_zero
from eomgen.symbolic.expression.rational import EXACT, Fraction, known_to_sympy

NAMES = {
    "sin": 1,
    "cos": 1,
    "tan": 1,
    "asin": 1,
    "acos": 1,
    "atan": 1,
    "atan2": 2,
    "sinh": 1,
    "cosh": 1,
    "tanh": 1,
    "sqrt": 1,
    "exp": 1,
    "log": 1,
    "abs": 1,
    "sign": 1,
    "min": 2,
    "max": 2,
}
"""The functions of the model file's grammar and how many arguments each takes (min and max: two or more)."""


@overload
def function(name: str, *args: Scalar) -> Scalar: ...
@overload
def function(name: str, *args: Any) -> Any: ...
def function(name: str, *args: Any) -> Any:
    """The function of the table NAMES at its arguments, in the arithmetic of the arguments.

    At exact numbers it stays exact: sqrt(4) is 2, sqrt(2) a node of the graph CONSTANTS.
    """
    for a in args:
        if type(a) is Node:
            return a.graph.call(name, *args)
    if all(isinstance(a, EXACT) for a in args):
        return CONSTANTS.call(name, *args)
    if all(isinstance(a, (float, *EXACT)) for a in args):
        return _at_floats(name, *map(float, args))
    own = getattr(type(args[0]), f"scalar_{name}", None)
    if own is not None:
        return own(*args)
    return _sympy_function(name, *args)


def _at_floats(name: str, *args: float) -> float:
    if name in ("min", "max"):
        return min(args) if name == "min" else max(args)
    if name == "abs":
        return abs(args[0])
    if name == "sign":
        return float((args[0] > 0) - (args[0] < 0))
    return float(getattr(math, name)(*args))


def _sympy_function(name: str, *args: Any) -> Any:
    import sympy

    known_to_sympy()

    names = {"abs": "Abs", "min": "Min", "max": "Max"}
    return getattr(sympy, names.get(name, name))(*(sympy.sympify(a, strict=True) for a in args))


@overload
def sin(a: Scalar) -> Scalar: ...
@overload
def sin(a: Any) -> Any: ...
def sin(a: Any) -> Any:
    return 0 if type(a) is int and a == 0 else function("sin", a)


@overload
def cos(a: Scalar) -> Scalar: ...
@overload
def cos(a: Any) -> Any: ...
def cos(a: Any) -> Any:
    return 1 if type(a) is int and a == 0 else function("cos", a)


@overload
def sqrt(a: Scalar) -> Scalar: ...
@overload
def sqrt(a: Any) -> Any: ...
def sqrt(a: Any) -> Any:
    return function("sqrt", a)


@overload
def over(a: Scalar, b: Scalar) -> Scalar: ...
@overload
def over(a: Any, b: Any) -> Any: ...
def over(a: Any, b: Any) -> Any:
    """a / b, exact when both are exact (Python's int / int would be a float)."""
    if isinstance(a, int) and isinstance(b, int):
        quotient = Fraction(a, b)
        return quotient.numerator if quotient.denominator == 1 else quotient
    return a / b


@overload
def inner(a: Iterable[Scalar], b: Iterable[Scalar]) -> Scalar: ...
@overload
def inner(a: Iterable[Any], b: Iterable[Any]) -> Any: ...
def inner(a: Iterable[Any], b: Iterable[Any]) -> Any:
    """The sum of a_k b_k; what is multiplied by 0 is not looked at."""
    return sum((x * y for x, y in zip(a, b, strict=True) if not is_zero(x) and not is_zero(y)), start=0)


def combined(factors: Iterable[Any], rows: Iterable[Sequence[Any]]) -> tuple[Any, ...]:
    """The sum of f_k row_k; what is multiplied by 0 is not looked at. At least one row."""
    total: list[Any] = []
    for factor, row in zip(factors, rows, strict=True):
        total = total or [0] * len(row)
        if not is_zero(factor):
            for i, x in enumerate(row):
                if not is_zero(x):
                    total[i] = total[i] + factor * x
    return tuple(total)


def selected(a: Any, bound: Any, if_below: Any, if_above: Any) -> Any:
    """if_below where a <= bound, else if_above: a piecewise law over any scalar."""
    for x in (a, bound):
        if type(x) is Node:
            return x.graph.select(x.graph.call("less_equal", a, bound), if_below, if_above)
    if all(isinstance(x, (float, *EXACT)) for x in (a, bound)):
        return if_below if a <= bound else if_above
    import sympy

    known_to_sympy()

    return sympy.Piecewise((if_below, a <= bound), (if_above, True))
