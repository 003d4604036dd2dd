"""Trajectory -> the same, ended where ties no longer said how the motion goes on, and the tie named.

Dependent coordinates follow the independent ones as long as det J_d is not zero. A run that passes such an instant
(a change point, a dead centre) is held to be right where the energy that ought to stay does; where it does not, or the
integrator stopped there, the run ends there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from eomgen.simulation.trajectory import Trajectory

PASSED = 1e-6  # drift of the energy up to which a singular instant counts as passed
DRIFT = 1e3  # tolerances of one step that a run may drift by itself
NEAR = 1e-2  # of a determinant, against its rows: where it is larger, the end of a run has another reason

Determinants = Callable[[np.ndarray, np.ndarray], np.ndarray]


def ended_where_singular(
    run: Trajectory, determinants: Determinants, what: Sequence[str], *, rtol: float = 1e-9
) -> Trajectory:
    """The run, cut where it went wrong by a vanishing determinant.

    Args:
        determinants: (t n, x n x states) -> n x k, against the lengths of their rows.
        what: of each determinant, what is not determined where it vanishes: "'pin' does not determine 'phi'".
        rtol: of the integration, whose own drift is no sign of anything.
    """
    if len(run.t) == 0 or not what:
        return run
    with np.errstate(all="ignore"):
        values = np.nan_to_num(np.reshape(determinants(run.t, run.x), (len(run.t), len(what))))
    broken = _broken(run, values, max(PASSED, DRIFT * rtol))
    if broken is not None:
        i, k = broken
        return _cut(run, i, _instant(run.t, values[:, k], i), what[k])
    if run.ok or run.status == "interrupted":
        return run
    k = int(np.argmin(abs(values[-1])))
    flipped = _flips(values[-3:, k]).size > 0
    return _cut(run, len(run.t) - 1, run.phases[-1].end, what[k]) if flipped or abs(values[-1, k]) < NEAR else run


def _broken(run: Trajectory, values: np.ndarray, passed: float) -> tuple[int, int] | None:
    """(last sound instant, determinant) of the first singular instant after which the energy is another."""
    if run.energy is None or run.drift is None or not run.drift > passed:
        return None
    moved = np.abs(run.energy - run.energy[0])
    scale = np.max(moved) / run.drift
    first_off = int(np.argmax(moved > passed * scale))
    before = [(int(i), k) for k in range(values.shape[1]) for i in _flips(values[:, k]) if i < first_off]
    found = max(before, default=None)
    if found is None or first_off - found[0] > max(2, len(run.t) // 100):
        return None  # the energy went astray elsewhere
    return found


def _flips(values: np.ndarray) -> np.ndarray:
    """The instants after which a determinant has another sign, or is zero."""
    signs = np.sign(values)
    return np.flatnonzero(signs[:-1] * signs[1:] <= 0)


def _instant(t: np.ndarray, values: np.ndarray, i: int) -> float:
    """Where a straight line between two instants is zero."""
    if i + 1 >= len(t) or values[i] == values[i + 1]:
        return float(t[i])
    return float(t[i] + (t[i + 1] - t[i]) * values[i] / (values[i] - values[i + 1]))


def _cut(run: Trajectory, i: int, instant: float, what: str) -> Trajectory:
    """The run up to its i-th instant."""
    message = f"Stopped at t = {instant:.6g} s: {what} there (a dead centre or a change point)."
    energy, drift = run.energy, run.drift
    if energy is not None:
        moved = np.abs(energy - energy[0])
        scale = np.max(moved) / drift if drift else np.inf
        energy, drift = energy[: i + 1], None if drift is None else float(np.max(moved[: i + 1]) / scale)
    if drift is not None and not np.isfinite(drift):
        drift = None
    phases = (*run.phases[:-1], replace(run.phases[-1], end=instant, ended_by=message))
    return replace(run, t=run.t[: i + 1], x=run.x[: i + 1], energy=energy, drift=drift, phases=phases,
                   status="singular", message=message)  # fmt: skip
