"""x' = f(t, x), start -> the states of one run, step by step, by scipy's integrators."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from eomgen.codegen.spheres import Places, on_spheres
from eomgen.simulation.events import Crossing, Events, Watch
from eomgen.simulation.trajectory import Status

METHODS = ("DOP853", "RK45", "RK23", "Radau", "BDF", "LSODA")
MOST_STEPS = 10_000_000

Rate = Callable[[float, np.ndarray], np.ndarray]
Dense = Callable[[], Callable[[Any], np.ndarray]]


@dataclass(frozen=True)
class Stepping:
    """How an integrator goes: its method, its tolerances of one step, and after how many steps it gives up."""

    method: str = "DOP853"
    rtol: float = 1e-9
    atol: float = 1e-9
    most_steps: int = MOST_STEPS


@dataclass(frozen=True)
class Run:
    """What an integrator left behind.

    Args:
        t, x: the instants reached and the states there, one row each.
        end, last: how far it came [s], and the state there.
        crossing: the event that ended it.
    """

    t: np.ndarray
    x: np.ndarray
    end: float
    last: np.ndarray
    status: Status
    message: str
    steps: int
    evaluations: int
    crossing: Crossing | None = None


class _NotFinite(ArithmeticError):
    """An implicit method met a right-hand side without a value."""


@dataclass(frozen=True)
class _Rows:
    """The rows of a run as they come: at the instants asked for, or (None) at the integrator's own steps."""

    instants: np.ndarray | None
    t: list[np.ndarray]
    x: list[np.ndarray]

    def add(self, span: tuple[float, float], x_new: np.ndarray, dense: Dense) -> None:
        """The instants of a step, its beginning left out, or its end; x_new is the state there."""
        if self.instants is None:
            self._put(span[1], x_new)
            return
        first, last = np.searchsorted(self.instants, span, side="right")
        if last > first:
            self.t.append(self.instants[first:last])
            self.x.append(dense()(self.instants[first:last]).T)

    def close(self, t: float, x: np.ndarray) -> None:
        """The state in which a run ended early, unless it is there."""
        if not self.t[-1].size or self.t[-1][-1] != t:
            self._put(t, x)

    def _put(self, t: float, x: np.ndarray) -> None:
        self.t.append(np.array([t]))
        self.x.append(x[None, :].copy())


def march(
    f: Rate, span: tuple[float, float], x0: np.ndarray, *, how: Stepping, instants: np.ndarray | None = None,
    events: Events | None = None, spheres: Sequence[Places] = (),
) -> Run:  # fmt: skip
    """Step from the first instant of the span to the second, or to an event, or until it goes no further.

    Args:
        instants: where states are wanted, in order; None: at the integrator's own steps.
        spheres: the places of quaternions in x: each is put back to norm 1 after every step.
    """
    start, end = span
    x0 = on_spheres(x0, spheres)
    if not np.all(np.isfinite(f(start, x0))):
        return Run(np.array([start]), x0[None, :], start, x0, "not finite", _no_value(start), 0, 1)
    if end == start or x0.size == 0:
        times = instants if instants is not None and end > start else np.unique([start, end])
        return Run(times, np.tile(x0, (len(times), 1)), end, x0, "finished", _reached(end), 0, 1)
    asked = 1 if instants is None or (instants.size and instants[0] == start) else 0
    rows = _Rows(instants, [np.array([start])[:asked]], [x0[None, :][:asked]])
    solver = _solver(f, span, x0, how)
    watch = Watch(events, start, x0) if events is not None else None
    status, message, steps, crossing = _stepped(f, solver, rows, watch, how.most_steps, spheres)
    t, x = (float(solver.t), solver.y) if crossing is None else (crossing.t, crossing.x)
    if status != "finished":
        rows.close(t, x)
    times, states = np.concatenate(rows.t), on_spheres(np.concatenate(rows.x), spheres)
    return Run(times, states, t, on_spheres(x, spheres), status, message or _reached(end), steps, solver.nfev, crossing)


def _stepped(
    f: Rate, solver: Any, rows: _Rows, watch: Watch | None, most_steps: int, spheres: Sequence[Places]
) -> tuple[Status, str, int, Crossing | None]:
    """(status, message, steps, the event that ended it)."""
    steps = 0
    while solver.status == "running":
        if steps == most_steps:
            return "too many steps", f"Gave up after {steps} steps, at t = {solver.t:.6g} s.", steps, None
        try:
            with np.errstate(all="ignore"):
                solver.step()
        except (_NotFinite, KeyboardInterrupt) as stop:
            return *_stopped(stop, solver.t), steps, None
        if solver.status == "failed":
            return *_failed(f, solver), steps, None
        steps += 1
        dense = cache(solver.dense_output)
        crossing = None if watch is None else watch.step(solver.t_old, solver.t, dense())
        if crossing is not None:
            rows.add((solver.t_old, crossing.t), crossing.x, dense)
            return "event", f"Stopped by an event at t = {crossing.t:.6g} s.", steps, crossing
        rows.add((solver.t_old, solver.t), solver.y, dense)
        solver.y = on_spheres(solver.y, spheres)
    return "finished", "", steps, None


def _solver(f: Rate, span: tuple[float, float], x0: np.ndarray, how: Stepping) -> Any:
    import scipy.integrate

    def finite(t: float, x: np.ndarray) -> np.ndarray:
        dx = f(t, x)
        if not np.all(np.isfinite(dx)):
            raise _NotFinite
        return dx

    explicit = how.method in ("DOP853", "RK45", "RK23")  # these shrink the step where a trial has no value
    kind = getattr(scipy.integrate, how.method)
    with np.errstate(all="ignore"):
        return kind(f if explicit else finite, span[0], x0, span[1], rtol=how.rtol, atol=how.atol)


def _failed(f: Rate, solver: Any) -> tuple[Status, str]:
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
