"""Singular positions: runs that end there, and runs that are carried across.

Run -> the same, ended where constraints no longer determine the motion, with the constraint named.

Dependent coordinates follow the independent ones as long as det J_d is not zero. Across an instant where it vanishes
(a change point, a dead centre) the integrator's own estimate of its error is useless. So a run that came by one
is integrated again from before it until after it, much finer: where both agree it has passed, else it ends there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from eomgen.codegen import QuaternionPlaces
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import DependentBlock
from eomgen.simulation.constraint_drift import EnergyLevel, Nearness, Projection, RankLookout, Undetermined
from eomgen.simulation.event_location import LOOKED_OUT, Crossing, Events, EventSearch
from eomgen.simulation.integrator import Run, Stepping, march
from eomgen.simulation.solvers import LateSlope, StateRate
from eomgen.symbolic.numeric import tolerances

STEPS = 100  # tolerances of one step by which they may differ
NEAR = 0.02  # of a determinant's largest value: how small a minimum may be the sign of a zero
LAST = 1e-2  # of a determinant's largest value: where it is larger, the end of a run has another reason

Again = Callable[[float, np.ndarray, float], np.ndarray]


def ended_where_singular(run: Run, what: Undetermined, again: Again, *, rtol: float = tolerances.RUN) -> Run:
    """The run, cut where a vanishing determinant led it astray.

    Args:
        again: (t0, x0, t1) -> x there, by a much finer integration; nan where it does not get there.
        rtol: of the run.
    """
    if not len(run.t):
        return run
    with np.errstate(all="ignore"):
        values = np.nan_to_num(what.determinants(run.t, run.x)).reshape(len(run.t), -1)
    largest = np.max(np.abs(values), axis=0)
    values = values / np.where(largest > 0, largest, 1.0)
    allowed = max(tolerances.RUNS_AGREE, STEPS * rtol)
    zeros = sorted(
        (i, k) for k in range(values.shape[1]) for i in vanishing_after(values[:, k]) if not _carried(run, i)
    )
    for i, number in zeros:
        if not _passed_the_same(run, i, again, allowed):
            return _cut(run, i, _instant(run.t, values[:, number], i), what, number)
    if run.status in ("finished", "event", "interrupted", "out of patience", "singular"):
        return run
    k = int(np.argmin(abs(values[-1])))
    flipped = np.any(np.diff(np.sign(values[-3:, k])))
    if not flipped and abs(values[-1, k]) >= LAST:
        return run
    return _cut(run, len(run.t) - 1, run.end, what, k)


def vanishing_after(values: np.ndarray) -> list[int]:
    """The instants after which a determinant has another sign, or before which it comes near to zero and turns back."""
    signs, size = np.sign(values), np.abs(values)
    flips = np.flatnonzero(signs[:-1] * signs[1:] <= 0)
    inner = size[1:-1]
    minima = np.flatnonzero((inner <= size[:-2]) & (inner < size[2:]) & (inner < NEAR * np.max(size, initial=0)))
    return sorted({*flips.tolist(), *minima.tolist()})


def _carried(run: Run, i: int) -> bool:
    """True if the motion after the i-th instant was carried across a singular position."""
    start, end = float(run.t[i]), float(run.t[min(i + 2, len(run.t) - 1)])
    return any(first <= end and last >= start for first, last in run.carried)


def _passed_the_same(run: Run, i: int, again: Again, allowed: float) -> bool:
    """True if the motion from the i-th instant to two later comes out the same by a finer integration."""
    j = min(i + 2, len(run.t) - 1)
    if j == i:
        return True
    finer = again(float(run.t[i]), run.x[i], float(run.t[j]))
    scale = 1 + np.max(np.abs(run.x[i : j + 1]), axis=0)
    return bool(np.all(np.abs(finer - run.x[j]) <= allowed * scale))


def _instant(t: np.ndarray, values: np.ndarray, i: int) -> float:
    """Instant at which a straight line between two instants is zero; the later one where it is not."""
    if i + 1 >= len(t):
        return float(t[i])
    if values[i] * values[i + 1] > 0:
        return float(t[i + 1])
    share = values[i] / (values[i] - values[i + 1]) if values[i] != values[i + 1] else 0.0
    return float(t[i] + (t[i + 1] - t[i]) * share)


def _cut(run: Run, i: int, instant: float, what: Undetermined, number: int) -> Run:
    """The run up to its i-th instant."""
    message = f"Stopped at t = {instant:.6g} s: {what.what(run.t, run.x)[number]} there ({what.place})."
    return replace(
        run,
        t=run.t[: i + 1],
        x=run.x[: i + 1],
        end=instant,
        last=run.x[i],
        status="singular",
        message=message,
        crossing=None,
        tracks=tuple(track.until(float(run.t[i])) for track in run.tracks),
    )


# -------- singular crossing -----------------------------------------------------------------------------------
# x' = f(t, x) -> the states of one run, carried across singular positions of the constraints.
#
# At a change point or a dead centre the rows of the constraints come to depend on one another, and the accelerations
# are 0/0 there; on either side they are not. A motion that comes by with a speed is an analytic function of time on its
# branch, so it is continued by a polynomial through what it did just before, and put back onto the constraints beyond:
#
#     x(t) = sum of c_n T_n(t)   over t0 - W < t < t0,   taken at t0 + 2 tau,   tau = s/|s'|
#
# s is the measure of independence that vanishes. Taken only where polynomials of two degrees agree and the constraints
# hold.


NEARNESS = (1e-2, 2e-3, 5e-4)  # of s, against its largest value: where the motion is carried across
WINDOWS = ((20.0, 12), (40.0, 16), (10.0, 10))  # (W / tau, the degree)
LOWER = 4  # degrees less, for the comparison
SHORTEST = 4.0  # W / tau
AGREE = 100.0  # tolerances of one step by which both polynomials may differ
REACHES = 4  # how often the far side is sought further on
BEYOND = 0.5  # of the nearness: how far from the singular position the far side is


@dataclass(frozen=True)
class SingularCrossing:
    """A singular position by which a motion came.

    Args:
        start, end: instants at which it was left and found again [s].
        motion: t n -> x, n x states, between them.
    """

    start: float
    end: float
    motion: Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Flow:
    """Differential equation of a motion, with the options of its integration.

    Args:
        f: x' = f(t, x).
        how: the integration.
        projection: onto the constraints.
        slope: df/dx, used where steps are implicit.
        level: the energy that is held constant.
    """

    f: StateRate
    how: Stepping
    unit_quaternions: QuaternionPlaces = QuaternionPlaces()
    projection: Projection | None = None
    slope: LateSlope | None = None
    level: EnergyLevel | None = None

    def march(
        self,
        span: tuple[float, float],
        x0: np.ndarray,
        instants: np.ndarray | None,
        events: Events | None,
        lookout: RankLookout | None = None,
    ) -> Run:
        """A run that ends where the lookout says so."""
        return march(
            self.f,
            span,
            x0,
            how=self.how,
            instants=instants,
            events=events,
            unit_quaternions=self.unit_quaternions,
            projection=self.projection,
            slope=self.slope,
            lookout=lookout,
            level=self.level,
        )


def march_across(
    flow: Flow,
    span: tuple[float, float],
    x0: np.ndarray,
    nearness: Nearness | None,
    *,
    instants: np.ndarray | None = None,
    events: Events | None = None,
) -> Run:
    """`march`, carried across singular positions; where that fails it ends.

    Args:
        nearness: to these; None where they are not watched.
    """
    if nearness is None:
        return flow.march(span, x0, instants, events)
    runs: list[Run] = []
    carried: list[SingularCrossing] = []
    (t, end), x, since, level = span, x0, span[0], 0
    while True:
        lookout = RankLookout(nearness, NEARNESS[level], t, x)
        run = flow.march((t, end), x, _from(instants, t), events, lookout)
        runs.append(run)
        if run.crossing is None or run.crossing.index != LOOKED_OUT:
            return _joined(runs, carried, instants)
        t, x = run.crossing.t, run.crossing.x
        found = _passed(flow, t, x, since, nearness, lookout.near)
        if found is None and level + 1 == len(NEARNESS):
            return _ended(flow, _joined(runs, carried, instants), nearness)
        if found is None:
            level += 1
            continue
        across, x = _up_to(flow, found[0], found[1], end)
        carried.append(across)
        crossing = None if events is None else _met(events, across)
        if crossing is not None:
            runs.append(_stopped(run, crossing))
            return _joined(runs, carried, instants)
        t, since, level = across.end, across.end, 0


def _up_to(flow: Flow, across: SingularCrossing, beyond: np.ndarray, end: float) -> tuple[SingularCrossing, np.ndarray]:
    """(the crossing, the state behind it), cut where the run is to end."""
    if across.end <= end:
        return across, beyond
    last = across.motion(np.array([end]))[0]
    return replace(across, end=end), last if flow.projection is None else flow.projection.closed(end, last, 0.0)[0]


def _met(events: Events, across: SingularCrossing) -> Crossing | None:
    """The first event in a singular crossing."""

    def motion(t: Any) -> np.ndarray:
        return across.motion(np.atleast_1d(t)).T if np.ndim(t) else across.motion(np.array([t]))[0]

    return EventSearch(events, across.start, motion(across.start)).step(across.start, across.end, motion)


def _stopped(run: Run, crossing: Crossing) -> Run:
    """A run of one instant, that of an event."""
    message = f"Stopped by an event at t = {crossing.t:.6g} s."
    return replace(
        run,
        t=np.array([crossing.t]),
        x=crossing.x[None, :],
        end=crossing.t,
        last=crossing.x,
        status="event",
        message=message,
        steps=0,
        evaluations=0,
        crossing=crossing,
        tracks=(),
    )


def _from(instants: np.ndarray | None, t: float) -> np.ndarray | None:
    return None if instants is None else instants[instants >= t]


def _ended(flow: Flow, run: Run, nearness: Nearness) -> Run:
    """A run that cannot be carried on, and why."""
    tau = _time_to(flow, run.end, run.last, nearness) or 0.0
    message = (
        f"Stopped at t = {run.end + tau:.6g} s: {nearness.words(run.end, run.last)} there ({DependentBlock.PLACE})."
    )
    return replace(run, status="singular", message=message, crossing=None)


# -- one crossing ----------------------------------------------------------------------------------


def _passed(
    flow: Flow, t: float, x: np.ndarray, since: float, nearness: Nearness, near: float
) -> tuple[SingularCrossing, np.ndarray] | None:
    """(the crossing, the state beyond it); None where the motion cannot be continued to the other side."""
    x = x if flow.projection is None else flow.projection.closed(t, x, 0.0)[0]
    tau = _time_to(flow, t, x, nearness)
    if tau is None:
        return None
    for windows, degree in WINDOWS:
        window = min(windows * tau, t - since)
        if window >= SHORTEST * tau:
            found = _continued(flow, t, x, window, degree, nearness, near, tau)
            if found is not None:
                return found
    return None


def _time_to(flow: Flow, t: float, x: np.ndarray, nearness: Nearness) -> float | None:
    """tau = s/|s'|: the time in which the nearness would vanish; None where it does not fall."""
    dx = flow.f(t, x)
    step = tolerances.WIDE_STEP * (1 + np.max(np.abs(x))) / (1 + np.max(np.abs(dx)))
    here, after = nearness.at(t, x), nearness.at(t + step * 1e-2, x + step * 1e-2 * dx)
    slope = (after - here) / (step * 1e-2)
    return here / -slope if slope < 0 else None


