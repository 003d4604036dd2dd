"""Program -> RightHandSide: dx = f(t, x, p, inputs) as a function of arrays."""

from __future__ import annotations

import ctypes
import functools
import sys
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from functools import cached_property, partial
from typing import Any, TypeVar

import numpy as np

from eomgen.codegen.build import function_of, library
from eomgen.codegen.program import Program, QuaternionPlaces, Solve
from eomgen.codegen.targets import ALL
from eomgen.codegen.targets.base import Address, Functions, Role, Target
from eomgen.codegen.targets.c import C, c_together
from eomgen.codegen.targets.c_lanes import LANES, constants_of, lanes_text, text_of, vector_compiler
from eomgen.codegen.taylor import Series, series_of, series_text, without_series
from eomgen.errors import RunFailed, ToolMissing, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank
from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.model import Model, Valued
from eomgen.resources import in_threads, pieces_of
from eomgen.symbolic.numeric import of_one_length, tolerances

_Made = TypeVar("_Made")

_said: set[str] = set()


class RightHandSide:
    """A program as a function; safe to call from several threads.

    `rhs(t, x, p, inputs=())` -> dx, a new array; x = (q, u, z) in the order of `coordinates`, `speeds`, `states`; p in
    that of `parameters`; inputs in that of `inputs`, or () for the model's own expressions.

    Args:
        program: the compiled program.
        functions: the program in memory.
        target: name of the target that made them.
        x0, p0: start and parameter values, None where one is missing.
    """

    def __init__(self, program: Program, functions: Functions, target: str, x0: Any, p0: Any) -> None:
        symbols = program.symbols
        self.program, self.target = program, target
        self.coordinates = tuple(x.name for x in symbols.q)
        self.speeds = tuple(x.name for x in symbols.u)
        self.states = tuple(x.name for x in symbols.z)
        self.parameters, self.inputs = tuple(symbols.parameters), tuple(symbols.inputs)
        self.x0 = None if x0 is None else np.array(x0, dtype=float)
        self.p0 = None if p0 is None else np.array(p0, dtype=float)
        self._functions, self._one = functions, functions.one
        self.unit_quaternions = program.unit_quaternions
        self._states = len(program.moving)
        self._known: tuple[bytes, Any] = (b"none yet", None)
        self._series: dict[int, Series | None] = {}

    def __call__(self, t: float, x: Any, p: Any, inputs: Sequence[float] = ()) -> np.ndarray:
        """dx at one state.

        Raises:
            UsageError: x, p or inputs of the wrong length.
        """
        if len(x) != self._states:
            raise _wrong_length("x", self.moving, len(x))
        key = np.asarray(p, dtype=float).tobytes()
        known = self._known
        if key != known[0]:
            known = self._known = key, self._constants(p)
        if len(inputs) == 0:
            return self._one(t, x, known[1], None)
        if len(inputs) != len(self.inputs):
            raise _wrong_length("inputs", self.inputs, len(inputs))
        return self._one(t, x, known[1], inputs)

    def at(self, p: Any) -> RateFunction:
        """(t, x) -> dx for given parameters and the model's own inputs: a call without checks, for integrators."""
        return RateFunction(self, self._functions, self._constants(p), p)

    def many(self, t: Any, x: Any, p: Any, inputs: Any = ()) -> np.ndarray:
        """dx at n states: t n or one number, x n x states, p of all or n x parameters, inputs () or n x inputs."""
        x = np.ascontiguousarray(x, dtype=float)
        if x.ndim != 2 or x.shape[1] != self._states:
            raise UsageError(f"x is {' x '.join(map(str, x.shape))}, not n x {self._states}", fix="one state a row")
        t = np.ascontiguousarray(np.broadcast_to(np.asarray(t, dtype=float), len(x)))
        given = None
        if np.size(inputs):
            given = np.ascontiguousarray(np.broadcast_to(inputs, (len(x), len(self.inputs))), dtype=float)
        if np.ndim(p) == 1:
            return self._functions.many(t, x, self._checked(p), given)
        p = np.ascontiguousarray(p, dtype=float)
        if p.shape != (len(x), len(self.parameters)):
            raise UsageError(
                f"p is {' x '.join(map(str, p.shape))}, not {len(x)} x {len(self.parameters)}",
                fix="one row of parameters for each state",
            )
        if self.target == "c" and self._in_lanes is not None:
            return self._in_lanes(t, x, p, given)
        if self.target == "numpy":
            return self._functions.many(t, x, p, given)
        rows = ((t[i : i + 1], x[i : i + 1], p[i], None if given is None else given[i : i + 1]) for i in range(len(x)))
        return np.vstack([np.empty((0, len(self.program.outputs))), *(self._functions.many(*row) for row in rows)])

    @cached_property
    def _in_lanes(self) -> ProgramInLanes | None:
        """The program in lanes; None where no compiler makes it."""
        return in_c(lambda: ProgramInLanes(self.program), "states are evaluated one by one")

    @cached_property
    def without_series(self) -> str:
        """First part of its program without a power series; "" if all have one."""
        return without_series(self.program)

    def series(self, order: int) -> Series | None:
        """The power series of the motion, in C; None if it has none."""
        if order not in self._series:
            self._series[order] = series_of(self.program, order)
        return self._series[order]

    @property
    def source(self) -> str:
        """The program's text in the target's language."""
        return target_named(self.target).text(self.program, "eomgen", Role.RHS)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles its program, which is compiled again where the pickle is read: in C where there is a compiler."""
        return _compiled_again, (self.program, None if self.target == "c" else self.target, self.x0, self.p0)

    def __repr__(self) -> str:
        arguments = f"x = ({', '.join(self.moving)}), p = ({', '.join(self.parameters)})"
        return f"<right-hand side in {self.target}: {arguments}>"

    @property
    def moving(self) -> tuple[str, ...]:
        """Everything in x = (q, u, z) by name."""
        return self.coordinates + self.speeds + self.states

    def _constants(self, p: Any) -> Any:
        return self._functions.constants(self._checked(p))

    def _checked(self, p: Any) -> np.ndarray:
        values: np.ndarray = np.ascontiguousarray(p, dtype=float)
        if values.shape != (len(self.parameters),):
            raise _wrong_length("p", self.parameters, values.size)
        return values

    @classmethod
    def of(cls, program: Program, target: str | None = None, *, x0: Any = None, p0: Any = None) -> RightHandSide:
        """The program as a function.

        Args:
            program: the compiled program.
            target: "numpy", "c", or None: C where there is a compiler, else numpy, said once on stderr.
            x0, p0: start and parameter values for the function's attributes.
        Raises:
            UsageError: an unknown target.
            ToolMissing: "c" without a compiler.
            RunFailed: "c", and the compiler fails.
        """
        if target is not None:
            return cls(program, target_named(target).load(program), target, x0, p0)
        found = in_c(
            lambda: RightHandSide.of(program, "c", x0=x0, p0=p0),
            "the equations run in numpy, some 30 times slower",
        )
        return RightHandSide.of(program, "numpy", x0=x0, p0=p0) if found is None else found

    @staticmethod
    def compiled_together(programs: Sequence[Program], target: str | None = None) -> tuple[RightHandSide, ...]:
        """Several programs as functions, one library of them where they run in C; with the errors of `of`."""
        if target in (None, "c"):
            with suppress(*([RunFailed, ToolMissing] if target is None else [])):
                made = c_together(programs)
                return tuple(
                    RightHandSide(program, functions, "c", None, None)
                    for program, functions in zip(programs, made, strict=True)
                )
        return tuple(RightHandSide.of(program, target) for program in programs)

    @staticmethod
    def parameter_values(model: Model, overrides: Mapping[str, Any] | None = None) -> np.ndarray:
        """p: the value of every parameter, in the model's order.

        Args:
            overrides: other values: numbers in SI, or values with a unit.
        Raises:
            MissingValues: parameters without a value, all named.
        """
        if overrides and not all(isinstance(x, (int, float, np.number)) for x in overrides.values()):
            model, overrides = Valued.of(model, overrides).model, None
        return np.array(list(model.numeric_parameters(overrides).values()), dtype=float)


class RateFunction:
    """(t, x) -> dx of a right-hand side; `address` is where a compiled one lies, None of others."""

    def __init__(self, rhs: RightHandSide, functions: Functions, known: Any, p: Any) -> None:
        self.rhs, self._one, self._known, self.p = rhs, functions.one, known, p
        self.address: Address | None = None if functions.address is None else functions.address(known)

    def __call__(self, t: float, x: Any) -> np.ndarray:
        return self._one(t, x, self._known, None)


def in_c(make: Callable[[], _Made], otherwise: str) -> _Made | None:
    """Result of a compiler; None where there is none, or it fails: that, and what is done instead, is said once."""
    try:
        return make()
    except (RunFailed, ToolMissing) as error:
        _say(f"{error.what.splitlines()[0]}: {otherwise}")
        return None


def _compiled_again(program: Program, target: str | None, x0: Any, p0: Any) -> RightHandSide:
    """A right-hand side out of a pickle."""
    return RightHandSide.of(program, target, x0=x0, p0=p0)


def target_named(name: str) -> Target:
    """The target of this name; UsageError where there is none."""
    for target in ALL:
        if target.name == name:
            return target
    raise UsageError(f"unknown target '{name}'", fix=f"targets are {', '.join(target.name for target in ALL)}")


def targets_named(names: Iterable[str] | None = None) -> tuple[Target, ...]:
    """The targets of these names, all where none are given; UsageError where there is none of a name."""
    return ALL if names is None else tuple(map(target_named, names))


def _say(line: str) -> None:
    """One line on stderr, once in a process."""
    if line not in _said:
        _said.add(line)
        print(f"eomgen: {line}", file=sys.stderr)


def _wrong_length(what: str, names: tuple[str, ...], given: int) -> UsageError:
    listed = f": {', '.join(names)}" if names else ""
    return UsageError(f"{what} has {given} entries, not {len(names)}{listed}")


# -------- accelerations ---------------------------------------------------------------------------------------
# Equations, a state -> the accelerations and multipliers there, those that have a single value.
#
#     M a - J^T lam = forcing,   J a = -gamma
#
# lam_i has one value where no combination of rows that vanishes holds it: n_i = 0 for every n with n^T J = 0.


@dataclass(frozen=True)
class Accelerations:
    """a and lam at one state by name, "theta''" and "lam(pin, 1)"; None where there is no single value."""

    a: dict[str, float | None]
    lam: dict[str, float | None]


def closing_accelerations(equations: EquationsOfMotion, t: float, x: np.ndarray, p: np.ndarray) -> Accelerations:
    """The accelerations and multipliers at one state; none has a single value where branches meet.

    Args:
        p: the parameters' values.
    """
    system = equations.system
    symbols, rows = system.symbols, [row.label for row in system.constraints.closing]
    names = [f"{u.name}'" for u in symbols.u]
    if not names:
        return Accelerations({}, {})
    outputs = (*symbols.a, *symbols.lam, *(entry for row in equations.J for entry in row))
    program = Program.of(outputs, symbols, inputs=system.inputs, solve=Solve.bordered(equations))
    values = RightHandSide.of(program, "numpy")(t, x, p)
    a, lam, J = np.split(values, [len(names), len(names) + len(rows)])
    left = _left(J.reshape(len(rows), len(names)))
    if len(left) and len(rows) - len(left) < Rank(system.constraints).rank():
        return Accelerations(dict.fromkeys(names), dict.fromkeys(rows))
    single = np.max(np.abs(left), axis=0, initial=0.0) < tolerances.SHARE
    return Accelerations(
        {name: _number(value) for name, value in zip(names, a, strict=True)},
        {name: _number(value) if one else None for name, value, one in zip(rows, lam, single, strict=True)},
    )


def _left(J: np.ndarray) -> np.ndarray:
    """n with n^T J = 0, one a row; all where J has no value."""
    if not J.size or not np.all(np.isfinite(J)):
        return np.eye(len(J))
    U, sizes, _ = np.linalg.svd(of_one_length(J))
    left: np.ndarray = U[:, int(np.sum(sizes > tolerances.RANK)) :].T
    return left


def _number(x: float) -> float | None:
    return float(x) if np.isfinite(x) else None


# -------- batches ---------------------------------------------------------------------------------------------
# Program -> ProgramInLanes, Batch: many states, or runs in threads, at once in the lanes of vectors.


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
    unit_quaternions: QuaternionPlaces = QuaternionPlaces()


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
