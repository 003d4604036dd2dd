"""Program -> ProgramInLanes, Batch: many states, or runs in threads, at once in the lanes of vectors."""

from __future__ import annotations

import ctypes
import functools
import threading
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from eomgen.codegen.build import function_of, library
from eomgen.codegen.program import Program, QuaternionPlaces
from eomgen.codegen.targets.c import C
from eomgen.codegen.targets.c_lanes import LANES, constants_of, lanes_text, text_of, vector_compiler
from eomgen.codegen.taylor import series_text
from eomgen.frozen import dataclass
from eomgen.resources import in_threads, pieces_of

STATUS = ("running", "finished", "not finite", "step too small", "too many steps", "stiff")
ROUNDS = 2000  # of a call: between two calls somebody may have lost patience
LOOKED_AT = 16  # steps from one look for stiffness to the next
_SIZE, _REAL, _AT = ctypes.c_size_t, ctypes.c_double, ctypes.c_void_p


@dataclass(frozen=True)
class BatchOptions:
    """Options that are the same for all runs.

    Args:
        span: the first and the last instant [s].
        instants: at which states are wanted, ascending.
        rtol, atol: of one step.
        most_steps: of one run.
        stops: instants across which no step goes.
        unit_quaternions: the places of quaternions in x.
    """

    span: tuple[float, float]
    instants: np.ndarray
    rtol: float
    atol: float
    most_steps: int
    stops: tuple[float, ...] = ()
    unit_quaternions: tuple[QuaternionPlaces, ...] = ()


@dataclass(frozen=True)
class BatchedRuns:
    """Results of runs: states, runs x instants x n; of each run its STATUS, the instant that it reached, its steps."""

    x: np.ndarray
    status: np.ndarray
    reached: np.ndarray
    steps: np.ndarray

    @property
    def words(self) -> np.ndarray:
        """The STATUS of each run, in words."""
        found: np.ndarray = np.array(STATUS, dtype=object)[self.status]
        return found


def _fields(kind: Any, names: str) -> list[tuple[str, Any]]:
    return [(name, kind) for name in names.split()]


@functools.cache
def _struct(lanes: int) -> Any:
    """`struct batch` of batch.c, in its order."""

    class Struct(ctypes.Structure):
        __slots__ = ()  # a name that is no field is an error
        _fields_ = (
            *_fields(_SIZE, "n parameters constants samples next last"),
            *_fields(_REAL, "start end rtol atol"),
            ("most_steps", _SIZE),
            *_fields(_AT, "instants x0 p x reached status steps stops"),
            ("n_stops", _SIZE),
            ("unit_quaternions", _AT),
            *_fields(_SIZE, "n_unit_quaternions begun"),
            ("work", _AT),
            ("room", _SIZE),
            *_fields(_SIZE * lanes, "run sample stop taken stiff easy"),
            ("h", _REAL * lanes),
            *_fields(ctypes.c_int * lanes, "is_new is_over rejected"),
        )

    return Struct


class ProgramInLanes:
    """A program at many states, in the lanes of vectors.

    Raises:
        RunFailed, ToolMissing: as of `library`.
    """

    def __init__(self, program: Program) -> None:
        self.lanes, text = lanes_text(program)
        made = library(f"{text}\n{text_of('many.c')}", by=vector_compiler())
        self._many = function_of(made, "lanes_many")
        self._many.argtypes, self._many.restype = [_SIZE, *[_AT] * 4, _SIZE, *[_AT] * 3], None
        self.program, self._constants = program, constants_of(program)

    def __call__(self, t: np.ndarray, x: np.ndarray, p: np.ndarray, inputs: np.ndarray | None) -> np.ndarray:
        """Outputs at n states: t n, x n x states, p of all or n x parameters, inputs None or n x inputs."""
        program = self.program
        given, outputs = len(program.symbols.inputs), len(program.outputs)
        sizes = np.array([x.shape[1], p.shape[-1], given, outputs], dtype=np.uintp)
        found = np.empty((len(x), outputs))
        room = _aligned((int(sizes.sum()) + self._constants + 1) * self.lanes)
        t, x, p = (np.ascontiguousarray(each, dtype=float) for each in (t, x, p))
        at = None if inputs is None else np.ascontiguousarray(inputs, dtype=float)
        self._many(
            len(x),
            *(each.ctypes.data for each in (sizes, t, x, p)),
            p.ndim - 1,
            None if at is None else at.ctypes.data,
            found.ctypes.data,
            room.ctypes.data,
        )
        return found


