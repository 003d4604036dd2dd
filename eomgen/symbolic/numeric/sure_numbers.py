"""Exact expressions -> their numbers: the one door by which a number leaves an exact form.

A form is evaluated in balls (see `balls`) of 50 digits, then of 120, and so on until the ball is narrow compared with
its number: so no digit is lost to what cancels in it, (1 - cos x)/x^2 at x = 1e-9. What is still undecided with the
most digits is 0 where it is tiny beyond all measure, and has no number otherwise.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import isfinite, nan

from eomgen.symbolic.expression import Node, Scalar, symbols_of
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.arithmetic import NONE, Ball, balls
from eomgen.symbolic.numeric.digits import ball_of, precision
from eomgen.symbolic.numeric.evaluation import Arithmetic, evaluate

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
