"""march.c -> its functions and its structure, as Python sees them."""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable
from importlib import resources
from typing import Any

import numpy as np

from eomgen.codegen.build import function_of, library, of_this_machine
from eomgen.codegen.rhs import RightHandSide
from eomgen.codegen.targets.base import Address
from eomgen.codegen.targets.c import c_together
from eomgen.simulation import constraint_drift, constraint_rank, event_location
from eomgen.simulation.solvers import FORGOTTEN, HELD_SHORT, SEEN
from eomgen.symbolic.numeric.tolerances import DIFFERENCE_STEP, ITERATED, NEARLY_SINGULAR, PIVOT, ROUNDING, SOLVED

SAFETY, SMALLEST, LARGEST = 0.9, 0.2, 10.0  # factors between two step sizes, as scipy takes them
SWEEPS = 30  # of turning pairs of rows; a handful does
MOST_AT_ONCE = 1024  # steps in a call
NEWTON_STEPS = 6  # of Radau's method, as scipy's
EASY = HELD_SHORT / 2  # h |lambda| of implicit steps with which DOP853 would go as far

_CONSTANTS = {
    "MOST_SWEEPS": SWEEPS,
    "SQUARE": ROUNDING,
    "GAP_ROUNDING": constraint_drift.ROUNDING,
    "ROW_ROUNDING": ROUNDING,
    "DAMPING": NEARLY_SINGULAR**2,
    "PUT_BACK_STEPS": constraint_drift.STEPS,
    "PUT_BACK_FAR": constraint_drift.FAR,
    "LOST": constraint_drift.LOST,
    "SLOW": constraint_drift.SLOW,
    "LARGEST_GROWTH": LARGEST,
    "SMALLEST_GROWTH": SMALLEST,
    "SAFETY": SAFETY,
    "SAME_INSTANT": SOLVED,
    "RESOLVED": event_location.RESOLVED,
    "EDGE": event_location.EDGE,
    "TOUCHES": ITERATED,
    "STEEP": constraint_rank.STEEP,
    "ARMED": constraint_rank.ARMED,
    "MOST_AT_ONCE": MOST_AT_ONCE,
    "SLOPE_STEP": DIFFERENCE_STEP,
    "REGULAR_PIVOT": PIVOT,
    "HELD_SHORT": HELD_SHORT,
    "EASY": EASY,
    "FORGOTTEN": FORGOTTEN,
    "RADAU_STEPS": NEWTON_STEPS,
}

BATCHED = {name: _CONSTANTS[name] for name in ("LARGEST_GROWTH", "SMALLEST_GROWTH", "SAFETY", "SAME_INSTANT")}
BATCHED |= {"HELD_SHORT": HELD_SHORT, "FORGOTTEN": FORGOTTEN, "SEEN": SEEN}  # what batch.c is told

SIZE, _REAL, _AT = ctypes.c_size_t, ctypes.c_double, ctypes.c_void_p


class MarchFunction(ctypes.Structure):
    _fields_ = tuple((name, _AT) for name in ("f", "p", "c", "inputs"))


class MarchRows(ctypes.Structure):
    _fields_ = (("f", MarchFunction), ("k", SIZE), ("n", SIZE))


def _fields(kind: Any, names: str) -> list[tuple[str, Any]]:
    return [(name, kind) for name in names.split()]


class March(ctypes.Structure):
    """`struct march` of march.c, in its order."""

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
        ("spheres", _AT),
        *_fields(SIZE, "n_spheres holds"),
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
        ("ties", MarchFunction),
        *_fields(SIZE, "n_determinants n_rows n_columns rank"),
        *_fields(_REAL, "near before"),
        ("slopes", _REAL * constraint_rank.REMEMBERED),
        *_fields(SIZE, "n_slopes is_armed"),
        *_fields(_AT, "lengths sizes"),
        *_fields(SIZE, "is_implicit is_auto dense_of stiff_seen easy_seen most_seen implicit_steps"),
        ("slope", MarchFunction),
        *_fields(SIZE, "has_slope slope_speeds slope_rows has_slope_values is_fresh has_lu"),
        *_fields(_REAL, "fastest h_older error_old"),
        *_fields(_AT, "jac real both Z pivots"),
        ("energies", MarchFunction),
        ("keeps_energy", SIZE),
        *_fields(_REAL, "energy most_kinetic"),
        ("order", SIZE),
        *_fields(_AT, "series along X X_old W"),
        ("has_series", SIZE),
    )


@functools.cache
def library_of_march() -> tuple[Any, Any, Any, Any, Any]:
    """(begin, march, dense, look, runs) of march.c, compiled."""
    defined = [f"#define {name} {value!r}" for name, value in _CONSTANTS.items()]
    here = resources.files("eomgen.simulation")
    texts = [resources.files("eomgen.codegen") / "dop853.c", here / "march.c", here / "radau.c"]
    text = "\n".join([*defined, *(text.read_text(encoding="utf-8") for text in texts)])
    made = library(text, by=of_this_machine())
    begin, march, dense, look, runs = (
        function_of(made, name) for name in ("march_begin", "march", "march_dense", "march_look", "march_runs")
    )
    begin.argtypes, begin.restype = [_AT], None
    march.argtypes, march.restype = [_AT, _AT], ctypes.c_int
    dense.argtypes, dense.restype = [_AT], None
    look.argtypes, look.restype = [_AT, SIZE, _AT, _AT], None
    runs.argtypes, runs.restype = [_AT, _AT, SIZE], ctypes.c_int
    return begin, march, dense, look, runs


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
