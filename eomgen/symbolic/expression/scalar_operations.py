"""The operations of the model file's grammar over any scalar, exact where their operands are.

An exact number with an exact number gives an exact number; a function of exact numbers is taken in the
arithmetic of `pi`, the one constant that every set of values must hold: a node of the graph, a sympy
expression or a float. What has no value (1/0, sqrt(-1), a power beyond all size) raises `Undefined`.
"""

from __future__ import annotations

import math
from math import isqrt
from typing import Any, overload

from eomgen.symbolic.expression import functions
from eomgen.symbolic.expression.graph import Node, Number, Scalar
from eomgen.symbolic.expression.rational import EXACT, Fraction
from eomgen.symbolic.expression.splines import Sampled, number_of_sampled

AnyScalar = Any
LARGEST_MAGNITUDE = 1000  # in bits: an exact number still fits a double
MOST_BITS = 5_000  # of a numerator or denominator: 9^9^9 is refused, not computed


class Undefined(ArithmeticError):
    """The operation has no value at these operands, said in words."""


def is_exact(a: AnyScalar) -> bool:
    """True for whole numbers and fractions."""
    return isinstance(a, EXACT)


def bounded(a: AnyScalar) -> AnyScalar:
    """a itself; a fraction that is whole as an int; an exact number beyond all size raises Undefined."""
    if type(a) is int:
        if a.bit_length() > LARGEST_MAGNITUDE:
            raise Undefined("the number is too large")
    elif type(a) is Fraction:
        upper, lower = a.numerator.bit_length(), a.denominator.bit_length()
        if upper - lower > LARGEST_MAGNITUDE or max(upper, lower) > MOST_BITS:
            raise Undefined("the number is too large")
        if a.denominator == 1:
            return a.numerator
    return a


def add(a: AnyScalar, b: AnyScalar) -> AnyScalar:
    return bounded(a + b)


def subtract(a: AnyScalar, b: AnyScalar) -> AnyScalar:
    return bounded(a - b)


def multiply(a: AnyScalar, b: AnyScalar) -> AnyScalar:
    return bounded(a * b)


def divide(a: AnyScalar, b: AnyScalar) -> AnyScalar:
    if type(b) is not Node and b == 0:
        raise Undefined("division by zero")
    return bounded(functions.over(a, b))


def power_value(a: AnyScalar, b: AnyScalar, pi: AnyScalar = None) -> AnyScalar:
    """a ^ b; of exact numbers it is exact where it can be (4^(1/2) = 2)."""
    if is_exact(b) and b.denominator == 1:
        return _whole_power(a, b.numerator)
    if is_exact(a):
        if type(b) is Fraction:
            return _root(a, b, pi)
        if type(b) is Node:
            return b.graph.pow(a, b)
        if not isinstance(b, float):  # Fraction ** sympy number would be a float
            a = a + (b - b)
    value = a**b
    if isinstance(value, complex):
        raise Undefined("a broken power of a negative number")
    return value


def _whole_power(a: AnyScalar, n: int) -> AnyScalar:
    if n < 0:
        return divide(1, _whole_power(a, -n))
    if is_exact(a) and a in (-1, 0, 1):
        return a**n
    bits = max(a.numerator.bit_length(), a.denominator.bit_length()) if is_exact(a) else 2
    if (bits - 1) * n > MOST_BITS or n > MOST_BITS:
        raise Undefined("the power is too large")
    return bounded(a**n)


def _root(a: int | Fraction, b: Fraction, pi: AnyScalar) -> AnyScalar:
    """a ^ (m/n) of an exact number, in the arithmetic of pi."""
    if a == 0 and b < 0:
        raise Undefined(f"division by zero in 0^({b})")
    if a < 0:
        raise Undefined("a broken power of a negative number")
    if type(pi) is Node:
        return pi.graph.pow(a, b)
    if b.denominator == 2:
        return _whole_power(function_value("sqrt", (a,), pi), b.numerator)
    if pi is None or isinstance(pi, float):
        try:
            return float(a) ** float(b)
        except OverflowError:
            raise Undefined("the number is too large") from None
    return (a + (pi - pi)) ** b


@overload
def through_samples(sampled: Sampled, t: Node, pi: Any = None) -> Scalar: ...
@overload
def through_samples(sampled: Sampled, t: Any, pi: Any = None) -> Any: ...
def through_samples(sampled: Sampled, t: AnyScalar, pi: AnyScalar = None) -> AnyScalar:
    """The value at t of a function through samples; in the graph it stays one operation."""
    if type(t) is Node:
        return t.graph.call("sampled", t, number_of_sampled(sampled))
    if is_exact(t):
        value = sampled.spline.at(Fraction(t))
        return bounded(value) if sampled.pi_power == 0 else value * (math.pi if pi is None else pi) ** sampled.pi_power
    if isinstance(t, float):
        return sampled.at(t, float, math.pi)
    return sampled.chosen(t, functions.selected, pi)


def function_value(name: str, args: tuple[AnyScalar, ...], pi: AnyScalar = None) -> AnyScalar:
    """An elementary function at its arguments; min and max take two or more."""
    if name in ("min", "max"):
        value = args[0]
        for other in args[1:]:
            value = _function(name, (value, other), pi)
        return value
    return _function(name, args, pi)


def _function(name: str, args: tuple[AnyScalar, ...], pi: AnyScalar) -> AnyScalar:
    if not all(is_exact(a) for a in args):
        if all(is_exact(a) or isinstance(a, float) for a in args):
            return functions.function(name, *(float(a) for a in args))
        return functions.function(name, *args)
    exact = _exact_value(name, args)
    if exact is not None:
        return exact
    if type(pi) is Node:
        return pi.graph.call(name, *args)
    if pi is None or isinstance(pi, float):
        return functions.function(name, *(float(a) for a in args))
    zero = pi - pi
    return functions.function(name, *(a + zero for a in args))


def _exact_value(name: str, args: tuple[Number, ...]) -> Number | None:
    """The function's value where it is an exact number for every arithmetic, else None."""
    a = args[0]
    if name == "abs":
        return -a if a < 0 else a
    if name == "sign":
        return (a > 0) - (a < 0)
    if name in ("min", "max"):
        return min(args) if name == "min" else max(args)
    if name == "sqrt":
        if a < 0:
            raise Undefined(f"sqrt({a}) is not a real number")
        root = Fraction(isqrt(a.numerator), isqrt(a.denominator))
        return bounded(root) if root * root == a else None
    if a == 0 and name in ("sin", "tan", "asin", "atan", "sinh", "tanh"):
        return 0
    if a == 0 and name in ("cos", "cosh", "exp"):
        return 1
    return 0 if a == 1 and name in ("log", "acos") else None
