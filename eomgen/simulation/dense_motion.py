"""A phase as it was run -> its states at any instant: polynomials between the integrator's steps, of the same steps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from eomgen.errors import RunFailed
from eomgen.records import dataclass
from eomgen.simulation.motion import Plan, advance
from eomgen.simulation.phase_run import PhaseRun
from eomgen.symbolic.numeric.chebyshev import nodes_between, transform
from eomgen.symbolic.numeric.tolerances import ROUNDING

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

    def at(self, t: np.ndarray) -> np.ndarray:
        """n x states, by the barycentric formula sum w_k x_k/(s - s_k) / sum w_k/(s - s_k)."""
        if len(self.states) == 0:
            raise RunFailed("the phase is one instant", mend="a longer run")
        k = np.clip(np.searchsorted(self.edges, t, side="right") - 1, 0, len(self.states) - 1)
        a, b = self.edges[k], self.edges[k + 1]
        nodes = -np.cos(np.pi * np.arange(DEGREE + 1) / DEGREE)
        weights = (-1.0) ** np.arange(DEGREE + 1)
        weights[[0, -1]] /= 2
        apart = ((2 * t - a - b) / (b - a))[:, None] - nodes
        exact = np.abs(apart) < ROUNDING
        shares = weights / np.where(exact, 1.0, apart)
        shares = np.where(exact.any(axis=1)[:, None], exact, shares)
        found: np.ndarray = np.einsum("nk,nkx->nx", shares, self.states[k]) / shares.sum(axis=1)[:, None]
        return found


def dense_motion(phase_run: PhaseRun, plan: Plan) -> DenseMotion:
    """The states of a phase between its steps.

    It is followed once more with other instants, which change no step; where polynomials of so low a degree are not
    what lies between two steps (few of many steps are kept), at more of them.

    Args:
        plan: by which it was run.
    Raises:
        RunFailed: the run was cut before its end.
    """
    run, here = phase_run.run, phase_run.here
    if run.status in CUT:
        raise RunFailed(f"the run was cut: {run.message}", mend="a longer --patience, or a shorter run")
    kept = np.concatenate([part for track in run.tracks for part in track.t])
    edges = np.unique(np.clip(np.concatenate([[here.t, run.end], kept, *run.carried]), here.t, run.end))
    edges = edges[np.append(True, np.diff(edges) > ROUNDING * max(1.0, run.end - here.t))]
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


def _through(phase_run: PhaseRun, plan: Plan, edges: np.ndarray) -> DenseMotion:
    run, here = phase_run.run, phase_run.here
    nodes = nodes_between(edges, DEGREE)
    times = np.unique(nodes)
    again = advance(phase_run.phase, here, replace(plan, instants=times[times < run.end]))
    if again.end != run.end:
        raise RunFailed(
            f"followed once more the phase ends at t = {again.end:.12g} s, not at {run.end:.12g} s",
            mend="smaller tolerances: rtol, atol",
        )
    t, x = np.append(again.t[again.t < run.end], run.end), np.vstack([again.x[again.t < run.end], run.last])
    return DenseMotion(edges, x[np.searchsorted(t, nodes)])
