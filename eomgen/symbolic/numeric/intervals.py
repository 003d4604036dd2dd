"""Intervals: what an expression may be worth anywhere in a box, for many boxes at once.

An interval is (low, high), two arrays with one entry a box. Every function gives an interval that holds its value at
every point of its arguments' intervals: [1, 2] * [-1, 3] = [-2, 6], its ends moved outwards by more than rounding may
have moved them. Where nothing can be said it is (-inf, inf).
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from typing import Any

import numpy as np

from eomgen.symbolic.expression.graph import Node, Number
from eomgen.symbolic.numeric.evaluation import Arithmetic, NoValue, nearest
from eomgen.symbolic.numeric.tolerances import OUTWARDS, TINIEST

Interval = tuple[Any, Any]
LARGEST = sys.float_info.max


def interval(low: Any, high: Any) -> Interval:
    """(low, high) with its ends moved outwards; where an end is no number, anything."""
    bad = np.isnan(low) | np.isnan(high)
    low, high = np.where(bad, -np.inf, low), np.where(bad, np.inf, high)
    return low - OUTWARDS * np.abs(low), high + OUTWARDS * np.abs(high)


def _number(c: Number) -> Interval:
    x = nearest(c)
    if math.isinf(x):
        return (LARGEST, x) if x > 0 else (x, -LARGEST)
    return (x, x) if c == x else interval(x, x)


def _rounded(function: Callable[..., Interval]) -> Callable[..., Interval]:
    """The function with the ends of its values moved outwards."""
    return lambda *arguments: interval(*function(*arguments))


def _mul(a: Interval, b: Interval) -> Interval:
    if a is b:
        return _even(a, 2)
    with np.errstate(invalid="ignore"):
        ends = [np.multiply(x, y) for x in a for y in b]
    ends = [np.where(np.isnan(x), 0.0, x) for x in ends]  # 0 * inf: 0 at every point
    return np.minimum.reduce(ends), np.maximum.reduce(ends)


def _div(a: Interval, b: Interval) -> Interval:
    through_zero = (b[0] <= 0) & (b[1] >= 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        low, high = _mul(a, (np.divide(1.0, b[1]), np.divide(1.0, b[0])))
    return np.where(through_zero, -np.inf, low), np.where(through_zero, np.inf, high)


def _even(a: Interval, n: int) -> Interval:
    """a^n of an even n > 0."""
    x, y = np.abs(a[0]), np.abs(a[1])
    inside = (a[0] <= 0) & (a[1] >= 0)
    return np.where(inside, 0.0, np.minimum(x, y) ** n), np.maximum(x, y) ** n


def _pow(a: Interval, n: Interval) -> Interval:
    if np.ndim(n[0]) or n[0] * n[1] < 0:
        return _any_power(a, n)
    e = float(n[0])
    if n[0] == n[1] and e == int(e):
        whole = abs(int(e))
        power = _even(a, whole) if whole % 2 == 0 and whole else (np.power(a[0], whole), np.power(a[1], whole))
        return _div((1.0, 1.0), power) if e < 0 else power
    ends = [np.maximum(x, 0.0) ** abs(float(k)) for x in a for k in n]  # n an interval too, as 1/3 is
    root = (np.minimum.reduce(ends), np.maximum.reduce(ends))
    return _div((1.0, 1.0), root) if e < 0 else root


def _rising(function: Callable[[Any], Any], low: float = -np.inf, high: float = np.inf) -> Callable[..., Interval]:
    """A function that rises on its domain from `low` to `high`."""

    def of(a: Interval) -> Interval:
        with np.errstate(all="ignore"):
            return interval(function(np.clip(a[0], low, high)), function(np.clip(a[1], low, high)))

    return of


def _any_power(a: Interval, n: Interval) -> Interval:
    """a^n = exp(n log a); of an a that may be negative what is known is that a power is positive."""
    low, high = _rising(np.exp)(_mul(n, _rising(np.log, TINIEST)(a)))
    return np.where(a[0] > 0, low, 0.0), np.where(a[0] > 0, high, np.inf)


def _cos(a: Interval) -> Interval:
    with np.errstate(invalid="ignore"):
        wide = ~(a[1] - a[0] < math.tau)
        top = np.floor(a[1] / math.tau) >= np.ceil(a[0] / math.tau)
        bottom = np.floor((a[1] - math.pi) / math.tau) >= np.ceil((a[0] - math.pi) / math.tau)
        x, y = np.cos(a[0]), np.cos(a[1])
    return np.where(wide | bottom, -1.0, np.minimum(x, y)), np.where(wide | top, 1.0, np.maximum(x, y))


def _sin(a: Interval) -> Interval:
    return _cos(interval(a[0] - math.pi / 2, a[1] - math.pi / 2))


def _tan(a: Interval) -> Interval:
    with np.errstate(invalid="ignore"):
        one_branch = np.floor(a[0] / math.pi + 0.5) == np.floor(a[1] / math.pi + 0.5)
        x, y = np.tan(a[0]), np.tan(a[1])
    return np.where(one_branch, x, -np.inf), np.where(one_branch, y, np.inf)


def _acos(a: Interval) -> Interval:
    low, high = _rising(np.arcsin, -1.0, 1.0)(a)
    return math.pi / 2 - high, math.pi / 2 - low


def _abs(a: Interval) -> Interval:
    x, y = np.abs(a[0]), np.abs(a[1])
    return np.where((a[0] <= 0) & (a[1] >= 0), 0.0, np.minimum(x, y)), np.maximum(x, y)


def _cosh(a: Interval) -> Interval:
    low, high = _abs(a)
    with np.errstate(over="ignore"):
        return np.cosh(low), np.cosh(high)


def _select(condition: Interval, if_true: Interval, if_false: Interval) -> Interval:
    """condition: (1 where it holds all over, 1 where it may hold)."""
    low = np.where(condition[0], if_true[0], np.where(condition[1], np.minimum(if_true[0], if_false[0]), if_false[0]))
    high = np.where(condition[0], if_true[1], np.where(condition[1], np.maximum(if_true[1], if_false[1]), if_false[1]))
    return low, high


def _no_value(x: Node) -> Any:
    raise NoValue(f"'{x.op}' outside its domain")


INTERVALS = Arithmetic(
    "intervals",
    _number,
    {
        "neg": lambda a: (-a[1], -a[0]),
        "add": lambda a, b: interval(a[0] + b[0], a[1] + b[1]),
        "sub": lambda a, b: interval(a[0] - b[1], a[1] - b[0]),
        "mul": _rounded(_mul),
        "div": _rounded(_div),
        "pow": _rounded(_pow),
        "sqrt": _rising(np.sqrt, 0.0),
        "sin": _rounded(_sin),
        "cos": _rounded(_cos),
        "tan": _rounded(_tan),
        "asin": _rising(np.arcsin, -1.0, 1.0),
        "acos": _rounded(_acos),
        "atan": _rising(np.arctan),
        "atan2": lambda a, b: (np.full_like(a[0] + b[0], -math.pi), np.full_like(a[0] + b[0], math.pi)),
        "sampled": lambda t, k: (np.full_like(t[0] + t[1], -np.inf), np.full_like(t[0] + t[1], np.inf)),
        "sinh": _rising(np.sinh),
        "cosh": _rounded(_cosh),
        "tanh": _rising(np.tanh),
        "exp": _rising(np.exp),
        "log": _rising(np.log, 0.0),
        "abs": _abs,
        "sign": lambda a: (np.sign(a[0]), np.sign(a[1])),
        "min": lambda a, b: (np.minimum(a[0], b[0]), np.minimum(a[1], b[1])),
        "max": lambda a, b: (np.maximum(a[0], b[0]), np.maximum(a[1], b[1])),
        "less": lambda a, b: (a[1] < b[0], a[0] < b[1]),
        "less_equal": lambda a, b: (a[1] <= b[0], a[0] <= b[1]),
        "select": _select,
        "pi": lambda: interval(math.pi, math.pi),
    },
    _no_value,
)
