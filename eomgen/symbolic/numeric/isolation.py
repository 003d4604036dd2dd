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

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

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
