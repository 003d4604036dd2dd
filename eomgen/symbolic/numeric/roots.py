"""Equations -> their roots: nearby, in any arithmetic; in a box, and none is missed.

`Newton` is the iteration from one place, `Descent` that of many places at once, `least_left` the least squares where
there may be no root; `all_roots` asks any of them from many starts. `isolated` misses no root in a box. Apart stays
the location of events in compiled runs, which brackets a sign change of a dense output.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any, Generic, Protocol, TypeVar

import numpy as np

from eomgen.frozen import dataclass
from eomgen.resources import check_patience
from eomgen.symbolic.expression import Node, Scalar, State, jacobian, order
from eomgen.symbolic.numeric import tolerances
from eomgen.symbolic.numeric.arithmetic import INTERVALS, interval_of, is_rounding
from eomgen.symbolic.numeric.dense import balanced
from eomgen.symbolic.numeric.evaluation import Layers, NoValue, evaluate, fifty_digits

# -------- newton ----------------------------------------------------------------------------------------------
# Equations -> a root nearby, by steps of least change, in any number of digits.
#
#     f(x) + A d = 0,  |d| least:   d = -A^+ f,   A = df/dx      x <- x + d      until |f| is small enough
#
# Redundant equations do no harm (A^+ passes over directions in which they all but do not resist). Where the way is
# long it is damped, (A^T A + |f|^2 1) d = -A^T f, which converges as fast and does not leap along directions that
# only an open loop resists. A is in floats: each step adds the digits of a float to x, whose own digits are those of
# f. Source: Yamashita & Fukushima, On the rate of convergence of the Levenberg-Marquardt method (2001).


X = TypeVar("X")


class Sought(Protocol[X]):
    """Equations in a place x of any kind: an array, a state, a point of a search."""

    def left(self, x: X, /) -> Sequence[Any] | np.ndarray:
        """f(x)."""

    def slopes(self, x: X, /) -> np.ndarray:
        """df/dx, equations x unknowns."""

    def moved(self, x: X, step: Sequence[Any], /) -> X:
        """x + step; the step has the digits of f."""


@dataclass(frozen=True)
class Root(Generic[X]):
    """End of an iteration.

    Args:
        x: the place.
        left: |f| before the last step, its largest entry; nan where f or its slopes have no value.
        met: True if it is a root.
    """

    x: X
    left: float
    met: bool


@dataclass(frozen=True)
class Newton:
    """Settings of the search for a root.

    Args:
        enough: |f| at a root.
        still: a step that ends the search at a root too, where |f| has no measure of its own.
        steps: at most.
        smallest: singular values of A below this part of the largest count as 0.
        damped: by |f|, while that is below 1.
        stalls: |f| below which a root is reached when it falls to no `share` of itself any more: redundant equations
            differ by rounding.
        again: one step more at the root, for its last digits.
        keeps: A is reused while |f| falls by this factor in a step.
        double: of a step, to within which the next is half of it: at a double root it is taken twice.
        longest: step.
        least: (the slopes, -f) -> d, where change has a measure of its own; None: |d| is least.
    """

    enough: float = 0.0
    still: float = 0.0
    steps: int = 60
    smallest: float = tolerances.LEAST_CHANGE
    damped: bool = False
    stalls: float = 0.0
    share: float = 0.5
    again: bool = False
    keeps: float = 0.0
    double: float = 0.0
    longest: float = math.inf
    least: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None

    def root(self, sought: Sought[X], start: X) -> Root[X]:
        """The root to which the steps lead from the start; not met where they lead to none, or leave the domain."""
        x, before, size, left = start, start, math.inf, math.inf
        A: np.ndarray | None = None
        last: np.ndarray | None = None
        try:
            for _ in range(self.steps):
                check_patience()
                f = sought.left(x)
                size = max(map(abs, f), default=0)
                if size <= self.enough:
                    return Root(self._again(sought, x, f, size), float(size), True)
                if left < self.stalls and size >= self.share * left:
                    return Root(before, float(left), True)
                if A is None or size > self.keeps * left:
                    A = sought.slopes(x)
                unit = self._unit_step(A, f, size)
                step = float(size) * unit
                longest = float(np.max(np.abs(step), initial=0.0))
                far = self._factor(step, last, longest)
                before, left, last = x, size, step
                x = sought.moved(x, [size * float(far * d) for d in unit])
                if longest <= self.still and self.still:
                    return Root(x, float(size), True)
        except (NoValue, ZeroDivisionError, np.linalg.LinAlgError):
            return Root(x, math.nan, False)
        return Root(x, float(size), False)

    def _unit_step(self, A: np.ndarray, f: Sequence[Any] | np.ndarray, size: Any) -> np.ndarray:
        """d / |f|: the entries of f may be below what floats can add to x.

        Raises:
            NoValue: A has entries without a value.
        """
        if not np.all(np.isfinite(A)):
            raise NoValue("the equations have no slopes")
        right = np.array([-float(y / size) for y in f])
        if self.least is not None:
            return self.least(A, right)
        if not self.damped:
            return np.asarray(np.linalg.lstsq(A, right, rcond=self.smallest)[0])
        n = A.shape[1]
        damped = np.vstack([A, min(float(size), 1.0) * np.eye(n)])
        return np.asarray(np.linalg.lstsq(damped, np.append(right, np.zeros(n)), rcond=None)[0])

    def _factor(self, step: np.ndarray, last: np.ndarray | None, longest: float) -> float:
        halves = last is not None and np.linalg.norm(2 * step - last) <= self.double * np.linalg.norm(last)
        if self.double and longest and halves:
            return 2.0
        return min(1.0, self.longest / longest) if longest else 1.0

    def _again(self, sought: Sought[X], x: X, f: Sequence[Any] | np.ndarray, size: Any) -> X:
        if not self.again or not size:
            return x
        return sought.moved(x, [size * float(d) for d in self._unit_step(sought.slopes(x), f, size)])


def all_roots(
    root: Callable[[X], X | None],
    starts: Iterable[X],
    far: Callable[[X], Any],
    same: Callable[[X, X], bool] | None = None,
) -> list[X]:
    """The roots to which the starts lead, each once, the nearest first.

    Args:
        root: the root that is reached from a start; None where none is.
        far: how far a root is, in any order.
        same: whether two of them are one (None: they are not compared).
    """
    found: list[X] = []
    for start in starts:
        reached = root(start)
        if reached is not None and (same is None or not any(same(reached, each) for each in found)):
            found.append(reached)
    return sorted(found, key=far)


def least_left(
    left: Callable[[np.ndarray], np.ndarray],
    start: np.ndarray,
    slopes: Callable[[np.ndarray], np.ndarray] | None = None,
) -> Root[np.ndarray]:
    """The place nearby where |f|^2 is least, in floats: a root, or how near the equations come to one.

    Args:
        slopes: df/dx (None: by differences).
    """
    from scipy.optimize import least_squares

    found = least_squares(
        left, start, slopes or "2-point", xtol=tolerances.BEST, ftol=tolerances.BEST, gtol=tolerances.BEST
    )
    size = float(np.max(np.abs(found.fun), initial=0.0))
    return Root(found.x, size, size <= tolerances.BEST)


# -------- roots nearby ----------------------------------------------------------------------------------------
# Equations, guesses -> their roots nearby, in numbers: many guesses at once, then 50 digits.
#
# Levenberg and Marquardt: (A^T A + mu 1) dx = -A^T f, A = df/dx, mu smaller after each success; rows and columns are
# scaled first, for equations have units of their own. What was found is a root only where Newton's next step is
# smaller again: the steps to a root of order k shrink by 1 - 1/k, whatever the units are; those along a tail that has
# none, exp(-x/l) or 1/x^2, do not.


STEPS = 80
FAILURES = 3  # steps one after the other after which a place so near a root is as near as its rounding lets it
UNDAMPED = 8
SHRINKS = 0.9  # of a step of Newton's method the next, at a root of order 10; along exp(-x^2) it is more
STEPS_APART = 1e3  # of Newton's steps at two places, within which they are one root
WANDERS = 1e-2  # how far 50 digits may lead away from what floats found
POLISHED = Newton(
    enough=tolerances.MET_AT_50, still=tolerances.CERTAIN_AT_50, steps=200, keeps=1e-3
)  # steps: at a multiple root


@dataclass(frozen=True)
class Descent:
    """Equations in some unknowns.

    Args:
        equations: what is to vanish.
        unknowns: the symbols sought.
        values: of every other symbol, with 50 digits.
        telling: how many of the unknowns, the first ones, distinguish two roots and their distance (None: all). The
            others may be free at a root, as the multipliers of redundant constraints are.
        scales: of the rows and of the columns (None: those of slopes at a few places).
        last: the last evaluated slopes, by the unknowns there.
    """

    equations: tuple[Scalar, ...]
    unknowns: tuple[Node, ...]
    values: Mapping[Node, Any]
    telling: int | None = None
    scales: tuple[np.ndarray, np.ndarray] | None = None
    last: dict[tuple[Any, ...], np.ndarray] = field(default_factory=dict, compare=False, repr=False)

    def roots_near(self, guesses: np.ndarray, most: int | None = None) -> list[np.ndarray]:
        """The roots that are reached from the guesses, each once; guesses that reach none are left out.

        Args:
            most: how many at most, the nearest to the first guess (None: all).
        """
        x = np.array(guesses, dtype=float).reshape(-1, len(self.unknowns))
        if not len(x):
            return []
        if not self.equations or not self.unknowns:
            return [row for row in x]
        with np.errstate(all="ignore"):
            x = np.vstack([self._undamped(x[0]), x])
            x = x[self._arrived(x)]
            apart = self._apart(x)
        if most is not None:
            apart = sorted(apart, key=lambda row: float(np.sum((row - guesses[0])[: self.telling] ** 2)))[:most]
        polished = (self.polished(row) for row in apart)
        return [row for row in polished if row is not None]

    def polished(self, x: np.ndarray) -> np.ndarray | None:
        """The root near x to all digits of a float; None where there is none."""
        near = self._measured_at(x)
        root = POLISHED.root(near, self._state(x))
        if np.isnan(root.left):
            return None
        found = np.array([float(root.x[node]) for node in self.unknowns])
        wanders = np.any(abs(found - x) > WANDERS * (1 + abs(x)))
        return None if wanders or not near.closes_in(root.x) else found

    def closes_in(self, state: State) -> bool:
        """True if Newton's steps from a state shrink or vanish, or the equations are 0 to within rounding."""
        first = self._step(state)
        if first is None or self._is_nothing(first, state) or self._is_rounding(state):
            return first is not None
        moved = state | {node: state[node] + d for node, d in zip(self.unknowns, first, strict=True)}
        second = self._step(moved)
        return second is not None and self._length(second) <= SHRINKS * self._length(first)

    def reach(self, x: np.ndarray) -> np.ndarray:
        """Distance, for each unknown, from a place found to its root."""
        step = self._measured_at(x)._step(self._state(x))
        return np.asarray(
            tolerances.COMPUTED * np.abs(x) + (0.0 if step is None else STEPS_APART * np.abs(step.astype(float)))
        )

    def _state(self, x: np.ndarray) -> dict[Node, Any]:
        """Values of all symbols at x, with 50 digits."""
        return dict(self.values) | {node: fifty_digits().number(float(v)) for node, v in self._pairs(x)}

    def _measured_at(self, x: np.ndarray) -> Descent:
        """The same with its rows measured by their slopes at x: what is left is then a length.

        With 50 digits, whose exponents have no end: where doubles underflow, nothing would be left and no step.
        """
        try:
            A = self._at_digits(self._state(x))
            quickly = _in_doubles(A, np.ones(len(A)), self._columns)
            slopes = np.abs(A) * self._columns if quickly is None else np.abs(quickly)
            largest = [max(row, default=0) for row in slopes]
        except (NoValue, ZeroDivisionError):
            return self
        rows = [1 / size if 0 < size < math.inf else r for size, r in zip(largest, self._rows, strict=True)]
        return replace(self, scales=(np.array(rows, dtype=object), self._columns))

    def _step(self, state: State) -> np.ndarray | None:
        """Newton's step with 50 digits; None where there is none."""
        try:
            f, A = self.left(state), self.slopes(state)
            largest = max(map(abs, f), default=0)
            if not largest:
                return np.zeros(len(self.unknowns))
            unit = np.linalg.lstsq(A, np.array([-float(y / largest) for y in f]), rcond=tolerances.LEAST_CHANGE)[0]
        except (NoValue, ZeroDivisionError, np.linalg.LinAlgError):
            return None
        return np.array([largest * float(c * d) for c, d in zip(self._columns, unit, strict=True)])

    def _is_nothing(self, step: np.ndarray, state: State) -> bool:
        return all(
            abs(d) <= tolerances.CERTAIN_AT_50 * (1 + abs(state[x])) for x, d in zip(self.unknowns, step, strict=True)
        )

    def _is_rounding(self, state: State) -> bool:
        """True if each equation is 0 to within the rounding of its terms at 50 digits."""
        return is_rounding(self.equations, state)

    def _length(self, step: np.ndarray) -> Any:
        return max(abs(d) / float(c) for d, c in zip(step, self._columns, strict=True))

    def left(self, state: State) -> list[Any]:
        """The equations with 50 digits, rows scaled."""
        values = evaluate(self.equations, state, fifty_digits())
        return [y * r for y, r in zip(values, self._rows, strict=True)]

    def slopes(self, state: State) -> np.ndarray:
        """Their derivatives, rows and columns scaled."""
        A = self._at_digits(state)
        quickly = _in_doubles(A, self._rows, self._columns)
        return np.array(self._rows[:, None] * A * self._columns, dtype=float) if quickly is None else quickly

    def moved(self, state: State, step: Sequence[Any]) -> State:
        """The state after a step of the scaled unknowns."""
        moves = zip(self.unknowns, self._columns, step, strict=True)
        return state | {node: state[node] + float(size) * d for node, size, d in moves}

    def _at_digits(self, state: Mapping[Node, Any]) -> np.ndarray:
        """df/dx with 50 digits."""
        place = tuple(state[x] for x in self.unknowns)
        if place not in self.last:
            found = np.empty(len(self._derivatives), dtype=object)
            found[:] = evaluate(self._derivatives, state, fifty_digits())
            self.last.clear()
            self.last[place] = found.reshape(self._shape)
        return self.last[place]

    def at_one(self, x: np.ndarray) -> np.ndarray:
        """df/dx at x, equations x unknowns."""
        return np.asarray(self._at(x[None, :])[1][0])

    def _pairs(self, x: np.ndarray) -> zip[tuple[Node, float]]:
        return zip(self.unknowns, x, strict=True)

    @property
    def _shape(self) -> tuple[int, int]:
        return len(self.equations), len(self.unknowns)

    @cached_property
    def _derivatives(self) -> tuple[Scalar, ...]:
        return tuple(x for row in jacobian(self.equations, self.unknowns) for x in row)

    @cached_property
    def _layers(self) -> Layers:
        floats = {node: float(x) for node, x in self.values.items()}
        return Layers((*self.equations, *self._derivatives), self.unknowns, floats)

    def _at(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(f, df/dx) at each place."""
        found, n = self._layers.at(x), len(self.equations)
        return found[:, :n], found[:, n:].reshape(-1, *self._shape)

    @cached_property
    def _scales(self) -> tuple[np.ndarray, np.ndarray]:
        """(of the rows, of the columns): with them the largest entries of df/dx are near 1, near a few places.

        Rows first: a load of 1e-100 N is a small force, and no reason to measure angles in units of 1e50 rad.
        """
        if self.scales is not None:
            return self.scales
        places = np.random.default_rng(2).uniform(-1, 1, (16, len(self.unknowns)))
        A = np.abs(self._at(places)[1])
        known = np.isfinite(A) & (A > 0)
        with np.errstate(all="ignore"):
            A = np.exp(np.sum(np.where(known, np.log(A), 0.0), axis=0) / np.sum(known, axis=0))
        A = np.where(np.isfinite(A), A, np.any(known, axis=0))
        largest = A.max(axis=1)
        largest = np.where(largest > 0, largest, 1.0)
        _, rows, columns = balanced(A / largest[:, None])
        return rows / largest, columns

    @property
    def _rows(self) -> np.ndarray:
        return self._scales[0]

    @property
    def _columns(self) -> np.ndarray:
        return self._scales[1]

    def _undamped(self, x: np.ndarray) -> np.ndarray:
        """The place reached by Newton's undamped steps from the first guess: damped ones creep along stiff valleys."""
        for _ in range(UNDAMPED):
            f, A = self._scaled(x[None, :])
            if not np.all(np.isfinite(f)):
                break
            x = x - self._columns * np.linalg.lstsq(A[0], f[0], rcond=tolerances.LEAST_CHANGE)[0]
        return x

    def _arrived(self, x: np.ndarray) -> np.ndarray:
        """Moves x to roots, in place; returns where that succeeded."""
        diagonal = np.arange(len(self.unknowns))
        f, A = self._scaled(x)
        mu, size, failed = np.full(len(x), 1e-3), _size(f), np.zeros(len(x))
        for _ in range(STEPS):
            left = np.flatnonzero(
                np.isfinite(size) & (size > tolerances.BEST) & ((failed < FAILURES) | (size > tolerances.SOLVED))
            )
            if not len(left):
                break
            At = A[left].transpose(0, 2, 1)
            normal = At @ A[left]
            normal[:, diagonal, diagonal] += mu[left, None]
            step = self._columns * _solved(normal, -(At @ f[left][:, :, None])[:, :, 0])
            trial = x[left] + step
            new_f, new_A = self._scaled(trial)
            better = _size(new_f) < size[left]
            done = left[better]
            x[done], f[done], A[done] = trial[better], new_f[better], new_A[better]
            size[done] = _size(f[done])
            failed[left] = np.where(better, 0, failed[left] + 1)
            mu[left] = np.clip(np.where(better, mu[left] / 5, mu[left] * 4), tolerances.DIFFERENCE_AT_50, 1e12)
        return np.asarray(np.isfinite(size) & (size < tolerances.NEAR_ROOT))

    def _apart(self, x: np.ndarray) -> list[np.ndarray]:
        """One row for each root: rows that agree in the entries that distinguish roots are the same root."""
        f, A = self._scaled(x)
        steps = self._columns * np.einsum("bij,bj->bi", np.linalg.pinv(A, rcond=tolerances.LEAST_CHANGE), f)
        reaches = (STEPS_APART * np.abs(steps) + tolerances.COMPUTED * np.abs(x))[:, : self.telling]
        found: list[int] = []
        for k, row in enumerate(x[:, : self.telling]):
            others = x[found, : self.telling]
            near = np.maximum(reaches[k], reaches[found])
            if not np.any(np.all(np.abs(others - row) <= near, axis=1)):
                found.append(k)
        return [x[k] for k in found]

    def _scaled(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        f, A = self._at(x)
        A = A * self._rows[:, None] * self._columns
        return self._rows * f, np.where(np.isfinite(A), A, 0.0)


def _solved(normal: np.ndarray, right: np.ndarray) -> np.ndarray:
    """x of normal x = right, one a row; the shortest where a matrix is singular (redundant equations)."""
    try:
        found: np.ndarray = np.linalg.solve(normal, right[:, :, None])[:, :, 0]
    except np.linalg.LinAlgError:
        found = (np.linalg.pinv(normal, hermitian=True) @ right[:, :, None])[:, :, 0]
    return found


def _in_doubles(A: np.ndarray, rows: np.ndarray, columns: np.ndarray) -> np.ndarray | None:
    """A of 50 digits, rows and columns scaled, in doubles; None where what is too small for one could be felt."""
    with np.errstate(all="ignore"):
        rows = np.array(rows, dtype=float)[:, None]
        found = rows * np.array(A, dtype=float) * columns
    largest = np.abs(found).max(axis=1, initial=0.0)
    felt = np.max(rows * columns, initial=0.0) <= 1 / tolerances.FELT and np.all(
        (largest >= tolerances.FELT) & np.isfinite(largest)
    )
    return found if felt else None


def _size(f: np.ndarray) -> np.ndarray:
    return np.asarray(np.sqrt(np.sum(f * f, axis=1)))


# -------- isolation -------------------------------------------------------------------------------------------
# Equations, a box -> all their roots in the box, each isolated, and none is missed.
#
# Boxes are halved and examined. One is dropped where an equation cannot vanish in it; it holds one root and no other
# where Krawczyk's operator maps it into its own inside:
#
#     K(x) = m - C f(m) + (1 - C f'(x)) (x - m),      m the middle of the box, C the inverse of f'(m)
#
# Where f' is singular at a root, boxes about it stay undecided down to the smallest size, a share of how far they are
# from 0: equilibria may be micrometres apart, and the range in which they are sought is a kilometre wide.
# Source: Neumaier, Interval Methods for Systems of Equations (1990), sections 5.1 and 5.2.

MOST_BOXES = 60_000  # examined in all
MOST_STATEMENTS = 30_000_000  # operations in all, of long equations
TOGETHER = 4096  # boxes of one evaluation
NARROWER = 60  # times that a box about one root is made smaller, while any gets narrower
STILL_NARROWER = 0.9
OF_ROUNDING = 8.0  # times the rounding of an equation at a point
HALF = 0.4837  # where a box is halved: roots at round numbers do not lie on borders
JUMPS = frozenset(("sign", "select", "less", "less_equal"))


@dataclass(frozen=True)
class Isolation:
    """The roots of equations in a box.

    Args:
        roots: the middle of a box about each root, roots x unknowns.
        undecided: the middles of boxes that may hold roots, `halves` how far they reach to each side.
        finished: True if every box was examined.
    """

    roots: np.ndarray
    undecided: np.ndarray
    halves: np.ndarray
    finished: bool


def can_isolate(equations: Sequence[Scalar]) -> bool:
    """True if the equations have no jumps."""
    return not any(node.op in JUMPS for node in order(equations))


def isolated(
    equations: Sequence[Scalar], unknowns: Sequence[Node], values: Mapping[Node, Any], low: np.ndarray, high: np.ndarray
) -> Isolation | None:
    """The roots of as many equations as unknowns in the box from `low` to `high`; None where they have jumps.

    Args:
        values: of every other symbol.
    """
    if not can_isolate(equations):
        return None
    return _Boxes(tuple(equations), tuple(unknowns), dict(values), high - low).examined(low, high)


@dataclass(frozen=True)
class _Boxes:
    equations: tuple[Scalar, ...]
    unknowns: tuple[Node, ...]
    values: Mapping[Node, Any]
    size: np.ndarray

    def examined(self, low: np.ndarray, high: np.ndarray) -> Isolation:
        slopes = tuple(x for row in jacobian(self.equations, self.unknowns) for x in row)
        roots, undecided, halves = ([np.zeros((0, len(low)))] for _ in range(3))
        lows, highs, seen = low[None, :], high[None, :], 0
        most = min(MOST_BOXES, MOST_STATEMENTS // len(order((*self.equations, *slopes))))
        while len(lows) and seen < most:
            seen += len(lows[:TOGETHER])
            a, b, rest_a, rest_b = lows[:TOGETHER], highs[:TOGETHER], lows[TOGETHER:], highs[TOGETHER:]
            a, b = _kept(self._may_vanish(a, b), a, b)
            a, b, alone, empty = self._krawczyk(slopes, a, b)
            roots.append(self._narrowed(slopes, a[alone], b[alone]))
            a, b = _kept(~alone & ~empty, a, b)
            small = np.all(
                b - a <= tolerances.NEAR_ROOT * np.maximum(abs(a + b) / 2, tolerances.COMPUTED * self.size), axis=1
            )
            small |= self._is_vain(slopes, a, b)
            undecided.append((a[small] + b[small]) / 2)
            halves.append((b[small] - a[small]) / 2)
            a, b = self._halved(*_kept(~small, a, b))
            lows, highs = np.concatenate([a, rest_a]), np.concatenate([b, rest_b])
        at, open_, wide = (np.concatenate(each) for each in (roots, undecided, halves))
        return Isolation(at, open_, wide, not len(lows))

    def _at(self, scalars: Sequence[Scalar], a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(lowest, highest) value of each scalar in each box, boxes x scalars."""
        if not len(a):
            return np.zeros((0, len(scalars))), np.zeros((0, len(scalars)))
        given = {node: interval_of(float(x)) for node, x in self.values.items()}
        given |= {node: np.array([a[:, k], b[:, k]]) for k, node in enumerate(self.unknowns)}
        with np.errstate(all="ignore"):  # what is beyond doubles may be anything
            found = evaluate(scalars, given, INTERVALS)
        low, high = np.stack([np.broadcast_to(x, (2, len(a))) for x in found], axis=2).astype(float)
        return low, high

    def _may_vanish(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        low, high = self._at(self.equations, a, b)
        return np.asarray(np.all(~((low > 0) | (high < 0)), axis=1))  # no value: it may

    def _is_vain(self, slopes: Sequence[Scalar], a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Boxes of which halves say no more: an equation is below all doubles, or has no value at the ends and in the
        middle, or changes in a small box by little more than the rounding at a point."""
        middle = (a + b) / 2
        ends = self._at(self.equations, np.concatenate([a, a, middle, b]), np.concatenate([b, a, middle, b]))
        low, high = (x.reshape(4, len(a), len(self.equations)) for x in ends)
        lost = np.any(np.maximum(-low[0], high[0]) <= tolerances.TINIEST, axis=1)
        lost |= ~np.any(np.all(np.isfinite(low) & np.isfinite(high), axis=2), axis=0)
        found = np.all(b - a <= tolerances.NEAR_ROOT * self.size, axis=1)
        rounding = (high[2] - low[2])[found]
        least, most = self._at(slopes, a[found], b[found])
        steepest = np.maximum(-least, most).reshape(-1, len(self.equations), len(self.unknowns))
        changes = np.einsum("bij,bj->bi", steepest, (b - a)[found])
        found[found] = np.any((changes <= OF_ROUNDING * rounding) & np.isfinite(rounding), axis=1)
        return np.asarray(lost | found)

    def _krawczyk(
        self, slopes: Sequence[Scalar], a: np.ndarray, b: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """(low, high) of each box made smaller, True if it holds one root alone, True if it holds none."""
        n = len(self.unknowns)
        middle, radius = (a + b) / 2, (b - a) / 2
        low, high = self._at(slopes, a, b)
        bounded = np.all(np.isfinite(low) & np.isfinite(high), axis=1)
        low, high = (np.where(bounded[:, None], x, np.eye(n).ravel()).reshape(-1, n, n) for x in (low, high))
        center, spread = (low + high) / 2, (high - low) / 2
        bounded &= _regular(center)
        C = np.linalg.inv(np.where(bounded[:, None, None], center, np.eye(n)))
        f_low, f_high = self._at(self.equations, middle, middle)
        bounded &= np.all(np.isfinite(f_low) & np.isfinite(f_high), axis=1)
        f_low, f_high = (np.where(bounded[:, None], x, 0.0) for x in (f_low, f_high))
        K = middle - np.einsum("bij,bj->bi", C, (f_low + f_high) / 2)
        left = np.abs(C) @ spread + np.abs(np.eye(n) - C @ center)
        reach = np.einsum("bij,bj->bi", left, radius) + np.einsum("bij,bj->bi", np.abs(C), (f_high - f_low) / 2)
        inside = np.all((K - reach > a) & (K + reach < b), axis=1)
        new_a = np.where(bounded[:, None], np.maximum(a, K - reach), a)
        new_b = np.where(bounded[:, None], np.minimum(b, K + reach), b)
        empty = np.any(new_a > new_b, axis=1)
        return np.minimum(new_a, new_b), new_b, bounded & inside, empty

    def _narrowed(self, slopes: Sequence[Scalar], a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """The middles of boxes that hold one root each, made as small as the operator and halving make them."""
        for _ in range(NARROWER):
            before, n = b - a, len(a)
            low, high, _, empty = self._krawczyk(slopes, *self._halved(a, b))
            holds = ~empty & self._may_vanish(low, high)
            holds |= np.tile(~holds[:n] & ~holds[n:], 2)
            kept = np.where(holds[:, None], np.stack([low, -high]), np.inf).reshape(2, 2, *a.shape)
            a, b = kept[0].min(axis=0), -kept[1].min(axis=0)
            if not np.any(b - a < STILL_NARROWER * before):
                break
        return np.asarray((a + b) / 2)

    def _halved(self, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Every box cut in two across its longest side."""
        longest = np.argmax((b - a) / self.size, axis=1)[:, None]
        cut = np.take_along_axis(a + HALF * (b - a), longest, axis=1)
        left, right = b.copy(), a.copy()
        np.put_along_axis(left, longest, cut, axis=1)
        np.put_along_axis(right, longest, cut, axis=1)
        return np.concatenate([a, right]), np.concatenate([left, b])


def _kept(chosen: np.ndarray, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return a[chosen], b[chosen]


def _regular(matrices: np.ndarray) -> np.ndarray:
    """True, for each matrix, if it can be inverted without losing all digits."""
    with np.errstate(all="ignore"):
        condition = np.linalg.cond(matrices) if len(matrices) else np.zeros(0)
    return np.isfinite(condition) & (condition < 1e10)
