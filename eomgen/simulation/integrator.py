"""x' = f(t, x), start -> the states of one run, step by step, and the reason if the end is out of reach.

x' = f(t, x), start -> the states of one run, step by step, by scipy's integrators.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from dataclasses import field, replace
from functools import cache, partial
from numbers import Real
from typing import Any, Protocol

import numpy as np

from eomgen.codegen import QuaternionPlaces, RateFunction, in_c
from eomgen.errors import UsageError
from eomgen.frozen import dataclass, with_fields
from eomgen.resources import PatienceEnded, check_patience, keep_what_there_is
from eomgen.simulation.compiled_steps import COMPILED, CompiledSteps, HeyokaSteps, Watched
from eomgen.simulation.constraint_drift import DriftCorrection, EnergyLevel, Projection
from eomgen.simulation.event_location import LOOKED_OUT, Crossing, Events, EventSearch, sharpened
from eomgen.simulation.result import RunStatus
from eomgen.simulation.solvers import (
    AUTO,
    EXPLICIT,
    HEYOKA,
    METHODS,
    TAYLOR,
    LateSlope,
    NotFinite,
    ScipySteps,
    StateRate,
    finer,
)
from eomgen.symbolic.numeric import tolerances

MOST = 20_000  # states


@dataclass
class StepStates:
    """States at the ends of steps: of all of them, or of every second, fourth, ... so that they do not grow too many.

    Args:
        t, x: instants and states, one a row; of a call in C all together.
        every: at each so many steps a state is stored.
        steps: taken so far.
    """

    t: list[np.ndarray] = field(default_factory=list)
    x: list[np.ndarray] = field(default_factory=list)
    every: int = 1
    steps: int = 0
    count: int = 0

    def add(self, t: np.ndarray, x: np.ndarray) -> None:
        """The states after steps, one a row; they are not copied."""
        first = -(self.steps + 1) % self.every
        self.steps += len(t)
        self.t.append(t[first :: self.every])
        self.x.append(x[first :: self.every])
        self.count += len(self.t[-1])
        while self.count > MOST:
            t, x = self.all
            self.t, self.x, self.every = [t[1::2]], [x[1::2]], 2 * self.every
            self.count = len(self.t[0])

    @property
    def all(self) -> tuple[np.ndarray, np.ndarray]:
        """(instants, states)."""
        return np.concatenate(self.t), np.concatenate(self.x)

    def until(self, end: float) -> StepStates:
        """The states up to an instant."""
        t, x = self.all
        n = int(np.searchsorted(t, end, side="right"))
        return StepStates([t[:n]], [x[:n]], self.every, self.steps, n)


def measured(t: np.ndarray, x: np.ndarray, tracks: Sequence[StepStates]) -> tuple[np.ndarray, np.ndarray]:
    """(t n, x n x states): the rows of a run and the states of its tracks, in the order of time."""
    times = np.concatenate([t, *(part for track in tracks for part in track.t)])
    states = np.concatenate([x, *(part for track in tracks for part in track.x)])
    order = np.argsort(times, kind="stable")
    return times[order], states[order]


MOST_STEPS = 100_000_000  # an hour of a small system in C
MOST_FINE_STEPS = 200  # from one instant to the next around an event
SHARE = 0.1  # of the tolerances of a run: those of one step
RATES = (10.0, 10.0)  # of Baumgarte's rows [1/s]
NO_QUATERNIONS = QuaternionPlaces()
STABILIZATIONS = ("projection", "energy", "baumgarte", "none")

Dense = Callable[[], Callable[[Any], np.ndarray]]
Steps = CompiledSteps | ScipySteps | HeyokaSteps


@dataclass(frozen=True)
class Stepping:
    """Options of an integrator.

    Args:
        method: one of METHODS; "auto" is DOP853, and Radau where a motion is stiff; "taylor" goes by power series where
            the equations have them, else as "auto".
        rtol, atol: tolerances of one step.
        most_steps: after so many it gives up.
        most_phases: after so many changes of contacts it gives up; None: where the end is out of reach.
        stabilization: the method that keeps the constraints satisfied, one of STABILIZATIONS: "projection" puts states
            back onto them, "energy" also onto the energy that they began with, "baumgarte" adds feedback of the gaps
            to the equations, "none" leaves them alone.
        every: project at each so many steps; None: where a constraint is open by more than atol.
        rates: alpha and beta of Baumgarte's rows [1/s].
        breakpoints: instants across which no step goes, ascending [s].
        keeps: a run that is interrupted returns the states found so far; else it raises.
    """

    method: str = "DOP853"
    rtol: float = tolerances.RUN
    atol: float = tolerances.RUN
    most_steps: int = MOST_STEPS
    stabilization: str = "projection"
    every: int | None = None
    rates: tuple[float, float] = RATES
    breakpoints: tuple[float, ...] = ()
    keeps: bool = False
    most_phases: int | None = None

    @staticmethod
    def fine(most_steps: int) -> Stepping:
        """Fine tolerances: of motions whose instants are then sought in closed form."""
        return Stepping(AUTO, tolerances.FINE_RUN, tolerances.FINE_RUN, most_steps)

    def refuse_bad_run(self, start: float, end: float) -> None:
        """Refuses options that make no sense.

        Raises:
            UsageError: the time, a tolerance, the method, or the stabilization of constraints.
        """
        if not (math.isfinite(start) and math.isfinite(end) and end >= start):
            raise UsageError(
                f"the time from {start:g} s to {end:g} s makes no sense", fix="give an end after the start"
            )
        if not all(isinstance(x, Real) and 0 < x < math.inf for x in (self.rtol, self.atol)):
            raise UsageError(
                f"tolerances must be positive numbers, not rtol = {self.rtol}, atol = {self.atol}",
                fix="take rtol and atol above 0",
            )
        if self.method not in (*METHODS, HEYOKA):
            raise UsageError(f"unknown method '{self.method}'", fix=f"methods are {', '.join((*METHODS, HEYOKA))}")
        if self.stabilization not in STABILIZATIONS:
            raise UsageError(
                f"unknown way to keep constraints closed: '{self.stabilization}'",
                fix=f"ways are {', '.join(STABILIZATIONS)}",
            )
        if self.every is not None and self.every < 1:
            raise UsageError(f"projection at every {self.every} steps makes no sense", fix="give 1 or more")

    def of_one_step(self) -> Stepping:
        """The tolerances of a whole run cut down to one step's: errors of many steps add up."""
        step: Stepping = with_fields(self, rtol=max(SHARE * self.rtol, tolerances.LEAST_RTOL), atol=SHARE * self.atol)
        return step

    @property
    def finer(self) -> Stepping:
        """The tolerances of the run that one is held against; coarser ones where there are no finer."""
        return replace(self, rtol=finer(self.rtol), atol=finer(self.atol))

    @property
    def is_in_lanes(self) -> bool:
        """True if many runs can be made so in the lanes of vectors."""
        return self.method in (AUTO, "DOP853", TAYLOR) and self.stabilization in ("projection", "none")

    @property
    def is_in_marches(self) -> bool:
        """True if many runs can be made so, one after the other, without Python."""
        projected = self.stabilization in ("projection", "none") and self.every is None
        return self.method in (AUTO, "DOP853") and projected

    def hold(
        self,
        unit_quaternions: QuaternionPlaces,
        projection: Projection | None,
        level: EnergyLevel | None = None,
    ) -> DriftCorrection:
        """Drift correction of the states of one run; the norms of quaternions are always corrected."""
        kept = projection if self.stabilization in ("projection", "energy") else None
        return DriftCorrection(unit_quaternions, kept, self.atol, self.every, level=level)


