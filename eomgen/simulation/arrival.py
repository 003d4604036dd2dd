"""x' = f(s, x), start, g -> the first s after the start at which g(s, x) = 0, in numbers.

s is the time, or any parameter along a path. Zeros at which g only touches 0 are found too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from eomgen.errors import RunFailed

Function = Callable[[float, np.ndarray], Any]

TOLERANCE = 1e-12  # of one step
SAMPLES = 16  # of g in one step
MOST_STEPS = 4000
NOISE = 1e-10  # of g, against its largest value, below which it may be rounding
TOUCHES = 1e-9  # of g at an extremum, against its largest value, below which it is zero there
POLISHINGS = 3


@dataclass(frozen=True)
class Arrival:
    """Where g is 0: s and the state there."""

    s: float
    x: np.ndarray


class NeverReached(RunFailed):
    """g stays away from 0 as far as it was followed."""


def first_arrival(
    f: Function, g: Function, s: float, x: np.ndarray,
    *, sense: int = 1, valid: Function | None = None, within: float = np.inf,
) -> Arrival:  # fmt: skip
    """The first zero of g after the start; a zero at the start is none.

    Args:
        f: x' = f(s, x).
        g: a number.
        s, x: the start.
        sense: in which s runs, +1 or -1.
        valid: positive as long as the path may be followed.
        within: a distance |s| beyond which it is not sought.
    Raises:
        NeverReached: the path ends, or goes on for long, before there is one.
    """
    path = _Path(f, g, sense)
    solver = _solver(f, s, x, sense, TOLERANCE)
    first, last = float(g(s, x)), s
    for _ in range(MOST_STEPS):
        old = solver.y.copy()
        with np.errstate(all="ignore"):
            solver.step()
        if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
            break
        found = path.in_step(solver, old, starting=last == s, at_start=first)
        if valid is not None and not _holds(valid, solver, found):
            raise NeverReached(f"the motion turns back before, at {solver.t:.6g}")
        if found is not None:
            return found
        last = solver.t
        if abs(last) > within:
            break
    raise NeverReached(f"it is not met as far as the motion was followed, up to {solver.t:.6g}")


def _holds(valid: Function, solver: Any, found: Arrival | None) -> bool:
    """Whether the path may be followed up to the zero, or to the end of the step."""
    if found is not None:
        return float(valid(found.s, found.x)) > -TOUCHES
    return float(valid(solver.t, solver.y)) > 0


def _solver(f: Function, s: float, x: np.ndarray, sense: int, tolerance: float) -> Any:
    from scipy.integrate import DOP853

    with np.errstate(all="ignore"):
        return DOP853(f, s, np.array(x, dtype=float), sense * np.inf, rtol=tolerance, atol=tolerance)


@dataclass
class _Path:
    """What is known of g along the path."""

    f: Function
    g: Function
    sense: int
    largest: float = 0.0
    last: float = 0.0  # the last value of g that is no rounding; 0 before there is one

    def in_step(self, solver: Any, old: np.ndarray, *, starting: bool, at_start: float) -> Arrival | None:
        """The first zero in the step just made."""
        dense = solver.dense_output()
        s = np.linspace(solver.t_old, solver.t, SAMPLES + 1)
        values = np.array([float(self.g(z, dense(z))) for z in s])
        if not np.all(np.isfinite(values)):
            return None
        self.largest = max(self.largest, float(np.max(np.abs(values))))
        if starting and abs(at_start) > NOISE * self.largest:
            self.last = at_start
        for k in range(1, len(s)):
            found = self._between(dense, s, values, k)
            if found is not None:
                return self._polished(solver.t_old, old, found)
            if abs(values[k]) > NOISE * self.largest:
                self.last = values[k]
        return None

    def _between(self, dense: Any, s: np.ndarray, values: np.ndarray, k: int) -> float | None:
        """A zero between the samples k - 1 and k, or an extremum at 0 around k - 1."""
        from scipy.optimize import brentq

        if self.last * values[k] < 0:
            if values[k - 1] * values[k] < 0:
                return float(brentq(lambda z: float(self.g(z, dense(z))), s[k - 1], s[k], xtol=1e-15, rtol=8.9e-16))
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

        near = minimize_scalar(size, bounds=(low, high), method="bounded", options={"xatol": 1e-13})
        if near.fun > TOUCHES * self.largest:
            return None
        h = 1e-3 * (high - low)
        left, right = max(low, near.x - 10 * h), min(high, near.x + 10 * h)
        return float(brentq(slope, left, right, xtol=1e-15)) if slope(left) * slope(right) < 0 else float(near.x)

    def _polished(self, begin: float, x: np.ndarray, s: float) -> Arrival:
        """The state at s by steps that end there, then Newton's method on g."""
        state = self._carried(begin, x, s)
        best = Arrival(s, state)
        for _ in range(POLISHINGS):
            value, slope = float(self.g(best.s, best.x)), self._slope(best)
            if value == 0 or not np.isfinite(value / slope if slope else np.inf):
                break
            step = -value / slope
            if abs(step) > 1e-6 * (1 + abs(best.s)):
                break  # an extremum: g has no slope there
            best = Arrival(best.s + step, best.x + step * self.f(best.s + step / 2, best.x))
        return best

    def _slope(self, at: Arrival) -> float:
        """dg/ds by a central difference along the path."""
        h = 1e-5 * (1 + abs(at.s))
        rate = self.f(at.s, at.x)
        ahead, behind = self.g(at.s + h, at.x + h * rate), self.g(at.s - h, at.x - h * rate)
        return float(ahead - behind) / (2 * h)

    def _carried(self, begin: float, x: np.ndarray, end: float) -> np.ndarray:
        from scipy.integrate import solve_ivp

        if end == begin:
            return x
        run = solve_ivp(self.f, (begin, end), x, method="DOP853", rtol=1e-13, atol=1e-14)
        return run.y[:, -1]
