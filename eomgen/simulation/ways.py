"""x' = f(t, x) with ties, start -> the state at a time, or where a condition first holds, across singular positions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from eomgen.codegen.spheres import SpherePlaces
from eomgen.simulation.arrival import Arrival, NeverReached
from eomgen.simulation.constraint_rank import Nearness
from eomgen.simulation.event_location import TOUCH, Events
from eomgen.simulation.integrator import LOOKED_OUT, Run, Stepping
from eomgen.simulation.projection import Projection
from eomgen.simulation.singular_crossing import Flow, march_across
from eomgen.simulation.solvers import StateRate
from eomgen.symbolic.numeric.tolerances import COMPUTED, FAIR_RUN, FINE_RUN

TOLERANCES = (FINE_RUN, FAIR_RUN)  # of one step; the coarser where the finer does not come across
HORIZONS = (10.0, 100.0, 1000.0)  # s, for conditions that are met late
MOST_STEPS = 4000  # of a search
FINE = Stepping(rtol=TOLERANCES[0], atol=TOLERANCES[0], most_steps=100_000)


@dataclass(frozen=True)
class Way:
    """A motion from its start.

    Args:
        f: x' = f(t, x).
        t0, x0: the start.
        nearness: to singular positions, a new one for each run; it gives None where nobody needs to look.
        projection: onto the ties.
    """

    f: StateRate
    t0: float
    x0: np.ndarray
    spheres: Sequence[SpherePlaces]
    nearness: Callable[[], Nearness | None]
    projection: Callable[[], Projection | None]

    def until(self, end: float, how: Stepping = FINE, events: Events | None = None) -> tuple[Run, bool]:
        """(the motion until then, or to an event; whether it was carried across a singular position)."""
        nearness = self.nearness()
        flow = Flow(self.f, how, self.spheres, None if nearness is None else self.projection())
        run, passages = march_across(flow, (self.t0, end), self.x0, nearness, events=events)
        return run, bool(passages)

    def first(self, condition: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> tuple[Arrival, bool]:
        """Where a condition, (t n, x n x states) -> n x 1, first holds; whether a singular position came before.

        Raises:
            NeverReached: it does not hold as far as the motion was followed.
        """
        message = "not looked for"
        for tolerance in TOLERANCES:
            how = replace(FINE, rtol=tolerance, atol=tolerance, most_steps=MOST_STEPS)
            events = Events(condition, np.full(1, COMPUTED), (0,), TOUCH * tolerance)
            for horizon in HORIZONS:
                run, passed = self.until(self.t0 + horizon, how, events)
                if run.crossing is not None and run.crossing.index != LOOKED_OUT:
                    return Arrival(run.crossing.t, run.crossing.x), passed
                message = run.message
                if run.status != "finished":
                    break
            if run.status != "singular":
                break
        raise NeverReached(f"the condition is not met as far as the motion was followed: {message}")
