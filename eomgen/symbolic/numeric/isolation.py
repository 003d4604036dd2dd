"""Equations, a box -> all their roots in the box, and none is missed.

Equations, a box -> all their roots in the box, each isolated, and none is missed.

Boxes are halved and examined. One is dropped where an equation cannot vanish in it; it holds one root and no other
where Krawczyk's operator maps it into its own inside:

    K(x) = m - C f(m) + (1 - C f'(x)) (x - m),      m the middle of the box, C the inverse of f'(m)

Where f' is singular at a root, boxes about it stay undecided down to the smallest size, a share of how far they are
from 0: equilibria may be micrometres apart, and the range in which they are sought is a kilometre wide.
Source: Neumaier, Interval Methods for Systems of Equations (1990), sections 5.1 and 5.2.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Node, Scalar, jacobian, order
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.arithmetic import INTERVALS, interval_of
from eomgen.symbolic.numeric.evaluation import evaluate

MOST_BOXES = 60_000  # examined in all
MOST_STATEMENTS = 30_000_000  # operations in all, of long equations
TOGETHER = 4096  # boxes of one evaluation
NARROWER = 60  # times that a box about one root is made smaller, while any gets narrower
STILL_NARROWER = 0.9
OF_ROUNDING = 8.0  # times the rounding of an equation at a point
HALF = 0.4837  # where a box is halved: roots at round numbers do not lie on borders
JUMPS = frozenset(("sign", "select", "less", "less_equal"))


@dataclass(frozen=True)
class Isolation:
    """The roots of equations in a box.

    Args:
        roots: the middle of a box about each root, roots x unknowns.
        undecided: the middles of boxes that may hold roots, `halves` how far they reach to each side.
        finished: True if every box was examined.
    """

    roots: np.ndarray
    undecided: np.ndarray
    halves: np.ndarray
    finished: bool


def can_isolate(equations: Sequence[Scalar]) -> bool:
    """True if the equations have no jumps."""
    return not any(node.op in JUMPS for node in order(equations))


def isolated(
    equations: Sequence[Scalar], unknowns: Sequence[Node], values: Mapping[Node, Any], low: np.ndarray, high: np.ndarray
) -> Isolation | None:
    """The roots of as many equations as unknowns in the box from `low` to `high`; None where they have jumps.

    Args:
        values: of every other symbol.
    """
    if not can_isolate(equations):
        return None
    return _Boxes(tuple(equations), tuple(unknowns), dict(values), high - low).examined(low, high)


@dataclass(frozen=True)
class _Boxes:
    equations: tuple[Scalar, ...]
    unknowns: tuple[Node, ...]
    values: Mapping[Node, Any]
    size: np.ndarray

    def examined(self, low: np.ndarray, high: np.ndarray) -> Isolation:
        slopes = tuple(x for row in jacobian(self.equations, self.unknowns) for x in row)
        roots, undecided, halves = ([np.zeros((0, len(low)))] for _ in range(3))
        lows, highs, seen = low[None, :], high[None, :], 0
        most = min(MOST_BOXES, MOST_STATEMENTS // len(order((*self.equations, *slopes))))
        while len(lows) and seen < most:
            seen += len(lows[:TOGETHER])
            a, b, rest_a, rest_b = lows[:TOGETHER], highs[:TOGETHER], lows[TOGETHER:], highs[TOGETHER:]
            a, b = _kept(self._may_vanish(a, b), a, b)
            a, b, alone, empty = self._krawczyk(slopes, a, b)
            roots.append(self._narrowed(slopes, a[alone], b[alone]))
            a, b = _kept(~alone & ~empty, a, b)
            small = np.all(
                b - a <= tolerances.NEAR_ROOT * np.maximum(abs(a + b) / 2, tolerances.COMPUTED * self.size), axis=1
            )
            small |= self._is_vain(slopes, a, b)
            undecided.append((a[small] + b[small]) / 2)
            halves.append((b[small] - a[small]) / 2)
            a, b = self._halved(*_kept(~small, a, b))
            lows, highs = np.concatenate([a, rest_a]), np.concatenate([b, rest_b])
        at, open_, wide = (np.concatenate(each) for each in (roots, undecided, halves))
        return Isolation(at, open_, wide, not len(lows))

    def _at(self, scalars: Sequence[Scalar], a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(lowest, highest) value of each scalar in each box, boxes x scalars."""
        if not len(a):
            return np.zeros((0, len(scalars))), np.zeros((0, len(scalars)))
        given = {node: interval_of(float(x)) for node, x in self.values.items()}
        given |= {node: np.array([a[:, k], b[:, k]]) for k, node in enumerate(self.unknowns)}
        with np.errstate(all="ignore"):  # what is beyond doubles may be anything
            found = evaluate(scalars, given, INTERVALS)
        low, high = np.stack([np.broadcast_to(x, (2, len(a))) for x in found], axis=2).astype(float)
        return low, high

    def _may_vanish(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        low, high = self._at(self.equations, a, b)
        return np.asarray(np.all(~((low > 0) | (high < 0)), axis=1))  # no value: it may

    def _is_vain(self, slopes: Sequence[Scalar], a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Boxes of which halves say no more: an equation is below all doubles, or has no value at the ends and in the
        middle, or changes in a small box by little more than the rounding at a point."""
        middle = (a + b) / 2
        ends = self._at(self.equations, np.concatenate([a, a, middle, b]), np.concatenate([b, a, middle, b]))
        low, high = (x.reshape(4, len(a), len(self.equations)) for x in ends)
        lost = np.any(np.maximum(-low[0], high[0]) <= tolerances.TINIEST, axis=1)
        lost |= ~np.any(np.all(np.isfinite(low) & np.isfinite(high), axis=2), axis=0)
        found = np.all(b - a <= tolerances.NEAR_ROOT * self.size, axis=1)
        rounding = (high[2] - low[2])[found]
        least, most = self._at(slopes, a[found], b[found])
        steepest = np.maximum(-least, most).reshape(-1, len(self.equations), len(self.unknowns))
        changes = np.einsum("bij,bj->bi", steepest, (b - a)[found])
        found[found] = np.any((changes <= OF_ROUNDING * rounding) & np.isfinite(rounding), axis=1)
        return np.asarray(lost | found)

    def _krawczyk(
        self, slopes: Sequence[Scalar], a: np.ndarray, b: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """(low, high) of each box made smaller, True if it holds one root alone, True if it holds none."""
        n = len(self.unknowns)
        middle, radius = (a + b) / 2, (b - a) / 2
        low, high = self._at(slopes, a, b)
        bounded = np.all(np.isfinite(low) & np.isfinite(high), axis=1)
        low, high = (np.where(bounded[:, None], x, np.eye(n).ravel()).reshape(-1, n, n) for x in (low, high))
        center, spread = (low + high) / 2, (high - low) / 2
        bounded &= _regular(center)
        C = np.linalg.inv(np.where(bounded[:, None, None], center, np.eye(n)))
        f_low, f_high = self._at(self.equations, middle, middle)
        bounded &= np.all(np.isfinite(f_low) & np.isfinite(f_high), axis=1)
        f_low, f_high = (np.where(bounded[:, None], x, 0.0) for x in (f_low, f_high))
        K = middle - np.einsum("bij,bj->bi", C, (f_low + f_high) / 2)
        left = np.abs(C) @ spread + np.abs(np.eye(n) - C @ center)
        reach = np.einsum("bij,bj->bi", left, radius) + np.einsum("bij,bj->bi", np.abs(C), (f_high - f_low) / 2)
        inside = np.all((K - reach > a) & (K + reach < b), axis=1)
        new_a = np.where(bounded[:, None], np.maximum(a, K - reach), a)
        new_b = np.where(bounded[:, None], np.minimum(b, K + reach), b)
        empty = np.any(new_a > new_b, axis=1)
        return np.minimum(new_a, new_b), new_b, bounded & inside, empty

    def _narrowed(self, slopes: Sequence[Scalar], a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """The middles of boxes that hold one root each, made as small as the operator and halving make them."""
        for _ in range(NARROWER):
            before, n = b - a, len(a)
            low, high, _, empty = self._krawczyk(slopes, *self._halved(a, b))
            holds = ~empty & self._may_vanish(low, high)
            holds |= np.tile(~holds[:n] & ~holds[n:], 2)
            kept = np.where(holds[:, None], np.stack([low, -high]), np.inf).reshape(2, 2, *a.shape)
            a, b = kept[0].min(axis=0), -kept[1].min(axis=0)
            if not np.any(b - a < STILL_NARROWER * before):
                break
        return np.asarray((a + b) / 2)

    def _halved(self, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Every box cut in two across its longest side."""
        longest = np.argmax((b - a) / self.size, axis=1)[:, None]
        cut = np.take_along_axis(a + HALF * (b - a), longest, axis=1)
        left, right = b.copy(), a.copy()
        np.put_along_axis(left, longest, cut, axis=1)
        np.put_along_axis(right, longest, cut, axis=1)
        return np.concatenate([a, right]), np.concatenate([left, b])


def _kept(chosen: np.ndarray, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return a[chosen], b[chosen]


def _regular(matrices: np.ndarray) -> np.ndarray:
    """True, for each matrix, if it can be inverted without losing all digits."""
    with np.errstate(all="ignore"):
        condition = np.linalg.cond(matrices) if len(matrices) else np.zeros(0)
    return np.isfinite(condition) & (condition < 1e10)


# -------- chebyshev -------------------------------------------------------------------------------------------
# A function of one variable -> polynomials that are it piece by piece: extremes, zeros and integrals between samples.
#
#     g(t) = sum of c_k T_k(s),   s = (2 t - a - b)/(b - a)   in each piece a < t < b
#
# A piece whose last coefficients do not vanish is halved: what is smooth needs few, a kink or a jump is enclosed.


DEGREE = 16
FINE = 4 * DEGREE  # parts of a piece in which extremes and zeros are sought
LAST = 3  # coefficients that vanish where a piece is resolved
MOST_HALVINGS = 50
MOST_PIECES = 200_000

Curve = Callable[[np.ndarray], np.ndarray]


def nodes_between(edges: np.ndarray, degree: int = DEGREE) -> np.ndarray:
    """The extremes of T_n in each piece, both ends among them: pieces x (n + 1), ascending."""
    s = -np.cos(np.pi * np.arange(degree + 1) / degree)
    a, b = edges[:-1, None], edges[1:, None]
    found: np.ndarray = (a + b) / 2 + (b - a) / 2 * s
    found[:, 0], found[:, -1] = edges[:-1], edges[1:]
    return found


@cache
def transform(degree: int) -> np.ndarray:
    """Values at the nodes -> coefficients."""
    s = -np.cos(np.pi * np.arange(degree + 1) / degree)
    return np.asarray(np.linalg.inv(chebyshev.chebvander(s, degree)))


@dataclass(frozen=True)
class ChebyshevPieces:
    """A function, resolved.

    Args:
        g: itself, t n -> n.
        a, b: the ends of the pieces, ascending.
        c: coefficients of each, pieces x (DEGREE + 1).
    """

    g: Curve
    a: np.ndarray
    b: np.ndarray
    c: np.ndarray

    def extreme(self, sign: int) -> tuple[float, float]:
        """(the largest value of sign * g times sign, where)."""
        values = self._looked
        size = np.nanmax(np.abs(values), initial=0.0)
        high = sign * values
        best = np.nanmax(high)
        # between two looks a polynomial of this degree rises by less than a tenth of its change nearby
        change = np.nanmax(high, axis=1) - np.nanmin(high, axis=1)
        candidates = np.flatnonzero(np.nanmax(high, axis=1) + change / 10 >= best - tolerances.SOLVED * size)
        found = [self._peak(int(k), sign) for k in candidates]
        k = int(np.nanargmax([sign * value for value, _ in found]))
        return found[k]

    def _peak(self, k: int, sign: int) -> tuple[float, float]:
        """The largest value in one piece: at an end, or where the polynomial's derivative vanishes."""
        roots = _roots(chebyshev.chebder(self.c[k]))
        t = np.concatenate([[self.a[k], self.b[k]], self._time(k, roots)])
        values = self.g(t)
        best = int(np.nanargmax(sign * values))
        return float(values[best]), float(t[best])

    def zeros(self) -> list[tuple[float, int]]:
        """(where it changes its sign, +1 where it rises), ascending."""
        flat, times = self._looked.ravel(), nodes_between_each(self.a, self.b, FINE).ravel()
        floor = tolerances.SOLVED * np.nanmax(np.abs(flat), initial=0.0)
        signs = np.where(np.abs(flat) <= floor, 0, np.sign(flat))
        standing = np.flatnonzero(signs != 0)
        found = []
        for i, j in pairwise(standing.tolist()):
            if signs[i] != signs[j]:
                found.append((self._zero(times[i], times[j]), int(signs[j])))
        return found

    def _zero(self, before: float, after: float) -> float:
        from scipy.optimize import brentq

        low, high = self.g(np.array([before, after]))
        if not low * high < 0:  # the polynomial's own zero, as near to that of the function as it is resolved
            return float(before + after) / 2
        return float(
            brentq(
                lambda t: float(self.g(np.array([t]))[0]), before, after, xtol=tolerances.BEST, rtol=4 * tolerances.BEST
            )
        )

    def integral(self) -> float:
        """Over all pieces: of T_k over -1 < s < 1 it is 2/(1 - k^2) for even k, else 0."""
        k = np.arange(0, self.c.shape[1], 2)
        return float(np.sum((self.c[:, ::2] @ (2.0 / (1.0 - k**2))) * (self.b - self.a) / 2))

    @property
    def _looked(self) -> np.ndarray:
        """Values of the polynomials, pieces x looks."""
        s = -np.cos(np.pi * np.arange(FINE + 1) / FINE)
        return np.asarray(self.c @ chebyshev.chebvander(s, self.c.shape[1] - 1).T)

    def _time(self, k: int, s: np.ndarray) -> np.ndarray:
        return np.asarray((self.a[k] + self.b[k]) / 2 + (self.b[k] - self.a[k]) / 2 * s)


def nodes_between_each(a: np.ndarray, b: np.ndarray, degree: int) -> np.ndarray:
    """The nodes of `nodes_between`, for pieces that need not follow one another."""
    s = -np.cos(np.pi * np.arange(degree + 1) / degree)
    found: np.ndarray = ((a + b) / 2)[:, None] + ((b - a) / 2)[:, None] * s
    found[:, 0], found[:, -1] = a, b
    return found


def _roots(c: np.ndarray) -> np.ndarray:
    """The real roots in -1 < s < 1 of a sum of T_k."""
    size = np.max(np.abs(c), initial=0.0)
    c = chebyshev.chebtrim(c, tolerances.SOLVED * size)
    if len(c) < 2 or not np.isfinite(size):
        return np.zeros(0)
    roots = chebyshev.chebroots(c)
    return np.asarray(roots.real[(np.abs(roots.imag) < tolerances.CARRIED) & (np.abs(roots.real) < 1)])


def resolved_curve(g: Curve, edges: np.ndarray) -> ChebyshevPieces:
    """A function between the edges, halved until polynomials are it; nan where it has no value in a piece.

    Args:
        g: t n -> n.
        edges: where it may have a kink, ascending.
    """
    a, b = edges[:-1], edges[1:]
    above = np.full(len(a), np.inf)
    done: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    size, narrow, count = 0.0, tolerances.SOLVED * float(edges[-1] - edges[0]), 0
    for halving in range(MOST_HALVINGS + 1):
        t = nodes_between_each(a, b, DEGREE)
        values = g(t.ravel()).reshape(t.shape)
        size = max(size, float(np.nanmax(np.abs(values), initial=0.0)))
        c = values @ transform(DEGREE).T
        left = np.abs(c[:, -LAST:]).max(axis=1)
        noisy = (left <= tolerances.CARRIED * size) & (left > above / 1.5)
        enough = (left <= tolerances.ITERATED * size) | noisy | (b - a <= narrow) | ~np.isfinite(left)
        count += len(a)
        if halving == MOST_HALVINGS or count > MOST_PIECES:
            enough[:] = True
        rough = ~(left <= tolerances.CARRIED * size)
        c[rough] = 0.0  # a jump, or too many to be halved: a straight line from end to end
        c[rough, 0], c[rough, 1] = (
            (values[rough, 0] + values[rough, -1]) / 2,
            (values[rough, -1] - values[rough, 0]) / 2,
        )
        done.append((a[enough], b[enough], c[enough]))
        if enough.all():
            break
        a, b, left = a[~enough], b[~enough], left[~enough]
        middle = (a + b) / 2
        a, b = np.column_stack([a, middle]).ravel(), np.column_stack([middle, b]).ravel()
        above = np.repeat(left, 2)
    starts, ends, coefficients = (np.concatenate(parts) for parts in zip(*done, strict=True))
    order = np.argsort(starts, kind="stable")
    return ChebyshevPieces(g, starts[order], ends[order], coefficients[order])
