"""Steps of arithmetic, and rows of equations, by Arb's balls, ten times as quickly as by mpmath.

A ball holds the true value. Where it is too wide for 50 digits, or there is none, nothing is said, and mpmath decides.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from flint import arb, arb_mat, arf, ctx
from mpmath.libmp import from_man_exp

SOLVING = 256  # bits: those of 50 digits, and as many more as an elimination takes
SURE = 100  # bits of a value, or of its sum with 1, that must be left
WORTH = 2  # operations that a value must save if it is converted, or converted back
ROWS = 8  # from which on elimination is handed over
OPERATIONS: dict[str, Callable[..., Any]] = {
    "neg": operator.neg,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "pow": operator.pow,
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
    if not _value(len(given) + len(outputs), steps):
        return None
    with ctx.workprec(mp.prec):
        known = _balls(given)
        if known is None:
            return None
        _go(known, steps)
        first = len(given)
        return _numbers(((known[i], given[i] if i < first else None) for i in outputs), mp)


def in_balls(mp: Any, given: Sequence[Any], steps: Sequence[_Step], outputs: Sequence[int]) -> list[Any] | None:
    """The same of balls (x, r), |true - x| <= r, for balls; None where one of them has no end."""
    if not _value(len(given) + len(outputs), steps):
        return None
    with ctx.workprec(mp.prec):
        middles, radii = _balls(x for x, _ in given), _balls(r for _, r in given)
        if middles is None or radii is None:
            return None
        known = [x if not r else arb(x, r) for x, r in zip(middles, radii, strict=True)]
        _go(known, steps)
        found = [known[i] for i in outputs]
        if not all(ball.is_finite() for ball in found):
            return None
        return [(_rounded(ball.mid(), mp), _rounded(ball.rad(), mp)) for ball in found]


def _value(handed: int, steps: Sequence[_Step]) -> bool:
    """True if all steps are known operations, and enough of them for the conversion of `handed` values to pay."""
    return len(steps) >= WORTH * handed and {op for _, op, _ in steps} <= OPERATIONS.keys()


def _go(known: list[Any], steps: Sequence[_Step]) -> None:
    """The value of each step behind those that are known."""
    value = known.__getitem__
    for _, op, places in steps:
        known.append(OPERATIONS[op](*map(value, places)))


def solved_by_balls(mp: Any, rows: Sequence[Sequence[Any]]) -> list[Any] | None:
    """x of as many rows [A | b] as unknowns; None where they are few, or A is singular or nearly so."""
    n = len(rows)
    if n < ROWS or len(rows[0]) != n + 1:
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


def sums_by_balls(mp: Any, rows: Sequence[Sequence[Any]], columns: Sequence[Sequence[Any]]) -> list[Any] | None:
    """(row column, |row| |column|) for each row, in a list for each column; None where they are few, or not sure."""
    n, m, k = len(rows), len(columns[0]), len(columns)
    if n < ROWS:
        return None
    with ctx.workprec(SOLVING):
        flat, given = (
            _balls(x for row in rows for x in row),
            _balls(x for row in zip(*columns, strict=True) for x in row),
        )
        if flat is None or given is None:
            return None
        sizes = arb_mat(n, m, list(map(abs, flat))) * arb_mat(m, k, list(map(abs, given)))
        sums = arb_mat(n, m, flat) * arb_mat(m, k, given)
        each = [(A[i, j], None) for j in range(k) for i in range(n) for A in (sums, sizes)]
        found = _numbers(each, mp)
    if found is None:
        return None
    pairs = list(zip(found[::2], found[1::2], strict=True))
    return [pairs[n * j : n * j + n] for j in range(k)]


def _balls(values: Iterable[Any]) -> list[Any] | None:
    """The numbers as balls; None where one is infinite or has no value."""
    found, zero = [], arb(0)
    for x in values:
        if not x:
            found.append(zero)
            continue
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
        found.append(_rounded(ball.mid(), mp))
    return found


def _rounded(x: Any, mp: Any) -> Any:
    """An exact ball as a number of mpmath's."""
    man, exp = x.man_exp()
    return mp.make_mpf(from_man_exp(int(man), int(exp), mp.prec, "n"))
