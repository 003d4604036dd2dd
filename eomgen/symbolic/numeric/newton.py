"""Equations -> a root nearby, by steps of least change; the one iteration of the package, in any number of digits.

    f(x) + A d = 0,  |d| least:   d = -A^+ f,   A = df/dx      x <- x + d      until |f| is small enough

Redundant equations do no harm (A^+ passes over directions in which they all but do not resist). Where the way is long
it is damped, (A^T A + |f|^2 1) d = -A^T f, which converges as fast and does not leap along directions that only an open
loop resists. A is in floats: each step adds the digits of a float to x, whose own digits are those of f.
Source: Yamashita & Fukushima, On the rate of convergence of the Levenberg-Marquardt method (2001).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Generic, Protocol, TypeVar

import numpy as np

from eomgen.records import dataclass
from eomgen.symbolic.numeric.evaluation import NoValue
from eomgen.symbolic.numeric.tolerances import BEST, LEAST_CHANGE
from eomgen.symbolic.numeric.work import check_patience

X = TypeVar("X")


class Sought(Protocol[X]):
    """Equations in a place x of any kind: an array, a state, a point of a search."""

    def left(self, x: X, /) -> Sequence[Any] | np.ndarray:
        """f(x)."""

    def slopes(self, x: X, /) -> np.ndarray:
        """df/dx, equations x unknowns."""

    def moved(self, x: X, step: Sequence[Any], /) -> X:
        """x + step; the step has the digits of f."""


@dataclass(frozen=True)
class Root(Generic[X]):
    """Where an iteration ended.

    Args:
        x: the place.
        left: |f| before the last step, its largest entry; nan where f or its slopes have no value.
        met: whether it is a root.
    """

    x: X
    left: float
    met: bool


@dataclass(frozen=True)
class Newton:
    """How a root is sought.

    Args:
        enough: |f| at a root.
        still: a step that ends the search at a root too, where |f| has no measure of its own.
        steps: at most.
        smallest: singular values of A below this part of the largest count as 0.
        damped: by |f|, while that is below 1.
        stalls: |f| below which a root is reached when it falls to no `share` of itself any more: redundant equations
            differ by rounding.
        again: one step more at the root, for its last digits.
        keeps: A is kept while |f| falls by this factor in a step.
        double: of a step, to within which the next is half of it: at a double root it is taken twice.
        longest: step.
        least: (the slopes, -f) -> d, where change has a measure of its own; None: |d| is least.
    """

    enough: float = 0.0
    still: float = 0.0
    steps: int = 60
    smallest: float = LEAST_CHANGE
    damped: bool = False
    stalls: float = 0.0
    share: float = 0.5
    again: bool = False
    keeps: float = 0.0
    double: float = 0.0
    longest: float = math.inf
    least: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None

    def root(self, sought: Sought[X], start: X) -> Root[X]:
        """The root to which the steps lead from the start; not met where they lead to none, or leave the domain."""
        x, before, size, left = start, start, math.inf, math.inf
        A: np.ndarray | None = None
        last: np.ndarray | None = None
        try:
            for _ in range(self.steps):
                check_patience()
                f = sought.left(x)
                size = max(map(abs, f), default=0)
                if size <= self.enough:
                    return Root(self._again(sought, x, f, size), float(size), True)
                if left < self.stalls and size >= self.share * left:
                    return Root(before, float(left), True)
                if A is None or size > self.keeps * left:
                    A = sought.slopes(x)
                unit = self._unit_step(A, f, size)
                step = float(size) * unit
                longest = float(np.max(np.abs(step), initial=0.0))
                far = self._factor(step, last, longest)
                before, left, last = x, size, step
                x = sought.moved(x, [size * float(far * d) for d in unit])
                if longest <= self.still and self.still:
                    return Root(x, float(size), True)
        except (NoValue, ZeroDivisionError, np.linalg.LinAlgError):
            return Root(x, math.nan, False)
        return Root(x, float(size), False)

    def _unit_step(self, A: np.ndarray, f: Sequence[Any] | np.ndarray, size: Any) -> np.ndarray:
        """d / |f|: the entries of f may be below what floats can add to x.

        Raises:
            NoValue: A has entries without a value.
        """
        if not np.all(np.isfinite(A)):
            raise NoValue("the equations have no slopes")
        right = np.array([-float(y / size) for y in f])
        if self.least is not None:
            return self.least(A, right)
        if not self.damped:
            return np.asarray(np.linalg.lstsq(A, right, rcond=self.smallest)[0])
        n = A.shape[1]
        damped = np.vstack([A, min(float(size), 1.0) * np.eye(n)])
        return np.asarray(np.linalg.lstsq(damped, np.append(right, np.zeros(n)), rcond=None)[0])

    def _factor(self, step: np.ndarray, last: np.ndarray | None, longest: float) -> float:
        halves = last is not None and np.linalg.norm(2 * step - last) <= self.double * np.linalg.norm(last)
        if self.double and longest and halves:
            return 2.0
        return min(1.0, self.longest / longest) if longest else 1.0

    def _again(self, sought: Sought[X], x: X, f: Sequence[Any] | np.ndarray, size: Any) -> X:
        if not self.again or not size:
            return x
        return sought.moved(x, [size * float(d) for d in self._unit_step(sought.slopes(x), f, size)])


def least_left(
    left: Callable[[np.ndarray], np.ndarray],
    start: np.ndarray,
    slopes: Callable[[np.ndarray], np.ndarray] | None = None,
) -> Root[np.ndarray]:
    """The place nearby where |f|^2 is least, in floats: a root, or how near the equations come to one.

    Args:
        slopes: df/dx (None: by differences).
    """
    from scipy.optimize import least_squares

    found = least_squares(left, start, slopes or "2-point", xtol=BEST, ftol=BEST, gtol=BEST)
    size = float(np.max(np.abs(found.fun), initial=0.0))
    return Root(found.x, size, size <= BEST)
