"""System, states along a motion -> how near it comes to positions in which the ties do not determine it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from eomgen.codegen.program import program_of
from eomgen.codegen.rhs import compiled
from eomgen.mechanics.bodies.gimbal import locks_of
from eomgen.mechanics.constraints.elimination import PLACE, singular_blocks
from eomgen.mechanics.constraints.freedom import rank_of_ties
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.records import dataclass
from eomgen.simulation.event_location import LOOKED_OUT, PARTS, Crossing, Measured
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.numeric.dense import divisor

SHARE = 0.1  # of a row's part in the combination that vanishes, above which its tie is named


@dataclass(frozen=True)
class ConstraintRank:
    """The closing rows J of a system.

    Args:
        rows: (t n, x n x states) -> J, n x (k nu).
        ties: the tie of each row, k.
        rank: how many rows are independent at almost every state.
        dependent: ties, and what dependent coordinates they determine, in words.
    """

    rows: Callable[[np.ndarray, np.ndarray], np.ndarray]
    ties: tuple[str, ...]
    rank: int
    dependent: tuple[tuple[tuple[str, ...], str], ...] = ()

    def at(self, p: np.ndarray) -> ConstraintRank:
        """The same at other values of the parameters."""
        return replace(self, rows=measured_at(self.rows, p))

    def __call__(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """The singular value of J that vanishes where the rank falls, each row against its greatest length, n x 1."""
        return np.linalg.svd(self._scaled(t, x), compute_uv=False)[:, self.rank - 1 : self.rank]

    def words(self, t: np.ndarray, x: np.ndarray) -> str:
        """Which ties depend on one another at the worst of the states."""
        J = self._scaled(t, x)
        worst = int(np.argmin(np.linalg.svd(J, compute_uv=False)[:, self.rank - 1]))
        shares = np.abs(np.linalg.svd(J[worst])[0][:, self.rank - 1])
        names = dict.fromkeys(tie for tie, share in zip(self.ties, shares, strict=True) if share > SHARE)
        for ties, words in self.dependent:
            if names.keys() <= set(ties):
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
        return np.linalg.svd(J / divisor(greatest), compute_uv=False)[:, self.rank - 1 : self.rank], greatest

    def J(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """J at n states, n x k x nu; 0 where it has no value."""
        values = self.rows(t, x)
        known = np.isfinite(values)
        return (values if known.all() else np.where(known, values, 0.0)).reshape(len(t), len(self.ties), -1)

    def _scaled(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        J = self.J(t, x)
        return np.asarray(J / divisor(_lengths(J)))


def _lengths(J: np.ndarray) -> np.ndarray:
    found: np.ndarray = np.sqrt(np.einsum("nkj,nkj->nk", J, J)).max(axis=0, initial=0.0)[:, None]
    return found


STEEP = 2.0  # times the steepest fall or rise in the steps before: s may not change faster in a step
REMEMBERED = 4  # steps
ARMED = 1.4  # of what is near
DEEP = 1e-3  # of an interval: how closely the least nearness in it is sought

Measure = Callable[[np.ndarray, np.ndarray], np.ndarray]


def measured_at(measure: Measure, p: np.ndarray) -> Measure:
    """What is measured, at other values of the parameters."""
    assert isinstance(measure, Measured | ConstraintRank), "made by `measure`, or of such"
    return measure.at(p)


@dataclass
class Nearness:
    """How far a motion is from a singular position: 1 at its farthest so far, 0 there.

    Args:
        determinants: (t n, x n x states) -> n x k, each of which vanishes where dependent coordinates are not
            determined; None where there are none.
        rows: the rows that close by multipliers; None where there are none.
        what: of each determinant, what is not determined where it vanishes.
        lengths, largest: of the rows, and of what vanishes, the greatest so far.
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
        """What is not determined at a state near a singular position."""
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
        near: where the run ends, once it has been farther than ARMED times that.
    """

    def __init__(self, nearness: Nearness, near: float, t: float, x: np.ndarray) -> None:
        self.nearness, self.near, self.before = nearness, near, nearness.at(t, x)
        self.armed = self.before > ARMED * near
        self.slopes: deque[float] = deque(maxlen=REMEMBERED)

    def step(self, t_old: float, t_new: float, x_new: np.ndarray, dense: Callable[[], Any]) -> Crossing | None:
        """Where the nearness falls below what is near in a step that ends in x_new."""
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
        """Whether it cannot have come near zero within a step, unless it changes much faster than before."""
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
    return Measured(compiled(program_of(outputs, system.symbols, inputs=system.inputs), "numpy"), p)


@dataclass(frozen=True)
class Undetermined:
    """What vanishes where something of the motion is not determined.

    Args:
        determinants: (t n, x n x states) -> n x k.
        words: of each determinant, what is not determined where it vanishes; () of rows, which say it at states.
        place: what such a position is called.
        is_watched: whether the nearness of a run looks at them too.
    """

    determinants: Measure
    words: tuple[str, ...]
    place: str = PLACE
    is_watched: bool = False

    def at(self, p: np.ndarray) -> Undetermined:
        """The same at other values of the parameters."""
        return replace(self, determinants=measured_at(self.determinants, p))

    def what(self, t: np.ndarray, x: np.ndarray) -> Sequence[str]:
        """Of each determinant, what is not determined where it vanishes, by the states of a run."""
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

    found = of(singular_blocks(system.elimination, system.scope), PLACE, is_watched=True)
    found += of(system.declared, "declare other speeds")
    found += of(locks_of(system.motion), "gimbal lock: choose another `orientation`, or a quaternion")
    rows = independence_of(equations, p, declared)
    return (*found, *([] if rows is None else [Undetermined(rows, (), is_watched=True)]))


def nearness_of(equations: EquationsOfMotion, p: np.ndarray, declared: System) -> Nearness | None:
    """How near a motion is to positions in which the ties do not determine it; None without ties."""
    system = equations.system
    blocks = singular_blocks(system.elimination, system.scope)
    determinants = measure(system, tuple(block.determinant for block in blocks), p) if blocks else None
    rows = independence_of(equations, p, declared)
    what = tuple(map(str, blocks))
    return None if determinants is None and rows is None else Nearness(determinants, rows, what)


def independence_of(equations: EquationsOfMotion, p: np.ndarray, declared: System) -> ConstraintRank | None:
    """How independent the rows are that close by multipliers; None without such."""
    system = equations.system
    rank = rank_of_ties(system.ties)
    if not rank:
        return None
    J = measure(system, tuple(x for row in equations.J for x in row), p)
    dependent = () if declared.elimination is None else declared.elimination.blocks
    known = tuple((block.ties, str(block)) for block in dependent)
    return ConstraintRank(J, tuple(row.tie for row in system.ties.closing), rank, known)
