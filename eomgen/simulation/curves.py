"""A function of one variable -> polynomials that are it piece by piece: extremes, zeros and integrals between samples.

    g(t) = sum of c_k T_k(s),   s = (2 t - a - b)/(b - a)   in each piece a < t < b

A piece whose last coefficients do not vanish is halved: what is smooth needs few, a kink or a jump is enclosed.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from eomgen.frozen import dataclass
from eomgen.symbolic.numeric import tolerances

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
