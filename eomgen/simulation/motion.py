"""Start -> the phases of a motion, one after the other, each with its own equations; a plain model has one."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from eomgen.errors import DerivationError, UsageError
from eomgen.mechanics.constraints.edges import left_of, stopped_at
from eomgen.mechanics.equations.jumps import SMOOTH, signs_of_rates
from eomgen.records import dataclass
from eomgen.simulation.configuration import Configuration
from eomgen.simulation.event_location import TOUCH, Events
from eomgen.simulation.integrator import Run, Stepping
from eomgen.simulation.phase_change import PhaseStart, next_start
from eomgen.simulation.phase_model import PhaseModel
from eomgen.simulation.phase_models import PhaseModels
from eomgen.simulation.phase_run import PhaseCondition, PhaseRun, ended
from eomgen.simulation.singular import ended_where_singular
from eomgen.simulation.singular_crossing import Flow, march_across
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.numeric.tolerances import COMPUTED, FINEST_RUN
from eomgen.symbolic.print.text import to_text

LOOK_PHASES = 1000  # from one look at how fast they follow one another to the next
MOST_PHASES = 100_000  # that may be left to the end: about half an hour of work
STEPS_AGAIN = 10_000  # of the finer integration across one instant
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
    until: PhaseCondition | None = None


def through(models: PhaseModels, here: PhaseStart, plan: Plan) -> Iterator[PhaseRun]:
    """The phases of a motion, up to the first instant at which what ends it holds."""
    runs = passed(models, here, plan)
    return runs if plan.until is None else ended(runs, plan.until)


def passed(models: PhaseModels, here: PhaseStart, plan: Plan) -> Iterator[PhaseRun]:
    """The phases one after the other; the last is the one that ends with the time, the condition, or in failure."""
    ended: frozenset[Configuration] = frozenset()
    hasty = count = 0
    looked = here.t
    while True:
        phase = models.of(here.configuration)
        failure = here.failure or _hasty(phase, hasty)
        if not failure and count == plan.how.most_phases:
            failure = f"after {count} phases the contacts {_contacts(phase)} still change"
        if not failure and count and count % LOOK_PHASES == 0:
            failure, looked = _endless(phase, count, (looked, here.t, plan.end)), here.t
        if failure:
            yield _standstill(phase, here, failure)
            return
        run = advance(phase, here, plan)
        crossing = run.crossing
        if crossing is None or crossing.index >= len(phase.bounds):
            yield PhaseRun(here, phase, run, None, None)
            return
        soon = run.end - here.t <= COMPUTED
        hasty, count = hasty + 1 if soon else 0, count + 1
        ended = frozenset({*(ended if soon else ()), here.configuration})
        after = next_start(models, phase, crossing, ended)
        yield PhaseRun(here, phase, run, phase.bounds[crossing.index], after)
        here = after


def advance(phase: PhaseModel, here: PhaseStart, plan: Plan) -> Run:
    """One phase: to the end, to the condition, or to the first of its bounds; carried across singular positions.

    Raises:
        DerivationError: doubles are too coarse for the start.
    """
    x = phase.state(here.values)
    _refuse_coarse(phase, here.t, x)
    wanted = plan.instants
    if wanted is not None and not (len(wanted) and wanted[0] == here.t):
        wanted = np.concatenate([[here.t], wanted[wanted > here.t]])
    events = _events(phase, here.t, x, plan)
    level = phase.level(here.t, x) if plan.how.stabilization == "energy" else None
    flow = Flow(phase.rate, plan.how, phase.functions.rhs.spheres, phase.projection, lambda: phase.slope, level)
    run = march_across(flow, (here.t, plan.end), x, phase.nearness, instants=wanted, events=events)
    return _determined(phase, _named(phase, _at_edge(phase, run), here.t), plan.how)


def _named(phase: PhaseModel, run: Run, begun: float) -> Run:
    """The run; where it came to a state without a value, with what has none there, or with what is too large."""
    if run.status in ("step too small", "too many steps") and (large := phase.overlarge(run.end, run.last)):
        return replace(run, message=f"{run.message[:-1]}: {large.what}.")
    if run.status in ("step too small", "too many steps") and (jumping := signs_of_rates(phase.system)):
        told = f"A force jumps with the sign of {to_text(jumping[0])}, and sticks where that is 0: {SMOOTH}."
        return replace(run, message=f"{run.message} {told}")
    found = phase.valueless(run.end, run.last) if run.status == "not finite" else None
    if found is None:
        return run
    when = "The motion starts where" if run.end == begun else f"Stopped at t = {run.end:.6g} s:"
    return replace(run, message=f"{when} {found.what}.")


def _refuse_coarse(phase: PhaseModel, t: float, x: np.ndarray) -> None:
    """Refuses a state so far from 0 that its neighbour among doubles moves otherwise, or is not reached in a second.

    Raises:
        DerivationError: the coordinate is named.
    """
    if max(map(abs, x.tolist()), default=0.0) < COMPUTED / np.finfo(float).eps:
        return
    apart = np.spacing(np.abs(x))
    for k in np.flatnonzero(apart[: len(phase.coordinates)] > COMPUTED):
        beside = x.copy()
        beside[k] += apart[k]
        rate, other = phase.rate(t, x), phase.rate(t, beside)
        gained = np.abs(phase.rate(t, x + rate)[k]) + np.abs(rate[k])
        if np.max(np.abs(other - rate)) > COMPUTED * np.max(np.abs(rate)) or 0 < gained < apart[k]:
            name = phase.coordinates[k]
            why = "farther than it moves in a second" if 0 < gained < apart[k] else "and move otherwise"
            what = f"'{name}' starts at {x[k]:.6g}, where neighbouring doubles are {apart[k]:.3g} apart"
            raise DerivationError(
                f"{what} {why}", f"coordinates.{name}", "start nearer to 0, an angle less whole turns"
            )


def _events(phase: PhaseModel, t: float, x: np.ndarray, plan: Plan) -> Events | None:
    """The bounds of the contacts, the edges of the ties, and last the condition; None without any."""
    floors = phase.signals.floors(t, x)
    asked = () if plan.until is None else (plan.until(phase),)
    if any(type(x) is not Node for x in asked):
        raise UsageError("nothing in the condition moves: it holds always or never", mend='write "theta = pi/2"')
    further = (*left_of(phase.edges), *asked)
    if not further and not phase.bounds:
        return None
    whole = phase.signals.measured(further)
    if not further:
        return Events(phase.signals.watched, floors, measured=whole)
    function = phase.functions.function(further)

    def values(t: np.ndarray, x: np.ndarray) -> np.ndarray:
        return np.hstack([phase.signals.watched(t, x), function.many(t, phase.functions.inner(x), phase.p)])

    floors = np.append(floors, np.full(len(further), COMPUTED))
    either = (len(floors) - 1,) if asked else ()
    return Events(values, floors, either, TOUCH * plan.how.rtol, whole)


def _at_edge(phase: PhaseModel, run: Run) -> Run:
    """The run; where it came to an edge of a tie, that is why it ended."""
    k = -1 if run.crossing is None else run.crossing.index - len(phase.bounds)
    if not 0 <= k < len(phase.edges):
        return run
    return replace(run, status="singular", message=stopped_at(phase.edges[k], run.end), crossing=None)


def _determined(phase: PhaseModel, run: Run, how: Stepping) -> Run:
    """The run, ended where the ties do not say how it goes on, and it went astray."""
    if run.status == "singular" or not phase.undetermined:
        return run
    finer = replace(how, rtol=_finer(how.rtol), atol=_finer(how.atol), most_steps=STEPS_AGAIN, breakpoints=())
    flow = Flow(phase.rate, finer, phase.functions.rhs.spheres, phase.projection)

    def again(start: float, x: np.ndarray, end: float) -> np.ndarray:
        found = flow.march((start, end), x, np.array([start, end]), None)
        return found.last if found.status == "finished" else np.full_like(x, np.nan)

    for what in phase.undetermined:
        run = ended_where_singular(run, what, again, rtol=how.rtol)
    return run


def _finer(tolerance: float) -> float:
    return max(tolerance / 1000, FINEST_RUN)


def _hasty(phase: PhaseModel, hasty: int) -> str:
    """That phases follow one another without time going on; "" where they do not."""
    return f"the contacts {_contacts(phase)} change without end at one instant" if hasty == MOST_AT_ONCE else ""


def _endless(phase: PhaseModel, count: int, instants: tuple[float, float, float]) -> str:
    """Why the end is out of reach at the pace of the last phases; "" where it is not.

    Args:
        instants: of the last look, now, and of the end [s].
    """
    looked, now, end = instants
    left = LOOK_PHASES * (end - now) / (now - looked) if now > looked else math.inf
    if left <= MOST_PHASES:
        return ""
    coming = f"{left:.1e} more of them are left to t = {end:.6g} s"
    return f"after {count} phases the contacts {_contacts(phase)} still change, {coming}"


def _contacts(phase: PhaseModel) -> str:
    return ", ".join(f"'{contact.name}'" for contact in phase.contacts)


def _standstill(phase: PhaseModel, here: PhaseStart, failure: str) -> PhaseRun:
    """Where no phase follows."""
    x = phase.state(here.values)
    message = f"Stopped at t = {here.t:.6g} s: {failure}."
    return PhaseRun(here, phase, Run(np.array([here.t]), x[None, :], here.t, x, "contact", message, 0, 0), None, None)