def _continued(
    flow: Flow, t: float, x: np.ndarray, window: float, degree: int, nearness: Nearness, near: float, tau: float
) -> tuple[SingularCrossing, np.ndarray] | None:
    """The motion beyond by a polynomial through its states before."""
    from numpy.polynomial.chebyshev import Chebyshev

    nodes, states = _before(flow, t, x, window, 2 * degree + 1)
    if states is None:
        return None
    domain = [t - window, t]
    fits = [[Chebyshev.fit(nodes, column, n, domain=domain) for column in states.T] for n in (degree, degree - LOWER)]
    end = t + 2 * tau
    for _ in range(REACHES):
        found, other = (np.array([fit(end) for fit in each]) for each in fits)
        if nearness.at(end, found) >= BEYOND * near:
            beyond = found if flow.projection is None else flow.projection.closed(end, found, 0.0)[0]
            rtol, atol = max(flow.how.rtol, tolerances.FAIR_RUN), max(flow.how.atol, tolerances.FAIR_RUN)
            allowed = AGREE * (rtol * (1 + np.max(np.abs(found))) + atol)
            if np.max(np.abs(found - other)) > allowed or np.max(np.abs(beyond - found)) > allowed:
                return None
            return SingularCrossing(t, end, lambda s: np.column_stack([fit(s) for fit in fits[0]])), beyond
        end += tau / 2
    return None


