"""x' = f(t, x) -> the states of one run, carried across singular positions of the ties.

At a change point or a dead centre the rows of the ties come to depend on one another, and the accelerations are 0/0
there; on either side they are not. A motion that comes by with a speed is an analytic function of time on its branch,
so it is continued by a polynomial through what it did just before, and put back onto the ties beyond:

    x(t) = sum of c_n T_n(t)   over t0 - W < t < t0,   taken at t0 + 2 tau,   tau = s/|s'|

s is the measure of independence that vanishes. Taken only where polynomials of two degrees agree and the ties hold.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from eomgen.codegen.spheres import Places
from eomgen.simulation.events import PARTS, Crossing, Events, Watch
from eomgen.simulation.independence import Independence
from eomgen.simulation.projection import Projection
from eomgen.simulation.solvers import Rate, Slope
from eomgen.simulation.stepping import LOOKED_OUT, Run, Stepping, march

NEARNESS = (1e-2, 2e-3, 5e-4)  # of s, against its largest value: where the motion is carried across
STEEP = 2.0  # times the steepest fall or rise in the steps before: s may not change faster in a step
REMEMBERED = 4  # steps
ARMED = 1.4  # of what is near
DEEP = 1e-3  # of an interval: how closely the least nearness in it is sought
WINDOWS = ((20.0, 12), (40.0, 16), (10.0, 10))  # (W / tau, the degree)
LOWER = 4  # degrees less, for the comparison
SHORTEST = 4.0  # W / tau
FINE = 1e-13  # tolerance of the motion that is continued
AGREE = 100.0  # tolerances of one step by which both polynomials may differ
REACHES = 4  # how often the far side is sought further on
BEYOND = 0.5  # of the nearness: how far from the singular position the far side is

PLACE = "a dead centre or a change point"

Measure = Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass
class Nearness:
    """How far a motion is from a singular position: 1 at its farthest so far, 0 there.

    Args:
        determinants: (t n, x n x states) -> n x k, each of which vanishes where dependent coordinates are not
            determined; None where there are none.
        rows: the rows that close by multipliers; None where there are none.
        what: of each determinant, what is not determined where it vanishes.
        lengths, largest: of the rows, and of what vanishes, the greatest so far.
    """

    determinants: Measure | None
    rows: Independence | None
    what: tuple[str, ...] = ()
    lengths: np.ndarray | float = 0.0
    largest: np.ndarray | float = 0.0

    def __call__(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """The nearness at n states."""
        with np.errstate(all="ignore"):
            sizes = np.abs(self._measured(t, x))
        self.largest = largest = np.maximum(self.largest, sizes.max(axis=0, initial=0.0))
        scaled: np.ndarray = (sizes / (largest if largest.all() else np.where(largest > 0, largest, 1.0))).min(axis=1)
        return np.minimum(scaled, 1.0)

    def _measured(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        found = []
        if self.determinants is not None:
            found.append(np.nan_to_num(self.determinants(t, x)).reshape(len(t), -1))
        if self.rows is not None:
            least, self.lengths = self.rows.least(t, x, self.lengths)
            found.append(least)
        return found[0] if len(found) == 1 else np.hstack(found)

    def words(self, t: float, x: np.ndarray) -> str:
        """What is not determined at a state near a singular position."""
        sizes = self._measured(np.array([t]), x[None, :])[0] / np.where(self.largest > 0, self.largest, 1.0)
        worst = int(np.argmin(np.abs(sizes)))
        if worst < len(self.what) or self.rows is None:
            return self.what[worst]
        return self.rows.words(np.array([t]), x[None, :])

    def at(self, t: float, x: np.ndarray) -> float:
        return float(self(np.array([t]), x[None, :])[0])


class Lookout:
    """Follows the nearness of a run from step to step, closely only where it may come near zero within a step.

    Args:
        near: where the run ends, once it has been farther than ARMED times that.
    """

    def __init__(self, nearness: Nearness, near: float, t: float, x: np.ndarray) -> None:
        self.nearness, self.near, self._before = nearness, near, nearness.at(t, x)
        self._armed = self._before > ARMED * near
        self._slopes: deque[float] = deque(maxlen=REMEMBERED)

    def step(self, t_old: float, t_new: float, x_new: np.ndarray, dense: Callable[[], Any]) -> Crossing | None:
        """Where the nearness falls below what is near in a step that ends in x_new."""
        before, self._before = self._before, self.nearness.at(t_new, x_new)
        if self._armed and self._is_calm(before, t_new - t_old):
            return None
        motion = dense()
        times = np.linspace(t_old, t_new, PARTS + 1)
        sizes = self.nearness(times, motion(times).T)
        if not self._armed:
            far = np.flatnonzero(sizes > ARMED * self.near)
            if not far.size:
                return None
            self._armed, times, sizes = True, times[far[0] :], sizes[far[0] :]
        found = self._fallen(times, sizes, lambda t: self.nearness.at(t, motion(t)))
        return None if found is None else Crossing(LOOKED_OUT, found, motion(found))

    def _is_calm(self, before: float, step: float) -> bool:
        """Whether it cannot have come near zero within a step, unless it changes much faster than before."""
        self._slopes.append(abs(self._before - before) / step)
        enough = len(self._slopes) == REMEMBERED
        return enough and min(before, self._before) > self.near + STEEP * max(self._slopes) * step

    def _fallen(self, t: np.ndarray, sizes: np.ndarray, size: Callable[[float], float]) -> float | None:
        """The first instant at which it is near; a V between two instants is looked into where it may reach zero."""
        from scipy.optimize import brentq, minimize_scalar

        i = int(np.argmin(sizes))
        if sizes[i] > max(self.near, np.max(np.abs(np.diff(sizes)), initial=0.0)):
            return None
        bounds = float(t[max(i - 1, 0)]), float(t[min(i + 1, len(t) - 1)])
        least = float(t[i])
        if sizes[i] > self.near:
            deepest = minimize_scalar(size, bounds=bounds, method="bounded", options={"xatol": DEEP * np.ptp(bounds)})
            if deepest.fun > self.near:
                return None
            least = float(deepest.x)
        first = least if not np.any(sizes <= self.near) else float(t[np.flatnonzero(sizes <= self.near)[0]])
        before = t[(t < first) & (sizes > self.near)]
        return float(brentq(lambda s: size(s) - self.near, before[-1], first)) if before.size else first


@dataclass(frozen=True)
class Passage:
    """A singular position by which a motion came.

    Args:
        start, end: where it was left and where it was found again [s].
        motion: t n -> x, n x states, between them.
    """

    start: float
    end: float
    motion: Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Flow:
    """What a motion follows.

    Args:
        f: x' = f(t, x).
        how: the integration.
        projection: onto the ties.
    """

    f: Rate
    how: Stepping
    spheres: Sequence[Places] = ()
    projection: Projection | None = None
    slope: Slope | None = None


def march_across(
    flow: Flow, span: tuple[float, float], x0: np.ndarray, nearness: Nearness, *, instants: np.ndarray | None = None,
    events: Events | None = None,
) -> tuple[Run, tuple[Passage, ...]]:  # fmt: skip
    """`march`, carried across singular positions; where that fails it ends.

    Returns:
        the run, and the passages in it.
    """
    runs: list[Run] = []
    passages: list[Passage] = []
    (t, end), x, since, level = span, x0, span[0], 0
    while True:
        lookout = Lookout(nearness, NEARNESS[level], t, x)
        run = march(flow.f, (t, end), x, how=flow.how, instants=_from(instants, t), events=events,
                    spheres=flow.spheres, projection=flow.projection, slope=flow.slope, lookout=lookout)  # fmt: skip
        runs.append(run)
        if run.crossing is None or run.crossing.index != LOOKED_OUT:
            return _joined(runs, passages, instants), tuple(passages)
        t, x = run.crossing.t, run.crossing.x
        found = _passed(flow, t, x, since, nearness, lookout.near)
        if found is None and level + 1 == len(NEARNESS):
            return _ended(flow, _joined(runs, passages, instants), nearness), tuple(passages)
        if found is None:
            level += 1
            continue
        passage, x = _up_to(flow, found[0], found[1], end)
        passages.append(passage)
        crossing = None if events is None else _met(events, passage)
        if crossing is not None:
            runs.append(_stopped(run, crossing))
            return _joined(runs, passages, instants), tuple(passages)
        t, since, level = passage.end, passage.end, 0


def _up_to(flow: Flow, passage: Passage, beyond: np.ndarray, end: float) -> tuple[Passage, np.ndarray]:
    """(the passage, the state behind it), cut where the run is to end."""
    if passage.end <= end:
        return passage, beyond
    last = passage.motion(np.array([end]))[0]
    return replace(passage, end=end), last if flow.projection is None else flow.projection.closed(end, last, 0.0)[0]


def _met(events: Events, passage: Passage) -> Crossing | None:
    """The first event in a passage."""

    def motion(t: Any) -> np.ndarray:
        return passage.motion(np.atleast_1d(t)).T if np.ndim(t) else passage.motion(np.array([t]))[0]

    return Watch(events, passage.start, motion(passage.start)).step(passage.start, passage.end, motion)


def _stopped(run: Run, crossing: Crossing) -> Run:
    """A run of one instant, that of an event."""
    message = f"Stopped by an event at t = {crossing.t:.6g} s."
    return replace(run, t=np.array([crossing.t]), x=crossing.x[None, :], end=crossing.t, last=crossing.x,
                   status="event", message=message, steps=0, evaluations=0, crossing=crossing)  # fmt: skip


def _from(instants: np.ndarray | None, t: float) -> np.ndarray | None:
    return None if instants is None else instants[instants >= t]


def _ended(flow: Flow, run: Run, nearness: Nearness) -> Run:
    """A run that cannot be carried on, and why."""
    tau = _time_to(flow, run.end, run.last, nearness) or 0.0
    message = f"Stopped at t = {run.end + tau:.6g} s: {nearness.words(run.end, run.last)} there ({PLACE})."
    return replace(run, status="singular", message=message, crossing=None)


# -- one passage -------------------------------------------------------------------------------------


def _passed(
    flow: Flow, t: float, x: np.ndarray, since: float, nearness: Nearness, near: float
) -> tuple[Passage, np.ndarray] | None:
    """(the passage, the state beyond it); None where the motion cannot be continued to the other side."""
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
    """tau = s/|s'|: how soon the nearness would vanish; None where it does not fall."""
    dx = flow.f(t, x)
    step = 1e-4 * (1 + np.max(np.abs(x))) / (1 + np.max(np.abs(dx)))
    here, after = nearness.at(t, x), nearness.at(t + step * 1e-2, x + step * 1e-2 * dx)
    slope = (after - here) / (step * 1e-2)
    return here / -slope if slope < 0 else None


