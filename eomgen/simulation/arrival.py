"""x' = f(s, x), start, g -> the first s after the start at which g(s, x) = 0, in numbers.

s is the time, or any parameter along a path. Zeros at which g only touches 0 are found too. g is integrated beside x,
roughly, so that no step is too long for it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from eomgen.errors import RunFailed
from eomgen.symbolic.numeric.tolerances import (
    BEST,
    COMPUTED,
    DIFFERENCE_STEP,
    FINE_RUN,
    FINEST_RUN,
    ITERATED,
    ROOT,
    ROUGH_RUN,
    ROUNDING,
    SAME_PLACE,
    SUMMED,
)

FunctionOnPath = Callable[[float, np.ndarray], Any]

SAMPLES = 16  # of g in one step
MOST_STEPS = 4000
POLISHINGS = 3


@dataclass(frozen=True)
class Arrival:
    """Where g is 0: s and the state there."""

    s: float
    x: np.ndarray


class NeverReached(RunFailed):
    """g stays away from 0 as far as it was followed."""


def first_arrival(
    f: FunctionOnPath,
    g: FunctionOnPath,
    s: float,
    x: Any,
    *,
    sense: int = 1,
    valid: FunctionOnPath | None = None,
    within: float = np.inf,
) -> Arrival:
    """The first zero of g after the start; a zero at the start is none.

    Args:
        f: x' = f(s, x).
        g: a number.
        s, x: the start.
        sense: in which s runs, +1 or -1.
        valid: positive as long as the path may be followed.
        within: how far s may go from the start.
    Raises:
        NeverReached: the path ends, or goes on for long, before there is one.
    """
    x = np.array(x, dtype=float)
    if not np.all(np.isfinite(f(s, x))):
        raise NeverReached("the motion has no finite rates at the start")
    path = _Path(f, g)
    first = float(g(s, x))
    with np.errstate(all="ignore"):
        solver = path.solver(s, x, first, s + sense * within)
        while solver.status == "running" and path.steps < MOST_STEPS:
            begin, old = solver.t, solver.y[:-1].copy()
            solver.step()
            if solver.status == "failed" or not np.all(np.isfinite(solver.y[:-1])):
                break
            found = path.in_step(solver, old, first if begin == s else None)
            if valid is not None and not _holds(valid, solver, found):
                raise NeverReached(f"the motion turns back before, at {solver.t:.6g}")
            if found is not None:
                return found
    raise NeverReached(f"the condition is not met as far as the motion was followed, up to {solver.t:.6g}")


def _holds(valid: FunctionOnPath, solver: Any, found: Arrival | None) -> bool:
    """Whether the path may be followed up to the zero, or to the end of the step."""
    if found is not None:
        return float(valid(found.s, found.x)) > -COMPUTED
    return float(valid(solver.t, solver.y[:-1])) > 0


@dataclass
class _Path:
    """What is known of g along the path."""

    f: FunctionOnPath
    g: FunctionOnPath
    steps: int = 0
    largest: float = 0.0
    last: float = 0.0  # the last value of g that is no rounding; 0 before there is one

    def solver(self, s: float, x: np.ndarray, first: float, end: float) -> Any:
        """The integrator of (x, g), g with a tolerance of its own."""
        from scipy.integrate import DOP853

        def both(s: float, y: np.ndarray) -> np.ndarray:
            rate = np.asarray(self.f(s, y[:-1]), dtype=float)
            slope = self._slope(Arrival(s, y[:-1]), rate)
            return np.append(rate, slope if np.isfinite(slope) else 0.0)

        steepness = abs(self._slope(Arrival(s, x), np.asarray(self.f(s, x), dtype=float)))
        scale = max(abs(first), 0.01 * steepness, COMPUTED)
        atol = np.append(np.full(len(x), FINE_RUN), ROUGH_RUN * (scale if np.isfinite(scale) else 1.0))
        return DOP853(both, s, np.append(x, 0.0), end, rtol=FINE_RUN, atol=atol)

    def in_step(self, solver: Any, old: np.ndarray, at_start: float | None) -> Arrival | None:
        """The first zero in the step just made.

        Args:
            old: the state where it began.
            at_start: g at the very start, where the step began there.
        """
        self.steps += 1
        whole = solver.dense_output()

        def dense(z: float) -> np.ndarray:
            return whole(z)[:-1]

        s = np.linspace(solver.t_old, solver.t, SAMPLES + 1)
        values = np.array([float(self.g(z, dense(z))) for z in s])
        if not np.all(np.isfinite(values)):
            return None
        self.largest = max(self.largest, float(np.max(np.abs(values))))
        if at_start is not None and abs(at_start) > ITERATED * self.largest:
            self.last = at_start
        for k in range(1, len(s)):
            found = self._between(dense, s, values, k)
            if found is not None:
                return self._polished(solver.t_old, old, found)
            if abs(values[k]) > ITERATED * self.largest:
                self.last = values[k]
        return None

    def _between(self, dense: Any, s: np.ndarray, values: np.ndarray, k: int) -> float | None:
        """A zero between the samples k - 1 and k, or an extremum at 0 around k - 1."""
        from scipy.optimize import brentq

        if np.sign(self.last) * np.sign(values[k]) < 0:
            if np.sign(values[k - 1]) * np.sign(values[k]) < 0:
                return float(brentq(lambda z: float(self.g(z, dense(z))), s[k - 1], s[k], xtol=BEST, rtol=ROOT))
            return float(s[k - 1])
        a, b = abs(values[k - 2]) if k > 1 else np.inf, abs(values[k])
        if self.last and k > 1 and abs(values[k - 1]) <= min(a, b):
            return self._touching(dense, *sorted((s[k - 2], s[k])))
        return None

    def _touching(self, dense: Any, low: float, high: float) -> float | None:
        """Where g has an extremum that is 0."""
        from scipy.optimize import brentq, minimize_scalar

        def size(z: float) -> float:
            return abs(float(self.g(z, dense(z))))

        def slope(z: float) -> float:
            return float(self.g(z + h, dense(z + h)) - self.g(z - h, dense(z - h)))

        near = minimize_scalar(size, bounds=(low, high), method="bounded", options={"xatol": SUMMED})
        if near.fun > COMPUTED * self.largest:
            return None
        h = 1e-3 * (high - low)
        left, right = max(low, near.x - 10 * h), min(high, near.x + 10 * h)
        return float(brentq(slope, left, right, xtol=BEST)) if slope(left) * slope(right) < 0 else float(near.x)

    def _polished(self, begin: float, x: np.ndarray, s: float) -> Arrival:
        """The state at s by steps that end there, then Newton's method on g."""
        best = Arrival(s, self._carried(begin, x, s))
        for _ in range(POLISHINGS):
            rate = np.asarray(self.f(best.s, best.x), dtype=float)
            value, slope = float(self.g(best.s, best.x)), self._slope(best, rate)
            step = -value / slope if slope else 0.0
            if value == 0 or not np.isfinite(step) or abs(step) > SAME_PLACE * (1 + abs(best.s)):
                break  # there, or at an extremum, where g has no slope
            best = Arrival(best.s + step, best.x + step * rate)
        return best

    def _slope(self, at: Arrival, rate: np.ndarray) -> float:
        """dg/ds by a central difference along the path."""
        fastest = float(np.max(np.abs(rate) / (1 + np.abs(at.x)), initial=0.0))
        h = DIFFERENCE_STEP / max(fastest, 1e-3)
        ahead, behind = self.g(at.s + h, at.x + h * rate), self.g(at.s - h, at.x - h * rate)
        return float(ahead - behind) / (2 * h)

    def _carried(self, begin: float, x: np.ndarray, end: float) -> np.ndarray:
        from scipy.integrate import solve_ivp

        if end == begin:
            return x
        run = solve_ivp(self.f, (begin, end), x, method="DOP853", rtol=FINEST_RUN, atol=ROUNDING)
        return run.y[:, -1]
