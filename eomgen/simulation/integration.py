"""RightHandSide, start -> Trajectory, by scipy's integrators."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from eomgen.codegen import RightHandSide
from eomgen.errors import UsageError
from eomgen.mechanics.dynamics import EquationsOfMotion, System
from eomgen.model import Typed, are_several, seconds, typed_values
from eomgen.simulation.constraint_drift import Nearness, Projection, nearness_of, projection_of
from eomgen.simulation.event_location import Events
from eomgen.simulation.integrator import MOST_STEPS, Run, Stepping, measured
from eomgen.simulation.result import Kept, Phase, Trajectory
from eomgen.simulation.singular import Flow, march_across
from eomgen.simulation.solvers import Slope
from eomgen.symbolic.numeric import tolerances

SAMPLES = 1001
MOST_SAMPLES = 10_000_000

FunctionOfStates = Callable[[np.ndarray, np.ndarray], Any]


def integrate(
    rhs: RightHandSide,
    *,
    time: float | tuple[float, float],
    x0: Sequence[float] | np.ndarray | None = None,
    p: Sequence[float] | np.ndarray | None = None,
    inputs: Callable[[float], Sequence[float]] | None = None,
    rtol: float = tolerances.RUN,
    atol: float = tolerances.RUN,
    method: str = "DOP853",
    samples: int | Sequence[float] | None = SAMPLES,
    energy: FunctionOfStates | None = None,
    conservative: bool = True,
    gaps: FunctionOfStates | None = None,
    events: Events | None = None,
    most_steps: int = MOST_STEPS,
    projection: Projection | None = None,
    stabilization: str = "projection",
    every: int | None = None,
    slope: Slope | None = None,
    nearness: Nearness | None = None,
    breakpoints: tuple[float, ...] = (),
) -> Trajectory:
    """The motion from a start, x' = rhs(t, x, p).

    Args:
        rhs: the equations of motion.
        time: the end, or start and end [s].
        x0, p: start (q, u) and parameters; None takes those of rhs.
        inputs: t -> values in the order of rhs.inputs; None takes the model's own.
        rtol, atol: tolerances of one step.
        method: one of METHODS; Radau, BDF and LSODA for stiff systems.
        samples: the number of instants, evenly spaced; the instants themselves; or None: the integrator's own steps.
        energy: (t n, x n x states) -> (T, V), n each [J].
        conservative: T + V should be constant; if not, no drift is reported.
        gaps: (t n, x n x states) -> phi of the closing constraints, n x k; not needed with a projection.
        events: functions that end the run where they fall to zero.
        most_steps, stabilization, every: as of Stepping.
        projection: onto the constraints; by it these are also measured.
        slope: (t, x) -> df/dx for the implicit methods; None: by differences.
        breakpoints: instants across which no step goes, ascending.
        nearness: to singular positions, across which the motion is carried; None: not watched.
    Raises:
        UsageError: a start, parameter, tolerance, method or time that is missing or makes no sense.
    """
    start, end = (0.0, float(time)) if isinstance(time, (int, float)) else map(float, time)
    x0, p = _vector("x0", rhs.x0 if x0 is None else x0), _vector("p", rhs.p0 if p is None else p)
    how = Stepping(method, rtol, atol, most_steps, stabilization, every, breakpoints=breakpoints)
    how.refuse_bad_run(start, end)
    instants = None if samples is None else instants_of(samples, start, end)

    rhs(start, x0, p, () if inputs is None else inputs(start))  # refuses what is too short or too long
    f = rhs.at(p) if inputs is None else lambda t, x: rhs(t, x, p, inputs(t))
    flow = Flow(f, how, rhs.unit_quaternions, projection, lambda: slope)
    run = march_across(flow, (start, end), x0, nearness, instants=instants, events=events)
    E, drift = (None, None) if energy is None else _energy(run, energy, conservative)
    track = measured(run.t, run.x, run.tracks)
    kept = Kept(drift, *_open(*track, projection, gaps))
    return Trajectory(
        t=run.t,
        x=run.x,
        coordinates=rhs.coordinates,
        speeds=rhs.speeds,
        states=rhs.states,
        energies=None if E is None else lambda: E,
        measure=lambda: kept,
        phases=(Phase(start, run.end, run.message, (0, len(run.t)), tracked=lambda: track),),
        ended=run.status,
        words=run.message,
        steps=run.steps,
        evaluations=run.evaluations,
        carried=run.carried,
    )


def integrate_one_phase(
    rhs: RightHandSide,
    equations: EquationsOfMotion,
    declared: System,
    how: Stepping,
    x0: np.ndarray,
    p: np.ndarray,
    time: float,
    samples: int | None,
) -> Trajectory:
    """The motion from a start while the equations hold, put back onto their constraints, carried across what is
    singular; arguments as of `integrate`."""
    return integrate(
        rhs,
        time=time,
        x0=x0,
        p=p,
        method=how.method,
        rtol=how.rtol,
        atol=how.atol,
        samples=samples,
        projection=projection_of(declared, p, "numpy"),
        nearness=nearness_of(equations, p, declared),
        most_steps=how.most_steps,
    )


def _open(
    t: np.ndarray, x: np.ndarray, projection: Projection | None, gaps: FunctionOfStates | None
) -> tuple[float | None, float | None]:
    """The largest |phi| and |J u + sigma|; None where nothing closes or it is not measured."""
    if projection is not None:
        gap, gap_rate = np.max(projection.open(t, x), axis=0, initial=0.0)
        return float(gap), float(gap_rate) if projection.speeds else None
    return None if gaps is None else float(np.max(np.abs(gaps(t, x)), initial=0.0)), None


def drift_of(T: np.ndarray, V: np.ndarray) -> float:
    """max |E - E(0)| over max(T, |V - V(0)|), E = T + V; over |E(0)| where as good as nothing moves."""
    E = T + V
    moving = max(np.max(np.abs(T), initial=0.0), np.max(np.abs(V - V[:1]), initial=0.0))
    standing = np.max(np.abs(E), initial=0.0)
    scale = moving if moving > tolerances.SOLVED * standing else standing
    return float(np.max(np.abs(E - E[:1]), initial=0.0) / (scale if scale > 0 else 1.0))


def _energy(run: Run, energy: FunctionOfStates, conservative: bool) -> tuple[np.ndarray, float | None]:
    """(T + V at the requested instants, its drift, at the integrator's steps too)."""
    T, V = _rows(energy(run.t, run.x), run.t)
    if not conservative:
        return T + V, None
    t, x = measured(run.t, run.x, run.tracks)
    return T + V, drift_of(*_rows(energy(t, x), t))


def _rows(values: Any, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    T, V = values
    return np.broadcast_to(T, t.shape), np.broadcast_to(V, t.shape)


def instants_of(samples: int | Sequence[Typed] | None, start: float, end: float) -> np.ndarray:
    """The requested instants: so many, evenly spaced; or the instants themselves, in SI or with a unit.

    None: so many as a run has by itself.

    Raises:
        UsageError: fewer than two, or not in order between start and end.
    """
    samples = SAMPLES if samples is None else samples
    if isinstance(samples, (int, np.integer)):
        if samples < 2:
            raise UsageError(f"{samples} samples: at least the start and the end are needed", fix="samples = 2 or more")
        if samples > MOST_SAMPLES:
            raise UsageError(f"{samples} samples: at most {MOST_SAMPLES} are given", fix="ask for fewer")
        return _evenly(start, end, int(samples))
    if not are_several(samples):
        raise UsageError(f"{samples!r} samples make no sense", fix="say how many, or give the instants in a list")
    plain = isinstance(samples, np.ndarray) and samples.dtype.kind in "fiu"
    times = np.asarray(samples, dtype=float) if plain else np.array([*map(seconds, typed_values(samples))])
    if len(times) == 0 or np.any(np.diff(times) <= 0) or not (times[0] >= start and times[-1] <= end):
        raise UsageError(
            f"samples must be instants between {start:g} s and {end:g} s, in order",
            fix="sort them, and leave out what is outside",
        )
    return times


@lru_cache(maxsize=16)
def _evenly(start: float, end: float, count: int) -> np.ndarray:
    found = np.linspace(start, end, count)
    found.setflags(write=False)
    return found


def _vector(what: str, values: Any) -> np.ndarray:
    if values is None:
        raise UsageError(f"no {what}: some of its values are missing", fix="give all of them")
    vector = np.array(values, dtype=float)
    if vector.ndim != 1 or not np.all(np.isfinite(vector)):
        raise UsageError(
            f"{what} must be finite numbers, not {values!r}", fix="leave out what is infinite or no number"
        )
    return vector
