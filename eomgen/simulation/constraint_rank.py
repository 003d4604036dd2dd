"""How far a run is from the singular positions of its ties, followed from step to step."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from eomgen.simulation.event_location import PARTS, Crossing
from eomgen.simulation.independence import ConstraintRank
from eomgen.simulation.integrator import LOOKED_OUT

STEEP = 2.0  # times the steepest fall or rise in the steps before: s may not change faster in a step
REMEMBERED = 4  # steps
ARMED = 1.4  # of what is near
DEEP = 1e-3  # of an interval: how closely the least nearness in it is sought

PLACE = "a dead centre or a change point"

Measure = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass
class Nearness:
    """How far a motion is from a singular position: 1 at its farthest so far, 0 there.

    Args:
        determinants: (t n, x n x states) -> n x k, each of which vanishes where dependent coordinates are not
            determined; None where there are none.
        rows: the rows that close by multipliers; None where there are none.
        what: of each determinant, what is not determined where it vanishes.
        lengths, largest: of the rows, and of what vanishes, the greatest so far.
    """

    determinants: Measure | None
    rows: ConstraintRank | None
    what: tuple[str, ...] = ()
    lengths: np.ndarray | float = 0.0
    largest: np.ndarray | float = 0.0

    def __call__(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """The nearness at n states."""
        with np.errstate(all="ignore"):
            sizes = np.abs(self._measured(t, x))
        self.largest = largest = np.maximum(self.largest, sizes.max(axis=0, initial=0.0))
        scaled: np.ndarray = (sizes / (largest if largest.all() else np.where(largest > 0, largest, 1.0))).min(axis=1)
        return np.minimum(scaled, 1.0)

    def _measured(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        found = []
        if self.determinants is not None:
            found.append(np.nan_to_num(self.determinants(t, x)).reshape(len(t), -1))
        if self.rows is not None:
            least, self.lengths = self.rows.least(t, x, self.lengths)
            found.append(least)
        return found[0] if len(found) == 1 else np.hstack(found)

    def words(self, t: float, x: np.ndarray) -> str:
        """What is not determined at a state near a singular position."""
        sizes = self._measured(np.array([t]), x[None, :])[0] / np.where(self.largest > 0, self.largest, 1.0)
        worst = int(np.argmin(np.abs(sizes)))
        if worst < len(self.what) or self.rows is None:
            return self.what[worst]
        return self.rows.words(np.array([t]), x[None, :])

    def at(self, t: float, x: np.ndarray) -> float:
        return float(self(np.array([t]), x[None, :])[0])


class RankLookout:
    """Follows the nearness of a run from step to step, closely only where it may come near zero within a step.

    Args:
        near: where the run ends, once it has been farther than ARMED times that.
    """

    def __init__(self, nearness: Nearness, near: float, t: float, x: np.ndarray) -> None:
        self.nearness, self.near, self._before = nearness, near, nearness.at(t, x)
        self._armed = self._before > ARMED * near
        self._slopes: deque[float] = deque(maxlen=REMEMBERED)

    def step(self, t_old: float, t_new: float, x_new: np.ndarray, dense: Callable[[], Any]) -> Crossing | None:
        """Where the nearness falls below what is near in a step that ends in x_new."""
        before, self._before = self._before, self.nearness.at(t_new, x_new)
        if self._armed and self._is_calm(before, t_new - t_old):
            return None
        motion = dense()
        times = np.linspace(t_old, t_new, PARTS + 1)
        sizes = self.nearness(times, motion(times).T)
        if not self._armed:
            far = np.flatnonzero(sizes > ARMED * self.near)
            if not far.size:
                return None
            self._armed, times, sizes = True, times[far[0] :], sizes[far[0] :]
        found = self._fallen(times, sizes, lambda t: self.nearness.at(t, motion(t)))
        return None if found is None else Crossing(LOOKED_OUT, found, motion(found))

    def _is_calm(self, before: float, step: float) -> bool:
        """Whether it cannot have come near zero within a step, unless it changes much faster than before."""
        self._slopes.append(abs(self._before - before) / step)
        enough = len(self._slopes) == REMEMBERED
        return enough and min(before, self._before) > self.near + STEEP * max(self._slopes) * step

    def _fallen(self, t: np.ndarray, sizes: np.ndarray, size: Callable[[float], float]) -> float | None:
        """The first instant at which it is near; a V between two instants is looked into where it may reach zero."""
        from scipy.optimize import brentq, minimize_scalar

        i = int(np.argmin(sizes))
        if sizes[i] > max(self.near, np.max(np.abs(np.diff(sizes)), initial=0.0)):
            return None
        bounds = float(t[max(i - 1, 0)]), float(t[min(i + 1, len(t) - 1)])
        least = float(t[i])
        if sizes[i] > self.near:
            deepest = minimize_scalar(size, bounds=bounds, method="bounded", options={"xatol": DEEP * np.ptp(bounds)})
            if deepest.fun > self.near:
                return None
            least = float(deepest.x)
        first = least if not np.any(sizes <= self.near) else float(t[np.flatnonzero(sizes <= self.near)[0]])
        before = t[(t < first) & (sizes > self.near)]
        return float(brentq(lambda s: size(s) - self.near, before[-1], first)) if before.size else first
