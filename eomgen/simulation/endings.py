"""Stretches, a condition -> the stretches up to the first instant at which it holds, where phases change too.

Within a phase the integrator finds the instant. That a phase ends, or another begins, in such a state is seen
here: what slides comes to rest and sticks, what lands loses its speed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

import numpy as np

from eomgen.simulation.stage import Stage
from eomgen.simulation.stretch import Stretch
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.numeric.tolerances import COMPUTED

Condition = Callable[[Stage], Scalar]
"""What is asked to become 0, over the symbols, accelerations and multipliers of a stage."""


def met(stretch: Stretch, until: Condition) -> bool:
    """Whether the condition holds where a phase ends, and did not hold all along."""
    sizes = _sizes(stretch, until)
    largest = float(np.max(sizes))
    return bool(sizes[-1] <= COMPUTED * max(1.0, largest) < largest)


def ended(stretches: Iterable[Stretch], until: Condition) -> Iterator[Stretch]:
    """The phases, the last of them cut off where the condition first holds."""
    before: Stretch | None = None
    for stretch in stretches:
        if before is not None and _begins(before, stretch, until):
            yield _only_begun(stretch)
            return
        if stretch.bound is not None and met(stretch, until):
            yield _by_condition(stretch)
            return
        yield stretch
        before = stretch


def _begins(before: Stretch, stretch: Stretch, until: Condition) -> bool:
    """Whether the condition holds where a phase begins, and did not at the end of the one before."""
    last, largest = (float(find(_sizes(before, until))) for find in (lambda sizes: sizes[-1], np.max))
    enough = COMPUTED * max(1.0, largest)
    return last > enough and bool(_sizes(stretch, until)[0] <= enough)


def _sizes(stretch: Stretch, until: Condition) -> np.ndarray:
    """The absolute values of what ought to be 0, at the instants of a phase and at its end."""
    run, stage = stretch.run, stretch.stage
    stops, after = stretch.bound is not None and stretch.bound.kind == "stops", stretch.after
    last = stage.state(after.values) if stops and after is not None else run.last  # on a surface near to 0, then 0
    t, x = np.append(run.t, run.end), np.vstack([run.x, last])
    return np.abs(stage.evaluated(t, x, (until(stage),))[:, 0])


def _only_begun(stretch: Stretch) -> Stretch:
    run = stretch.run
    first = replace(run, t=run.t[:1], x=run.x[:1], end=float(run.t[0]), last=run.x[0], steps=0, evaluations=0)
    return _by_condition(replace(stretch, run=first))


def _by_condition(stretch: Stretch) -> Stretch:
    message = f"Stopped by an event at t = {stretch.run.end:.6g} s."
    return replace(stretch, run=replace(stretch.run, status="event", message=message), bound=None, after=None)
