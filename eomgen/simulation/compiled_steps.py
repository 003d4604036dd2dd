"""Many steps of an integrator a call, compiled: DOP853, Radau, Taylor series.

A right-hand side in C -> many steps of DOP853 or Radau a call: Python is called where a step needs a look.

`march.c` takes steps, corrects quaternions and constraints, gives states at the requested instants, as long as no event
can lie in a step and no singular position near it. Of the step at which it stops nothing but the motion has been
changed.
"""

from __future__ import annotations

import ctypes
import math
import time
from bisect import bisect_right
from collections.abc import Callable, Sequence
from functools import partial
from itertools import accumulate
from types import ModuleType
from typing import Any, Protocol

import numpy as np
from numpy.polynomial.polynomial import polyval

from eomgen.codegen import Address, Program, RightHandSide, Solve, in_c, order_for, outputs_at
from eomgen.errors import ToolMissing, UsageError
from eomgen.simulation import event_location
from eomgen.simulation.constraint_drift import DriftCorrection, RankLookout, Rows
from eomgen.simulation.event_location import EventSearch
from eomgen.simulation.many_runs import (
    MOST_AT_ONCE,
    SIZE,
    March,
    MarchRows,
    compiled_functions,
    function_at,
    library_of_march,
)
from eomgen.simulation.phase_model import ExactSlope
from eomgen.simulation.solvers import AUTO, MOST_PIECES, SEEN, TAYLOR, LateSlope, stiff_words
from eomgen.symbolic.expression import Node, order
from eomgen.symbolic.numeric import FLOAT, Arithmetic, tolerances

COMPILED = (AUTO, "DOP853", "Radau", TAYLOR)  # the methods that there are in C
FEW = 8  # steps in the first call
A_CALL = 0.03  # [s] of a call: after it Python looks whether somebody has lost patience
BY_SERIES = 2  # what dense_of returns
_GOES_ON, _LOOK, _REACHED, _TOO_SMALL, _STIFF = range(5)


Watched = tuple[DriftCorrection, EventSearch | None, Any]
"""The drift correction of the states; the search for events; the lookout for singular positions."""


class Tolerances(Protocol):
    """Options of an integrator that compiled steps read."""

    @property
    def rtol(self) -> float: ...

    @property
    def atol(self) -> float: ...

    @property
    def breakpoints(self) -> tuple[float, ...]: ...

    @property
    def method(self) -> str: ...


def _in_c(functions: tuple[RightHandSide, ...]) -> tuple[Callable[[np.ndarray], Address], ...] | None:
    """Functions in C, as of `compiled_functions`; None where there is no compiler, and steps are watched in Python."""
    return in_c(lambda: compiled_functions(functions), "steps are watched in Python, slower")


