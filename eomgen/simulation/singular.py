"""Run -> the same, ended where ties no longer said how the motion goes on, and the tie named.

Dependent coordinates follow the independent ones as long as det J_d is not zero. Across an instant where it vanishes
(a change point, a dead centre) the integrator's own estimate of its error is worth nothing. So a run that came by one
is integrated again from before it until after it, much finer: where both agree it has passed, else it ends there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from eomgen.simulation.constraint_rank import Undetermined
from eomgen.simulation.integrator import Run
from eomgen.symbolic.numeric.tolerances import RUN, RUNS_AGREE

STEPS = 100  # tolerances of one step by which they may differ
NEAR = 0.02  # of a determinant's largest value: how small a minimum may be the sign of a zero
LAST = 1e-2  # of a determinant's largest value: where it is larger, the end of a run has another reason

Again = Callable[[float, np.ndarray, float], np.ndarray]


def ended_where_singular(run: Run, what: Undetermined, again: Again, *, rtol: float = RUN) -> Run:
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
    allowed = max(RUNS_AGREE, STEPS * rtol)
    zeros = sorted(
        (i, k) for k in range(values.shape[1]) for i in vanishing_after(values[:, k]) if not _carried(run, i)
    )
    for i, number in zeros:
        if not _passed(run, i, again, allowed):
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
    """Whether the motion after the i-th instant was carried across a singular position."""
    start, end = float(run.t[i]), float(run.t[min(i + 2, len(run.t) - 1)])
    return any(first <= end and last >= start for first, last in run.carried)


def _passed(run: Run, i: int, again: Again, allowed: float) -> bool:
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
