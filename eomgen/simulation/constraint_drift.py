"""Constraints along a motion: states projected back onto them, and positions in which they lose rank.

System, parameters -> Projection: states put back onto the constraints, by the least change that does it.

    min ds^T M ds  with  J ds = -phi,             q <- q + N ds      until phi = 0
    min du^T M du  with  J du = -(J u + sigma),   u <- u + du

Positions move in all coordinates, dependent ones as freely as others; speeds are those of the state. Measured by M the
least change is the same in every set of coordinates. Driven coordinates and the time stay: their rows of N are zero.
Redundant rows do no harm: residuals are removed in the sense of least squares, and directions in which the constraints
all but do not resist (near a singular position) are passed over. Source: Eich, Convergence results for a coordinate
projection method applied to mechanical systems with algebraic constraints, SIAM J. Numer. Anal. 30 (1993).
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen import Program, QuaternionPlaces, RightHandSide
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import DependentBlock, Rank
from eomgen.mechanics.dynamics import EquationsOfMotion, System, mass
from eomgen.simulation.event_location import LOOKED_OUT, PARTS, Crossing, Measured
from eomgen.symbolic.expression import Scalar, substituted
from eomgen.symbolic.numeric import Newton, dense, tolerances

STEPS = 8
FAR = 1e-3  # of what is allowed to be open: so far it is closed
SHORT = 400  # operations up to which a function runs in numpy: compiling takes longer
ROUNDING = 64 * float(np.finfo(float).eps)  # of the largest entry of a state


@dataclass(frozen=True)
class Rows:
    """The rows J of some constraints, and the metric of a change there.

    Args:
        function: (t, x, p) -> M, J, N, one after the other.
        k, n: rows and speeds.
        resting: they are those of positions, for which the speeds are 0.
    """

    function: RightHandSide
    k: int
    n: int
    resting: bool

    def change(self, values: np.ndarray, right: np.ndarray) -> np.ndarray:
        """N ds with the least ds for which J ds = right.

        Args:
            values: of the function at a state.
            right: of the rows; those that keep quaternions at norm 1 come last and have none.
        """
        n, k = self.n, self.k
        M, J, N = np.split(values, [n * n, n * n + k * n])
        right = np.append(right, np.zeros(k - len(right)))
        change: np.ndarray = N.reshape(-1, n) @ least_change(M.reshape(n, n), J.reshape(k, n), right)
        return change


@dataclass(frozen=True)
class Projection:
    """Projection of states onto the constraints of a system.

    Args:
        p: the parameters' values.
        coordinates: their number.
        size: of (q, u); further entries of a state are left alone.
        placed: the number of the gaps that are phi.
        unit_quaternions: the places of quaternions, which keep norm 1.
        gaps: (t, x, p) -> phi of all constraints, J u + sigma of the closing ones.
        positions, speeds: the projection of either; None where there is none.
    """

    p: np.ndarray
    coordinates: int
    size: int
    placed: int
    unit_quaternions: QuaternionPlaces
    gaps: RightHandSide
    positions: Rows | None
    speeds: Rows | None

    def open(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """(the largest |phi|, the largest |J u + sigma|) at n states, n x 2."""
        found = np.abs(self.gaps.many(t, x[:, : self.size], self.p))
        parts = found[:, : self.placed], found[:, self.placed :]
        return np.column_stack([np.max(part, axis=1, initial=0.0) for part in parts])

    def is_open(self, t: float, x: np.ndarray, allowed: float) -> bool:
        """True if a constraint is open by more than is allowed, and by more than rounding."""
        return not self._gap(t, x, slice(None)) <= max(allowed, rounding_of(x[: self.size]))

    def closed(self, t: float, x: np.ndarray, allowed: float) -> tuple[np.ndarray, float]:
        """(the nearest state in which the constraints hold, their residual there).

        Args:
            allowed: the residual that they may have; 0: as little as Newton's method reaches, as needed near a singular
                position, where residuals are divided by a determinant that vanishes.
        """
        found = self.unit_quaternions.at_unit_norms(x)
        enough = max(FAR * allowed, rounding_of(x[: self.size])) if allowed > 0 else 0.0
        for rows in (self.positions, self.speeds):
            if rows is not None:
                closing = Newton(enough, steps=STEPS, stalls=math.inf, share=1.0, least=rows.change)
                sought = _Open(self, rows, t)
                nearer = closing.root(sought, found).x
                if sought.gap(nearer) < sought.gap(found):
                    found = nearer
        return found, self._gap(t, found, slice(None))

    def _gap(self, t: float, x: np.ndarray, which: slice) -> float:
        return float(np.abs(self.gaps_at(t, x[: self.size])[which]).max(initial=0.0))

    @cached_property
    def gaps_at(self) -> Callable[[float, np.ndarray], np.ndarray]:
        """(t, x) -> phi and J u + sigma of all constraints."""
        return self.gaps.at(self.p)


@dataclass(frozen=True)
class _Open:
    """Residuals of the constraints at an instant, for Newton's method: of positions alone, or of velocities alone."""

    projection: Projection
    rows: Rows
    t: float

    @property
    def _which(self) -> slice:
        """Residuals that are driven to 0: of positions, or of velocities."""
        placed = self.projection.placed
        return slice(0, placed) if self.rows.resting else slice(placed, None)

    @property
    def _moved(self) -> slice:
        """Entries of the state that move: coordinates, or speeds."""
        q = self.projection.coordinates
        return slice(0, q) if self.rows.resting else slice(q, self.projection.size)

    def gap(self, x: np.ndarray) -> float:
        return float(np.abs(self.left(x)).max(initial=0.0))

    def left(self, x: np.ndarray) -> np.ndarray:
        return self.projection.gaps_at(self.t, x[: self.projection.size])[self._which]

    def slopes(self, x: np.ndarray) -> np.ndarray:
        state = x[: self.projection.size].copy()
        if self.rows.resting:
            state = np.concatenate([x[self._moved], np.zeros(self.rows.n)])
        return np.asarray(self.rows.function(self.t, state, self.projection.p))

    def moved(self, x: np.ndarray, step: Sequence[float]) -> np.ndarray:
        found = x.copy()
        found[self._moved] += step
        return np.asarray(self.projection.unit_quaternions.at_unit_norms(found))


