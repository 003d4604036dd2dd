"""Arithmetics that know their error: balls, intervals, Arb's balls, the prime field."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any

import numpy as np

from eomgen.symbolic.expression import Node, Number, sampled_of
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.evaluation import PRIME, Arithmetic, NoValue, nearest

# -------- balls -----------------------------------------------------------------------------------------------
# Balls: a number of many digits and how far from it the true one may be, (x, r) with |true - x| <= r.
#
# Rounding of each operation widens its ball; what cancels shows as a ball that is wide compared with its number. r = 0
# of a number that is exact; r = inf where nothing can be said: 1/x with 0 in the ball of x. x = nan: surely no value.


Ball = tuple[Any, Any]
SLACK = 4  # units in the last place that one operation may lose, and the estimate of r too


@cache
def balls(digits: int, *, last: bool = False) -> Arithmetic:
    """Balls around numbers of so many digits.

    Args:
        last: True if what no precision could distinguish counts as equal, so that branches and signs are decided.
    """
    return _Balls(digits, last).arithmetic


class _Balls:
    """The operations on balls of one precision; the arguments are those of `balls`."""

    def __init__(self, digits: int, last: bool) -> None:
        from mpmath.ctx_mp import MPContext

        self.mp, self.digits, self.last = MPContext(), digits, last
        self.mp.dps = digits
        self.unit = SLACK * self.mp.eps
        self.zero: Ball = (self.mp.mpf(0), self.mp.mpf(0))
        self.none: Ball = (self.mp.nan, self.mp.mpf(0))
        self.open: Ball = (self.mp.mpf(0), self.mp.inf)

    @property
    def arithmetic(self) -> Arithmetic:
        from eomgen.symbolic.numeric.sure_digits import in_balls

        mp = self.mp
        table: dict[str, Callable[..., Ball]] = {
            "neg": lambda a: (-a[0], a[1]),
            "add": lambda a, b: self._rounded(a[0] + b[0], a[1] + b[1]),
            "sub": lambda a, b: self._rounded(a[0] - b[0], a[1] + b[1]),
            "mul": self._mul,
            "div": self._div,
            "pow": self._pow,
            "sqrt": self._sqrt,
            "sin": lambda a: self._rounded(mp.sin(a[0]), a[1]),
            "cos": lambda a: self._rounded(mp.cos(a[0]), a[1]),
            "tan": lambda a: self._div(self._rounded(mp.sin(a[0]), a[1]), self._rounded(mp.cos(a[0]), a[1])),
            "asin": lambda a: self._on(mp.asin, a, -1, 1),
            "acos": lambda a: self._on(mp.acos, a, -1, 1),
            "atan": lambda a: self._rounded(mp.atan(a[0]), a[1]),
            "atan2": self._atan2,
            "sinh": lambda a: self._on(mp.sinh, a),
            "cosh": lambda a: self._rounded(mp.cosh(a[0]), mp.sinh(abs(a[0]) + a[1]) * a[1]),
            "tanh": lambda a: self._rounded(mp.tanh(a[0]), a[1]),
            "exp": lambda a: self._on(mp.exp, a),
            "log": self._log,
            "abs": lambda a: (abs(a[0]), a[1]),
            "sign": lambda a: self._selected(self._less(self.zero, a), self.one, self._minus_if_negative(a)),
            "min": lambda a, b: (min(a[0], b[0]), max(a[1], b[1])),
            "max": lambda a, b: (max(a[0], b[0]), max(a[1], b[1])),
            "less": self._less,
            "less_equal": lambda a, b: self._not(self._less(b, a)),
            "sampled": self._sampled,
        }
        guarded = {op: self._guarded(function) for op, function in table.items()}
        own: dict[str, Callable[..., Ball]] = {"select": self._selected, "pi": lambda: self._rounded(+mp.pi, 0)}
        by_arb = partial(in_balls, mp)
        return Arithmetic(f"balls of {self.digits} digits", self.number, guarded | own, lambda x: self.none, by_arb)

    @property
    def one(self) -> Ball:
        return (self.mp.mpf(1), self.mp.mpf(0))

    def number(self, c: Number | float) -> Ball:
        """An exact number; a double, as of an outline that is drawn, is one."""
        if isinstance(c, float):
            return (self.mp.mpf(c), self.mp.mpf(0))
        above = self.mp.mpf(c.numerator)
        if c.denominator == 1 and above == c.numerator:
            return (above, self.mp.mpf(0))
        return self._rounded(above / c.denominator, 0)

    def _rounded(self, x: Any, r: Any) -> Ball:
        return (x, r + self.unit * abs(x))

    def _guarded(self, function: Callable[..., Ball]) -> Callable[..., Ball]:
        """Makes an operation propagate arguments that have no value, or an unbounded error, without being called."""

        def of(*arguments: Ball) -> Ball:
            if any(x != x for x, _ in arguments):
                return self.none
            return self.open if any(r == self.mp.inf for _, r in arguments) else function(*arguments)

        return of

    # -- operations --------------------------------------------------------------------------------

    def _mul(self, a: Ball, b: Ball) -> Ball:
        (x, r), (y, s) = a, b
        return self._rounded(x * y, abs(x) * s + abs(y) * r + r * s) if r or s else self._rounded(x * y, 0)

    def _div(self, a: Ball, b: Ball) -> Ball:
        (x, r), (y, s) = a, b
        if abs(y) <= s:
            return self.none if not y and not s else self.open
        quotient = x / y
        return self._rounded(quotient, (r + abs(quotient) * s) / (abs(y) - s))

    def _sqrt(self, a: Ball) -> Ball:
        x, r = a
        if x > r:
            root = self.mp.sqrt(x)
            return self._rounded(root, r / root)
        return (self.mp.mpf(0), self.mp.sqrt(abs(x) + r)) if x + r >= 0 else self.none

    def _log(self, a: Ball) -> Ball:
        x, r = a
        if x > r:
            return self._rounded(self.mp.log(x), r / (x - r))
        return self.open if x + r > 0 else self.none

    def _on(self, function: Callable[[Any], Any], a: Ball, low: Any = None, high: Any = None) -> Ball:
        """A function that rises, or falls, from `low` to `high`: its ends say how far it reaches."""
        x, r = a
        if low is not None and (x + r < low or x - r > high):
            return self.none
        inside = [y if low is None else min(max(y, low), high) for y in (x, x - r, x + r)]
        middle, *ends = (function(y) for y in inside)
        return self._rounded(middle, max(abs(end - middle) for end in ends))

    def _pow(self, a: Ball, b: Ball) -> Ball:
        (x, r), (n, s) = a, b
        if not s and self.mp.isint(n):
            size = self.mp.power(abs(x) + r, abs(n) - 1) * abs(n) * r if n else self.mp.mpf(0)
            power = self._rounded(self.mp.power(x, abs(n)), size)
            return power if n >= 0 else self._div(self.one, power)
        if x > r:
            return self._on(self.mp.exp, self._mul(b, self._log(a)))
        if x + r < 0:
            return self.none
        reach = self.mp.power(abs(x) + r, n - s) if n > s else self.mp.inf  # at the edge 0^n = 0
        return self.none if reach == self.mp.inf and not r else (self.mp.mpf(0), reach)

    def _atan2(self, a: Ball, b: Ball) -> Ball:
        (y, r), (x, s) = a, b
        if x <= s and abs(y) <= r and (r or s or not x):
            return self.open if r or s else self.zero
        least = self.mp.hypot(max(abs(y) - r, 0), max(abs(x) - s, 0))
        return self._rounded(self.mp.atan2(y, x), (r + s) / least if r or s else 0)

    def _sampled(self, t: Ball, k: Ball) -> Ball:
        """Samples at t: as far apart as they are at the ends of its ball; twice, for what lies in between."""
        sampled, (x, r) = sampled_of(k[0]), t
        values = [sampled.at(y, lambda c: self.number(c)[0], +self.mp.pi) for y in (x, x - r, x + r)]
        return self._rounded(
            values[0], 2 * max(abs(y - values[0]) for y in values[1:]) + 9 * self.unit * abs(values[0])
        )

    # -- decisions ---------------------------------------------------------------------------------

    def _less(self, a: Ball, b: Ball) -> Ball:
        """1 or 0; (1/2, 1/2) where both may be."""
        (x, r), (y, s) = a, b
        if abs(x - y) > r + s or (not r and not s):
            return self.one if x < y else self.zero
        return self.zero if self.last else (self.mp.mpf(0.5), self.mp.mpf(0.5))

    def _not(self, a: Ball) -> Ball:
        return (1 - a[0], a[1])

    def _minus_if_negative(self, a: Ball) -> Ball:
        return self._selected(self._less(a, self.zero), (-self.one[0], self.one[1]), self.zero)

    def _selected(self, condition: Ball, if_true: Ball, if_false: Ball) -> Ball:
        """One of the two; both in one ball where the condition is open."""
        if condition[0] != condition[0]:
            return self.none
        if not condition[1]:
            return if_true if condition[0] else if_false
        (x, r), (y, s) = if_true, if_false
        return (x, max(r, abs(x - y) + s)) if x == x and y == y else self.open


# -------- intervals -------------------------------------------------------------------------------------------
# Intervals: the values that an expression may take anywhere in a box, for many boxes at once.
#
# An interval is a 2 x n array, its low ends and its high ones, a column a box; of what is the same in all boxes 2 x 1.
# Every function gives an interval that holds its value at every point of its arguments' intervals:
# [1, 2] * [-1, 3] = [-2, 6], its ends moved outwards by more than rounding may have moved them. Where nothing can be
# said it is (-inf, inf). What a function does beyond doubles it does without a word: numpy's warnings are the caller's.


Interval = np.ndarray
LARGEST = sys.float_info.max
OUTWARDS_BY = np.array([[-tolerances.OUTWARDS], [tolerances.OUTWARDS]])
ANYTHING = np.array([[-np.inf], [np.inf]])


def interval(ends: Interval) -> Interval:
    """The interval with its ends moved outwards; where an end is no number, anything."""
    least = np.minimum.reduce(ends, axis=None, initial=np.inf)
    if least != least:
        ends = np.where(np.isnan(ends).any(axis=0), ANYTHING, ends)
    return np.asarray(ends + OUTWARDS_BY * np.abs(ends))


def interval_of(x: float) -> Interval:
    """The interval about a double that is itself rounded."""
    return interval(np.array([[x], [x]]))


def _number(c: Number) -> Interval:
    x = nearest(c)
    if math.isinf(x):
        return np.array([[LARGEST], [x]] if x > 0 else [[x], [-LARGEST]])
    return np.array([[x], [x]]) if c == x else interval_of(x)


def _rounded(function: Callable[..., Interval]) -> Callable[..., Interval]:
    """The function with the ends of its values moved outwards."""
    return lambda *arguments: interval(function(*arguments))


def _pair(low: Any, high: Any) -> Interval:
    return np.array([low, high])


def _mul(a: Interval, b: Interval) -> Interval:
    if a is b:
        return _even(a, 2)
    ends = a[:, None] * b
    ends = ends.reshape(4, ends.shape[2])
    low, high = np.minimum.reduce(ends), np.maximum.reduce(ends)
    least = np.minimum.reduce(low, initial=np.inf)
    if least != least:  # 0 * inf: 0 at every point
        ends = np.where(np.isnan(ends), 0.0, ends)
        low, high = np.minimum.reduce(ends), np.maximum.reduce(ends)
    return _pair(low, high)


def _div(a: Interval, b: Interval) -> Interval:
    through_zero = (b[0] <= 0) & (b[1] >= 0)
    return np.where(through_zero, ANYTHING, _mul(a, np.divide(1.0, b[::-1])))


def _even(a: Interval, n: int) -> Interval:
    """a^n of an even n > 0."""
    sizes = np.abs(a)
    inside = (a[0] <= 0) & (a[1] >= 0)
    return _pair(
        np.where(inside, 0.0, np.minimum.reduce(sizes) ** n),
        np.maximum.reduce(sizes) ** n,
    )


def _pow(a: Interval, n: Interval) -> Interval:
    if n.shape[1] != 1 or n[0, 0] * n[1, 0] < 0:
        return _any_power(a, n)
    e = float(n[0, 0])
    if n[0, 0] == n[1, 0] and e == int(e):
        whole = abs(int(e))
        power = _even(a, whole) if whole % 2 == 0 and whole else np.power(a, whole)
        return _div(ONE, power) if e < 0 else power
    ends = [np.maximum(x, 0.0) ** abs(float(k)) for x in a for k in n[:, 0]]  # n an interval too, as 1/3 is
    root = _pair(np.minimum.reduce(ends), np.maximum.reduce(ends))
    return _div(ONE, root) if e < 0 else root


ONE = np.array([[1.0], [1.0]])


def _rising(function: Callable[[Any], Any], low: float = -np.inf, high: float = np.inf) -> Callable[..., Interval]:
    """A function that rises on its domain from `low` to `high`."""
    return lambda a: interval(function(np.clip(a, low, high)))


def _any_power(a: Interval, n: Interval) -> Interval:
    """a^n = exp(n log a); of an a that may be negative what is known is that a power is positive."""
    low, high = _rising(np.exp)(_mul(n, _rising(np.log, tolerances.TINIEST)(a)))
    return _pair(np.where(a[0] > 0, low, 0.0), np.where(a[0] > 0, high, np.inf))


def _cos(a: Interval) -> Interval:
    wide = ~(a[1] - a[0] < math.tau)
    top = np.floor(a[1] / math.tau) >= np.ceil(a[0] / math.tau)
    bottom = np.floor((a[1] - math.pi) / math.tau) >= np.ceil((a[0] - math.pi) / math.tau)
    values = np.cos(a)
    return _pair(
        np.where(wide | bottom, -1.0, np.minimum.reduce(values)),
        np.where(wide | top, 1.0, np.maximum.reduce(values)),
    )


def _sin(a: Interval) -> Interval:
    return _cos(interval(a - math.pi / 2))


def _tan(a: Interval) -> Interval:
    branches = np.floor(a / math.pi + 0.5)
    return np.where(branches[0] == branches[1], np.tan(a), ANYTHING)


def _acos(a: Interval) -> Interval:
    return math.pi / 2 - _rising(np.arcsin, -1.0, 1.0)(a)[::-1]


def _abs(a: Interval) -> Interval:
    sizes = np.abs(a)
    inside = (a[0] <= 0) & (a[1] >= 0)
    return _pair(np.where(inside, 0.0, np.minimum.reduce(sizes)), np.maximum.reduce(sizes))


def _select(condition: Interval, if_true: Interval, if_false: Interval) -> Interval:
    """condition: (1 where it holds all over, 1 where it may hold)."""
    either = _pair(np.minimum(if_true[0], if_false[0]), np.maximum(if_true[1], if_false[1]))
    return np.where(condition[0], if_true, np.where(condition[1], either, if_false))


def _no_value(x: Node) -> Any:
    raise NoValue(f"'{x.op}' outside its domain")


INTERVALS = Arithmetic(
    "intervals",
    _number,
    {
        "neg": lambda a: -a[::-1],
        "add": _rounded(np.add),
        "sub": lambda a, b: interval(a - b[::-1]),
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
        "atan2": lambda a, b: np.broadcast_to([[-math.pi], [math.pi]], (a + b).shape),
        "sampled": lambda t, k: np.broadcast_to(ANYTHING, t.shape),
        "sinh": _rising(np.sinh),
        "cosh": _rounded(lambda a: np.cosh(_abs(a))),
        "tanh": _rising(np.tanh),
        "exp": _rising(np.exp),
        "log": _rising(np.log, 0.0),
        "abs": _abs,
        "sign": np.sign,
        "min": np.minimum,
        "max": np.maximum,
        "less": lambda a, b: _pair(a[1] < b[0], a[0] < b[1]),
        "less_equal": lambda a, b: _pair(a[1] <= b[0], a[0] <= b[1]),
        "select": _select,
        "pi": lambda: interval_of(math.pi),
    },
    _no_value,
)


# -------- modular ---------------------------------------------------------------------------------------------
# Linear equations in the prime field: exact linear dependence.


def follows(rows: Sequence[Sequence[int]], row: Sequence[int]) -> bool:
    """True if the row is a combination of the others, modulo the prime."""
    left = list(row)
    for pivot, k in _echelon(rows):
        _take_out(left, pivot, k)
    return not any(x % PRIME for x in left)


def _echelon(rows: Sequence[Sequence[int]]) -> list[tuple[list[int], int]]:
    """(row with 1 at its pivot, place of the pivot), each without the pivots before it."""
    found: list[tuple[list[int], int]] = []
    for row in rows:
        left = [x % PRIME for x in row]
        for pivot, k in found:
            _take_out(left, pivot, k)
        k = next((k for k, x in enumerate(left) if x), -1)
        if k >= 0:
            inverse = pow(left[k], -1, PRIME)
            found.append(([x * inverse % PRIME for x in left], k))
    return found


def _take_out(row: list[int], pivot: Sequence[int], k: int) -> None:
    """row - row[k] * pivot, in place."""
    factor = row[k]
    if factor:
        row[:] = [(x - factor * y) % PRIME for x, y in zip(row, pivot, strict=True)]
