"""Start -> the phases of a motion, one after the other, each with its own equations; a plain model has one."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property

import numpy as np

from eomgen.codegen import Program, RightHandSide
from eomgen.errors import DerivationError, RunFailed, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import DependentBlock
from eomgen.mechanics.dynamics import EquationsOfMotion, ForceJumps
from eomgen.simulation.compiled_phases import CompiledPhases, compiled_phases
from eomgen.simulation.contacts import Configuration
from eomgen.simulation.departure import RestDeparture
from eomgen.simulation.event_location import TOUCH, Events, nodes_between, transform
from eomgen.simulation.integrator import Run, Stepping, march
from eomgen.simulation.many_runs import MOST_AT_INSTANT
from eomgen.simulation.phase_change import PhaseStart, next_start
from eomgen.simulation.phase_model import PhaseModel
from eomgen.simulation.phase_models import PhaseModels
from eomgen.simulation.phase_run import PhaseCondition, PhaseRun, ended
from eomgen.simulation.singular import Flow, ended_where_singular, march_across
from eomgen.symbolic.exact import roots
from eomgen.symbolic.expression import Node, Scalar, State, depends_on
from eomgen.symbolic.numeric import FLOAT, evaluate, tolerances
from eomgen.symbolic.print import to_text

LOOK_PHASES = 1000  # from one look at how fast they follow one another to the next
MOST_PHASES = 100_000  # that may be left to the end: about half an hour of work
FEW_STEPS = 200  # of a phase that is run by Python where it may never come again
STEPS_AGAIN = 10_000  # of the finer integration across one instant


@dataclass(frozen=True)
class Plan:
    """Options of the integration of a motion.

    Args:
        end: the last instant [s].
        how: the integrator's options.
        instants: at which states are wanted; None: at the integrator's own steps.
        until: the condition that ends it where it becomes 0.
    """

    end: float
    how: Stepping
    instants: np.ndarray | None = None
    until: PhaseCondition | None = None

    def through(self, models: PhaseModels, here: PhaseStart) -> Iterator[PhaseRun]:
        """The phases of a motion, up to the first instant at which its end condition holds."""
        runs = passed(models, here, self)
        return runs if self.until is None else ended(runs, self.until)


def passed(models: PhaseModels, here: PhaseStart, plan: Plan) -> Iterator[PhaseRun]:
    """The phases one after the other; the last is the one that ends with the time, the condition, or in failure."""
    with compiled_phases(models, plan.how) as in_c:
        yield from _passed(models, here, plan, in_c if plan.until is None else None)


def _passed(models: PhaseModels, here: PhaseStart, plan: Plan, in_c: CompiledPhases | None) -> Iterator[PhaseRun]:
    """The same, each phase in C where all that it needs is there."""
    pace = _Pace(plan, here.t)
    while True:
        for each in () if in_c is None else in_c.through(here, plan, pace.ended):
            yield each
            if each.after is None:
                return
            pace.add(each)
            here = each.after
            if pace.is_looked_at:
                break
        phase = models.of(here.configuration)
        failure = here.failure or pace.failure(phase, here)
        if failure:
            yield _standstill(phase, here, failure)
            return
        phase, run, rests = _followed(models, phase, here, plan)
        if rests is not None:
            yield PhaseRun(here, phase, run, None, rests)
            here = rests
            continue
        crossing = run.crossing
        if crossing is None or crossing.index >= len(phase.bounds):
            yield PhaseRun(here, phase, run, None, None)
            return
        bound = phase.bounds[crossing.index]
        pace.add(PhaseRun(here, phase, run, bound, None))
        after = next_start(models, phase, crossing, pace.ended)
        yield PhaseRun(here, phase, run, bound, after)
        here = after


@dataclass
class _Pace:
    """Pace at which the phases of a run follow one another.

    Args:
        ended: the configurations that ended at the last instant.
        hasty: phases that ended as soon as they began, one after the other.
        count: of all phases that ended by an event.
        looked: the instant of the last look [s].
        seen: how many there were then.
    """

    plan: Plan
    looked: float
    ended: frozenset[Configuration] = frozenset()
    hasty: int = 0
    count: int = 0
    seen: int = 0

    def add(self, phase_run: PhaseRun) -> None:
        """One phase more."""
        here, run = phase_run.here, phase_run.run
        if phase_run.bound is None:
            return
        soon = run.end - here.t <= tolerances.COMPUTED
        self.hasty, self.count = self.hasty + 1 if soon else 0, self.count + 1
        self.ended = frozenset({*(self.ended if soon else ()), here.configuration})

    @property
    def is_looked_at(self) -> bool:
        """True if they are too fast, or a look at how fast they are is due."""
        return self.hasty == MOST_AT_INSTANT or (self.count != self.seen and self.count % LOOK_PHASES == 0)

    def failure(self, phase: PhaseModel, here: PhaseStart) -> str:
        """Why no phase follows; "" where one does."""
        if self.hasty == MOST_AT_INSTANT:
            return f"the contacts {_contacts(phase)} change without end at one instant"
        if self.count == self.plan.how.most_phases:
            return f"after {self.count} phases the contacts {_contacts(phase)} still change"
        if self.count == self.seen or self.count % LOOK_PHASES:
            return ""
        (looked, self.looked), self.seen = (self.looked, here.t), self.count
        return _endless(phase, self.count, (looked, here.t, self.plan.end))


def _followed(
    models: PhaseModels, phase: PhaseModel, here: PhaseStart, plan: Plan
) -> tuple[PhaseModel, Run, PhaseStart | None]:
    """(the phase, and as of `_until_rest`): where it may never come again and is short, without a compiler."""
    if not models.comes_again(here.configuration) and plan.how.most_steps > FEW_STEPS:
        few, own = replace(plan, how=replace(plan.how, most_steps=FEW_STEPS)), phase.interpreted
        run, rests = _until_rest(own, here, few)
        if run.status != "too many steps":
            return own, run, rests
    return phase, *_until_rest(phase, here, plan)


def _until_rest(phase: PhaseModel, here: PhaseStart, plan: Plan) -> tuple[Run, PhaseStart | None]:
    """(the phase as it was run, what follows where bounces without end come to rest within it, or None)."""
    limit = here.t + (here.limit or 0.0)
    if not here.t < limit < plan.end:
        return advance(phase, here, plan), None
    wanted = None if plan.instants is None else plan.instants[plan.instants < limit]
    run = advance(phase, here, replace(plan, end=limit, instants=wanted))
    if run.status != "finished":
        return run, None
    return run, PhaseStart(limit, phase.values(run.end, run.last), here.configuration)


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
    flow = Flow(
        phase.rate, plan.how, phase.functions.rhs.unit_quaternions, phase.projection, lambda: phase.slope, level
    )
    run = march_across(flow, (here.t, plan.end), x, phase.nearness, instants=wanted, events=events)
    return _determined(phase, _named(phase, _at_edge(phase, run), here.t), plan.how)


def _named(phase: PhaseModel, run: Run, begun: float) -> Run:
    """The run; where it ended at a state without a value, with the quantity that has none there or is too large."""
    if run.status in ("step too small", "too many steps") and (large := phase.overlarge(run.end, run.last)):
        return replace(run, message=f"{run.message[:-1]}: {large.what}.")
    if run.status in ("step too small", "too many steps") and (jumping := ForceJumps(phase.system).signs):
        reported = (
            f"A force jumps with the sign of {to_text(jumping[0])}, and sticks where that is 0: {ForceJumps.SMOOTH}."
        )
        return replace(run, message=f"{run.message} {reported}")
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
    if max(map(abs, x.tolist()), default=0.0) < tolerances.COMPUTED / np.finfo(float).eps:
        return
    apart = np.spacing(np.abs(x))
    for k in np.flatnonzero(apart[: len(phase.coordinates)] > tolerances.COMPUTED):
        beside = x.copy()
        beside[k] += apart[k]
        rate, other = phase.rate(t, x), phase.rate(t, beside)
        gained = np.abs(phase.rate(t, x + rate)[k]) + np.abs(rate[k])
        if np.max(np.abs(other - rate)) > tolerances.COMPUTED * np.max(np.abs(rate)) or 0 < gained < apart[k]:
            name = phase.coordinates[k]
            why = "farther than it moves in a second" if 0 < gained < apart[k] else "and move otherwise"
            what = f"'{name}' starts at {x[k]:.6g}, where neighbouring doubles are {apart[k]:.3g} apart"
            raise DerivationError(
                f"{what} {why}", f"coordinates.{name}", "start nearer to 0, an angle less whole turns"
            )


def _events(phase: PhaseModel, t: float, x: np.ndarray, plan: Plan) -> Events | None:
    """The bounds of the contacts, the edges of the constraints, and last the condition; None without any."""
    floors = phase.signals.floors(t, x)
    requested = () if plan.until is None else (plan.until(phase),)
    if any(type(x) is not Node for x in requested):
        raise UsageError("nothing in the condition moves: it holds always or never", fix='write "theta = pi/2"')
    further = (*(edge.left for edge in phase.edges), *requested)
    if not further and not phase.bounds:
        return None
    whole = phase.signals.measured(further)
    if not further:
        return Events(phase.signals.watched, floors, measured=whole)
    function = phase.functions.function(further)

    def values(t: np.ndarray, x: np.ndarray) -> np.ndarray:
        return np.hstack([phase.signals.watched(t, x), function.many(t, phase.functions.inner(x), phase.p)])

    floors = np.append(floors, np.full(len(further), tolerances.COMPUTED))
    either = (len(floors) - 1,) if requested else ()
    return Events(values, floors, either, TOUCH * plan.how.rtol, whole)


def _at_edge(phase: PhaseModel, run: Run) -> Run:
    """The run; where it came to an edge of a constraint, that is why it ended."""
    k = -1 if run.crossing is None else run.crossing.index - len(phase.bounds)
    if not 0 <= k < len(phase.edges):
        return run
    message = f"Stopped at t = {run.end:.6g} s: {phase.edges[k].words}, and how it goes on is not determined."
    return replace(run, status="singular", message=message, crossing=None)


def _determined(phase: PhaseModel, run: Run, how: Stepping) -> Run:
    """The run, ended where the constraints do not determine its continuation and it went astray."""
    if run.status == "singular" or not phase.undetermined:
        return run
    finer = replace(how, rtol=_finer(how.rtol), atol=_finer(how.atol), most_steps=STEPS_AGAIN, breakpoints=())
    flow = Flow(phase.rate, finer, phase.functions.rhs.unit_quaternions, phase.projection)

    def again(start: float, x: np.ndarray, end: float) -> np.ndarray:
        found = flow.march((start, end), x, np.array([start, end]), None)
        return found.last if found.status == "finished" else np.full_like(x, np.nan)

    for what in phase.undetermined:
        run = ended_where_singular(run, what, again, rtol=how.rtol)
    return run


def _finer(tolerance: float) -> float:
    return max(tolerance / 1000, tolerances.FINEST_RUN)


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
    """Phase of a single instant, where no phase can follow."""
    x = phase.state(here.values)
    message = f"Stopped at t = {here.t:.6g} s: {failure}."
    return PhaseRun(here, phase, Run(np.array([here.t]), x[None, :], here.t, x, "contact", message, 0, 0), None, None)


# -------- dense motion ----------------------------------------------------------------------------------------
# A phase as it was run -> its states at any instant: polynomials between the integrator's steps, of the same steps.


DEGREE = 9  # that of the integrator's own polynomials between its steps, and two more
MOST_HALVINGS = 6
CUT = ("interrupted", "out of patience")


@dataclass(frozen=True)
class DenseMotion:
    """The states of one phase at any instant of it.

    Args:
        edges: the pieces, ascending: the integrator's steps.
        states: at the nodes of each piece, pieces x nodes x states.
    """

    edges: np.ndarray
    states: np.ndarray

    @staticmethod
    def of(phase_run: PhaseRun, plan: Plan) -> DenseMotion:
        """The states of a phase between its steps.

        It is followed once more with other instants, which change no step; where polynomials of so low a degree are not
        what lies between two steps (few of many steps are stored), at more of them.

        Args:
            plan: the options with which it was run.
        Raises:
            RunFailed: the run was cut before its end.
        """
        run, here = phase_run.run, phase_run.here
        if run.status in CUT:
            raise RunFailed(f"the run was cut: {run.message}", fix="a longer --patience, or a shorter run")
        kept = np.concatenate([part for track in run.tracks for part in track.t])
        edges = np.unique(np.clip(np.concatenate([[here.t, run.end], kept, *run.carried]), here.t, run.end))
        edges = edges[np.append(True, np.diff(edges) > tolerances.ROUNDING * max(1.0, run.end - here.t))]
        edges[-1] = run.end
        for _ in range(MOST_HALVINGS + 1):
            found = _through(phase_run, plan, edges)
            last = np.abs(np.einsum("kn,mnx->mkx", transform(DEGREE)[-2:], found.states)).max(axis=1)
            size = np.abs(found.states).max(axis=(0, 1), initial=0.0)
            rough = (last > 10 * (plan.how.rtol * size + plan.how.atol)).any(axis=1)
            if not rough.any():
                break
            edges = np.sort(np.concatenate([edges, (edges[:-1] + edges[1:])[rough] / 2]))
        return found

    def at(self, t: np.ndarray) -> np.ndarray:
        """n x states, by the barycentric formula sum w_k x_k/(s - s_k) / sum w_k/(s - s_k)."""
        if len(self.states) == 0:
            raise RunFailed("the phase is one instant", fix="a longer run")
        k = np.clip(np.searchsorted(self.edges, t, side="right") - 1, 0, len(self.states) - 1)
        a, b = self.edges[k], self.edges[k + 1]
        nodes = -np.cos(np.pi * np.arange(DEGREE + 1) / DEGREE)
        weights = (-1.0) ** np.arange(DEGREE + 1)
        weights[[0, -1]] /= 2
        apart = ((2 * t - a - b) / (b - a))[:, None] - nodes
        exact = np.abs(apart) < tolerances.ROUNDING
        shares = weights / np.where(exact, 1.0, apart)
        shares = np.where(exact.any(axis=1)[:, None], exact, shares)
        found: np.ndarray = np.einsum("nk,nkx->nx", shares, self.states[k]) / shares.sum(axis=1)[:, None]
        return found


def _through(phase_run: PhaseRun, plan: Plan, edges: np.ndarray) -> DenseMotion:
    run, here = phase_run.run, phase_run.here
    nodes = nodes_between(edges, DEGREE)
    times = np.unique(nodes)
    again = advance(phase_run.phase, here, replace(plan, instants=times[times < run.end]))
    if again.end != run.end:
        raise RunFailed(
            f"followed once more the phase ends at t = {again.end:.12g} s, not at {run.end:.12g} s",
            fix="smaller tolerances: rtol, atol",
        )
    t, x = np.append(again.t[again.t < run.end], run.end), np.vstack([again.x[again.t < run.end], run.last])
    return DenseMotion(edges, x[np.searchsorted(t, nodes)])


# -------- first time ------------------------------------------------------------------------------------------
# System, condition, start -> the state at which the condition first holds after the start, in numbers.
#
# By the motion in time; from an unstable rest or a dead centre along the configurations (`rest_departure`).


LONGEST = 1e9  # s, of a search
FINE = Stepping.fine(100_000)
SEARCH = replace(FINE, most_steps=4000)
FAIR = replace(
    SEARCH, rtol=tolerances.FAIR_RUN, atol=tolerances.FAIR_RUN
)  # where the finer one does not come across a singular position


@dataclass(frozen=True)
class FirstTime:
    """A motion in one phase, and the condition sought on it.

    Args:
        equations, accelerations: the equations of motion.
        condition: of q, u, t and parameters; it vanishes at the instant.
        exact: q and u at the start as scalars of the parameters, {} where they have no closed form.
        start: t, q and u at the start.
        values: of the parameters.
    """

    equations: EquationsOfMotion
    accelerations: tuple[Scalar, ...]
    condition: Scalar
    exact: State
    start: State
    values: State

    def located(self) -> tuple[State, str]:
        """(t, q and u at the instant, the method); t is nan where it is not known.

        Raises:
            RunFailed: the condition is not met.
        """
        if not depends_on(self.condition, self.equations.symbols.x):
            return self._at_time(), "integration in time"
        if (departure := self._departure()).is_needed:
            return departure.first(self.condition), "energy theorem"
        run = self._met()
        self._refuse_undetermined(run)
        return self._state(run), "integration in time"

    @property
    def t0(self) -> float:
        return float(self.start.get(self.equations.symbols.t, 0.0))

    @cached_property
    def _phase(self) -> PhaseModel:
        p = np.array([self.values[node] for node in self.equations.symbols.parameters.values()])
        return PhaseModels.one_phase(self.equations.system, self.equations, p)

    @cached_property
    def _here(self) -> PhaseStart:
        symbols = self.equations.symbols
        begun = {node.name: float(self.start[node]) for node in symbols.x}
        return PhaseStart(self.t0, self._phase.with_rates(self.t0, begun), Configuration())

    def _departure(self) -> RestDeparture:
        equations = (self.equations, self.accelerations)
        return RestDeparture(*equations, self.exact, self.start, self.values, self._phase, dict(self._here.values))

    def _state(self, run: Run) -> State:
        symbols, values = self.equations.symbols, self._phase.values(run.end, run.last)
        return {symbols.t: run.end} | {node: values[node.name] for node in symbols.x}

    def _at_time(self) -> State:
        """The state at a time that is given by itself.

        Raises:
            RunFailed: the motion does not go on until then.
        """
        end = self._given_time()
        if end <= self.t0:
            return {**self.start, self.equations.symbols.t: end}
        run = advance(self._phase, self._here, Plan(end, FINE))
        if run.status != "finished" or not np.all(np.isfinite(run.last)):
            raise RunFailed(
                f"the motion ends before the instant: {run.message[0].lower()}{run.message[1:]}",
                fix="ask for an earlier one",
            )
        return self._state(run)

    def _met(self) -> Run:
        """The motion up to where the condition first holds.

        Raises:
            RunFailed: it is not met.
        """
        for how in (SEARCH, FAIR):
            run = advance(self._phase, self._here, Plan(self.t0 + LONGEST, how, None, lambda phase: self.condition))
            if run.status != "singular":
                break
        if run.crossing is None:
            raise RunFailed(
                f"the condition is not met as far as the motion was followed: {run.message}",
                fix="ask for what the motion reaches",
            )
        return run

    def _refuse_undetermined(self, run: Run) -> None:
        """Refuse an instant at which the rates of dependent coordinates are 0/0.

        Raises:
            RunFailed: they are named.
        """
        for block in self.equations.system.singular_blocks:
            t, x = np.array([self.t0, run.end]), np.vstack([self._phase.state(self._here.values), run.last])
            before, there = self._phase.functions.evaluated(t, x, (block.determinant,))[:, 0]
            if abs(there) < tolerances.DEGENERATE * abs(before):
                raise RunFailed(
                    f"{block} at that instant ({DependentBlock.PLACE})",
                    fix="leave out `dependent`: then their rates belong to the state",
                )

    def _given_time(self) -> float:
        """The first t, from the start on, at which a condition on t alone holds."""
        t = self.equations.symbols.t
        values = [float(evaluate((root,), self.values, FLOAT)[0]) for root in roots(self.condition, t)]
        later = [value for value in values if value >= self.t0 - tolerances.SOLVED]
        if later:
            return min(later)
        if values:
            raise DerivationError(f"the instant t = {max(values):g} s is before the start", fix="ask for a later one")
        function = RightHandSide.of(Program.of((self.condition,), self.equations.symbols), "numpy")
        x = np.array([self.start[node] for node in self.equations.symbols.x])
        events = Events(
            lambda t, _: function.many(t, np.tile(x, (len(t), 1)), self._phase.p), np.full(1, tolerances.COMPUTED), (0,)
        )
        run = march(lambda t, _: np.ones(1), (self.t0, LONGEST), np.zeros(1), how=SEARCH, events=events)
        if run.crossing is None:
            raise RunFailed("the condition on the time is never met", fix="ask for an instant after the start")
        return run.end
