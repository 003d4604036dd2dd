"""Model with contacts that change -> Trajectory: phase after phase, each with the equations of its own stage."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from eomgen.model.parts import Model
from eomgen.simulation.conditions import Condition as Ending
from eomgen.simulation.contacts import Configuration
from eomgen.simulation.course import Course, Standing, at_start, course_of
from eomgen.simulation.events import Events
from eomgen.simulation.integrate import instants_of
from eomgen.simulation.joined import joined
from eomgen.simulation.solvers import IMPLICIT
from eomgen.simulation.stage import Stage
from eomgen.simulation.stepping import Run, Stepping, march
from eomgen.simulation.stretch import Stretch
from eomgen.simulation.trajectory import Trajectory
from eomgen.symbolic.graph import Scalar

MOST_PHASES = 1000
MOST_AT_ONCE = 20  # phases that end as soon as they begin, one after the other
AT_ONCE = 1e-9  # s
MET = 1e-9  # of a condition's size, at which it holds

Condition = Callable[[Stage], Scalar]
"""What is asked to become 0, over the symbols, accelerations and multipliers of a stage."""


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
    model: Model, *, time: float | tuple[float, float], p: np.ndarray, parameters: Mapping[str, float] | None = None,
    start: Mapping[str, float] | None = None, target: str | None = None, how: Stepping | None = None,
    samples: int | Sequence[float] | None = None, until: Ending | None = None,
) -> Trajectory:  # fmt: skip
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
    condition = None if until is None else lambda stage: until(stage.system)
    stretches = list(passed(course, first, Plan(end, how, instants, condition)))
    return joined(course, stretches)


def passed(course: Course, here: Standing, plan: Plan) -> Iterator[Stretch]:
    """The phases one after the other; the last is the one that ends with the time, the condition, or in failure."""
    ended: frozenset[Configuration] = frozenset()
    hasty = count = 0
    while True:
        stage = course.stages.of(here.configuration)
        failure = here.failure or _endless(stage, count, hasty)
        if failure:
            yield _standstill(stage, here, failure)
            return
        run = _run(stage, here, plan)
        crossing = run.crossing
        if crossing is None or crossing.index == len(stage.bounds):
            yield Stretch(here, stage, run, None, None)
            return
        soon = run.end - here.t <= AT_ONCE
        hasty, count = hasty + 1 if soon else 0, count + 1
        ended = frozenset({*(ended if soon else ()), here.configuration})
        after = course.after(stage, crossing, ended)
        yield Stretch(here, stage, run, stage.bounds[crossing.index], after)
        here = after


def _run(stage: Stage, here: Standing, plan: Plan) -> Run:
    """One phase: to the end, to the condition, or to the first of its bounds."""
    x = stage.state(here.values)
    wanted = None if plan.instants is None else np.concatenate([[here.t], plan.instants[plan.instants > here.t]])
    events = _events(stage, here.t, x, plan)
    slope = stage.slope if plan.how.method in IMPLICIT else None
    return march(stage.rate, (here.t, plan.end), x, how=plan.how, instants=wanted, events=events,
                 spheres=stage.rhs.spheres, projection=stage.projection, slope=slope)  # fmt: skip


def _events(stage: Stage, t: float, x: np.ndarray, plan: Plan) -> Events | None:
    floors = stage.floors(t, x)
    if plan.until is None:
        return Events(stage.watched, floors) if stage.bounds else None
    condition = (plan.until(stage),)
    function = stage.function(condition)

    def values(t: np.ndarray, x: np.ndarray) -> np.ndarray:
        return np.hstack([stage.watched(t, x), function.many(t, stage.inner(x), stage.p)])

    return Events(values, np.append(floors, MET), either=(len(floors),))


def _endless(stage: Stage, count: int, hasty: int) -> str:
    """Why there are too many phases; "" while there are not."""
    names = ", ".join(f"'{contact.name}'" for contact in stage.contacts)
    if hasty == MOST_AT_ONCE:
        return f"the contacts {names} change without end at one instant"
    return f"after {count} phases the contacts {names} still change" if count == MOST_PHASES else ""


def _standstill(stage: Stage, here: Standing, failure: str) -> Stretch:
    """Where no phase follows."""
    x = stage.state(here.values)
    message = f"Stopped at t = {here.t:.6g} s: {failure}."
    return Stretch(here, stage, Run(np.array([here.t]), x[None, :], here.t, x, "contact", message, 0, 0), None, None)
