"""Equations, guesses -> their roots nearby, in numbers: many guesses at once, then 50 digits.

Levenberg and Marquardt: (A^T A + mu 1) dx = -A^T f, A = df/dx, mu smaller after each success; rows and columns are
scaled first, for equations have units of their own.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.symbolic.dense import balanced
from eomgen.symbolic.derivative import jacobian
from eomgen.symbolic.evaluation import Arithmetic, NoValue, evaluate, fifty_digits
from eomgen.symbolic.graph import Node, Scalar
from eomgen.symbolic.splines import sampled_of

STEPS = 80
POLISHINGS = 200  # at a multiple root the error shrinks by a factor only
CLOSE = 1e-7  # of the scaled equations, at which a root is near
ROOT = 1e-30  # of a step, against the size of the unknown and 1
NOTHING = 1e-40  # of the scaled equations: what is left is rounding of 50 digits
TOGETHER = 1e-6  # distance of two results of floats that become one root
WANDERS = 1e-2  # how far 50 digits may lead away from what floats found
FALLS = 1e-3  # by which what is left falls in a step with the slopes of an earlier place, or they are taken anew
RANK = 1e-12  # of the largest singular value

_ON_ARRAYS: dict[str, Callable[..., Any]] = {
    "neg": operator.neg, "add": operator.add, "sub": operator.sub, "mul": operator.mul, "div": np.true_divide,
    "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2, "pow": np.float_power,
    "min": np.minimum, "max": np.maximum, "select": np.where, "pi": lambda: np.pi,
    "sampled": np.vectorize(lambda t, k: sampled_of(k).at(t, float, np.pi), otypes=[float]),
    **{op: getattr(np, op) for op in "sqrt sin cos tan sinh cosh tanh exp log abs sign less less_equal".split()},
}  # fmt: skip
ARRAYS = Arithmetic("arrays", float, _ON_ARRAYS, lambda x: np.nan)
"""Floats, or arrays of them: many states at once."""


@dataclass(frozen=True)
class Descent:
    """Equations in some unknowns.

    Args:
        equations: what is to vanish.
        unknowns: the symbols sought.
        values: of every other symbol, with 50 digits.
    """

    equations: tuple[Scalar, ...]
    unknowns: tuple[Node, ...]
    values: Mapping[Node, Any]

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
            x = x[self._arrived(x)]
        apart = _apart(x)
        if most is not None:
            apart = sorted(apart, key=lambda row: float(np.sum((row - guesses[0]) ** 2)))[:most]
        polished = (self.polished(row) for row in apart)
        return [row for row in polished if row is not None]

    def polished(self, x: np.ndarray) -> np.ndarray | None:
        """The root near x to all digits of a float; None where there is none."""
        state = dict(self.values) | {node: fifty_digits().number(1) * float(v) for node, v in self._pairs(x)}
        inverse, before = None, np.inf
        try:
            for _ in range(POLISHINGS):
                f = evaluate(self.equations, state, fifty_digits())
                size = max(abs(y) for y in f)
                if max(abs(y) * r for y, r in zip(f, self._rows, strict=True)) < NOTHING:
                    break
                if inverse is None or size > FALLS * before:
                    inverse = self._inverse(state)
                step = self._columns * (inverse @ (-self._rows * np.array([float(y / size) for y in f])))
                before, moved = size, [size * float(d) for d in step]
                state |= {node: state[node] + d for node, d in zip(self.unknowns, moved, strict=True)}
                if max(abs(d) / (1 + abs(state[n])) for n, d in zip(self.unknowns, moved, strict=True)) < ROOT:
                    break
        except (NoValue, ZeroDivisionError, np.linalg.LinAlgError):
            return None
        found = np.array([float(state[node]) for node in self.unknowns])
        return found if self._holds(state) and np.all(abs(found - x) <= WANDERS * (1 + abs(x))) else None

    def _inverse(self, state: Mapping[Node, Any]) -> np.ndarray:
        """The pseudo-inverse of df/dx, scaled."""
        A = np.reshape([float(y) for y in evaluate(self._slopes, state, fifty_digits())], self._shape)
        return np.linalg.pinv(self._rows[:, None] * A * self._columns, rcond=RANK)

    def at_one(self, x: np.ndarray) -> np.ndarray:
        """df/dx at x, equations x unknowns."""
        return self._at(self._slopes, x[None, :]).reshape(self._shape)

    def _holds(self, state: Mapping[Node, Any]) -> bool:
        f = np.array([float(y) for y in evaluate(self.equations, state, fifty_digits())])
        return bool(np.all(abs(self._rows * f) < 1e-18))

    def _pairs(self, x: np.ndarray) -> zip[tuple[Node, float]]:
        return zip(self.unknowns, x, strict=True)

    @property
    def _shape(self) -> tuple[int, int]:
        return len(self.equations), len(self.unknowns)

    @cached_property
    def _slopes(self) -> tuple[Scalar, ...]:
        return tuple(x for row in jacobian(self.equations, self.unknowns) for x in row)

    @cached_property
    def _floats(self) -> dict[Node, float]:
        return {node: float(x) for node, x in self.values.items()}

    def _at(self, scalars: Sequence[Scalar], x: np.ndarray) -> np.ndarray:
        values = self._floats | {node: x[:, k] for k, node in enumerate(self.unknowns)}
        found = evaluate(scalars, values, ARRAYS)
        return np.stack([np.broadcast_to(y, len(x)) for y in found], axis=1).astype(float)

    @cached_property
    def _scales(self) -> tuple[np.ndarray, np.ndarray]:
        """(of the rows, of the columns): with them the largest entries of df/dx are near 1, near a few places."""
        places = np.random.default_rng(2).uniform(-1, 1, (16, len(self.unknowns)))
        with np.errstate(all="ignore"):
            A = np.abs(self._at(self._slopes, places)).reshape(-1, *self._shape)
            A = np.sqrt(np.nanmean(np.where(np.isfinite(A), A, np.nan) ** 2, axis=0))
        return balanced(np.where(np.isfinite(A), A, 1.0))[1:]

    @property
    def _rows(self) -> np.ndarray:
        return self._scales[0]

    @property
    def _columns(self) -> np.ndarray:
        return self._scales[1]

    def _arrived(self, x: np.ndarray) -> np.ndarray:
        """Move x to roots in place; where that succeeded."""
        n = len(self.unknowns)
        f, A = self._scaled(x)
        mu, size = np.full(len(x), 1e-3), _size(f)
        for _ in range(STEPS):
            left = np.flatnonzero(np.isfinite(size) & (size > 1e-15))
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
            mu[left] = np.clip(np.where(better, mu[left] / 5, mu[left] * 4), 1e-18, 1e12)
        return np.isfinite(size) & (size < CLOSE)

    def _scaled(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        f = self._rows * self._at(self.equations, x)
        A = self._at(self._slopes, x).reshape(-1, *self._shape) * self._rows[:, None] * self._columns
        return f, np.where(np.isfinite(A), A, 0.0)


def _solved(normal: np.ndarray, right: np.ndarray) -> np.ndarray:
    """x of normal x = right, one a row; the shortest where a matrix is singular (redundant equations)."""
    try:
        found: np.ndarray = np.linalg.solve(normal, right[:, :, None])[:, :, 0]
    except np.linalg.LinAlgError:
        found = (np.linalg.pinv(normal, hermitian=True) @ right[:, :, None])[:, :, 0]
    return found


def _apart(x: np.ndarray) -> list[np.ndarray]:
    """Of the rows that are as good as equal, one."""
    found: list[np.ndarray] = []
    for row in x:
        if not any(np.all(abs(row - other) <= TOGETHER * (1 + abs(row))) for other in found):
            found.append(row)
    return found


def _size(f: np.ndarray) -> np.ndarray:
    return np.sqrt(np.sum(f * f, axis=1))