def _before(flow: Flow, t: float, x: np.ndarray, window: float, many: int) -> tuple[np.ndarray, np.ndarray | None]:
    """(so many instants before t, the states at them, None where there are none), by a fine integration backwards."""
    from scipy.integrate import solve_ivp

    nodes = t - window / 2 * (1 - np.cos(np.pi * np.arange(many) / (many - 1)))
    with np.errstate(all="ignore"):
        run = solve_ivp(
            flow.f,
            (t, t - window),
            x,
            method="DOP853",
            rtol=tolerances.FINEST_RUN,
            atol=tolerances.FINEST_RUN,
            t_eval=nodes,
        )
    good = run.success and run.y.shape[1] == many and np.all(np.isfinite(run.y))
    if not good:
        return nodes, None
    states = run.y.T
    if flow.projection is not None:
        states = np.array([flow.projection.closed(float(s), x, 0.0)[0] for s, x in zip(nodes, states, strict=True)])
    return nodes, states


# -- all of it ---------------------------------------------------------------------------------------


def _joined(runs: Sequence[Run], carried: Sequence[SingularCrossing], instants: np.ndarray | None) -> Run:
    """One run of several, with the instants inside the crossings."""
    last = runs[-1]
    if len(runs) == 1 and not carried:
        return last
    t, x = [run.t for run in runs], [run.x for run in runs]
    if instants is not None:
        for across in carried:
            inside = instants[(instants > across.start) & (instants < min(across.end, last.end))]
            t.append(inside)
            x.append(across.motion(inside))
    times, states = _in_order(np.concatenate(t), np.concatenate(x))
    if instants is not None:
        kept = np.isin(times, instants) | ((times == last.end) if last.status != "finished" else False)
        times, states = times[kept], states[kept]
    return replace(
        last,
        t=times,
        x=states,
        steps=sum(run.steps for run in runs),
        evaluations=sum(run.evaluations for run in runs),
        tracks=tuple(track for run in runs for track in run.tracks),
        carried=tuple((across.start, across.end) for across in carried),
    )


def _in_order(t: np.ndarray, x: np.ndarray) -> tuple[Any, Any]:
    """The rows by time, one an instant."""
    times, first = np.unique(t, return_index=True)
    return times, x[first]