class CompiledSteps:
    """Steps of DOP853 or Radau in C, with the attributes of scipy's integrators; `advance` instead of `step`.

    Args:
        f: the right-hand side, with its address.
        span, x0: the first and the last instant, and the state at the first.
        how: the tolerances of one step, and instants across which no step goes.
        instants: at which states are wanted.
        watched: corrections of the states after every step, and conditions that may end the run; one not in C leaves
            every step to Python.
        slope: df/dx, used where steps are implicit.
    Raises:
        RunFailed, ToolMissing: as of `library`.
    """

    def __init__(
        self,
        f: Any,
        span: tuple[float, float],
        x0: np.ndarray,
        *,
        how: Tolerances,
        instants: np.ndarray | None,
        watched: Watched,
        slope: LateSlope,
    ) -> None:
        self._begin, self._march, self._dense, self._look, _ = library_of_march()
        n = len(x0)
        self._fun, at = f, f.address
        self.placed: list[tuple[int, Address]] = [(March.rate.offset, at)]
        self._kept: list[Any] = [f]
        sizes = {"x": n, "x_old": n, "f": n, "F": 7 * n, "K": 16 * n, "room": 3 * n}
        sizes |= {"track_t": MOST_AT_ONCE, "track_x": MOST_AT_ONCE * n, "pivots": 2 * n}
        sizes |= {"piece": MOST_PIECES * 8 * n, "along_pieces": 18 * n}
        self._instants = np.zeros(0) if instants is None else np.ascontiguousarray(instants)
        self._instants = self._instants[self._instants.searchsorted(span[0], "right") :]
        sizes |= {"rows": n * len(self._instants)}
        ends = list(accumulate(sizes.values()))
        numbers = np.zeros(ends[-1])
        first = self._put(numbers)
        m = self._m = self.struct = March(
            n=n, rate=function_at(at), t=span[0], t_old=span[0], end=span[1], rtol=how.rtol, atol=how.atol
        )
        parts = {}
        for (name, size), end in zip(sizes.items(), ends, strict=True):
            setattr(m, name, first + 8 * (end - size))
            parts[name] = numbers[end - size : end]
        self._x, self._x_old, self._f, self._track_t = (parts[name] for name in ("x", "x_old", "f", "track_t"))
        self._x[:] = self._x_old[:] = x0
        self._F, self._track_x = parts["F"].reshape(7, n), parts["track_x"].reshape(MOST_AT_ONCE, n)
        self._piece = parts["piece"].reshape(MOST_PIECES, 8, n)
        self._rows, self._given = parts["rows"].reshape(-1, n), 0
        m.stops, m.n_stops = self._put(np.array(how.breakpoints, dtype=float)), len(how.breakpoints)
        m.instants, m.n_instants = self._put(self._instants), len(self._instants)
        self._search: EventSearch | None = None
        self._lookout: RankLookout | None = None
        self._few, self.status, self.t_bound = FEW, "running", span[1]
        self._most = SIZE(0)
        self._watch(*watched)
        self._slope, m.most_seen = slope, SEEN
        self.stiff_from: float | None = None
        m.is_auto = how.method == AUTO
        if self._most_rows > 3 * n:
            m.pivots = self._put(np.zeros(self._most_rows, dtype=np.int32))
        if how.method == "Radau":
            self._stiffen()
        if how.method == TAYLOR:
            self._expand()
        self._begin(ctypes.byref(m))

    # -- what is watched --------------------------------------------------------------------------

    def _watch(self, hold: DriftCorrection, search: EventSearch | None, lookout: Any) -> None:
        m, projection = self._m, hold.projection
        m.unit_quaternions = self._put(np.array(hold.unit_quaternions, dtype=np.int32).reshape(-1, 4))
        m.n_unit_quaternions = len(hold.unit_quaternions)
        functions: list[tuple[str, RightHandSide, np.ndarray]] = []
        blind = hold.projection is not None and hold.every is not None
        if projection is not None:
            functions.append(("gaps", projection.gaps, projection.p))
            m.holds, m.placed, m.n_gaps = 1, projection.placed, len(projection.gaps.program.outputs)
            m.coordinates, m.speeds = projection.coordinates, projection.size - projection.coordinates
            for name, rows in (("places", projection.positions), ("rates", projection.speeds)):
                if rows is not None:
                    functions.append((name, rows.function, projection.p))
                    setattr(m, name, MarchRows(k=rows.k, n=rows.n))
        if hold.level is not None:
            level = hold.level
            functions.append(("energies", level.function, level.p))
            m.keeps_energy, m.energy, m.most_kinetic = 1, level.energy, level.most
            m.coordinates, m.speeds = level.coordinates, level.size - level.coordinates
        if search is not None:
            self._search = search
            measured = search.events.measured
            if measured is None:
                blind = True
            else:
                functions.append(("events", measured.function, measured.p))
                m.n_events = len(search.signs)
                self._events(search)
        if lookout is not None:
            nearness = lookout.nearness if isinstance(lookout, RankLookout) else None
            parts = [] if nearness is None else [nearness.determinants, nearness.rows and nearness.rows.rows]
            known = [getattr(part, "function", None) for part in parts if part is not None]
            if not parts or None in known:
                blind = True
            else:
                self._lookout = lookout
                self._near(lookout, functions)
        made = _in_c(tuple(function for _, function, _ in functions)) if functions and not blind else ()
        blind = blind or made is None
        m.is_blind = blind
        if search is not None and not blind:
            search.seen = self._seen
        for (name, _, p), address in zip(functions, made or (), strict=False):
            found = address(p)
            self._kept.append(found)
            place = getattr(m, name)
            self.placed.append((getattr(March, name).offset, found))
            if isinstance(place, MarchRows):
                place.f = function_at(found)
            else:
                setattr(m, name, function_at(found))
        self._work = self._room(projection)
        self._most_rows = max(m.places.k, m.places.n, m.rates.k, m.rates.n)
        m.work = self._put(np.zeros(self._work))

    def _events(self, search: EventSearch) -> None:
        m, k = self._m, len(search.signs)
        self._signs, self._largest, self._armed = np.zeros(k), np.zeros(k), np.zeros(k, dtype=np.int32)
        either = np.zeros(k, dtype=np.int32)
        either[list(search.events.either)] = 1
        m.floors, m.either = self._put(np.array(search.events.floors, dtype=float)), self._put(either)
        m.signs, m.largest, m.armed = self._put(self._signs), self._put(self._largest), self._put(self._armed)
        m.looks = self._put(np.zeros((event_location.PARTS + 4, k)))  # the last for a single look

    def _seen(self, times: np.ndarray) -> np.ndarray:
        """The functions of the events at instants of the last step."""
        times, found = np.ascontiguousarray(times), np.empty((len(times), self._m.n_events))
        self._look(ctypes.byref(self._m), len(times), times.ctypes.data, found.ctypes.data)
        return found

    def _near(self, lookout: RankLookout, functions: list[tuple[str, RightHandSide, np.ndarray]]) -> None:
        m, nearness = self._m, lookout.nearness
        m.is_near_watched, m.near = 1, lookout.near
        if nearness.determinants is not None:
            measure: Any = nearness.determinants
            functions.append(("determinants", measure.function, measure.p))
            m.n_determinants = len(measure.function.program.outputs)
        if nearness.rows is not None:
            measure = nearness.rows.rows
            functions.append(("constraints", measure.function, measure.p))
            m.n_rows, m.rank = len(nearness.rows.constraints), nearness.rows.rank
            m.n_columns = len(measure.function.program.outputs) // m.n_rows
        self._lengths, self._sizes = np.zeros((m.n_rows, 1)), np.zeros(m.n_determinants + 1)
        m.lengths, m.sizes = self._put(self._lengths), self._put(self._sizes)

    def _stiffen(self) -> None:
        """Takes implicit steps from now on."""
        m, n = self._m, int(self._m.n)
        self.stiff_from = self.t if self.stiff_from is None else self.stiff_from
        slope = self._slope()
        if not m.jac:
            m.jac, m.real, m.both, m.Z = (self._put(np.zeros(k)) for k in (n * n, n * n, 4 * n * n, 7 * n))
            made = _in_c((slope.function,)) if isinstance(slope, ExactSlope) else None
            if isinstance(slope, ExactSlope) and made is not None:
                found = made[0](slope.p)
                self._kept.append(found)
                m.slope, m.has_slope, m.slope_speeds, m.slope_rows = function_at(found), 1, slope.n, slope.k
                m.slope_states = slope.states
                s = slope.n + slope.k
                m.work = self._put(np.zeros(max(self._work, len(slope.function.program.outputs) + s * s)))
                m.pivots = self._put(np.zeros(max(3 * n, s, self._most_rows), dtype=np.int32))
        m.is_implicit, m.has_slope_values, m.error_old = 1, 0, 0.0

    def _expand(self) -> None:
        """Takes steps along power series, from the start on."""
        m = self._m
        m.order = order_for(m.rtol, alone=True)
        series = self._fun.rhs.series(m.order)
        rows = 2 * (m.order + 1) * m.n
        numbers = _aligned(series.size + rows)
        self._X = numbers[series.size :].reshape(2, -1, m.n)
        m.series, m.along, m.W = series.address, series.along, self._put(numbers)
        m.X = m.W + 8 * series.size
        m.X_old = m.X + 4 * rows

    def _room(self, projection: Any) -> int:
        """Size of the work array: for the correction of a state, and for the nearness of a singular position."""
        m = self._m
        near = max(m.n_determinants, m.n_rows * m.n_columns)
        if projection is None:
            return int(near + 1)
        rows: list[Rows] = [each for each in (projection.positions, projection.speeds) if each is not None]
        n, k = max(each.n for each in rows), max(each.k for each in rows)
        moves = m.coordinates + m.speeds
        own = m.n_gaps + 2 * m.n + k + 2 * moves + 2 * n + 2 * (n * n + k * n) + moves * n + n * k + k * k + 2 * k
        return int(max(near, own) + 1)

    # -- steps --------------------------------------------------------------------------------------

    def advance(self, most: int) -> tuple[int, bool]:
        """(steps taken, at most so many; whether nothing is left to be done about the last of them)."""
        self._reported()
        self._most.value = min(most, self._few)
        began = time.perf_counter()
        found = self._march(ctypes.byref(self._m), ctypes.byref(self._most))
        taken = self._most.value
        spent = time.perf_counter() - began
        if spent > 0:
            self._few = max(1, min(MOST_AT_ONCE, int(taken * A_CALL / spent)))
        self._heard()
        if found == _STIFF:
            self._stiffen()
        if found == _TOO_SMALL:
            self.status = "failed"
        elif self._m.t >= self.t_bound:
            self.status = "finished"
        return taken, found in (_GOES_ON, _REACHED, _STIFF)

    def _reported(self) -> None:
        """Copies what Python knows of events and singular positions to C."""
        if self._search is not None and self._m.n_events:
            self._signs[:], self._armed[:], self._largest[:] = (
                self._search.signs,
                self._search.armed,
                self._search.largest,
            )
        if self._lookout is not None:
            m, nearness = self._m, self._lookout.nearness
            self._lengths[:], sizes = nearness.lengths, np.atleast_1d(nearness.largest)
            self._sizes[:] = np.resize(sizes, len(self._sizes)) if sizes.size > 1 else sizes
            m.before, m.is_armed = self._lookout.before, self._lookout.armed
            m.n_slopes = len(self._lookout.slopes)
            m.slopes[: m.n_slopes] = list(self._lookout.slopes)

    def _heard(self) -> None:
        """The same back."""
        if self._search is not None and self._m.n_events:
            self._search.signs, self._search.armed = self._signs.copy(), self._armed.astype(bool)
            self._search.largest = self._largest.copy()
        if self._lookout is not None:
            m, nearness = self._m, self._lookout.nearness
            nearness.lengths = self._lengths.copy()
            nearness.largest = self._sizes[: m.n_determinants + (m.n_rows > 0)].copy()
            self._lookout.before = m.before
            self._lookout.slopes.clear()
            self._lookout.slopes.extend(m.slopes[: m.n_slopes])

    @property
    def words(self) -> str:
        """Sentence on the stiff part of the run; "" where nothing was stiff, or a stiff method was requested."""
        return stiff_words(self.stiff_from if self._m.is_auto else None, self._m.implicit_steps)

    @property
    def track(self) -> tuple[np.ndarray, np.ndarray]:
        """(instants, states) at the ends of the steps of the last call that are done with."""
        done = self._m.tracked
        return self._track_t[:done].copy(), self._track_x[:done].copy()

    def rows(self) -> tuple[np.ndarray, np.ndarray]:
        """(instants, states) that were requested and reached since the last call."""
        before, self._given = self._given, self._m.next
        return self._instants[before : self._given], self._rows[before : self._given]

    def passed(self, t: float) -> None:
        """The instants up to t have been given by Python."""
        self._given = self._m.next = int(np.searchsorted(self._instants, t, side="right"))

    # -- as scipy's ---------------------------------------------------------------------------------

    @property
    def t(self) -> float:
        return float(self._m.t)

    @property
    def t_old(self) -> float:
        return float(self._m.t_old)

    @property
    def nfev(self) -> int:
        return int(self._m.evaluations)

    @property
    def y(self) -> np.ndarray:
        return self._x.copy()

    def put(self, x: np.ndarray) -> None:
        """Go on from another state nearby; the instants up to here have been given by Python."""
        self._x[:], self._f[:] = x, self._fun(self.t, x)
        self._m.evaluations += 1
        self._m.has_series = 0

    def dense_output(self) -> Any:
        """t -> x in the last step, before it was put back onto the constraints."""
        self._dense(ctypes.byref(self._m))
        if self._m.dense_of == BY_SERIES:
            begun, X = self.t_old, self._X[int(self._m.X_old != self._X.ctypes.data)].copy()
            return lambda t: polyval(np.asarray(t) - begun, X)
        t_old, h, x_old, F = self.t_old, self.t - self.t_old, self._x_old.copy(), self._F.copy()
        if self._m.dense_of:
            return partial(_implicit_between, t_old, h, x_old, F)
        pieces = int(self._m.pieces)
        rows = self._piece[:pieces].copy() if pieces > 1 else np.vstack([x_old, F])[None]
        return partial(_between, t_old, h, rows)

    def _put(self, array: np.ndarray) -> int:
        """Address of an array, which is kept alive; 0 of an empty one."""
        if not array.size:
            return 0
        self._kept.append(array)
        return int(array.__array_interface__["data"][0])