def least_change(M: np.ndarray, J: np.ndarray, right: np.ndarray) -> np.ndarray:
    """ds with the least ds^T M ds of those that come nearest to J ds = right; ds^T ds where M leaves some unmeasured.

    M + J^T W J measures alike where J ds is given, and is positive definite also where M is so on J ds = 0 only. Then
    ds = M^-1 J^T lam with J M^-1 J^T lam = right, rows brought to one length, damped where they depend on one another.
    """
    J = dense.without_rounding(J)
    try:
        moved = np.linalg.solve(dense.weighted(M, J), J.T)
    except np.linalg.LinAlgError:  # bodies without mass
        moved = J.T
    S = J @ moved
    d = 1 / np.sqrt(np.where(np.diagonal(S) > 0, np.diagonal(S), 1.0))
    lam = d * np.linalg.solve(d[:, None] * S * d + tolerances.NEARLY_SINGULAR**2 * np.eye(len(S)), d * right)
    found: np.ndarray = moved @ lam
    return found


def projection_of(system: System, p: np.ndarray, target: str | None = None) -> Projection | None:
    """Projection of states onto the constraints of a system; None where none closes.

    Args:
        p: the parameters' values.
        target: the language in which long functions are run.
    """
    free = system if system.elimination is None else system.free or system
    symbols, closing, gaps = system.symbols, system.constraints.closing, free.constraints.gaps
    if not gaps and not closing:
        return None
    speeds = tuple(row.velocity for row in closing)
    function = _compiled((*gaps, *speeds), system, target)
    return Projection(
        p,
        len(symbols.q),
        len(symbols.q) + len(symbols.u),
        len(gaps),
        function.program.unit_quaternions,
        function,
        _positions(free, target) if gaps else None,
        _rows(system, system.constraints.J, _identity(len(symbols.u)), target) if closing and symbols.u else None,
    )


def _positions(free: System, target: str | None) -> Rows:
    """The rows of the constraints that have a gap, and e . de = 0 of every quaternion."""
    J = [
        row
        for row, constraint in zip(free.constraints.J, free.constraints.closing, strict=True)
        if constraint.gap is not None
    ]
    q, N = free.symbols.q, free.scope.N
    for four in free.scope.quaternions:
        rows = [(e, N[q.index(e)]) for e in four]
        J.append(tuple(sum((e * row[k] for e, row in rows), start=0) for k in range(len(free.symbols.u))))
    return _rows(free, J, N, target, resting=True)