@dataclass(frozen=True)
class Run:
    """Result of an integration.

    Args:
        t, x: the instants reached and the states there, one row each.
        end, last: the instant that it reached [s], and the state there.
        crossing: the event that ended it.
        tracks: states at the integrator's steps, the start among them.
        carried: the start and the end of each crossing of a singular position.
    """

    t: np.ndarray
    x: np.ndarray
    end: float
    last: np.ndarray
    status: RunStatus
    message: str
    steps: int
    evaluations: int
    crossing: Crossing | None = None
    tracks: tuple[StepStates, ...] = ()
    carried: tuple[tuple[float, float], ...] = ()


class Lookout(Protocol):
    """Condition that ends a run by the state at the end of each step; it looks into the step only where needed."""

    def step(self, t_old: float, t_new: float, x_new: np.ndarray, dense: Dense) -> Crossing | None:
        """A crossing of index LOOKED_OUT in the step; `dense()` gives the state at instants in it."""


@dataclass(frozen=True)
class _Watches:
    """Both kinds of conditions that end a run."""

    watch: EventSearch | None
    lookout: Lookout | None

    def step(self, t_old: float, t_new: float, x_new: np.ndarray, dense: Dense) -> Crossing | None:
        """The first crossing in a step."""
        one = None if self.watch is None else self.watch.step(t_old, t_new, dense())
        other = None if self.lookout is None else self.lookout.step(t_old, t_new, x_new, dense)
        return min((each for each in (one, other) if each is not None), key=lambda each: each.t, default=None)