def _implicit_between(t_old: float, h: float, x_old: np.ndarray, F: np.ndarray, t: Any) -> np.ndarray:
    part = np.asarray((np.asarray(t) - t_old) / h)[..., None]
    return np.asarray((x_old + part * (F[0] + part * (F[1] + part * F[2]))).T)


def _between(t_old: float, h: float, rows: np.ndarray, t: Any) -> np.ndarray:
    """States x instants in a step of pieces, of each the rows x and F."""
    at = np.asarray(np.asarray(t) - t_old) * (len(rows) / h)
    k = np.clip(np.floor(at).astype(int), 0, len(rows) - 1)
    part, row = (at - k)[..., None], rows[k]
    x = np.zeros_like(row[..., 0, :])
    for i, factor in zip(range(7, 0, -1), (part, 1 - part) * 4, strict=False):
        x = (x + row[..., i, :]) * factor
    return np.asarray((x + row[..., 0, :]).T)


def _aligned(size: int) -> np.ndarray:
    """Array of zeros that begins at a line of the processor's cache, so that no vector lies across two lines."""
    room = np.zeros(size + 8)
    return room[-(room.__array_interface__["data"][0] // 8) % 8 :][:size]


# -------- heyoka steps ----------------------------------------------------------------------------------------
# x' = f(t, x) by Taylor series of an order that the tolerance says: heyoka's integrator (the extra `heyoka`).
#
# It differentiates the equations themselves, so that these must be smooth and written out, without a linear solve.


PIECES = frozenset("abs sign min max less less_equal select sampled".split())
LONG = 1000  # operations from which on heyoka makes code with loops: else its compiler takes long


class HeyokaSteps:
    """One step of heyoka a call.

    Args:
        program, p: the equations, and the parameters' values.
        span, x0: the first and the last instant, and the state at the first.
        tolerance: of one step.
        breakpoints: instants across which no step goes.
    Raises:
        UsageError: the equations are not smooth, or solve a linear system.
        ToolMissing: heyoka is not installed.
    """

    stiff_from, words = None, ""

    def __init__(
        self,
        program: Program | None,
        p: Sequence[float],
        span: tuple[float, float],
        x0: np.ndarray,
        *,
        tolerance: float,
        breakpoints: Sequence[float],
    ) -> None:
        self._end, self._breakpoints = span[1], breakpoints
        self._taylor = _integrator(smooth(program), p, span[0], x0, tolerance)
        self.t, self.t_old, self.status, self.nfev = span[0], span[0], "running", 0

    def advance(self, _: int) -> tuple[int, bool]:
        """(1, False), or no step where it failed."""
        k = bisect_right(self._breakpoints, self.t + tolerances.SOLVED * max(1.0, abs(self.t)))
        bound = min([self._end, *self._breakpoints[k : k + 1]])
        outcome, length = self._taylor.step(bound - self.t, write_tc=True)
        self.nfev += 1
        if not (length > 0 and np.all(np.isfinite(self._taylor.state))) or "nf_state" in str(outcome):
            self.status = "failed"
            return 0, False
        at_bound = "time_limit" in str(outcome)
        self.t_old, self.t = self.t, bound if at_bound else float(self._taylor.time)
        self._taylor.time = self.t
        self.status = "finished" if self.t >= self._end else "running"
        return 1, False

    @property
    def y(self) -> np.ndarray:
        return np.array(self._taylor.state)

    def dense_output(self) -> Callable[[Any], np.ndarray]:
        """t -> x in the last step, by its series."""

        def at(t: Any) -> np.ndarray:
            found = np.array([self._taylor.update_d_output(float(each)).copy() for each in np.atleast_1d(t)])
            return found[0] if np.ndim(t) == 0 else found.T

        return at

    def put(self, x: np.ndarray) -> None:
        """Go on from another state nearby."""
        self._taylor.state[:] = x


def smooth(program: Program | None) -> Program:
    """The program, where a Taylor series can be made of it.

    Raises:
        UsageError: it cannot.
    """
    why = _hindrance(program)
    if why or program is None:
        raise UsageError(f"no Taylor series of these equations: {why}", fix="leave --method out, or take another")
    return program


def _hindrance(program: Program | None) -> str:
    """Why there is no series; "" where there is one."""
    if program is None:
        return "more than the equations of motion is stepped"
    if any(type(s) is Solve for s in program.statements):
        return "they solve a linear system at every instant"
    parameters = {*program.symbols.parameters.values()}
    fixed: set[Node] = set()
    for x in order([*program.outputs, *program.defaults]):
        if x in parameters or (x.op != "symbol" and all(type(a) is not Node or a in fixed for a in x.args)):
            fixed.add(x)
        elif x.op in PIECES:
            return f"they are made of pieces ('{x.op}')"
    return ""


def _integrator(program: Program, p: Sequence[float], t: float, x: np.ndarray, tolerance: float) -> Any:
    try:
        import heyoka
    except ImportError as error:
        raise ToolMissing(
            f"heyoka cannot be imported: {error}", fix="pip install 'eomgen[heyoka]', or take another --method"
        ) from None
    symbols = program.symbols
    names = heyoka.make_vars(*(f"x{k}" for k in range(len(x)))) if len(x) > 1 else [heyoka.make_vars("x0")]
    values: dict[Node, Any] = dict(zip(program.states, names, strict=True))
    values |= dict(zip(symbols.parameters.values(), map(float, p), strict=True)) | {symbols.t: heyoka.time}
    rates = [heyoka.expression(rate) if type(rate) is float else rate for rate in _rates(program, values, heyoka)]
    return heyoka.taylor_adaptive(
        list(zip(names, rates, strict=True)),
        x.tolist(),
        time=t,
        tol=tolerance,
        compact_mode=program.count.total > LONG,
    )


def _rates(program: Program, values: dict[Node, Any], heyoka: ModuleType) -> list[Any]:
    """The right-hand side in heyoka's expressions; constants of the parameters are floats."""

    def either(op: str, made: Callable[..., Any]) -> Callable[..., Any]:
        known = FLOAT.functions[op]
        return lambda *args: known(*args) if all(type(a) is float for a in args) else made(*args)

    names = "sqrt sin cos tan asin acos atan sinh cosh tanh exp log atan2".split()
    functions = {op: either(op, getattr(heyoka, op)) for op in names} | {"pow": lambda a, b: a**b}
    return outputs_at(
        program, values, Arithmetic("heyoka", FLOAT.number, {**FLOAT.functions, **functions}, lambda _: math.nan)
    )