def _rows(
    system: System,
    J: Sequence[Sequence[Scalar]],
    N: Sequence[Sequence[Scalar]],
    target: str | None,
    *,
    resting: bool = False,
) -> Rows:
    """The rows, with the masses by which a change is measured; those that are states have their start values in it."""
    M, states = mass(system.motion), {z: system.scope.start_value(z) for z in system.symbols.z}
    entries = substituted(tuple(x for matrix in (M, J, N) for row in matrix for x in row), states)
    return Rows(_compiled(entries, system, target), len(J), len(M), resting)


def _compiled(outputs: tuple[Scalar, ...], system: System, target: str | None) -> RightHandSide:
    program = Program.of(outputs, replace(system.symbols, z=()), inputs=system.inputs)
    return RightHandSide.of(program, target if program.count.total > SHORT else "numpy")


def _identity(n: int) -> tuple[tuple[int, ...], ...]:
    return tuple(tuple(int(i == j) for j in range(n)) for i in range(n))


def rounding_of(x: np.ndarray) -> float:
    """Residual of constraints by rounding of the state alone: at the coordinates of a satellite it is 1e-7 m."""
    return ROUNDING * max(1.0, float(np.abs(x).max(initial=0.0)))


SLOW = 1e-3  # of the largest T so far: below it speeds say too little of the energy to be changed by it


@dataclass
class EnergyLevel:
    """The energy that a motion began with: u <- u sqrt((E - V) / T), the least change of u that puts it back.

    Args:
        function: (t, x, p) -> (T, V).
        p: the parameters' values.
        coordinates, size: the number of q, and of (q, u).
        energy: E [J].
        most: the largest T so far.
    Source: Hairer, Lubich & Wanner, Geometric Numerical Integration, 2nd ed., IV.4.
    """

    function: RightHandSide
    p: np.ndarray
    coordinates: int
    size: int
    energy: float
    most: float = 0.0

    def at(self, t: float, x: np.ndarray) -> np.ndarray:
        """The state on the level; itself where it is slow, or has no energy left to move by."""
        T, V = self.function(t, x[: self.size], self.p)
        self.most = max(self.most, float(T))
        if not (T > SLOW * self.most and self.energy > V):
            return x
        found = x.copy()
        found[self.coordinates : self.size] *= math.sqrt((self.energy - V) / T)
        return found


LOST = 100.0  # absolute tolerances of a step by which a constraint may stay open without a word, and by rounding


