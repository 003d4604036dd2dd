"""Along the configurations of one freedom, without time: where a motion goes from a rest or a dead centre.

dq/ds = d(q),   u_s^2 = y(q) >= 0 where the motion may be
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from eomgen.errors import RunFailed
from eomgen.records import dataclass
from eomgen.simulation.event_location import Events
from eomgen.simulation.integrator import Run, Stepping, march
from eomgen.symbolic.numeric.newton import least_left
from eomgen.symbolic.numeric.tolerances import (
    CARRIED,
    COMPUTED,
    DIFFERENCE_STEP,
    FINE_RUN,
    GAP_CLOSED,
    RANK_NEARBY,
    SUMMED,
    WIDE_STEP,
)

STEP = 1e-3  # from a singular start, of the leading coordinate
AROUND = 12.0  # steps: how far other coordinates may move in this one
GUESSES = 60
SEARCH = Stepping(rtol=FINE_RUN, atol=FINE_RUN, most_steps=4000)
REACHES = (1.0, 10.0, 100.0)  # how far the leading coordinate is followed, in sizes of its start and 1
NEARER = 1 - COMPUTED  # what the second sense must undercut: of two mirror images the first one is taken
ASIDE = 0.1

VectorFunction = Callable[[np.ndarray], np.ndarray]
NumberFunction = Callable[[np.ndarray], float]
SensedCondition = Callable[[np.ndarray, int], float]
"""(q, sense of motion) -> a number."""


@dataclass(frozen=True)
class Arrival:
    """Where a condition holds: the way to it, of the leading coordinate, and the state there."""

    s: float
    x: np.ndarray


class NeverReached(RunFailed):
    """The condition stays away from 0 as far as the way was followed."""


@dataclass(frozen=True)
class Configurations:
    """The configurations that one freedom leaves, as numbers.

    Args:
        direction: d(q) = dq/ds.
        gaps: what vanishes.
        leading: index of the coordinate whose rate is u_s.
        sought: indices of those that the gaps fix.
    """

    direction: VectorFunction
    gaps: VectorFunction
    leading: int
    sought: tuple[int, ...]

    def first(
        self, g: SensedCondition, y: NumberFunction, q: np.ndarray, senses: Sequence[int], near: np.ndarray
    ) -> tuple[Arrival, int]:
        """(the nearest configuration with g(q, sense) = 0, the sense of motion).

        Args:
            g: the condition, which may hold speeds, and so the sense.
            y: u_s^2; the motion does not go where it is negative.
            q: the start.
            senses: in which the motion may leave it.
            near: guesses of the coordinates, which choose the branch where several leave the start.
        Raises:
            NeverReached: in no sense.
        """
        reasons: list[NeverReached] = []
        for reach in REACHES:
            found: list[tuple[float, Arrival, int]] = []
            for sense in senses:
                within = min([reach * (1 + abs(q[self.leading])), *(NEARER * distance for distance, *_ in found)])
                try:
                    arrival = self._one_way(g, y, q, sense, near, within)
                    found.append((abs(arrival.s), arrival, sense))
                except NeverReached as reason:
                    reasons.append(reason)
            if found:
                _, arrival, sense = min(found, key=lambda each: each[0])
                return arrival, sense
        raise reasons[-1]

    def _one_way(
        self, g: SensedCondition, y: NumberFunction, q: np.ndarray, sense: int, near: np.ndarray, within: float
    ) -> Arrival:
        regular = self.is_regular(q)
        s = 0.0
        if not regular:
            s = sense * STEP
            q = self._beside(q, s, near)
        if y(q + (0 if not regular else WIDE_STEP * sense * self.direction(q))) < 0:
            raise NeverReached("the motion does not go this way from the start")
        sensed = _Sensed(self, g, y, sense)
        return sensed.arrival(march(sensed.rate, (abs(s), within), q, how=SEARCH, events=sensed.events))

    def is_regular(self, q: np.ndarray) -> bool:
        """Whether the gaps fix the sought coordinates' rates: no branch point, as its rounded place may seem finite."""
        with np.errstate(all="ignore"):
            if not np.all(np.isfinite(self.direction(q))):
                return False
        if not self.sought:
            return True
        aside = q.copy()
        aside[list(self.sought)] += ASIDE
        usual = np.linalg.norm(self._slopes(aside))
        return bool(np.min(np.linalg.svd(self._slopes(q), compute_uv=False), initial=usual) > RANK_NEARBY * usual)

    def _slopes(self, q: np.ndarray) -> np.ndarray:
        """d gaps / d sought coordinates, by central differences."""
        columns = []
        for k in self.sought:
            h = np.zeros(len(q))
            h[k] = DIFFERENCE_STEP * (1 + abs(q[k]))
            columns.append((self.gaps(q + h) - self.gaps(q - h)) / (2 * h[k]))
        return np.array(columns).T

    def _beside(self, start: np.ndarray, step: float, near: np.ndarray) -> np.ndarray:
        """The configuration a small step from a singular start: on the branch that is nearest to the guesses.

        Raises:
            NeverReached: there is none.
        """
        rng = np.random.default_rng(1)
        sought = list(self.sought)
        found = []
        for _ in range(GUESSES):
            q = start.copy()
            q[self.leading] += step
            q[sought] += abs(step) * rng.uniform(-AROUND / 2, AROUND / 2, len(sought))
            closed = self._closed(q)
            if closed is not None and np.max(np.abs(closed - start)) < AROUND * abs(step):
                found.append(closed)
        if not found:
            raise NeverReached("no configuration leads away from the start")
        return min(found, key=lambda q: (round(float(np.linalg.norm((q - near)[sought])), 9), *q))

    def _closed(self, q: np.ndarray) -> np.ndarray | None:
        """The nearest configuration with all gaps 0, moved by the sought coordinates."""
        sought = list(self.sought)

        def gaps(x: np.ndarray) -> np.ndarray:
            moved = q.copy()
            moved[sought] = x
            return self.gaps(moved)

        found = least_left(gaps, q[sought])
        if found.left > GAP_CLOSED:
            return None
        closed = q.copy()
        closed[sought] = found.x
        return closed


@dataclass(frozen=True)
class _Sensed:
    """The way in one sense, s growing: the condition, and how far u_s^2 allows the motion to go.

    Args:
        along: the configurations.
        g, y: as of `Configurations.first`.
    """

    along: Configurations
    g: SensedCondition
    y: NumberFunction
    sense: int

    def rate(self, s: float, q: np.ndarray) -> np.ndarray:
        return self.sense * self.along.direction(q)

    @property
    def events(self) -> Events:
        """The condition, from either side; u_s^2, which may not fall below 0."""

        def values(s: np.ndarray, q: np.ndarray) -> np.ndarray:
            return np.array([(self.g(each, self.sense), self.y(each)) for each in q])

        return Events(values, np.array([COMPUTED, SUMMED]), (0,))

    def arrival(self, run: Run) -> Arrival:
        """Where the condition holds; it may do so just where the motion turns back.

        Raises:
            NeverReached: the way ends before.
        """
        if run.crossing is None:
            raise NeverReached(f"the condition is not met as far as the motion was followed, up to {run.end:.6g}")
        if run.crossing.index == 1 and abs(self.g(run.last, self.sense)) > CARRIED * self._largest(run):
            raise NeverReached(f"the motion turns back before, at {run.end:.6g}")
        return Arrival(self.sense * run.end, run.last)

    def _largest(self, run: Run) -> float:
        return max(abs(self.g(q, self.sense)) for q in run.x)