class Batch:
    """Runs of a program, in the lanes of vectors.

    Args:
        program: the right-hand side.
        defined: constants of batch.c.
        order: of the power series by which steps go; None: they are those of DOP853.
    Raises:
        RunFailed, ToolMissing: as of `library`.
    """

    def __init__(self, program: Program, defined: Mapping[str, float], order: int | None = None) -> None:
        self.lanes, text = lanes_text(program)
        reported = [f"#define {name} {value!r}" for name, value in {**defined, "LOOKED_AT": LOOKED_AT}.items()]
        n = len(program.states)
        if order is None:
            self._room = 48 * n
            steps = [text_of(name) for name in ("dop853.c", "dop853_pieces.c", "batch.c", "batch_dop853.c")]
        else:
            series, size = series_text(program, LANES if self.lanes > 1 else C, order)
            self._room, steps = (order + 1) * n + size, [series, text_of("batch.c"), text_of("batch_series.c")]
        made = library("\n".join([text, *reported, *steps]), by=vector_compiler())
        self._batch = function_of(made, "batch")
        self._batch.argtypes, self._batch.restype = [_AT, _SIZE], ctypes.c_int
        self._constants = constants_of(program)

    def runs(
        self, x0: np.ndarray, p: np.ndarray, requested: BatchOptions, *, threads: int, check: Callable[[], None]
    ) -> BatchedRuns:
        """The runs from x0 (runs x n) with parameters p (runs x parameters).

        Args:
            threads: among which they are divided.
            check: called now and then; its exceptions end all runs.
        """
        x0, p = np.ascontiguousarray(x0, dtype=float), np.ascontiguousarray(p, dtype=float)
        runs, n = x0.shape
        found = BatchedRuns(
            np.full((runs, len(requested.instants), n), np.nan),
            np.zeros(runs, dtype=np.int32),
            np.full(runs, requested.span[0]),
            np.zeros(runs, dtype=np.uintp),
        )
        pieces = pieces_of(runs, min(threads, -(-runs // self.lanes)))
        in_threads([partial(self._piece, x0, p, requested, found, piece) for piece in pieces], check)
        return found

    def _piece(
        self,
        x0: np.ndarray,
        p: np.ndarray,
        requested: BatchOptions,
        found: BatchedRuns,
        piece: tuple[int, int],
        stop: threading.Event,
    ) -> None:
        """The runs from one number on to another, in one thread."""
        n, instants = x0.shape[1], np.ascontiguousarray(requested.instants, dtype=float)
        stops, unit_quaternions = (
            np.array(requested.stops, dtype=float),
            np.array(requested.unit_quaternions, dtype=np.int32).reshape(-1, 4),
        )
        work = _aligned((6 * n + self._room + p.shape[1] + self._constants + 2) * self.lanes)
        b = _struct(self.lanes)(n=n, parameters=p.shape[1], constants=self._constants, samples=len(instants))
        b.next, b.last, b.start, b.end = *piece, *requested.span
        b.room = self._room
        b.rtol, b.atol, b.most_steps = requested.rtol, requested.atol, requested.most_steps
        b.n_stops, b.n_unit_quaternions = len(stops), len(unit_quaternions)
        arrays = {"instants": instants, "x0": x0, "p": p, "x": found.x, "reached": found.reached}
        arrays |= {
            "status": found.status,
            "steps": found.steps,
            "stops": stops,
            "unit_quaternions": unit_quaternions,
            "work": work,
        }
        for name, array in arrays.items():
            setattr(b, name, array.ctypes.data)
        while not stop.is_set() and self._batch(ctypes.byref(b), ROUNDS):
            pass


def _aligned(count: int) -> np.ndarray:
    """Array of zeros at an address that is aligned for vectors."""
    room = np.zeros(count + 8)
    first = -room.ctypes.data % 64 // 8
    return room[first : first + count]