@dataclass(frozen=True)
class _Rows:
    """The rows of a run as they come: at the requested instants, or (None) at the integrator's own steps."""

    instants: np.ndarray | None
    hold: DriftCorrection
    t: list[np.ndarray]
    x: list[np.ndarray]
    track: StepStates
    end: float

    def add(self, span: tuple[float, float], x_new: np.ndarray, dense: Dense) -> None:
        """The instants of a step, its beginning left out, or its end; x_new is the state there."""
        self.track.add(np.array([span[1]]), x_new[None, :].copy())
        if self.instants is None:
            self._put(span[1], x_new)
            return
        first, last = np.searchsorted(self.instants, span, side="right")
        if last > first:
            t = self.instants[first:last]
            self.t.append(t)
            self.x.append(self.hold.rows(t, dense()(t).T))

    def take(self, steps: CompiledSteps) -> None:
        """Takes over the states of finished steps in C."""
        t, x = steps.track
        self.track.add(t, x)
        t, x = (t, x) if self.instants is None else steps.rows()
        if len(t):
            self.t.append(t)
            self.x.append(x)

    def close(self, t: float, x: np.ndarray) -> None:
        """The state in which a run ended early, unless it is there."""
        if not self.t or not self.t[-1].size or self.t[-1][-1] != t:
            self._put(t, x)

    def kept(self) -> tuple[float, np.ndarray]:
        """The last stored state and its instant, in the middle of whatever a run was stopped."""
        for times, states in ((self.t, self.x), (self.track.t, self.track.x)):
            whole = min(len(times), len(states))
            del times[whole:], states[whole:]
        found = []
        for times, states in ((self.t, self.x), (self.track.t, self.track.x)):
            whole = min(len(times), len(states))
            del times[whole:], states[whole:]
            found += [(float(t[-1]), x[-1]) for t, x in zip(times, states, strict=True) if len(t)][-1:]
        return max(found, key=lambda each: each[0])

    def _put(self, t: float, x: np.ndarray) -> None:
        self.t.append(np.array([t]))
        self.x.append(x[None, :].copy())