@dataclass
class DriftCorrection:
    """Keeps the states of one run on the constraints, the norms of quaternions at 1, and the energy where that is
    requested.

    Args:
        unit_quaternions: the places of quaternions.
        projection: onto the constraints; None where nothing is put back.
        atol: the absolute tolerance of a step.
        every: put back at each so many steps, needed or not; None: where a constraint is open by more than atol.
        steps: taken so far.
        lost: the first instant at which a constraint stayed open by more than LOST tolerances and rounding, and by how
            much.
        level: the energy that is kept; None where it is only watched.
    """

    unit_quaternions: QuaternionPlaces
    projection: Projection | None
    atol: float
    every: int | None = None
    steps: int = 0
    lost: tuple[float, float] | None = field(default=None)
    level: EnergyLevel | None = None

    def step(self, t: float, x: np.ndarray) -> tuple[np.ndarray, bool]:
        """(the state from which the run goes on after a step, whether it was put back)."""
        self.steps += 1
        if self.every is not None and self.steps % self.every:
            return (self.unit_quaternions.at_unit_norms(x), True) if self.unit_quaternions else (x, False)
        found = self.at(t, x, forced=self.every is not None)
        return (x, False) if found is x else (found, True)

    def at(self, t: float, x: np.ndarray, *, forced: bool = False) -> np.ndarray:
        """A state on the constraints and on the level of the energy; itself where it is near enough."""
        found = self._on_constraints(t, x, forced)
        return found if self.level is None else self.level.at(t, found)

    def _on_constraints(self, t: float, x: np.ndarray, forced: bool) -> np.ndarray:
        if self.projection is None or not (forced or self.projection.is_open(t, x, self.atol)):
            return self.unit_quaternions.at_unit_norms(x) if self.unit_quaternions else x
        found, left = self.projection.closed(t, x, self.atol)
        if not left <= max(LOST * self.atol, rounding_of(found)) and self.lost is None:
            self.lost = t, left
        return found

    def rows(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """States between steps, one a row, on the constraints too."""
        found = self.unit_quaternions.at_unit_norms(x)
        if self.level is not None:
            return np.array([self.at(float(s), row) for s, row in zip(t, found, strict=True)])
        if self.projection is None or self.every is not None or not len(t):
            return np.asarray(found)
        for i in np.flatnonzero(~(np.max(self.projection.open(t, found), axis=1) <= self.atol)):
            found[i] = self.at(float(t[i]), found[i])
        return np.asarray(found)

    @property
    def remark(self) -> str:
        """Sentence that says since when constraints could not be closed; "" if all were."""
        if self.lost is None:
            return ""
        t, left = self.lost
        return f"From t = {t:.6g} s on the constraints could not be closed: they stayed open by {left:.1e}."


# -------- constraint rank -------------------------------------------------------------------------------------
# System, states along a motion -> how near it comes to positions in which the constraints do not determine it.


SHARE = 0.1  # of a row's part in the combination that vanishes, above which its constraint is named


@dataclass(frozen=True)
class ConstraintRank:
    """The constraint rows J of a system.

    Args:
        rows: (t n, x n x states) -> J, n x (k nu).
        constraints: the constraint of each row, k.
        rank: the number of rows that are independent at almost every state.
        dependent: constraints, and the dependent coordinates that they determine, in words.
    """

    rows: Callable[[np.ndarray, np.ndarray], np.ndarray]
    constraints: tuple[str, ...]
    rank: int
    dependent: tuple[tuple[tuple[str, ...], str], ...] = ()

    def at(self, p: np.ndarray) -> ConstraintRank:
        """The same constraints with other values of the parameters."""
        return replace(self, rows=measured_at(self.rows, p))

    def __call__(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """The singular value of J that vanishes where the rank falls, each row against its greatest length, n x 1."""
        return np.linalg.svd(self._scaled(t, x), compute_uv=False)[:, self.rank - 1 : self.rank]

    def words(self, t: np.ndarray, x: np.ndarray) -> str:
        """Names the constraints that depend on one another at the worst of the states."""
        J = self._scaled(t, x)
        worst = int(np.argmin(np.linalg.svd(J, compute_uv=False)[:, self.rank - 1]))
        shares = np.abs(np.linalg.svd(J[worst])[0][:, self.rank - 1])
        names = dict.fromkeys(
            constraint for constraint, share in zip(self.constraints, shares, strict=True) if share > SHARE
        )
        for constraints, words in self.dependent:
            if names.keys() <= set(constraints):
                return words
        listed = ", ".join(f"'{name}'" for name in names)
        return f"{listed} {'does' if len(names) == 1 else 'do'} not determine the motion"

    def least(self, t: np.ndarray, x: np.ndarray, lengths: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
        """(the same singular value at n states, n x 1, the greatest lengths of the rows, which it is against).

        Args:
            lengths: the greatest so far, k x 1.
        """
        J = self.J(t, x)
        greatest: np.ndarray = np.maximum(lengths, _lengths(J))
        return np.linalg.svd(J / dense.divisor(greatest), compute_uv=False)[:, self.rank - 1 : self.rank], greatest

    def J(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """J at n states, n x k x nu; 0 where it has no value."""
        values = self.rows(t, x)
        known = np.isfinite(values)
        return (values if known.all() else np.where(known, values, 0.0)).reshape(len(t), len(self.constraints), -1)

    def _scaled(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        J = self.J(t, x)
        return np.asarray(J / dense.divisor(_lengths(J)))


def _lengths(J: np.ndarray) -> np.ndarray:
    found: np.ndarray = np.sqrt(np.einsum("nkj,nkj->nk", J, J)).max(axis=0, initial=0.0)[:, None]
    return found


STEEP = 2.0  # times the steepest fall or rise in the steps before: s may not change faster in a step
REMEMBERED = 4  # steps
ARMED = 1.4  # of what is near
DEEP = 1e-3  # of an interval: how closely the least nearness in it is sought

Measure = Callable[[np.ndarray, np.ndarray], np.ndarray]


def measured_at(measure: Measure, p: np.ndarray) -> Measure:
    """The same measured quantities at other values of the parameters."""
    assert isinstance(measure, Measured | ConstraintRank), "made by `measure`, or of such"
    return measure.at(p)


@dataclass
class Nearness:
    """Distance of a motion from a singular position: 1 at its farthest so far, 0 there.

    Args:
        determinants: (t n, x n x states) -> n x k, each of which vanishes where dependent coordinates are not
            determined; None where there are none.
        rows: the rows that close by multipliers; None where there are none.
        what: of each determinant, what is not determined where it vanishes.
        lengths, largest: the greatest so far, of the rows and of the determinants.
    """

    determinants: Measure | None
    rows: ConstraintRank | None
    what: tuple[str, ...] = ()
    lengths: np.ndarray | float = 0.0
    largest: np.ndarray | float = 0.0

    def begun(self, p: np.ndarray) -> Nearness:
        """The same at other values of the parameters, nothing measured yet."""
        determinants = None if self.determinants is None else measured_at(self.determinants, p)
        return Nearness(determinants, None if self.rows is None else self.rows.at(p), self.what)

    def __call__(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """The nearness at n states."""
        with np.errstate(all="ignore"):
            sizes = np.abs(self._measured(t, x))
        self.largest = largest = np.maximum(self.largest, sizes.max(axis=0, initial=0.0))
        scaled: np.ndarray = (sizes / (largest if largest.all() else np.where(largest > 0, largest, 1.0))).min(axis=1)
        return np.asarray(np.minimum(scaled, 1.0))

    def _measured(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        found = []
        if self.determinants is not None:
            found.append(np.nan_to_num(self.determinants(t, x)).reshape(len(t), -1))
        if self.rows is not None:
            least, self.lengths = self.rows.least(t, x, self.lengths)
            found.append(least)
        return found[0] if len(found) == 1 else np.hstack(found)

    def words(self, t: float, x: np.ndarray) -> str:
        """Names what is not determined at a state near a singular position."""
        sizes = self._measured(np.array([t]), x[None, :])[0] / np.where(self.largest > 0, self.largest, 1.0)
        worst = int(np.argmin(np.abs(sizes)))
        if worst < len(self.what) or self.rows is None:
            return self.what[worst]
        return self.rows.words(np.array([t]), x[None, :])

    def at(self, t: float, x: np.ndarray) -> float:
        return float(self(np.array([t]), x[None, :])[0])


class RankLookout:
    """Follows the nearness of a run from step to step, closely only where it may come near zero within a step.

    Args:
        near: the nearness at which the run ends, once it has been farther than ARMED times that.
    """

    def __init__(self, nearness: Nearness, near: float, t: float, x: np.ndarray) -> None:
        self.nearness, self.near, self.before = nearness, near, nearness.at(t, x)
        self.armed = self.before > ARMED * near
        self.slopes: deque[float] = deque(maxlen=REMEMBERED)

    def step(self, t_old: float, t_new: float, x_new: np.ndarray, dense: Callable[[], Any]) -> Crossing | None:
        """Crossing at which the nearness falls below its limit in a step that ends in x_new; None if it does not."""
        known = self.nearness.lengths, self.nearness.largest
        before, self.before = self.before, self.nearness.at(t_new, x_new)
        if np.any(self.nearness.lengths > known[0]) or np.any(self.nearness.largest > known[1]):
            before = self.nearness.at(t_old, dense()(t_old))  # against what has grown: else it would seem to stay
        if self.armed and self._is_calm(before, t_new - t_old):
            return None
        motion = dense()
        times = np.linspace(t_old, t_new, PARTS + 1)
        sizes = self.nearness(times, motion(times).T)
        if not self.armed:
            far = np.flatnonzero(sizes > ARMED * self.near)
            if not far.size:
                return None
            self.armed, times, sizes = True, times[far[0] :], sizes[far[0] :]
        found = self._fallen(times, sizes, lambda t: self.nearness.at(t, motion(t)))
        return None if found is None else Crossing(LOOKED_OUT, found, motion(found))

    def _is_calm(self, before: float, step: float) -> bool:
        """True if the nearness cannot have come near zero within a step, unless it changes much faster than before."""
        self.slopes.append(abs(self.before - before) / step)
        enough = len(self.slopes) == REMEMBERED
        return enough and min(before, self.before) > self.near + STEEP * max(self.slopes) * step

    def _fallen(self, t: np.ndarray, sizes: np.ndarray, size: Callable[[float], float]) -> float | None:
        """The first instant at which it is near; a V between two instants is looked into where it may reach zero."""
        from scipy.optimize import brentq, minimize_scalar

        i = int(np.argmin(sizes))
        if sizes[i] > max(self.near, np.max(np.abs(np.diff(sizes)), initial=0.0)):
            return None
        bounds = float(t[max(i - 1, 0)]), float(t[min(i + 1, len(t) - 1)])
        least = float(t[i])
        if sizes[i] > self.near:
            deepest = minimize_scalar(size, bounds=bounds, method="bounded", options={"xatol": DEEP * np.ptp(bounds)})
            if deepest.fun > self.near:
                return None
            least = float(deepest.x)
        first = least if not np.any(sizes <= self.near) else float(t[np.flatnonzero(sizes <= self.near)[0]])
        before = t[(t < first) & (sizes > self.near)]
        return float(brentq(lambda s: size(s) - self.near, before[-1], first)) if before.size else first


def measure(system: System, outputs: tuple[Scalar, ...], p: np.ndarray) -> Measured:
    """(t n, x n x states) -> the outputs at each state, n x outputs."""
    return Measured(RightHandSide.of(Program.of(outputs, system.symbols, inputs=system.inputs), "numpy"), p)


@dataclass(frozen=True)
class Undetermined:
    """Determinants that vanish where something of the motion is not determined.

    Args:
        determinants: (t n, x n x states) -> n x k.
        words: of each determinant, what is not determined where it vanishes; () of rows, which say it at states.
        place: the name of such a position.
        is_watched: True if the nearness of a run looks at them too.
    """

    determinants: Measure
    words: tuple[str, ...]
    place: str = DependentBlock.PLACE
    is_watched: bool = False

    def at(self, p: np.ndarray) -> Undetermined:
        """The same at other values of the parameters."""
        return replace(self, determinants=measured_at(self.determinants, p))

    def what(self, t: np.ndarray, x: np.ndarray) -> Sequence[str]:
        """Names, of each determinant, what is not determined where it vanishes, at the states of a run."""
        if isinstance(self.determinants, ConstraintRank):
            return (self.determinants.words(t, x),)
        return self.words


def undetermined_of(equations: EquationsOfMotion, p: np.ndarray, declared: System) -> tuple[Undetermined, ...]:
    """Rates of dependent coordinates, declared speeds, angles that lock, rows that depend on one another."""

    system = equations.system

    def of(parts: Sequence[Any], place: str, *, is_watched: bool = False) -> list[Undetermined]:
        words = tuple(map(str, parts))
        determinants = tuple(part.determinant for part in parts)
        return [Undetermined(measure(system, determinants, p), words, place, is_watched)] if parts else []

    found = of(system.singular_blocks, DependentBlock.PLACE, is_watched=True)
    found += of(system.declared, "declare other speeds")
    found += of(system.motion.locks, "gimbal lock: choose another `orientation`, or a quaternion")
    rows = independence_of(equations, p, declared)
    return (*found, *([] if rows is None else [Undetermined(rows, (), is_watched=True)]))


def nearness_of(equations: EquationsOfMotion, p: np.ndarray, declared: System) -> Nearness | None:
    """Nearness of a motion to positions in which the constraints do not determine it; None without constraints."""
    system = equations.system
    blocks = system.singular_blocks
    determinants = measure(system, tuple(block.determinant for block in blocks), p) if blocks else None
    rows = independence_of(equations, p, declared)
    what = tuple(map(str, blocks))
    return None if determinants is None and rows is None else Nearness(determinants, rows, what)


def independence_of(equations: EquationsOfMotion, p: np.ndarray, declared: System) -> ConstraintRank | None:
    """Measure of the independence of the rows that close by multipliers; None without such."""
    system = equations.system
    rank = Rank(system.constraints).rank()
    if not rank:
        return None
    J = measure(system, tuple(x for row in equations.J for x in row), p)
    dependent = () if declared.elimination is None else declared.elimination.blocks
    known = tuple((block.constraints, str(block)) for block in dependent)
    return ConstraintRank(J, tuple(row.constraint for row in system.constraints.closing), rank, known)
