"""Normal reactions linear in the frictions -> |N| of contacts that hold on all sides of a line in space.

    N_r = n_r + sum over s of G_rs P_s,   P_r = |N_r| = sqrt(N_r1^2 + N_r2^2)

A contact that no other one feeds back on has a quadratic equation, with one positive root as long as |G_rr| < 1, beyond
which rigid bodies may jam: P = (n.g + sqrt(1 - g^2) sqrt(n^2 + (n.g)^2/(1 - g^2)))/(1 - g^2), without a value there.
Contacts that press one another are solved together by Newton's steps, as many as leave rounding alone; what they do not
reach has no value.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import gradient, substituted
from eomgen.symbolic.expression.functions import function, inner, over, selected, sqrt
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50
from eomgen.symbolic.solve.cramer import components
from eomgen.symbolic.solve.linear import ValuesAt

STEPS = 6  # of Newton's method; each doubles the number of right digits
REACHED = Fraction(1, 10**9)  # of all |N|, by which one may be off; what converges is off by rounding
LEAST = Fraction(1, 10**30)  # an N below it is none [N]

EqualPushes = tuple[Scalar, ...]


@dataclass(frozen=True)
class _Pressed:
    """Contacts that press one another: N_r = n_r + sum G_rs P_s."""

    n: tuple[EqualPushes, ...]
    G: tuple[tuple[EqualPushes, ...], ...]

    def normals(self, P: Sequence[Scalar]) -> list[EqualPushes]:
        return [_carried(n, zip(row, P, strict=True)) for n, row in zip(self.n, self.G, strict=True)]


def sizes(pairs: Mapping[Node, EqualPushes], values: ValuesAt) -> dict[Node, Scalar]:
    """The value of each |N|, by its symbol.

    Args:
        pairs: (N_1, N_2) of each contact, linear in the symbols of all.
        values: of scalars at one generic state, in an arithmetic of many digits.
    """
    symbols = tuple(pairs)
    n = [substituted(pair, dict.fromkeys(symbols, 0)) for pair in pairs.values()]
    G = _slopes(pairs, symbols, values)
    needs = [[s for s, g in enumerate(row) if not all(map(is_zero, g))] for row in G]
    found: dict[int, Scalar] = {}
    for group in components(needs):
        given = tuple(_carried(n[r], ((G[r][s], P) for s, P in found.items())) for r in group)
        pressed = _Pressed(given, tuple(tuple(G[r][s] for s in group) for r in group))
        found |= zip(group, _together(pressed), strict=True)
    return {symbol: found[r] for r, symbol in enumerate(symbols)}


def _slopes(pairs: Mapping[Node, EqualPushes], symbols: tuple[Node, ...], values: ValuesAt) -> list[list[EqualPushes]]:
    """G_rs, what vanishes at a generic state left out."""
    rows = [[gradient(N, symbols) for N in pair] for pair in pairs.values()]
    flat = [abs(x) for x in values([g for row in rows for slopes in row for g in slopes])]
    least, worth = ZERO_AT_50 * max(flat, default=0), iter(flat)
    kept = [[[g if next(worth) > least else 0 for g in slopes] for slopes in row] for row in rows]
    return [list(zip(*row, strict=True)) for row in kept]


def _carried(n: EqualPushes, shares: Any) -> EqualPushes:
    """n + sum g P"""
    for g, P in shares:
        n = tuple(x if is_zero(y) else x + y * P for x, y in zip(n, g, strict=True))
    return n


def _alone(n: EqualPushes, g: EqualPushes) -> Scalar:
    """P = |n + g P|; no value where |g| >= 1."""
    square, along, rest = inner(n, n), inner(n, g), 1 - inner(g, g)
    if is_zero(along):
        return sqrt(over(square, rest))
    return over(along + sqrt(rest) * sqrt(square + over(along * along, rest)), rest)


def _together(pressed: _Pressed) -> list[Scalar]:
    """P_r = |n_r + sum G_rs P_s|, by Newton's method from the roots of each alone."""
    each = range(len(pressed.n))
    P = [_alone(pressed.n[r], pressed.G[r][r]) for r in each]
    if len(P) == 1:
        return P
    for _ in range(STEPS):
        N = pressed.normals(P)
        length = [sqrt(inner(x, x)) for x in N]
        safe = [function("max", x, LEAST) for x in length]
        rows = [[int(r == s) - over(inner(N[r], pressed.G[r][s]), safe[r]) for s in each] for r in each]
        step = _solved(rows, [x - p for x, p in zip(length, P, strict=True)])
        P = [p + d for p, d in zip(P, step, strict=True)]
    return _reached(pressed, P)


def _solved(rows: Sequence[Sequence[Scalar]], right: Sequence[Scalar]) -> list[Scalar]:
    """Of rows near those of the unit matrix: elimination in their order."""
    if not rows:
        return []
    (first, *_), *_ = rows
    shares = [over(row[0], first) for row in rows[1:]]
    below = [
        [x - k * y for x, y in zip(row[1:], rows[0][1:], strict=True)] for k, row in zip(shares, rows[1:], strict=True)
    ]
    others = _solved(below, [b - k * right[0] for k, b in zip(shares, right[1:], strict=True)])
    return [over(right[0] - inner(rows[0][1:], others), first), *others]


def _reached(pressed: _Pressed, P: Sequence[Scalar]) -> list[Scalar]:
    """The values where they are |N|; elsewhere they are divided by 0, and there are none."""
    allowed = REACHED * sum((function("abs", p) for p in P), start=LEAST)
    off = [function("abs", p - sqrt(inner(N, N))) for p, N in zip(P, pressed.normals(P), strict=True)]
    return [over(p, selected(x, allowed, 1, 0)) for p, x in zip(P, off, strict=True)]
