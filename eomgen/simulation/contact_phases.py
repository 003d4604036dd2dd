"""Model with contacts that change -> Trajectory: phase after phase, each with the equations of its own phase."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from eomgen.mechanics.constraints.edges import left_of, stopped_at
from eomgen.model.parts import Model
from eomgen.simulation.conditions import Condition as Ending
from eomgen.simulation.configuration import Configuration
from eomgen.simulation.endings import Condition, ended
from eomgen.simulation.event_location import TOUCH, Events
from eomgen.simulation.integrate import instants_of
from eomgen.simulation.integrator import Run, Stepping
from eomgen.simulation.joined import joined
from eomgen.simulation.phase_change import Course, PhaseStart, at_start, course_of
from eomgen.simulation.phase_model import PhaseModel
from eomgen.simulation.phase_run import PhaseRun
from eomgen.simulation.result import Trajectory
from eomgen.simulation.singular_crossing import Flow, march_across
from eomgen.simulation.solvers import IMPLICIT
from eomgen.symbolic.numeric.tolerances import COMPUTED

MOST_PHASES = 1000
MOST_AT_ONCE = 20  # phases that end as soon as they begin, one after the other


@dataclass(frozen=True)
class Plan:
    """How a motion is followed.

    Args:
        end: the last instant [s].
        how: the integrator's way.
        instants: where states are wanted; None: at the integrator's own steps.
        until: what ends it where it becomes 0.
    """

    end: float
    how: Stepping
    instants: np.ndarray | None = None
    until: Condition | None = None


def run_phases(
    model: Model,
    *,
    time: float | tuple[float, float],
    p: np.ndarray,
    parameters: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None,
    target: str | None = None,
    how: Stepping | None = None,
    samples: int | Sequence[float] | None = None,
    until: Ending | None = None,
) -> Trajectory:
    """The motion from the start values, through every change of its contacts.

    Args:
        p: the parameters' values; parameters: those of them that replace the model's.
        start: start values and speeds that replace the model's.
        until: what ends it where it becomes 0.
        samples: as of `integrate`; given beside the beginning and the end of every phase (see `thinned`).
    Raises:
        DerivationError: the ties do not hold at the start; the reaction of a contact is indeterminate.
    """
    begin, end = (0.0, float(time)) if isinstance(time, (int, float)) else map(float, time)
    instants = instants_of(samples, begin, end)
    how = how or Stepping()
    course = course_of(model, p, target, how.rates if how.stabilization == "baumgarte" else None)
    first = at_start(course, begin, parameters, start)
    condition = None if until is None else lambda phase: until(phase.system)
    stretches = passed(course, first, Plan(end, how, instants, condition))
    return joined(course, list(stretches if condition is None else ended(stretches, condition)))


def passed(course: Course, here: PhaseStart, plan: Plan) -> Iterator[PhaseRun]:
    """The phases one after the other; the last is the one that ends with the time, the condition, or in failure."""
    ended: frozenset[Configuration] = frozenset()
    hasty = count = 0
    while True:
        phase = course.phase_models.of(here.configuration)
        failure = here.failure or _endless(phase, count, hasty)
        if failure:
            yield _standstill(phase, here, failure)
            return
        run = _run(phase, here, plan)
        crossing = run.crossing
        if crossing is None or crossing.index >= len(phase.bounds):
            yield PhaseRun(here, phase, _at_edge(phase, run), None, None)
            return
        soon = run.end - here.t <= COMPUTED
        hasty, count = hasty + 1 if soon else 0, count + 1
        ended = frozenset({*(ended if soon else ()), here.configuration})
        after = course.after(phase, crossing, ended)
        yield PhaseRun(here, phase, run, phase.bounds[crossing.index], after)
        here = after


def _run(phase: PhaseModel, here: PhaseStart, plan: Plan) -> Run:
    """One phase: to the end, to the condition, or to the first of its bounds; carried across singular positions."""
    x = phase.state(here.values)
    wanted = None if plan.instants is None else np.concatenate([[here.t], plan.instants[plan.instants > here.t]])
    events = _events(phase, here.t, x, plan)
    slope = phase.slope if plan.how.method in IMPLICIT else None
    flow = Flow(phase.rate, plan.how, phase.rhs.spheres, phase.projection, slope)
    run, passages = march_across(flow, (here.t, plan.end), x, phase.nearness, instants=wanted, events=events)
    return replace(run, carried=tuple((passage.start, passage.end) for passage in passages))


def _events(phase: PhaseModel, t: float, x: np.ndarray, plan: Plan) -> Events | None:
    """The bounds of the contacts, the edges of the ties, and last the condition; None without any."""
    floors = phase.floors(t, x)
    asked = () if plan.until is None else (plan.until(phase),)
    further = (*left_of(phase.edges), *asked)
    if not further:
        return Events(phase.watched, floors) if phase.bounds else None
    function = phase.function(further)

    def values(t: np.ndarray, x: np.ndarray) -> np.ndarray:
        return np.hstack([phase.watched(t, x), function.many(t, phase.inner(x), phase.p)])

    floors = np.append(floors, np.full(len(further), COMPUTED))
    return Events(values, floors, either=(len(floors) - 1,) if asked else (), touch=TOUCH * plan.how.rtol)


def _at_edge(phase: PhaseModel, run: Run) -> Run:
    """The run; where it came to an edge of a tie, that is why it ended."""
    k = -1 if run.crossing is None else run.crossing.index - len(phase.bounds)
    if not 0 <= k < len(phase.edges):
        return run
    return replace(run, status="singular", message=stopped_at(phase.edges[k], run.end), crossing=None)


def _endless(phase: PhaseModel, count: int, hasty: int) -> str:
    """Why there are too many phases; "" while there are not."""
    names = ", ".join(f"'{contact.name}'" for contact in phase.contacts)
    if hasty == MOST_AT_ONCE:
        return f"the contacts {names} change without end at one instant"
    return f"after {count} phases the contacts {names} still change" if count == MOST_PHASES else ""


def _standstill(phase: PhaseModel, here: PhaseStart, failure: str) -> PhaseRun:
    """Where no phase follows."""
    x = phase.state(here.values)
    message = f"Stopped at t = {here.t:.6g} s: {failure}."
    return PhaseRun(here, phase, Run(np.array([here.t]), x[None, :], here.t, x, "contact", message, 0, 0), None, None)
