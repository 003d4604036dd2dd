"""Steps of arithmetic, and rows of equations, at 50 digits by Arb's balls, ten times as quickly as by mpmath.

A ball holds the true value. Where it is too wide, or there is none, nothing is said, and mpmath decides.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from mpmath.libmp import from_man_exp

try:
    from flint import arb, arb_mat, arf, ctx

    HAS_BALLS = True
except ImportError:  # no wheel for this platform: mpmath decides
    HAS_BALLS = False

SOLVING = 256  # bits: those of 50 digits, and as many more as an elimination takes
SURE = 100  # bits of a value, or of one beside 1, that must be left
WORTH = 2  # operations that a value must save that is handed over, or handed back
ROWS = 8  # from which on elimination is handed over
OPERATIONS: dict[str, Callable[..., Any]] = {
    "neg": operator.neg,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "sqrt": lambda x: x.sqrt(),
    "sin": lambda x: x.sin(),
    "cos": lambda x: x.cos(),
    "pi": lambda: arb.pi(),
}

_Step = tuple[Any, str, tuple[int, ...]]


def by_balls(mp: Any, given: Sequence[Any], steps: Sequence[_Step], outputs: Sequence[int]) -> list[Any] | None:
    """The values at the places `outputs`, those given first, then one a step; None where they are not sure.

    They are worked with the digits of mpmath's context, no more: what cancels to the last of them there does so here.

    Args:
        mp: mpmath's context, of whose numbers and digits the values are.
        given: numbers of mpmath's, or exact ones.
        steps: each its operation, and the places of its arguments.
    """
    if (
        not HAS_BALLS
        or len(steps) < WORTH * (len(given) + len(outputs))
        or not {op for _, op, _ in steps} <= OPERATIONS.keys()
    ):
        return None
    with ctx.workprec(mp.prec):
        known = _balls(given)
        if known is None:
            return None
        value = known.__getitem__
        for _, op, places in steps:
            known.append(OPERATIONS[op](*map(value, places)))
        first = len(given)
        return _numbers(((known[i], given[i] if i < first else None) for i in outputs), mp)


def solved_by_balls(mp: Any, rows: Sequence[Sequence[Any]]) -> list[Any] | None:
    """x of as many rows [A | b] as unknowns; None where they are few, or A is singular or nearly so."""
    n = len(rows)
    if not HAS_BALLS or n < ROWS or len(rows[0]) != n + 1:
        return None
    with ctx.workprec(SOLVING):
        flat = _balls(x for row in rows for x in row)
        if flat is None:
            return None
        try:
            found = arb_mat(n, n, [flat[i * (n + 1) + j] for i in range(n) for j in range(n)]).solve(
                arb_mat(n, 1, [flat[i * (n + 1) + n] for i in range(n)])
            )
        except ZeroDivisionError:
            return None
        return _numbers(((found[i, 0], None) for i in range(n)), mp)


def _balls(values: Iterable[Any]) -> list[Any] | None:
    """The numbers as balls; None where one is infinite or has no value."""
    found = []
    for x in values:
        parts = getattr(x, "_mpf_", None)
        if parts is None:
            found.append(arb(x.numerator) / x.denominator if hasattr(x, "numerator") else arb(x))
        else:
            sign, man, exp, _ = parts
            if not man and exp:
                return None
            found.append(arb(arf((-man if sign else man, exp))))
    return found


def _numbers(balls: Iterable[tuple[Any, Any]], mp: Any) -> list[Any] | None:
    """The middles, with the digits of mpmath's context; what was given as it was given."""
    found, least = [], arb(arf((1, -SURE)))
    for ball, as_given in balls:
        if as_given is not None:
            found.append(as_given)
            continue
        if not ball.is_finite() or (ball.rel_accuracy_bits() < SURE and not ball.rad() < least):
            return None
        man, exp = ball.mid().man_exp()
        found.append(mp.make_mpf(from_man_exp(int(man), int(exp), mp.prec, "n")))
    return found