def march(
    f: StateRate,
    span: tuple[float, float],
    x0: np.ndarray,
    *,
    how: Stepping,
    instants: np.ndarray | None = None,
    events: Events | None = None,
    unit_quaternions: QuaternionPlaces = NO_QUATERNIONS,
    projection: Projection | None = None,
    slope: LateSlope | None = None,
    lookout: Lookout | None = None,
    level: EnergyLevel | None = None,
) -> Run:
    """Step from the first instant of the span to the second, or to an event, or until it goes no further.

    Args:
        instants: at which states are wanted, in order; None: at the integrator's own steps.
        unit_quaternions: the places of quaternions in x: each is put back to norm 1 after every step.
        projection: onto the constraints; it corrects the states between the steps too.
        slope: df/dx, used where steps are implicit.
        level: the energy that is held constant.
    """
    start, end = span
    hold = how.hold(unit_quaternions, projection, level)
    x0 = hold.at(start, x0)
    if not all(map(math.isfinite, f(start, x0))):
        return Run(np.array([start]), x0[None, :], start, x0, "not finite", _no_value(start), 0, 1)
    if end == start or x0.size == 0:
        times = instants if instants is not None and end > start else np.unique([start, end])
        return Run(times, np.tile(x0, (len(times), 1)), end, x0, "finished", reached_words(end), 0, 1)
    requested = 1 if instants is None or (instants.size and instants[0] == start) else 0
    rows = _Rows(
        instants,
        hold,
        [np.array([start])[:requested]],
        [x0[None, :][:requested]],
        StepStates([np.array([start])], [x0[None, :]], count=1),
        end,
    )
    watch = EventSearch(events, start, x0) if events is not None else None
    late = slope if slope is not None else lambda: None
    how, instead = _possible(how, f)
    solver: Steps | None = None
    if how.method in COMPILED and getattr(f, "address", None) is not None:
        watched: Watched = (hold, watch, lookout)
        marched = partial(CompiledSteps, f, span, x0, how=how, instants=instants, watched=watched, slope=late)
        solver = in_c(marched, "steps are taken in Python, slower")
    if solver is None:
        solver = _stepped_outside(f, span, x0, how, late)
    pace = Pace(f, how.method, start, end, how.most_steps)
    try:
        status, message, steps, crossing = _stepped(f, solver, rows, _Watches(watch, lookout), how, pace)
        t, x = (float(solver.t), solver.y) if crossing is None else (crossing.t, crossing.x)
    except PatienceEnded:
        if not how.keeps:
            raise
        keep_what_there_is()
        t, x = rows.kept()
        steps, crossing = rows.track.steps, None
        status, message = "out of patience", _impatient(pace.words(steps, t, x), t, steps)
    except KeyboardInterrupt:
        t, x = rows.kept()
        status, message, steps, crossing = "interrupted", f"Interrupted at t = {t:.6g} s.", rows.track.steps, None
    if status != "finished":
        rows.close(t, x)
    message = " ".join(part for part in (message or reached_words(end), instead, solver.words, hold.remark) if part)
    times, states = np.concatenate(rows.t), np.concatenate(rows.x)
    return Run(times, states, t, x, status, message, steps, solver.nfev, crossing, (rows.track,))


def _stepped_outside(
    f: StateRate, span: tuple[float, float], x0: np.ndarray, how: Stepping, slope: LateSlope
) -> HeyokaSteps | ScipySteps:
    """The steps of another program: heyoka's where it is requested, else scipy's."""
    if how.method == HEYOKA:
        program, p = (f.rhs.program, f.p) if isinstance(f, RateFunction) else (None, ())
        return HeyokaSteps(program, p, span, x0, tolerance=how.rtol, breakpoints=how.breakpoints)
    tolerances = {"rtol": how.rtol, "atol": how.atol}
    return ScipySteps(how.method, f, span, x0, breakpoints=how.breakpoints, slope=slope, **tolerances)


def _possible(how: Stepping, f: StateRate) -> tuple[Stepping, str]:
    """(options of the integrator, reason why they are not as requested): series need equations in C that have them."""
    if how.method != TAYLOR:
        return how, ""
    if getattr(f, "address", None) is None:
        why = "not in C" if isinstance(f, RateFunction) else "more than the equations of motion is stepped"
    else:
        lacks = f.rhs.without_series if isinstance(f, RateFunction) else ""
        why = lacks and f"'{lacks}' has none"
    return (replace(how, method=AUTO), f"Not by power series ({why}).") if why else (how, "")