def _continued(
    flow: Flow, t: float, x: np.ndarray, window: float, degree: int, nearness: Nearness, near: float, tau: float
) -> tuple[Passage, np.ndarray] | None:
    """The motion beyond by a polynomial through what it was before."""
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
            allowed = AGREE * (flow.how.rtol * (1 + np.max(np.abs(found))) + flow.how.atol)
            if np.max(np.abs(found - other)) > allowed or np.max(np.abs(beyond - found)) > allowed:
                return None
            return Passage(t, end, lambda s: np.column_stack([fit(s) for fit in fits[0]])), beyond
        end += tau / 2
    return None


def _before(flow: Flow, t: float, x: np.ndarray, window: float, many: int) -> tuple[np.ndarray, np.ndarray | None]:
    """(so many instants before t, the states at them, None where there are none), by a fine integration backwards."""
    from scipy.integrate import solve_ivp

    nodes = t - window / 2 * (1 - np.cos(np.pi * np.arange(many) / (many - 1)))
    with np.errstate(all="ignore"):
        run = solve_ivp(flow.f, (t, t - window), x, method="DOP853", rtol=FINE, atol=FINE, t_eval=nodes)
    good = run.success and run.y.shape[1] == many and np.all(np.isfinite(run.y))
    return nodes, run.y.T if good else None


# -- all of it ---------------------------------------------------------------------------------------


def _joined(runs: Sequence[Run], passages: Sequence[Passage], instants: np.ndarray | None) -> Run:
    """One run of several, with the instants inside the passages."""
    last = runs[-1]
    if len(runs) == 1 and not passages:
        return last
    t, x = [run.t for run in runs], [run.x for run in runs]
    if instants is not None:
        for passage in passages:
            inside = instants[(instants > passage.start) & (instants < min(passage.end, last.end))]
            t.append(inside)
            x.append(passage.motion(inside))
    times, states = _in_order(np.concatenate(t), np.concatenate(x))
    if instants is not None:
        kept = np.isin(times, instants) | ((times == last.end) if last.status != "finished" else False)
        times, states = times[kept], states[kept]
    return replace(last, t=times, x=states, steps=sum(run.steps for run in runs),
                   evaluations=sum(run.evaluations for run in runs))  # fmt: skip


def _in_order(t: np.ndarray, x: np.ndarray) -> tuple[Any, Any]:
    """The rows by time, one an instant."""
    times, first = np.unique(t, return_index=True)
    return times, x[first]
