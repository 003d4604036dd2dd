"""RightHandSide, start -> Trajectory, by scipy's integrators."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from eomgen.codegen.rhs import RightHandSide
from eomgen.errors import UsageError
from eomgen.simulation.trajectory import Phase, Status, Trajectory

METHODS = ("DOP853", "RK45", "RK23", "Radau", "BDF", "LSODA")
SAMPLES = 1001
MOST_STEPS = 10_000_000
STANDING = 1e-12  # energy that moves, against all energy, below which it is rounding

Function = Callable[[np.ndarray, np.ndarray], Any]


@dataclass(frozen=True)
class _Run:
    """What an integrator left behind.

    Args:
        t, x: the instants reached and the states there, one row each.
        end: how far it came [s].
    """

    t: np.ndarray
    x: np.ndarray
    end: float
    status: Status
    message: str
    steps: int
    evaluations: int


class _NotFinite(ArithmeticError):
    """An implicit method met a right-hand side without a value."""


def integrate(
    rhs: RightHandSide,
    *,
    time: float | tuple[float, float],
    x0: Sequence[float] | np.ndarray | None = None,
    p: Sequence[float] | np.ndarray | None = None,
    inputs: Callable[[float], Sequence[float]] | None = None,
    rtol: float = 1e-9,
    atol: float = 1e-9,
    method: str = "DOP853",
    samples: int | Sequence[float] | None = SAMPLES,
    energy: Function | None = None,
    conservative: bool = True,
    gaps: Function | None = None,
    most_steps: int = MOST_STEPS,
) -> Trajectory:
    """The motion from a start, x' = rhs(t, x, p).

    Args:
        rhs: the equations of motion.
        time: the end, or start and end [s].
        x0, p: start (q, u) and parameters; None takes those of rhs.
        inputs: t -> values in the order of rhs.inputs; None takes the model's own.
        rtol, atol: tolerances of one step.
        method: one of METHODS; Radau, BDF and LSODA for stiff systems.
        samples: how many instants, evenly spaced; the instants themselves; or None: the integrator's own steps.
        energy: (t n, x n x states) -> (T, V), n each [J].
        conservative: whether T + V should stay; if not, no drift is reported.
        gaps: (t n, x n x states) -> phi of the closing ties, n x k.
        most_steps: after so many it gives up.
    Raises:
        UsageError: a start, parameter, tolerance, method or time that is missing or makes no sense.
    """
    start, end = (0.0, float(time)) if isinstance(time, (int, float)) else map(float, time)
    x0, p = _vector("x0", rhs.x0 if x0 is None else x0), _vector("p", rhs.p0 if p is None else p)
    _check(start, end, rtol, atol, method)
    instants = _instants(samples, start, end)

    def f(t: float, x: np.ndarray) -> np.ndarray:
        return rhs(t, x, p) if inputs is None else rhs(t, x, p, inputs(t))

    run = _run(f, start, end, x0, instants, method, rtol, atol, most_steps)
    T, V = (None, None) if energy is None else _rows(energy(run.t, run.x), run.t)
    return Trajectory(
        t=run.t,
        x=run.x,
        coordinates=rhs.coordinates,
        speeds=rhs.speeds,
        energy=None if T is None or V is None else T + V,
        drift=None if T is None or V is None or not conservative else drift_of(T, V),
        gap=None if gaps is None else float(np.max(np.abs(gaps(run.t, run.x)), initial=0.0)),
        phases=(Phase(start, run.end, run.message),),
        status=run.status,
        message=run.message,
        steps=run.steps,
        evaluations=run.evaluations,
    )


def drift_of(T: np.ndarray, V: np.ndarray) -> float:
    """max |E - E(0)| over max(T, |V - V(0)|), E = T + V; over |E(0)| where as good as nothing moves."""
    E = T + V
    moving = max(np.max(np.abs(T), initial=0.0), np.max(np.abs(V - V[:1]), initial=0.0))
    standing = np.max(np.abs(E), initial=0.0)
    scale = moving if moving > STANDING * standing else standing
    return float(np.max(np.abs(E - E[:1]), initial=0.0) / (scale if scale > 0 else 1.0))


def _rows(values: Any, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    T, V = values
    return np.broadcast_to(T, t.shape), np.broadcast_to(V, t.shape)


def _run(f, start, end, x0, instants, method, rtol, atol, most_steps) -> _Run:
    """Step until the end, or until it goes no further."""
    if not np.all(np.isfinite(f(start, x0))):
        return _Run(np.array([start]), x0[None, :], start, "not finite", _no_value(start), 0, 1)
    if end == start or x0.size == 0:
        times = instants if instants is not None and end > start else np.unique([start, end])
        return _Run(times, np.tile(x0, (len(times), 1)), end, "finished", _reached(end), 0, 1)
    asked = 1 if instants is None or instants[0] == start else 0
    t, x = [np.array([start])[:asked]], [x0[None, :][:asked]]
    solver = _solver(f, start, end, x0, method, rtol, atol)
    status: Status = "finished"
    message, steps = "", 0
    while solver.status == "running":
        if steps == most_steps:
            status, message = "too many steps", f"Gave up after {steps} steps, at t = {solver.t:.6g} s."
            break
        try:
            with np.errstate(all="ignore"):
                solver.step()
        except (_NotFinite, KeyboardInterrupt) as stop:
            status, message = _stopped(stop, solver.t)
            break
        if solver.status == "failed":
            status, message = _failed(f, solver)
            break
        steps += 1
        _record(solver, instants, t, x)
    if status != "finished" and instants is not None and solver.t not in t[-1]:
        t, x = [*t, np.array([solver.t])], [*x, solver.y[None, :]]
    times, states = np.concatenate(t), np.concatenate(x)
    return _Run(times, states, float(solver.t), status, message or _reached(end), steps, solver.nfev)


def _record(solver: Any, instants: np.ndarray | None, t: list[np.ndarray], x: list[np.ndarray]) -> None:
    """The instants of the last step, or its end."""
    if instants is None:
        t.append(np.array([solver.t]))
        x.append(solver.y[None, :].copy())
        return
    first, last = np.searchsorted(instants, [solver.t_old, solver.t], side="right")
    if last > first:
        t.append(instants[first:last])
        x.append(solver.dense_output()(instants[first:last]).T)


def _solver(f, start, end, x0, method, rtol, atol) -> Any:
    import scipy.integrate

    def finite(t: float, x: np.ndarray) -> np.ndarray:
        dx = f(t, x)
        if not np.all(np.isfinite(dx)):
            raise _NotFinite
        return dx

    explicit = method in ("DOP853", "RK45", "RK23")  # these shrink the step where a trial has no value
    kind = getattr(scipy.integrate, method)
    with np.errstate(all="ignore"):
        return kind(f if explicit else finite, start, x0, end, rtol=rtol, atol=atol)


def _failed(f: Callable[..., np.ndarray], solver: Any) -> tuple[Status, str]:
    """Why the step size went to nothing."""
    ahead = solver.t + 1e-9 * max(1.0, abs(solver.t))
    if not np.all(np.isfinite(f(ahead, solver.y + (ahead - solver.t) * f(solver.t, solver.y)))):
        return "not finite", _no_value(solver.t)
    return "step too small", f"Stopped at t = {solver.t:.6g} s: the step size went to zero."


def _stopped(stop: BaseException, t: float) -> tuple[Status, str]:
    if isinstance(stop, KeyboardInterrupt):
        return "interrupted", f"Interrupted at t = {t:.6g} s."
    return "not finite", _no_value(t)


def _no_value(t: float) -> str:
    return f"Stopped at t = {t:.6g} s: the accelerations have no finite value there."


def _reached(end: float) -> str:
    return f"Reached t = {end:.6g} s."


def _instants(samples: int | Sequence[float] | None, start: float, end: float) -> np.ndarray | None:
    if samples is None:
        return None
    if isinstance(samples, (int, np.integer)):
        if samples < 2:
            raise UsageError(f"{samples} samples: at least the start and the end are needed")
        return np.linspace(start, end, int(samples))
    times = np.asarray(samples, dtype=float)
    if times.ndim != 1 or np.any(np.diff(times) <= 0) or len(times) == 0 or times[0] < start or times[-1] > end:
        raise UsageError(f"samples must be instants between {start:g} s and {end:g} s, in order")
    return times


def _vector(what: str, values: Any) -> np.ndarray:
    if values is None:
        raise UsageError(f"no {what}: some of its values are missing")
    vector = np.array(values, dtype=float)
    if vector.ndim != 1 or not np.all(np.isfinite(vector)):
        raise UsageError(f"{what} must be finite numbers, not {values!r}")
    return vector


def _check(start: float, end: float, rtol: float, atol: float, method: str) -> None:
    if not (np.isfinite(start) and np.isfinite(end) and end >= start):
        raise UsageError(f"the time from {start:g} s to {end:g} s makes no sense", mend="give an end after the start")
    if not (rtol > 0 and atol > 0 and np.isfinite(rtol) and np.isfinite(atol)):
        raise UsageError(f"tolerances must be positive, not rtol = {rtol:g}, atol = {atol:g}")
    if method not in METHODS:
        raise UsageError(f"unknown method '{method}'", mend=f"methods are {', '.join(METHODS)}")
