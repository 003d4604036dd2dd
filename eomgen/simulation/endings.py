"""Stretches, a condition -> the runs up to the first instant at which it holds, where phases change too.

Within a phase the integrator finds the instant. That a phase ends, or another begins, in such a state is seen
here: what slides comes to rest and sticks, what lands loses its speed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

import numpy as np

from eomgen.simulation.phase_model import PhaseModel
from eomgen.simulation.phase_run import PhaseRun
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.numeric.tolerances import COMPUTED

PhaseCondition = Callable[[PhaseModel], Scalar]
"""What is asked to become 0, over the symbols, accelerations and multipliers of a phase."""


def met(stretch: PhaseRun, until: PhaseCondition) -> bool:
    """Whether the condition holds where a phase ends, and did not hold all along."""
    sizes = _sizes(stretch, until)
    largest = float(np.max(sizes))
    return bool(sizes[-1] <= COMPUTED * max(1.0, largest) < largest)


def ended(runs: Iterable[PhaseRun], until: PhaseCondition) -> Iterator[PhaseRun]:
    """The phases, the last of them cut off where the condition first holds."""
    before: PhaseRun | None = None
    for stretch in runs:
        if before is not None and _begins(before, stretch, until):
            yield _only_begun(stretch)
            return
        if stretch.bound is not None and met(stretch, until):
            yield _by_condition(stretch)
            return
        yield stretch
        before = stretch


def _begins(before: PhaseRun, stretch: PhaseRun, until: PhaseCondition) -> bool:
    """Whether the condition holds where a phase begins, and did not at the end of the one before."""
    last, largest = (float(find(_sizes(before, until))) for find in (lambda sizes: sizes[-1], np.max))
    enough = COMPUTED * max(1.0, largest)
    return last > enough and bool(_sizes(stretch, until)[0] <= enough)


def _sizes(stretch: PhaseRun, until: PhaseCondition) -> np.ndarray:
    """The absolute values of what ought to be 0, at the instants of a phase and at its end."""
    run, phase = stretch.run, stretch.phase
    stops, after = stretch.bound is not None and stretch.bound.kind == "stops", stretch.after
    last = phase.state(after.values) if stops and after is not None else run.last  # on a surface near to 0, then 0
    t, x = np.append(run.t, run.end), np.vstack([run.x, last])
    return np.abs(phase.evaluated(t, x, (until(phase),))[:, 0])


def _only_begun(stretch: PhaseRun) -> PhaseRun:
    run = stretch.run
    first = replace(run, t=run.t[:1], x=run.x[:1], end=float(run.t[0]), last=run.x[0], steps=0, evaluations=0)
    return _by_condition(replace(stretch, run=first))


def _by_condition(stretch: PhaseRun) -> PhaseRun:
    message = f"Stopped by an event at t = {stretch.run.end:.6g} s."
    return replace(stretch, run=replace(stretch.run, status="event", message=message), bound=None, after=None)
