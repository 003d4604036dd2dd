"""Ties, a state -> whether branches meet there, and speeds that lead along one of them.

Where rank J falls below its value elsewhere (a change point) more speeds satisfy J u + sigma = 0 than lead anywhere:
accelerations with J a + gamma = 0 must exist too,

    n^T gamma(u) = 0   for every n with n^T J = 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Any

import numpy as np

from eomgen.mechanics.constraints.freedom import rank_of_ties
from eomgen.mechanics.constraints.ties import Ties
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import jacobian
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.dense import of_one_length
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.newton import Newton
from eomgen.symbolic.numeric.tolerances import CARRIED, RANK, SHARE, SOLVED, TINIEST

TRIES = 12  # places from which they are sought
ALONG_A_BRANCH = Newton(enough=SOLVED, steps=50, smallest=RANK)


@dataclass(frozen=True)
class Fork:
    """A position in which branches meet.

    Args:
        ties: those whose rows depend on one another there alone.
        more: freedoms that the ties leave beyond those that they leave elsewhere.
        left: n, one a row.
    """

    ties: tuple[str, ...]
    more: int
    left: np.ndarray

    @property
    def words(self) -> str:
        names = ", ".join(f"'{name}'" for name in self.ties)
        do = "does" if len(self.ties) == 1 else "do"
        return f"a change point, where {names} {do} not determine the motion"


def fork_at(ties: Ties, state: State) -> Fork | None:
    """Whether the closing rows are less independent there than elsewhere; None where they are not.

    Raises:
        MissingValues, DerivationError: the ties close nowhere near.
    """
    if not ties.closing or not ties.motion.scope.symbols.u:
        return None
    J = _matrix(ties, state)
    lengths = np.linalg.norm(J, axis=1, keepdims=True)
    U, sizes, _ = np.linalg.svd(of_one_length(J))
    here = int(np.sum(sizes > RANK))
    if here == len(ties.closing):
        return None
    more = rank_of_ties(ties) - here
    if more <= 0:
        return None
    shares = np.max(np.abs(U[:, here:]), axis=1)
    names = dict.fromkeys(row.tie for row, share in zip(ties.closing, shares, strict=True) if share > SHARE)
    return Fork(tuple(names), more, U[:, here:].T / np.where(lengths > 0, lengths, 1.0).T)


def leads_on(ties: Ties, fork: Fork, state: State) -> bool:
    """Whether accelerations exist with these speeds: J a + gamma = 0."""
    return bool(_Search(ties, fork, state, ()).size(np.zeros(0)) <= CARRIED)


def is_at_rest(ties: Ties, state: State) -> bool:
    """Whether all speeds are 0 there."""
    return all(abs(state[u]) <= SOLVED for u in ties.motion.scope.symbols.u)


def speeds_along(ties: Ties, fork: Fork, state: State, tiers: Sequence[Sequence[Node]]) -> dict[Node, Any] | None:
    """The state with the nearest speeds that lead along a branch; None where none is found.

    Args:
        tiers: what may move, each with those before it.
    """
    free: list[Node] = []
    for tier in tiers:
        free += tier
        if tier:
            found = _Search(ties, fork, state, tuple(free)).nearest()
            if found is not None:
                return {**state, **{u: state[u] + float(d) for u, d in zip(free, found, strict=True)}}
    return None


@dataclass(frozen=True)
class _Search:
    """Newton's method for J u + sigma = 0, n^T gamma(u) = 0 in some of the speeds."""

    ties: Ties
    fork: Fork
    state: State
    free: tuple[Node, ...]

    def nearest(self) -> np.ndarray | None:
        """The least change of the free speeds that is found."""
        rng = Random(1)
        reach = max([1.0, *(abs(float(self.state[u])) for u in self.ties.motion.scope.symbols.u)])
        starts = [np.zeros(len(self.free))]
        starts += [reach * np.array([rng.uniform(-1, 1) for _ in self.free]) for _ in range(TRIES)]
        roots = [ALONG_A_BRANCH.root(self, start) for start in starts]
        found = [root.x for root in roots if root.met]
        return min(found, key=lambda d: float(np.linalg.norm(d)), default=None)

    def size(self, d: np.ndarray) -> float:
        """What is left of both equations, against the size of the terms."""
        return float(np.max(np.abs(self.left(d)), initial=0.0))

    def left(self, d: np.ndarray) -> np.ndarray:
        """Both equations, each against the size of its terms."""
        f, sizes = self._left(d)
        return np.asarray(f / sizes)

    def slopes(self, d: np.ndarray) -> np.ndarray:
        """Their derivatives by the free speeds."""
        return np.asarray(self._slope(d) / self._left(d)[1][:, None])

    def moved(self, d: np.ndarray, step: Sequence[Any]) -> np.ndarray:
        return np.asarray(d + np.array(step, dtype=float))

    def _left(self, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(J u + sigma above n^T gamma, the size of the terms of each)."""
        k = len(self.ties.closing)
        values = self._at(d, (*(row.velocity for row in self.ties.closing), *self.ties.gamma))
        u = np.array([float(self._moved(d)[x]) for x in self.ties.motion.scope.symbols.u])
        J, fastest = np.abs(_matrix(self.ties, self.state)), np.max(np.abs(u), initial=0.0)
        of_speed = max(np.max(J @ np.abs(u), initial=0.0), np.max(np.abs(values[:k]), initial=0.0), TINIEST)
        own = np.abs(self.fork.left) @ (np.abs(values[k:]) + np.max(J, initial=0.0) * fastest**2)
        f = np.append(values[:k], self.fork.left @ values[k:])
        return f, np.append(np.full(k, of_speed), np.maximum(own, TINIEST))

    def _slope(self, d: np.ndarray) -> np.ndarray:
        k = len(self.ties.closing)
        rows: tuple[Scalar, ...] = (*(row.velocity for row in self.ties.closing), *self.ties.gamma)
        flat = tuple(x for row in jacobian(rows, self.free) for x in row)
        slope = self._at(d, flat).reshape(2 * k, len(self.free))
        return np.vstack([slope[:k], self.fork.left @ slope[k:]])

    def _moved(self, d: np.ndarray) -> State:
        return {**self.state, **{u: self.state[u] + float(x) for u, x in zip(self.free, d, strict=True)}}

    def _at(self, d: np.ndarray, scalars: Sequence[Scalar]) -> np.ndarray:
        return np.array([float(x) for x in evaluate(scalars, self._moved(d), fifty_digits())])


def _matrix(ties: Ties, state: State) -> np.ndarray:
    values = evaluate([x for row in ties.J for x in row], state, fifty_digits())
    return np.array([float(x) for x in values]).reshape(len(ties.closing), -1)
