"""One phase of a motion as it was run; where a run is to end, within a phase and where phases change.

Within a phase the integrator finds the instant. That a phase ends, or another begins, in a state in which the condition
holds is seen here: what slides comes to rest and sticks, what lands loses its speed.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import cached_property

import numpy as np

from eomgen.errors import ExpressionError, ModelError, UsageError
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.instant.outputs import Quantities
from eomgen.model.fields import WrittenEquation
from eomgen.model.parts import Model, Output
from eomgen.model.replaced import equation_typed
from eomgen.model.table import Table
from eomgen.records import dataclass
from eomgen.simulation.contact_events import EventFunction
from eomgen.simulation.integrator import Run, measured
from eomgen.simulation.phase_change import PhaseStart
from eomgen.simulation.phase_model import PhaseModel, Values
from eomgen.symbolic.expression.expressions import parse
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.numeric.tolerances import COMPUTED

SystemCondition = Callable[[System], Scalar]
"""What is asked to become 0, over the symbols, accelerations and multipliers of a system."""


def condition_of(model: Model, until: WrittenEquation | str) -> SystemCondition:
    """Left side minus right side of an equation such as "theta = pi/2" or "reaction_n(wall) = 0".

    Raises:
        UsageError: it is no equation, or names what the model does not have.
    """
    text = until.text if isinstance(until, WrittenEquation) else until
    try:
        equation = until if isinstance(until, WrittenEquation) else equation_typed(model, until)[0]
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
        after: what follows the bound; of a condition, what would follow if it holds just as the phase ends.
    """

    here: PhaseStart
    phase: PhaseModel
    run: Run
    bound: EventFunction | None
    after: PhaseStart | None

    @cached_property
    def end(self) -> Values:
        """Coordinates, rates and speeds at its end."""
        return self.phase.values(self.run.end, self.run.last)

    @cached_property
    def measured(self) -> tuple[np.ndarray, np.ndarray]:
        """(instants, states) asked for and at the integrator's steps, in the order of time."""
        return measured(self.run.t, self.run.x, self.run.tracks)

    def tracked(self) -> tuple[np.ndarray, np.ndarray]:
        """The same."""
        return self.measured

    @property
    def is_met(self) -> bool:
        """Whether a condition ended it."""
        return self.bound is None and self.run.status == "event"


PhaseCondition = Callable[[PhaseModel], Scalar]
"""What is asked to become 0, over the symbols, accelerations and multipliers of a phase."""


def met(phase_run: PhaseRun, until: PhaseCondition) -> bool:
    """Whether the condition holds where a phase ends, and did not hold all along."""
    sizes = _sizes(phase_run, until)
    largest = float(np.max(sizes))
    return bool(sizes[-1] <= COMPUTED * max(1.0, largest) < largest)


def ended(runs: Iterable[PhaseRun], until: PhaseCondition) -> Iterator[PhaseRun]:
    """The phases, the last of them cut off where the condition first holds."""
    before: PhaseRun | None = None
    for phase_run in runs:
        if before is not None and _begins(before, phase_run, until):
            yield _only_begun(phase_run)
            return
        if phase_run.bound is not None and met(phase_run, until):
            yield _by_condition(phase_run)
            return
        yield phase_run
        before = phase_run


def _begins(before: PhaseRun, phase_run: PhaseRun, until: PhaseCondition) -> bool:
    """Whether the condition holds where a phase begins, and did not at the end of the one before."""
    last, largest = (float(find(_sizes(before, until))) for find in (lambda sizes: sizes[-1], np.max))
    enough = COMPUTED * max(1.0, largest)
    return last > enough and bool(_sizes(phase_run, until)[0] <= enough)


def _sizes(phase_run: PhaseRun, until: PhaseCondition) -> np.ndarray:
    """The absolute values of what ought to be 0, at the instants of a phase and at its end."""
    run, phase = phase_run.run, phase_run.phase
    stops, after = phase_run.bound is not None and phase_run.bound.kind == "stops", phase_run.after
    last = phase.state(after.values) if stops and after is not None else run.last  # on a surface near to 0, then 0
    t, x = np.append(run.t, run.end), np.vstack([run.x, last])
    return np.asarray(np.abs(phase.functions.evaluated(t, x, (until(phase),))[:, 0]))


def _only_begun(phase_run: PhaseRun) -> PhaseRun:
    run = phase_run.run
    first = replace(run, t=run.t[:1], x=run.x[:1], end=float(run.t[0]), last=run.x[0], steps=0, evaluations=0)
    return _by_condition(replace(phase_run, run=first, after=None))


def _by_condition(phase_run: PhaseRun) -> PhaseRun:
    message = f"Stopped by an event at t = {phase_run.run.end:.6g} s."
    return replace(phase_run, run=replace(phase_run.run, status="event", message=message), bound=None)
