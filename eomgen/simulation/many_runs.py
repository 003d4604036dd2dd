"""PhaseModel, starts and parameters of many runs -> their states, by march.c."""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable, Mapping
from functools import cached_property
from importlib import resources
from typing import Any

import numpy as np

from eomgen.codegen import Address, Program, RightHandSide, c_together, functions_in_c
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import CLOSING
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.start import Start
from eomgen.simulation import constraint_drift, event_location, phase_change
from eomgen.simulation.constraint_drift import ARMED, REMEMBERED, STEEP
from eomgen.simulation.phase_model import PhaseModel
from eomgen.simulation.solvers import FORGOTTEN, HELD_SHORT, SEEN
from eomgen.symbolic.expression import Node, Scalar, jacobian
from eomgen.symbolic.numeric import tolerances

# -------- march -----------------------------------------------------------------------------------------------
# march.c -> its functions and its structure, as Python sees them.


SAFETY, SMALLEST, LARGEST = 0.9, 0.2, 10.0  # factors between two step sizes, as scipy takes them
SWEEPS = 30  # of turning pairs of rows; a handful does
MOST_AT_ONCE = 1024  # steps in a call
NEWTON_STEPS = 6  # of Radau's method, as scipy's
MOST_AT_INSTANT = 20  # phases that end as soon as they begin, one after the other
EASY = HELD_SHORT / 2  # h |lambda| of implicit steps with which DOP853 would go as far

_CONSTANTS = {
    "MOST_SWEEPS": SWEEPS,
    "SQUARE": tolerances.ROUNDING,
    "GAP_ROUNDING": constraint_drift.ROUNDING,
    "ROW_ROUNDING": tolerances.ROUNDING,
    "DAMPING": tolerances.NEARLY_SINGULAR**2,
    "PUT_BACK_STEPS": constraint_drift.STEPS,
    "PUT_BACK_FAR": constraint_drift.FAR,
    "LOST": constraint_drift.LOST,
    "SLOW": constraint_drift.SLOW,
    "LARGEST_GROWTH": LARGEST,
    "SMALLEST_GROWTH": SMALLEST,
    "SAFETY": SAFETY,
    "SAME_INSTANT": tolerances.SOLVED,
    "RESOLVED": event_location.RESOLVED,
    "EDGE": event_location.EDGE,
    "TOUCHES": tolerances.ITERATED,
    "STEEP": STEEP,
    "ARMED": ARMED,
    "MOST_AT_ONCE": MOST_AT_ONCE,
    "SLOPE_STEP": tolerances.DIFFERENCE_STEP,
    "REGULAR_PIVOT": tolerances.PIVOT,
    "HELD_SHORT": HELD_SHORT,
    "EASY": EASY,
    "FORGOTTEN": FORGOTTEN,
    "RADAU_STEPS": NEWTON_STEPS,
    "SEEN": SEEN,
    "COMPUTED": tolerances.COMPUTED,
    "SUMMED": tolerances.SUMMED,
    "GAP_CLOSED": tolerances.GAP_CLOSED,
    "LOWEST_FLIGHT": tolerances.LOWEST_FLIGHT,
    "LOW": phase_change.LOW,
    "SOON": tolerances.SOON,
    "SHARE": tolerances.SHARE,
    "MOST_TRIED": phase_change.MOST_TRIED,
    "MOST_AT_INSTANT": MOST_AT_INSTANT,
    "COARSE": float(tolerances.COMPUTED / np.finfo(float).eps),
}

BATCHED = {name: _CONSTANTS[name] for name in ("LARGEST_GROWTH", "SMALLEST_GROWTH", "SAFETY", "SAME_INSTANT")}
BATCHED |= {"HELD_SHORT": HELD_SHORT, "FORGOTTEN": FORGOTTEN, "SEEN": SEEN}  # constants of batch.c

SIZE, _REAL, _AT = ctypes.c_size_t, ctypes.c_double, ctypes.c_void_p


class MarchFunction(ctypes.Structure):
    _fields_ = tuple((name, _AT) for name in ("f", "p", "c", "inputs"))


class MarchRows(ctypes.Structure):
    _fields_ = (("f", MarchFunction), ("k", SIZE), ("n", SIZE))


def _fields(kind: Any, names: str) -> list[tuple[str, Any]]:
    return [(name, kind) for name in names.split()]


