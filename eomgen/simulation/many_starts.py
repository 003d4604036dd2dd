"""PhaseModel, parameters and starts of many runs -> the states at which they begin, in doubles and all at once.

Dependent coordinates are sought as `start_of_motion` seeks them, by the same steps from the same guesses:

    (A^T A + min(|phi|, 1)^2 1) d = -A^T phi,   A = d phi/dq of what is sought,   q <- q + d

Runs whose ties do not all hold then to rounding are left to it.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from eomgen.codegen.program import program_of
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.codegen.spheres import on_spheres, spheres_of
from eomgen.mechanics.bodies.system_scene import start_value
from eomgen.mechanics.constraints.assembly import fixed_by_position
from eomgen.mechanics.constraints.closure import CLOSING, gaps_of, norms_of
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.initial_state import start_speeds
from eomgen.records import dataclass
from eomgen.simulation.phase_model import PhaseModel
from eomgen.symbolic.expression.derivative import jacobian
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.tolerances import ROUNDING, SUMMED


@dataclass(frozen=True)
class ManyStarts:
    """The starts of many runs of the one phase of a model."""

    phase: PhaseModel

    def at(self, p: np.ndarray, given: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(states of the phase, n x states; where coordinates are declared, n x q; whether all ties hold, n).

        Args:
            p: n x parameters.
            given: starts in place of the model's, a number a run.
        """
        symbols, places = self._system.symbols, len(self._system.symbols.q)
        x = np.zeros((len(p), places + len(symbols.u)))
        names = [node.name for node in (*symbols.q, *symbols.u)]
        x[:, :places] = self._places.many(0.0, x, p)
        columns = {names.index(name): values for name, values in given.items()}
        for k in (k for k in columns if k < places):
            x[:, k] = columns[k]
        x = on_spheres(x, spheres_of(self._places.program))
        x[:, places:] = self._speeds.many(0.0, x, p)
        for k in (k for k in columns if k >= places):
            x[:, k] = columns[k]
        declared = x[:, :places].copy()
        holds = self._closed(x, p)
        return self._of_phase(x, p), declared, holds

    @property
    def _system(self) -> System:
        return self.phase.declared

    def _closed(self, x: np.ndarray, p: np.ndarray) -> np.ndarray:
        """Moves what is sought in the states to where positions hold; whether everything holds there."""
        sought = [self._system.symbols.q.index(q) for q in self._sought]
        moving = np.arange(len(x)) if sought else np.arange(0)
        best = np.full(len(x), np.inf)
        with np.errstate(all="ignore"):
            for _ in range(CLOSING.steps):
                if not len(moving):
                    break
                gaps, A = self._gaps(x[moving], p[moving])
                size = np.max(np.abs(gaps), axis=1, initial=0.0)
                goes_on = (size > ROUNDING * _size(x[moving])) & ~((best[moving] < SUMMED) & (size >= best[moving] / 2))
                goes_on &= np.all(np.isfinite(gaps), axis=1) & np.all(np.isfinite(A), axis=(1, 2))
                best[moving] = size
                moving, gaps, A, size = moving[goes_on], gaps[goes_on], A[goes_on], size[goes_on]
                x[np.ix_(moving, sought)] += _step(A, gaps, np.minimum(size, 1.0))
            left = np.max(np.abs(self._all.many(0.0, x, p)), axis=1, initial=0.0)
        return np.asarray(left <= SUMMED * _size(x))

    def _gaps(self, x: np.ndarray, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        found = self._slopes.many(0.0, x, p)
        k = len(self._phi)
        return found[:, :k], found[:, k:].reshape(len(x), k, len(self._sought))

    def _of_phase(self, x: np.ndarray, p: np.ndarray) -> np.ndarray:
        """The same states over the coordinates and speeds that are integrated."""
        phase, symbols = self.phase, self._system.symbols
        if phase.system is self._system:
            return x
        known = dict(zip((node.name for node in (*symbols.q, *symbols.u)), x.T, strict=True))
        names = (*phase.coordinates, *phase.speeds)
        found = np.array([known.get(name, np.zeros(len(x))) for name in names]).reshape(len(names), len(x)).T
        rates = phase.functions.kinematic(self._system.scope.rates).many(0.0, np.ascontiguousarray(found), p)
        known = {f"{q}'": rate for q, rate in zip(phase.coordinates, rates.T, strict=True)} | known
        return np.array([known[name] for name in names]).reshape(len(names), len(x)).T.copy()

    @cached_property
    def _sought(self) -> list[Node]:
        return fixed_by_position(self._system.ties)

    @cached_property
    def _phi(self) -> tuple[Scalar, ...]:
        return (*gaps_of(self._system.ties), *norms_of(self._system.ties))

    @cached_property
    def _slopes(self) -> RightHandSide:
        return self._of((*self._phi, *(x for row in jacobian(self._phi, self._sought) for x in row)))

    @cached_property
    def _all(self) -> RightHandSide:
        """What vanishes at a start."""
        return self._of((*self._phi, *(row.velocity for row in self._system.ties.closing)))

    @cached_property
    def _places(self) -> RightHandSide:
        """Where coordinates are declared to start; what is sought, where that begins."""
        scope = self._system.scope
        near = {q: scope.model.coordinates[q.name].near for q in self._sought}
        guesses = {q: scope.value(value) for q, value in near.items() if value is not None}
        return self._of(tuple(guesses[q] if q in guesses else start_value(scope, q) for q in scope.symbols.q))

    @cached_property
    def _speeds(self) -> RightHandSide:
        return self._of(tuple(start_speeds(self._system).values()))

    def _of(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        return compiled(program_of(scalars, self._system.symbols, inputs=self._system.inputs), "numpy")


def _size(x: np.ndarray) -> np.ndarray:
    return np.asarray(np.max(np.abs(x), axis=1, initial=1.0))


def _step(A: np.ndarray, f: np.ndarray, damping: np.ndarray) -> np.ndarray:
    """d of each run, by the singular values of its A."""
    U, s, V = np.linalg.svd(A, full_matrices=False)
    below = s * s + (damping * damping)[:, None]
    share = np.where(s > 0, s / np.where(below > 0, below, 1.0), 0.0)
    return np.asarray(-np.einsum("nij,ni->nj", V, share * np.einsum("nki,nk->ni", U, f)))