def _stepped(
    f: StateRate, solver: Steps, rows: _Rows, watches: _Watches, how: Stepping, pace: Pace
) -> tuple[RunStatus, str, int, Crossing | None]:
    """(status, message, steps, the event that ended it)."""
    steps, hold = 0, rows.hold
    while solver.status == "running":
        if steps == how.most_steps:
            return "too many steps", f"Gave up after {steps} steps, at t = {solver.t:.6g} s.", steps, None
        try:
            taken, calm = solver.advance(min(how.most_steps - steps, LOOK - steps % LOOK))
        except NotFinite:
            return "not finite", _no_value(solver.t), steps, None
        if isinstance(solver, CompiledSteps):
            rows.take(solver)
        steps += taken
        if solver.status == "failed":
            return *_failed(f, solver), steps, None
        check_patience()
        if taken and (hopeless := pace.hopeless(steps, solver.t, solver.y)):
            return "too many steps", f"Gave up after {steps} steps, at t = {solver.t:.6g} s: {hopeless}.", steps, None
        if calm:
            continue
        dense = cache(solver.dense_output)
        crossing = watches.step(solver.t_old, solver.t, solver.y, dense)
        if crossing is not None:
            crossing = _exactly(f, watches, crossing, (solver.t_old, solver.t), dense()(solver.t_old), how)
            crossing = replace(crossing, x=hold.at(crossing.t, crossing.x))
            rows.add((solver.t_old, crossing.t), crossing.x, dense)
            return "event", f"Stopped by an event at t = {crossing.t:.6g} s.", steps, crossing
        x, moved = hold.step(solver.t, solver.y)
        rows.add((solver.t_old, solver.t), x, dense)
        if isinstance(solver, CompiledSteps):
            solver.passed(solver.t)
        if moved:
            solver.put(x)
    return "finished", "", steps, None


def _exactly(
    f: StateRate, watches: _Watches, crossing: Crossing, span: tuple[float, float], x: np.ndarray, how: Stepping
) -> Crossing:
    """A crossing in the step over a span that began in x, by finer steps that end there."""
    if watches.watch is None or crossing.index == LOOKED_OUT or how.method not in (AUTO, *EXPLICIT, HEYOKA):
        return crossing
    before, after = bisect_right(how.breakpoints, span[0]), bisect_left(how.breakpoints, crossing.t)
    near = [abs(crossing.t - t) for t in how.breakpoints[max(before - 1, 0) : after + 1]]
    width = min([span[1] - span[0], *(d for d in near if d > 0)])
    return sharpened(watches.watch, crossing, width, lambda t: _carried(f, span[0], x, t))


def _carried(f: StateRate, t_0: float, x_0: np.ndarray, times: np.ndarray) -> np.ndarray:
    """The states at some instants, each the end of fine steps from the one nearer to t_0; nan where there is none."""
    found = np.full((len(times), len(x_0)), np.nan)
    for which in (np.flatnonzero(times >= t_0), np.flatnonzero(times < t_0)[::-1]):
        t, x = t_0, x_0
        for i in which[np.argsort(np.abs(times[which] - t_0), kind="stable")]:
            x = _stepped_to(f, t, x, float(times[i]))
            found[i], t = x, float(times[i])
    return found


def _stepped_to(f: StateRate, t: float, x: np.ndarray, end: float) -> np.ndarray:
    """x at the end, by steps of the finest tolerance; nan where they do not get there."""
    from scipy.integrate import DOP853

    if t == end or not np.all(np.isfinite(x)):
        return x
    with np.errstate(all="ignore"):
        solver = DOP853(f, t, x, end, rtol=tolerances.FINEST_RUN, atol=tolerances.FINEST_RUN, first_step=abs(end - t))
        for _ in range(MOST_FINE_STEPS):
            if solver.status != "running":
                break
            solver.step()
    return solver.y if solver.status == "finished" else np.full_like(x, np.nan)


def _failed(f: StateRate, solver: Any) -> tuple[RunStatus, str]:
    """Why the step size went to nothing."""
    ahead = solver.t + tolerances.COMPUTED * max(1.0, abs(solver.t))
    if not np.all(np.isfinite(f(ahead, solver.y + (ahead - solver.t) * f(solver.t, solver.y)))):
        return "not finite", _no_value(solver.t)
    return "step too small", f"Stopped at t = {solver.t:.6g} s: the step size went to zero."


def _impatient(why: str, t: float, steps: int) -> str:
    return (
        f"Gave up at t = {t:.6g} s: the time to wait (--patience) is over after {steps} steps"
        + f"; {why}" * bool(why)
        + "."
    )


def _no_value(t: float) -> str:
    return f"Stopped at t = {t:.6g} s: the accelerations have no finite value there."