class March(ctypes.Structure):
    """`struct march` of march.c, in its order."""

    __slots__ = ()  # a name that is no field is an error
    _fields_ = (
        ("n", SIZE),
        ("rate", MarchFunction),
        *_fields(_REAL, "t t_old h h_old end rtol atol"),
        *_fields(_AT, "x x_old f K F room stops"),
        *_fields(SIZE, "n_stops evaluations is_dense"),
        ("instants", _AT),
        *_fields(SIZE, "n_instants next"),
        *_fields(_AT, "rows track_t track_x"),
        ("tracked", SIZE),
        ("unit_quaternions", _AT),
        *_fields(SIZE, "n_unit_quaternions holds"),
        ("gaps", MarchFunction),
        *_fields(SIZE, "n_gaps placed coordinates speeds"),
        ("places", MarchRows),
        ("rates", MarchRows),
        ("work", _AT),
        *_fields(SIZE, "n_events is_blind"),
        ("events", MarchFunction),
        *_fields(_AT, "floors either signs largest looks armed"),
        ("is_near_watched", SIZE),
        ("determinants", MarchFunction),
        ("constraints", MarchFunction),
        *_fields(SIZE, "n_determinants n_rows n_columns rank"),
        *_fields(_REAL, "near before"),
        ("slopes", _REAL * REMEMBERED),
        *_fields(SIZE, "n_slopes is_armed"),
        *_fields(_AT, "lengths sizes"),
        *_fields(SIZE, "is_implicit is_auto dense_of stiff_seen easy_seen most_seen implicit_steps"),
        ("slope", MarchFunction),
        *_fields(SIZE, "has_slope slope_speeds slope_rows slope_states has_slope_values is_fresh has_lu"),
        *_fields(_REAL, "fastest h_older error_old"),
        *_fields(_AT, "jac real both Z pivots"),
        ("energies", MarchFunction),
        ("keeps_energy", SIZE),
        *_fields(_REAL, "energy most_kinetic"),
        ("order", SIZE),
        *_fields(_AT, "series along X X_old W"),
        *_fields(SIZE, "has_series pieces"),
        *_fields(_AT, "piece along_pieces"),
    )


@functools.cache
def library_of_march() -> tuple[Any, Any, Any, Any, Any]:
    """(begin, march, dense, look, runs) of march.c, compiled."""
    names = ("march_begin", "march", "march_dense", "march_look", "march_runs")
    begin, march, dense, look, runs = functions_in_c(march_text(phases=False), *names)
    begin.argtypes, begin.restype = [_AT], None
    march.argtypes, march.restype = [_AT, _AT], ctypes.c_int
    dense.argtypes, dense.restype = [_AT], None
    look.argtypes, look.restype = [_AT, SIZE, _AT, _AT], None
    runs.argtypes, runs.restype = [_AT, _AT, SIZE], ctypes.c_int
    return begin, march, dense, look, runs


@functools.cache
def machine() -> tuple[Any, Any]:
    """(machine_run, machine_runs) of phases.c, compiled with march.c."""
    run, runs = functions_in_c(march_text(phases=True), "machine_run", "machine_runs")
    run.argtypes, run.restype = [_AT, SIZE], ctypes.c_int
    runs.argtypes, runs.restype = [_AT, _AT, SIZE], ctypes.c_int
    return run, runs


@functools.cache
def march_text(*, phases: bool) -> str:
    """Steps in C, and phases of them, one after the other."""
    defined = [f"#define {name} {value!r}" for name, value in _CONSTANTS.items()]
    here = resources.files("eomgen.simulation")
    there = resources.files("eomgen.codegen")
    texts = [there / "dop853.c", there / "dop853_pieces.c", here / "march.c", here / "radau.c"]
    texts += [here / "phases.c"] * phases
    return "\n".join([*defined, *(text.read_text(encoding="utf-8") for text in texts)])


@functools.lru_cache(maxsize=256)
def compiled_functions(functions: tuple[RightHandSide, ...]) -> tuple[Callable[[np.ndarray], Address], ...]:
    """Functions of the state in C, whatever they run in otherwise: p -> where each lies."""
    compiled = c_together([function.program for function in functions])

    def of(each: Any) -> Callable[[np.ndarray], Address]:
        def found(p: np.ndarray) -> Address:
            address: Address = each.address(each.constants(p))
            return address

        return found

    return tuple(map(of, compiled))


def function_at(address: Address) -> MarchFunction:
    return MarchFunction(f=address.evaluate, p=address.p, c=address.c, inputs=None)


# -------- many starts -----------------------------------------------------------------------------------------
# PhaseModel, parameters and starts of many runs -> the states at which they begin, in doubles and all at once.
#
# Dependent coordinates are sought as `Start.of` seeks them, by the same steps from the same guesses:
#
#     (A^T A + min(|phi|, 1)^2 1) d = -A^T phi,   A = d phi/dq of what is sought,   q <- q + d
#
# Runs whose constraints do not all hold then to rounding are left to it.


