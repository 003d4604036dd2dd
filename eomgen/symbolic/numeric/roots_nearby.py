"""Equations, guesses -> their roots nearby, in numbers: many guesses at once, then 50 digits.

Levenberg and Marquardt: (A^T A + mu 1) dx = -A^T f, A = df/dx, mu smaller after each success; rows and columns are
scaled first, for equations have units of their own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import jacobian
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.batch_evaluation import Layers
from eomgen.symbolic.numeric.dense import balanced
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.newton import Newton
from eomgen.symbolic.numeric.tolerances import (
    BEST,
    CERTAIN_AT_50,
    DIFFERENCE_AT_50,
    LEAST_CHANGE,
    MET_AT_50,
    NEAR_ROOT,
    SAME_PLACE,
)

STEPS = 80
UNDAMPED = 8
WANDERS = 1e-2  # how far 50 digits may lead away from what floats found
POLISHED = Newton(enough=MET_AT_50, still=CERTAIN_AT_50, steps=200, keeps=1e-3)  # steps: at a multiple root


@dataclass(frozen=True)
class Descent:
    """Equations in some unknowns.

    Args:
        equations: what is to vanish.
        unknowns: the symbols sought.
        values: of every other symbol, with 50 digits.
        telling: how many of the unknowns, the first ones, tell two roots apart and how near they are (None: all). The
            others may be free at a root, as the multipliers of redundant ties are.
    """

    equations: tuple[Scalar, ...]
    unknowns: tuple[Node, ...]
    values: Mapping[Node, Any]
    telling: int | None = None

    def roots_near(self, guesses: np.ndarray, most: int | None = None) -> list[np.ndarray]:
        """From each guess the root that is reached; those that reach none are left out.

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
        apart, n = _apart(x, self.telling), self.telling
        if most is not None:
            apart = sorted(apart, key=lambda row: float(np.sum((row - guesses[0])[:n] ** 2)))[:most]
        polished = (self.polished(row) for row in apart)
        return [row for row in polished if row is not None]

    def polished(self, x: np.ndarray) -> np.ndarray | None:
        """The root near x to all digits of a float; None where there is none."""
        start = dict(self.values) | {node: fifty_digits().number(1) * float(v) for node, v in self._pairs(x)}
        root = POLISHED.root(self, start)
        if np.isnan(root.left):
            return None
        found = np.array([float(root.x[node]) for node in self.unknowns])
        return found if self._holds(root.x) and np.all(abs(found - x) <= WANDERS * (1 + abs(x))) else None

    def left(self, state: State) -> list[Any]:
        """The equations with 50 digits, rows scaled."""
        values = evaluate(self.equations, state, fifty_digits())
        return [y * float(r) for y, r in zip(values, self._rows, strict=True)]

    def slopes(self, state: State) -> np.ndarray:
        """Their derivatives, rows and columns scaled."""
        return np.asarray(self._rows[:, None] * self._at_digits(state) * self._columns)

    def moved(self, state: State, step: Sequence[Any]) -> State:
        """The state after a step of the scaled unknowns."""
        moves = zip(self.unknowns, self._columns, step, strict=True)
        return state | {node: state[node] + float(size) * d for node, size, d in moves}

    def _at_digits(self, state: Mapping[Node, Any]) -> np.ndarray:
        """df/dx with 50 digits, rounded."""
        return np.reshape([float(y) for y in evaluate(self._derivatives, state, fifty_digits())], self._shape)

    def at_one(self, x: np.ndarray) -> np.ndarray:
        """df/dx at x, equations x unknowns."""
        return np.asarray(self._at(x[None, :])[1][0])

    def _holds(self, state: Mapping[Node, Any]) -> bool:
        f = np.array([float(y) for y in evaluate(self.equations, state, fifty_digits())])
        return bool(np.all(abs(self._rows * f) < DIFFERENCE_AT_50))

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
        """(of the rows, of the columns): with them the largest entries of df/dx are near 1, near a few places."""
        places = np.random.default_rng(2).uniform(-1, 1, (16, len(self.unknowns)))
        A = np.abs(self._at(places)[1])
        known = np.isfinite(A)
        with np.errstate(all="ignore"):
            A = np.sqrt(np.sum(np.where(known, A, 0.0) ** 2, axis=0) / np.sum(known, axis=0))
        return balanced(np.where(np.isfinite(A), A, 1.0))[1:]

    @property
    def _rows(self) -> np.ndarray:
        return self._scales[0]

    @property
    def _columns(self) -> np.ndarray:
        return self._scales[1]

    def _undamped(self, x: np.ndarray) -> np.ndarray:
        """Where Newton's own steps lead from the first guess: damped ones creep along stiff valleys."""
        for _ in range(UNDAMPED):
            f, A = self._scaled(x[None, :])
            if not np.all(np.isfinite(f)):
                break
            x = x - self._columns * np.linalg.lstsq(A[0], f[0], rcond=LEAST_CHANGE)[0]
        return x

    def _arrived(self, x: np.ndarray) -> np.ndarray:
        """Move x to roots in place; where that succeeded."""
        n = len(self.unknowns)
        f, A = self._scaled(x)
        mu, size = np.full(len(x), 1e-3), _size(f)
        for _ in range(STEPS):
            left = np.flatnonzero(np.isfinite(size) & (size > BEST))
            if not len(left):
                break
            At = A[left].transpose(0, 2, 1)
            normal = At @ A[left] + mu[left, None, None] * np.eye(n)
            step = self._columns * _solved(normal, -(At @ f[left][:, :, None])[:, :, 0])
            trial = x[left] + step
            new_f, new_A = self._scaled(trial)
            better = _size(new_f) < size[left]
            done = left[better]
            x[done], f[done], A[done] = trial[better], new_f[better], new_A[better]
            size[done] = _size(f[done])
            mu[left] = np.clip(np.where(better, mu[left] / 5, mu[left] * 4), DIFFERENCE_AT_50, 1e12)
        return np.asarray(np.isfinite(size) & (size < NEAR_ROOT))

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


def _apart(x: np.ndarray, telling: int | None) -> list[np.ndarray]:
    """Of the rows that are as good as equal in the entries that tell, one."""
    found: list[np.ndarray] = []
    for row in x:
        if not any(np.all((abs(row - other) <= SAME_PLACE * (1 + abs(row)))[:telling]) for other in found):
            found.append(row)
    return found


def _size(f: np.ndarray) -> np.ndarray:
    return np.asarray(np.sqrt(np.sum(f * f, axis=1)))
