"""Trajectory -> the same, ended where ties no longer said how the motion goes on, and the tie named.

Dependent coordinates follow the independent ones as long as det J_d is not zero. Across an instant where it vanishes
(a change point, a dead centre) the integrator's own estimate of its error is worth nothing. So a run that came by one
is integrated again from before it until after it, much finer: where both agree it has passed, else it ends there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from eomgen.simulation.result import Trajectory
from eomgen.symbolic.numeric.tolerances import RUN, RUNS_AGREE

STEPS = 100  # tolerances of one step by which they may differ
NEAR = 0.02  # of a determinant's largest value: how small a minimum may be the sign of a zero
LAST = 1e-2  # of a determinant's largest value: where it is larger, the end of a run has another reason

Determinants = Callable[[np.ndarray, np.ndarray], np.ndarray]
Again = Callable[[float, np.ndarray, float], np.ndarray]


def ended_where_singular(
    run: Trajectory,
    determinants: Determinants,
    what: Sequence[str],
    again: Again,
    *,
    rtol: float = RUN,
    place: str = "a dead centre or a change point",
) -> Trajectory:
    """The run, cut where a vanishing determinant led it astray.

    Args:
        determinants: (t n, x n x states) -> n x k.
        what: of each determinant, what is not determined where it vanishes: "'pin' does not determine 'phi'".
        again: (t0, x0, t1) -> x there, by a much finer integration; nan where it does not get there.
        rtol: of the run.
        place: what such a position is called.
    """
    if len(run.t) == 0 or not what:
        return run
    with np.errstate(all="ignore"):
        values = np.nan_to_num(np.reshape(determinants(run.t, run.x), (len(run.t), len(what))))
    largest = np.max(np.abs(values), axis=0)
    values = values / np.where(largest > 0, largest, 1.0)
    allowed = max(RUNS_AGREE, STEPS * rtol)
    zeros = sorted((i, k) for k in range(len(what)) for i in _zeros(values[:, k]) if not _carried(run, i))
    for i, number in zeros:
        if not _passed(run, i, again, allowed):
            return _cut(run, i, _instant(run.t, values[:, number], i), what[number], place)
    if run.ok or run.status in ("interrupted", "singular"):
        return run
    k = int(np.argmin(abs(values[-1])))
    flipped = np.any(np.diff(np.sign(values[-3:, k])))
    if not flipped and abs(values[-1, k]) >= LAST:
        return run
    return _cut(run, len(run.t) - 1, run.phases[-1].end, what[k], place)


def _zeros(values: np.ndarray) -> list[int]:
    """The instants after which a determinant has another sign, or before which it comes near to zero and turns back."""
    signs, size = np.sign(values), np.abs(values)
    flips = np.flatnonzero(signs[:-1] * signs[1:] <= 0)
    inner = size[1:-1]
    minima = np.flatnonzero((inner <= size[:-2]) & (inner < size[2:]) & (inner < NEAR * np.max(size, initial=0)))
    return sorted({*flips.tolist(), *minima.tolist()})


def _carried(run: Trajectory, i: int) -> bool:
    """Whether the motion after the i-th instant was carried across a singular position."""
    start, end = float(run.t[i]), float(run.t[min(i + 2, len(run.t) - 1)])
    return any(first <= end and last >= start for first, last in run.passages)


def _passed(run: Trajectory, i: int, again: Again, allowed: float) -> bool:
    """Whether the motion from the i-th instant to two later comes out the same by a finer integration."""
    j = min(i + 2, len(run.t) - 1)
    if j == i:
        return True
    finer = again(float(run.t[i]), run.x[i], float(run.t[j]))
    scale = 1 + np.max(np.abs(run.x[i : j + 1]), axis=0)
    return bool(np.all(np.abs(finer - run.x[j]) <= allowed * scale))


def _instant(t: np.ndarray, values: np.ndarray, i: int) -> float:
    """Where a straight line between two instants is zero; the later one where it is not."""
    if i + 1 >= len(t):
        return float(t[i])
    if values[i] * values[i + 1] > 0:
        return float(t[i + 1])
    share = values[i] / (values[i] - values[i + 1]) if values[i] != values[i + 1] else 0.0
    return float(t[i] + (t[i + 1] - t[i]) * share)


def _cut(run: Trajectory, i: int, instant: float, what: str, place: str) -> Trajectory:
    """The run up to its i-th instant."""
    message = f"Stopped at t = {instant:.6g} s: {what} there ({place})."
    energy, drift = run.energy, run.drift
    if energy is not None:
        moved = np.abs(energy - energy[0])
        scale = np.max(moved) / drift if drift else np.inf
        energy, drift = energy[: i + 1], None if drift is None else float(np.max(moved[: i + 1]) / scale)
    if drift is not None and not np.isfinite(drift):
        drift = None
    phases = (*run.phases[:-1], replace(run.phases[-1], end=instant, ended_by=message))
    return replace(
        run,
        t=run.t[: i + 1],
        x=run.x[: i + 1],
        energy=energy,
        drift=drift,
        phases=phases,
        status="singular",
        message=message,
    )
