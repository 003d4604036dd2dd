"""Arithmetics that know their error: balls, intervals, linear dependence in the prime field; numbers of exact forms."""

from __future__ import annotations

import math
import operator
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from math import isfinite, nan
from typing import Any

import numpy as np
from flint import arb, arf, ctx

from eomgen.symbolic.expression import Node, Number, Sampled, Scalar, symbols_of
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.digits import BITS, ZERO, LongReal, ball_of, precision
from eomgen.symbolic.numeric.evaluation import PRIME, Arithmetic, NoValue, evaluate, nearest

# -------- balls -----------------------------------------------------------------------------------------------
# Balls, Arb's: numbers of many digits that know how far from them the true ones may be.
#
# What cancels shows as a ball that is wide compared with its number. Where nothing can be said the ball has no end;
# where there surely is no value it is nan. Arb says nan for both, so that functions with a domain look first.


Ball = arb
UNIT, NONE, OPEN = arb(1), arb.nan(), arb(0, float("inf"))
EITHER = arb(0.5, 0.5)  # of a condition that is open
SLACK = 2  # bits, the last ones of a number, that its rounding may have changed


@cache
def balls(*, last: bool = False) -> Arithmetic:
    """Balls with the digits of the precision in force.

    Args:
        last: True if what no precision could distinguish counts as equal, so that branches and signs are decided.
    """
    less = _less_at_last if last else _less
    table: dict[str, Callable[..., Ball]] = {
        "neg": operator.neg,
        "add": operator.add,
        "sub": operator.sub,
        "mul": operator.mul,
        "div": _ball_quotient,
        "pow": _ball_power,
        "sqrt": _ball_root,
        "tan": lambda a: _ball_quotient(a.sin(), a.cos()),
        "asin": lambda a: _between(arb.asin, a),
        "acos": lambda a: -_between(lambda x: -x.acos(), a),
        "atan2": _angle_at_last if last else _angle,
        "log": _ball_logarithm,
        "abs": abs,
        "sign": lambda a: _selected(less(ZERO, a), UNIT, _selected(less(a, ZERO), -UNIT, ZERO)),
        "less": less,
        "less_equal": lambda a, b: 1 - less(b, a),
        "sampled": _sampled,
        **{op: getattr(arb, op) for op in "sin cos atan sinh cosh tanh exp min max".split()},
    }
    guarded = {op: _guarded(function) for op, function in table.items()}
    return Arithmetic("balls", ball_of, guarded | {"select": _selected, "pi": arb.pi}, lambda x: NONE)


def in_balls(
    scalars: Sequence[Scalar],
    state: Mapping[Node, Any],
    radii: Mapping[Node, float] | None = None,
    *,
    last: bool = False,
    bits: int = BITS,
) -> list[Ball]:
    """Values at a state of numbers of 50 digits, in balls.

    Args:
        radii: how far from the true ones values may be.
        last: as of `balls`.
        bits: with which they are worked.
    """
    with precision(bits):
        known = {x: ball_of(v, (radii or {}).get(x, 0)) for x, v in state.items()}
        return evaluate(scalars, known, balls(last=last))


def is_rounding(scalars: Sequence[Scalar], state: Mapping[Node, Any]) -> bool:
    """True if all scalars may be 0 at a state whose numbers of 50 digits are rounded themselves."""
    known = {x: ball_of(v) for x, v in state.items()}
    known = {x: arb(ball, abs(ball) * _unit(SLACK)) for x, ball in known.items()}
    return all(ball.contains(0) for ball in evaluate(scalars, known, balls()))


def _unit(slack: int) -> Ball:
    """A number that changes the last bits of 1 alone."""
    return arb(arf((1, slack - ctx.prec)))


def _guarded(function: Callable[..., Ball]) -> Callable[..., Ball]:
    """Makes an operation propagate arguments that have no value, or an unbounded error, without being called."""

    def of(*arguments: Ball) -> Ball:
        if all(x.is_finite() for x in arguments):
            value = function(*arguments)
            return value if value.is_finite() or value.is_nan() else OPEN
        return NONE if any(x.is_nan() for x in arguments) else OPEN

    return of


# -- functions with a domain -----------------------------------------------------------------------


def _ball_quotient(a: Ball, b: Ball) -> Ball:
    if b.contains(0):
        return NONE if b.is_zero() else OPEN
    return a / b


def _ball_root(a: Ball) -> Ball:
    if a >= 0:
        return a.sqrt()
    return NONE if a < 0 else arb(0, a.abs_upper().sqrt().upper())


def _ball_logarithm(a: Ball) -> Ball:
    if a > 0:
        return a.log()
    return OPEN if a.upper() > 0 else NONE


def _between(function: Callable[[Ball], Ball], a: Ball) -> Ball:
    """A function that rises from -1 to 1."""
    if a > 1 or a < -1:
        return NONE
    if -1 <= a <= 1:
        return function(a)
    return function(a.lower().max(-UNIT)).union(function(a.upper().min(UNIT)))


