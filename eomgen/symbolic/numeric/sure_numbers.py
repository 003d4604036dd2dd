"""Exact expressions -> their numbers: the one door by which a number leaves an exact form.

A form is evaluated in balls (see `balls`) of 30 digits, then of 60, and so on until the ball is narrow compared with
its number: so no digit is lost to what cancels in it, (1 - cos x)/x^2 at x = 1e-9. What is still undecided with the
most digits is 0 where it is tiny beyond all measure, and has no number otherwise.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import isfinite, nan
from typing import Any

from eomgen.symbolic.expression import Fraction, Node, Scalar, symbols_of
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.arithmetic import Ball, balls
from eomgen.symbolic.numeric.evaluation import evaluate

PRECISIONS = (30, 60, 120, 240, 480)  # digits
VANISHED = "1e-100"  # what is smaller, as far as 480 digits can tell, is 0: a root of a root of nothing is 1e-120 wide


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
    for digits in PRECISIONS:
        undecided = [k for k, value in enumerate(found) if value is None]
        for k, ball in zip(undecided, _at(digits, [wanted[k] for k in undecided], values or {}), strict=True):
            found[k] = _decided(ball, last=digits == PRECISIONS[-1])
        if None not in found:
            break
    return [nan if value is None else value for value in found]


def _decided(ball: Ball, *, last: bool) -> float | None:
    """The number in the ball, nan where it has none; None where the ball is too wide to say."""
    x, r = ball
    if x != x:
        return nan
    if r <= tolerances.ROUNDING * abs(x):
        return float(x) + 0.0 if isfinite(float(x)) else nan
    return 0.0 if last and abs(x) + r < type(x)(VANISHED) else None


def _at(digits: int, scalars: Sequence[Scalar], values: Mapping[Node, Scalar | float]) -> list[Any]:
    """The balls at one precision."""
    arithmetic = balls(digits, last=digits == PRECISIONS[-1])
    used = frozenset(symbols_of(scalars))
    requested = {x: v for x, v in values.items() if x.op != "symbol" or x in used}
    number = {x: Fraction(v) if isinstance(v, float) and isfinite(v) else v for x, v in requested.items()}
    known = {x: v for x, v in number.items() if not isinstance(v, float)}
    state: dict[Node, Ball] = dict.fromkeys(requested, (nan, 0))
    state |= dict(zip(known, evaluate(tuple(known.values()), {}, arithmetic), strict=True))
    return evaluate(tuple(scalars), state, arithmetic)
