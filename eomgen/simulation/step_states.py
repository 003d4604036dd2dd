"""Steps of an integrator -> states at which a run is measured: how its energy drifts, how far its ties open.

The instants that a user asks for may be few, and all of them at rest.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

MOST = 20_000  # states


@dataclass
class StepStates:
    """States at the ends of steps: of all of them, or of every second, fourth, ... so that they do not grow too many.

    Args:
        every: at each so many steps a state is kept.
        steps: taken so far.
    """

    t: list[float] = field(default_factory=list)
    x: list[np.ndarray] = field(default_factory=list)
    every: int = 1
    steps: int = 0

    def add(self, t: float, x: np.ndarray) -> None:
        """The state after a step."""
        self.steps += 1
        if self.steps % self.every:
            return
        self.t.append(t)
        self.x.append(x.copy())
        if len(self.t) > MOST:
            self.t, self.x, self.every = self.t[1::2], self.x[1::2], 2 * self.every

    def until(self, end: float) -> StepStates:
        """Those up to an instant."""
        n = bisect_right(self.t, end)
        return StepStates(self.t[:n], self.x[:n], self.every, self.steps)


def measured(t: np.ndarray, x: np.ndarray, tracks: Sequence[StepStates]) -> tuple[np.ndarray, np.ndarray]:
    """(t n, x n x states): the rows of a run and the states of its tracks, in the order of time."""
    times = np.concatenate([t, *(np.array(track.t, dtype=float) for track in tracks)])
    states = np.concatenate([x, *(np.array(track.x).reshape(len(track.t), x.shape[1]) for track in tracks)])
    order = np.argsort(times, kind="stable")
    return times[order], states[order]