def _ball_power(a: Ball, b: Ball) -> Ball:
    if b.is_exact() and b.is_integer():
        power = a ** abs(b)
        return power if b >= 0 else _ball_quotient(UNIT, power)
    if a > 0:
        return a**b
    if a < 0 or (a.is_zero() and not b > 0):
        return NONE
    return arb(0, (a.abs_upper() ** b).abs_upper()) if b > 0 else OPEN  # at the edge 0^n = 0


def _angle(a: Ball, b: Ball) -> Ball:
    if a.contains(0) and b.contains(0):
        return ZERO if a.is_zero() and b.is_zero() else OPEN
    return arb.atan2(a, b)


def _angle_at_last(a: Ball, b: Ball) -> Ball:
    """The same; what may lie on either side of the half line to -x lies on it."""
    on = a.contains(0) and b < 0
    return arb(arb.pi(), (a / b).abs_upper()) if on and not a.is_zero() else _angle(a, b)


def _sampled(t: Ball, k: Ball) -> Ball:
    """Samples at t: as far apart as they are at the ends of its ball; twice, for what lies in between."""
    sampled = Sampled.of(float(k))

    def at(y: Ball) -> Ball:
        value: LongReal = sampled.at(LongReal(y), lambda c: LongReal(ball_of(c).mid()), LongReal(arb.pi().mid()))
        return value.ball

    value = at(t.mid())
    away = max((abs(at(y.mid()) - value) for y in (t.lower(), t.upper())), key=float)
    return arb(value, 2 * away + abs(value) * _unit(2 * SLACK))


# -- decisions -------------------------------------------------------------------------------------


def _less(a: Ball, b: Ball) -> Ball:
    """1 or 0; both where both may be."""
    if a < b:
        return UNIT
    return ZERO if a >= b else EITHER


def _less_at_last(a: Ball, b: Ball) -> Ball:
    return UNIT if a < b else ZERO


def _selected(condition: Ball, if_true: Ball, if_false: Ball) -> Ball:
    """One of the two; both in one ball where the condition is open."""
    if condition.is_nan():
        return NONE
    if condition.is_exact():
        return if_false if condition.is_zero() else if_true
    if if_true.is_nan() or if_false.is_nan():
        return OPEN
    return if_true.union(if_false)


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


# -------- sure numbers ----------------------------------------------------------------------------------------
# Exact expressions -> their numbers: the one door by which a number leaves an exact form.
#
# A form is evaluated in balls (see `balls`) of 50 digits, then of 120, and so on until the ball is narrow compared with
# its number: so no digit is lost to what cancels in it, (1 - cos x)/x^2 at x = 1e-9. What is still undecided with the
# most digits is 0 where it is tiny beyond all measure, and has no number otherwise.

PRECISIONS = (169, 400, 800, 1600)  # bits: 50, 120, 240, 480 digits


def number_of(x: Scalar, values: Mapping[Node, Scalar | float] | None = None) -> float:
    """The number of an exact form to double precision; nan where it has none.

    Args:
        values: of its symbols: exact numbers, exact constants such as sqrt(2), doubles as the numbers that they are.
    """
    return numbers_of((x,), values)[0]


def numbers_of(scalars: Iterable[Scalar], values: Mapping[Node, Scalar | float] | None = None) -> list[float]:
    """The numbers of several exact forms, as of `number_of`."""
    wanted = tuple(scalars)
    found: list[float | None] = [None] * len(wanted)
    for bits in PRECISIONS:
        last, undecided = bits == PRECISIONS[-1], [k for k, value in enumerate(found) if value is None]
        with precision(bits):
            each = _at([wanted[k] for k in undecided], values or {}, balls(last=last))
        for k, ball in zip(undecided, each, strict=True):
            found[k] = _decided(ball, last=last)
        if None not in found:
            break
    return [nan if value is None else value for value in found]


def _decided(ball: Ball, *, last: bool) -> float | None:
    """The number in the ball, nan where it has none; None where the ball is too wide to say."""
    if ball.is_nan():
        return nan
    if ball.rad() <= tolerances.ROUNDING * abs(ball.mid()):
        return float(ball) + 0.0 if isfinite(float(ball)) else nan
    return 0.0 if last and ball.abs_upper() < tolerances.VANISHED else None


def _at(scalars: Sequence[Scalar], values: Mapping[Node, Scalar | float], arithmetic: Arithmetic) -> list[Ball]:
    """The balls at the precision in force."""
    used = frozenset(symbols_of(scalars))
    requested = {x: v for x, v in values.items() if x.op != "symbol" or x in used}
    known = {x: ball_of(v) if isinstance(v, float) else v for x, v in requested.items()}
    forms = {x: v for x, v in known.items() if not isinstance(v, Ball)}
    state = known | dict(zip(forms, evaluate(tuple(forms.values()), {}, arithmetic), strict=True))
    return evaluate(tuple(scalars), {x: v if v.is_finite() else NONE for x, v in state.items()}, arithmetic)
