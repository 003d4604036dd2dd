"""Functions of the state -> the instant at which the first of them changes sign, within one step of an integrator."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from eomgen.symbolic.numeric.tolerances import CARRIED, ITERATED, SOLVED

PARTS = 8  # of a step: how often the functions are looked at
EDGE = 1e-3  # of a part: so near to the ends of a step they are looked at too, so that no extremum hides there
TOUCH = 100.0  # relative tolerances of a step; so near to zero, against its largest value, a function touches it
RELATIVE = 4 * np.finfo(float).eps  # of the instant of an event, and one part in 1e12 of the step


@dataclass(frozen=True)
class Events:
    """Functions that end a run where they fall to zero, or (`either`) where they reach zero from either side.

    A function must first have been above its floor: one that starts at zero (a gap that has just opened) ends nothing
    until it was positive, unless it falls below minus its floor first. One that counts from either side also ends a run
    where it touches zero and turns back, like a speed.

    Args:
        values: (t n, x n x states) -> n x k.
        floors: what is rounding, of each function, k.
        either: the indices of those that count from either side.
        touch: how near to zero these touch it, against their largest value.
    """

    values: Callable[[np.ndarray, np.ndarray], np.ndarray]
    floors: np.ndarray
    either: tuple[int, ...] = ()
    touch: float = CARRIED


@dataclass(frozen=True)
class Crossing:
    """An event: function `index` of Events reached zero at t, in the state x."""

    index: int
    t: float
    x: np.ndarray


@dataclass
class EventSearch:
    """Follows the functions of `events` from step to step.

    Args:
        signs: by which each function is multiplied so that it falls; 0 where that is not known yet.
        armed: those that have been above their floor.
        largest: their largest absolute values so far.
    """

    events: Events
    t: float
    x: np.ndarray
    signs: np.ndarray = field(init=False)
    armed: np.ndarray = field(init=False)
    largest: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        g = self.events.values(np.array([self.t]), self.x[None, :])[0]
        self.signs = np.ones(len(g))
        self.signs[list(self.events.either)] = 0.0
        self._direct(g)
        self.armed = self.signs * g > self.events.floors
        self.largest = np.abs(g)

    def _direct(self, g: np.ndarray) -> None:
        """Functions that count from either side fall from the side on which they first are."""
        new = (self.signs == 0) & (np.abs(g) > self.events.floors)
        self.signs[new] = np.sign(g[new])

    def step(self, t_old: float, t_new: float, dense: Callable[[Any], np.ndarray]) -> Crossing | None:
        """The first crossing in the step from t_old to t_new; `dense` gives the state at instants in it."""
        times = _looks(t_old, t_new)
        g = self.events.values(times, dense(times).T)
        for row in g:
            self._direct(row)
        self.largest = np.maximum(self.largest, np.nan_to_num(np.abs(g)).max(axis=0))
        found = [
            root
            for k in range(g.shape[1])
            if (root := self._first(k, times, self.signs[k] * g[:, k], dense)) is not None
        ]
        if not found:
            return None
        t, index = min(found)
        return Crossing(index, t, dense(t))

    def _first(self, k: int, times: np.ndarray, g: np.ndarray, dense: Callable[[Any], Any]) -> tuple[float, int] | None:
        """The first time at which function k crosses, and k."""
        floor, sign = self.events.floors[k], self.signs[k]
        touch = self.events.touch * self.largest[k] if k in self.events.either else None

        def value(t: float, level: float = 0.0) -> float:
            return sign * float(self.events.values(np.array([t]), np.asarray(dense(t))[None, :])[0, k]) - level

        for i in range(1, len(times)):
            if self.armed[k]:
                low = _low(value, times[max(i - 2, 0) : i + 1], g[max(i - 2, 0) : i + 1], closely=touch is not None)
                if low is not None and low[1] < 0:
                    return _root(value, times[i - 2], low[0]), k
                if low is not None and touch is not None and low[1] <= touch:
                    return low[0], k
                if g[i] <= 0:
                    return _root(value, times[i - 1], times[i]), k
            elif g[i] < -floor:
                return _root(lambda t: value(t, -floor), times[i - 1], times[i]), k
            elif g[i] > floor:
                self.armed[k] = True
        return None


def _looks(t_old: float, t_new: float) -> np.ndarray:
    """The instants of a step at which the functions are looked at."""
    parts = np.linspace(t_old, t_new, PARTS + 1)
    near = EDGE * (t_new - t_old) / PARTS
    return np.concatenate([parts[:1], [t_old + near], parts[1:-1], [t_new - near], parts[-1:]])


def _low(value: Callable[[float], float], t: np.ndarray, g: np.ndarray, *, closely: bool) -> tuple[float, float] | None:
    """(where, how low) between three positive values the middle one of which is the least; None where they are not so.

    Unless one looks closely, the parabola through the three says whether it is worth it.
    """
    if len(t) < 3 or not (g > 0).all() or not (g[1] <= g[0] and g[1] <= g[2]):
        return None
    if not closely and _vertex(t, g) > 0.5 * g[1]:
        return None
    from scipy.optimize import minimize_scalar

    least = minimize_scalar(value, bounds=(t[0], t[2]), method="bounded", options={"xatol": ITERATED * (t[2] - t[0])})
    return float(least.x), float(least.fun)


def _vertex(t: np.ndarray, g: np.ndarray) -> float:
    """The least value of the parabola through three points, the middle one of which is the least."""
    before, after = np.diff(g) / np.diff(t)
    curvature = (after - before) / (t[2] - t[0])
    slope = (before * (t[2] - t[1]) + after * (t[1] - t[0])) / (t[2] - t[0])
    return float(g[1] - slope**2 / (4 * curvature)) if curvature > 0 else float(g[1])


def _root(value: Callable[[float], float], before: float, after: float) -> float:
    """Where the function is zero between two instants, or just past it: never where it is still above."""
    from scipy.optimize import brentq

    if not value(before) > 0:
        return before
    if not value(after) < 0:
        return after
    xtol = SOLVED * (after - before)
    root = float(brentq(value, before, after, xtol=xtol, rtol=RELATIVE))
    step = float(xtol + RELATIVE * abs(root))
    while root < after and value(root) > 0:
        root, step = min(float(after), root + step), 2 * step
    return root