@dataclass(frozen=True)
class ManyStarts:
    """The starts of many runs of the one phase of a model."""

    phase: PhaseModel

    def at(self, p: np.ndarray, given: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(states of the phase, n x states; where coordinates are declared, n x q; whether all constraints hold, n).

        Args:
            p: n x parameters.
            given: starts in place of the model's, a number a run.
        """
        symbols, places = self._system.symbols, len(self._system.symbols.q)
        x = np.zeros((len(p), len(symbols.x)))
        names = [node.name for node in symbols.x]
        x[:, :places] = self._places.many(0.0, x, p)
        columns = {names.index(name): values for name, values in given.items()}
        for k in (k for k in columns if k < places):
            x[:, k] = columns[k]
        x = self._places.program.unit_quaternions.at_unit_norms(x)
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
        """Moves the sought coordinates until the positions hold; True for each run in which all constraints hold."""
        sought = [self._system.symbols.q.index(q) for q in self._sought]
        moving = np.arange(len(x)) if sought else np.arange(0)
        best = np.full(len(x), np.inf)
        with np.errstate(all="ignore"):
            for _ in range(CLOSING.steps):
                if not len(moving):
                    break
                gaps, A = self._gaps(x[moving], p[moving])
                size = np.max(np.abs(gaps), axis=1, initial=0.0)
                goes_on = (size > tolerances.ROUNDING * _size(x[moving])) & ~(
                    (best[moving] < tolerances.SUMMED) & (size >= best[moving] / 2)
                )
                goes_on &= np.all(np.isfinite(gaps), axis=1) & np.all(np.isfinite(A), axis=(1, 2))
                best[moving] = size
                moving, gaps, A, size = moving[goes_on], gaps[goes_on], A[goes_on], size[goes_on]
                x[np.ix_(moving, sought)] += _step(A, gaps, np.minimum(size, 1.0))
            left = np.max(np.abs(self._all.many(0.0, x, p)), axis=1, initial=0.0)
        return np.asarray(left <= tolerances.SUMMED * _size(x))

    def _gaps(self, x: np.ndarray, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        found = self._slopes.many(0.0, x, p)
        k = len(self._phi)
        return found[:, :k], found[:, k:].reshape(len(x), k, len(self._sought))

    def _of_phase(self, x: np.ndarray, p: np.ndarray) -> np.ndarray:
        """The same states over the coordinates and speeds that are integrated."""
        phase, symbols = self.phase, self._system.symbols
        if phase.system is self._system:
            return x
        known = dict(zip((node.name for node in symbols.x), x.T, strict=True))
        names = phase.moving
        found = np.array([known.get(name, np.zeros(len(x))) for name in names]).reshape(len(names), len(x)).T
        rates = phase.functions.kinematic(self._system.scope.rates).many(0.0, np.ascontiguousarray(found), p)
        known = {f"{q}'": rate for q, rate in zip(phase.coordinates, rates.T, strict=True)} | known
        return np.array([known[name] for name in names]).reshape(len(names), len(x)).T.copy()

    @cached_property
    def _sought(self) -> list[Node]:
        return self._system.constraints.fixed_by_position

    @cached_property
    def _phi(self) -> tuple[Scalar, ...]:
        return (*self._system.constraints.gaps, *self._system.constraints.norms)

    @cached_property
    def _slopes(self) -> RightHandSide:
        return self._of((*self._phi, *(x for row in jacobian(self._phi, self._sought) for x in row)))

    @cached_property
    def _all(self) -> RightHandSide:
        """Function of the residuals that vanish at a start: phi, and J u + sigma."""
        return self._of((*self._phi, *(row.velocity for row in self._system.constraints.closing)))

    @cached_property
    def _places(self) -> RightHandSide:
        """Function of the declared start of the coordinates; of sought ones the guess from which the search begins."""
        scope = self._system.scope
        near = {q: scope.model.coordinates[q.name].near for q in self._sought}
        guesses = {q: scope.value(value) for q, value in near.items() if value is not None}
        return self._of(tuple(guesses[q] if q in guesses else scope.start_value(q) for q in scope.symbols.q))

    @cached_property
    def _speeds(self) -> RightHandSide:
        """Function of the speeds at the start, and of the states of first order."""
        scope = self._system.scope
        states = (scope.value(part.start) for part in scope.model.states.values())
        return self._of((*Start.speeds_of(self._system).values(), *states))

    def _of(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        return RightHandSide.of(Program.of(scalars, self._system.symbols, inputs=self._system.inputs), "numpy")


def _size(x: np.ndarray) -> np.ndarray:
    return np.asarray(np.max(np.abs(x), axis=1, initial=1.0))


def _step(A: np.ndarray, f: np.ndarray, damping: np.ndarray) -> np.ndarray:
    """d of each run, by the singular values of its A."""
    U, s, V = np.linalg.svd(A, full_matrices=False)
    below = s * s + (damping * damping)[:, None]
    share = np.where(s > 0, s / np.where(below > 0, below, 1.0), 0.0)
    return np.asarray(-np.einsum("nij,ni->nj", V, share * np.einsum("nki,nk->ni", U, f)))