def reached_words(end: float) -> str:
    return f"Reached t = {end:.6g} s."


def ended_words(status: str, t: float, steps: int) -> str:
    """Sentence that says how a run ended."""
    if status == "finished":
        return reached_words(t)
    if status == "not finite":
        return _no_value(t)
    if status == "step too small":
        return f"Stopped at t = {t:.6g} s: the step size went to zero."
    return f"Gave up after {steps} steps, at t = {t:.6g} s."


# -------- pace ------------------------------------------------------------------------------------------------
# x' = f(t, x), steps -> why an end is out of reach: what is stiff, or turns too often.
#
# The rates of the fastest motions nearby are the eigenvalues of df/dx. Explicit steps h are held near h |lambda| = 1:
# by accuracy where lambda turns, by stability alone where it dies out, and then an implicit method takes longer ones.
# Source: Hairer & Wanner, Solving Ordinary Differential Equations II, 2nd ed., IV.2.


LOOK = 10_000  # steps from one look to the next
MOST_STIFF = 200_000  # steps left that an explicit method takes where stability alone holds them short
BEYOND = 2.0**53  # of what changes by more than this, doubles do not know the units
HELD = (0.2, 20.0)  # h |lambda| of steps that an eigenvalue holds short


@dataclass
class Pace:
    """Rate of progress of a run.

    Args:
        t: at the last look [s].
        end: of the run [s].
        most: steps in all.
        growth: the largest entry of dx/dt at the last look.
    """

    f: StateRate
    method: str
    t: float
    end: float
    most: int
    growth: float = 0.0

    def hopeless(self, steps: int, t: float, x: np.ndarray) -> str:
        """Why the end is out of reach, every LOOK steps; "" where it is not."""
        if steps % LOOK:
            return ""
        h, self.t = (t - self.t) / LOOK, t
        left = (self.end - t) / h if h > 0 else math.inf
        rate = self._fastest(t, x)
        most = MOST_STIFF if self._is_stiff(rate, h) else self.most
        return self._words(h, left, rate) if left > most else ""

    def words(self, steps: int, t: float, x: np.ndarray) -> str:
        """Sentence on the steps left to the end, and on what holds the steps short."""
        taken = steps % LOOK or LOOK
        h = (t - self.t) / taken if steps else 0.0
        return self._words(h, (self.end - t) / h, self._fastest(t, x)) if h > 0 else ""

    def _words(self, h: float, left: float, rate: complex) -> str:
        steps = f"steps are {h:.1e} s long, {left:.1e} of them are left to t = {self.end:.6g} s"
        if self._is_stiff(rate, h):
            return f"stiff, motions die out at {abs(rate):.1e} 1/s: {steps}; use --method Radau"
        turns = abs(rate.imag) * (self.end - self.t) / math.tau
        if HELD[0] <= h * abs(rate) <= HELD[1] and turns > 1:
            return f"fast, {turns:.1e} turns are left to t = {self.end:.6g} s: give a shorter --time"
        if self.growth * (self.end - self.t) > BEYOND:
            return f"the state grows by {self.growth:.1e} a second, beyond what doubles can follow"
        return f"{steps}; give a shorter --time, or another --method"

    def _is_stiff(self, rate: complex, h: float) -> bool:
        held = HELD[0] <= h * abs(rate) <= HELD[1]
        return self.method in EXPLICIT and held and -rate.real > abs(rate.imag)

    def _fastest(self, t: float, x: np.ndarray) -> complex:
        """The eigenvalue of df/dx of the largest size, by differences; 0 where it has no value."""
        dx = np.asarray(self.f(t, x))
        self.growth = float(np.max(np.abs(dx), initial=0.0))
        columns = []
        with np.errstate(all="ignore"):
            for k, size in enumerate(np.abs(x)):
                beside = x.copy()
                beside[k] += (step := tolerances.DIFFERENCE_STEP * (1 + float(size)))
                columns.append((np.asarray(self.f(t, beside)) - dx) / step)
        J = np.array(columns).T
        if not np.all(np.isfinite(J)):
            return 0j
        rates = np.linalg.eigvals(J)
        return complex(rates[np.argmax(np.abs(rates))])
