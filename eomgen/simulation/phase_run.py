"""One phase of a motion as it was run; where a run is to end, within a phase and where phases change.

Within a phase the integrator finds the instant. That a phase ends, or another begins, in a state in which the condition
holds is seen here: what slides comes to rest and sticks, what lands loses its speed.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from eomgen.errors import ExpressionError, ModelError, UsageError
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.instant.outputs import Quantities
from eomgen.model.fields import WrittenEquation
from eomgen.model.parts import Model, Output
from eomgen.model.table import Table
from eomgen.simulation.contact_events import EventFunction
from eomgen.simulation.integrator import Run
from eomgen.simulation.phase_change import PhaseStart
from eomgen.simulation.phase_model import PhaseModel
from eomgen.symbolic.expression.expressions import parse, parse_equation
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.numeric.tolerances import COMPUTED

SystemCondition = Callable[[System], Scalar]
"""What is asked to become 0, over the symbols, accelerations and multipliers of a system."""


def condition_of(model: Model, text: str) -> SystemCondition:
    """Left side minus right side of an equation such as "theta = pi/2" or "reaction_n(wall) = 0".

    Raises:
        UsageError: it is no equation, or names what the model does not have.
    """
    try:
        equation = WrittenEquation(*parse_equation(text), text=text)
        dataclasses.replace(model, outputs=Table({"until": Output(value=parse("t"), at=equation)}))
    except ExpressionError as error:
        raise UsageError(f"until '{text}': {error.what}", mend=error.mend or 'write "theta = pi/2"') from error
    except ModelError as error:
        raise UsageError(f"until '{text}': {error.problems[0].what}", mend=error.problems[0].mend) from error

    def difference(system: System) -> Scalar:
        names, value = system.scope.names, Quantities(system).value
        return equation.left.evaluate(names, value) - equation.right.evaluate(names, value)

    return difference


@dataclass(frozen=True)
class PhaseRun:
    """One phase as it was run.

    Args:
        here: its start.
        phase: its equations.
        run: what the integrator left.
        bound: what ended it; None where the time, a condition or a failure did.
        after: what follows the bound.
    """

    here: PhaseStart
    phase: PhaseModel
    run: Run
    bound: EventFunction | None
    after: PhaseStart | None


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
    return np.asarray(np.abs(phase.evaluated(t, x, (until(phase),))[:, 0]))


def _only_begun(stretch: PhaseRun) -> PhaseRun:
    run = stretch.run
    first = replace(run, t=run.t[:1], x=run.x[:1], end=float(run.t[0]), last=run.x[0], steps=0, evaluations=0)
    return _by_condition(replace(stretch, run=first))


def _by_condition(stretch: PhaseRun) -> PhaseRun:
    message = f"Stopped by an event at t = {stretch.run.end:.6g} s."
    return replace(stretch, run=replace(stretch.run, status="event", message=message), bound=None, after=None)
