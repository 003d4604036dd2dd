"""System -> rows of Y at states that keep the constraints, along the motions that these allow, with 50 digits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from random import Random
from typing import Any

import numpy as np

from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Closure
from eomgen.mechanics.dynamics import System
from eomgen.symbolic.expression import Fraction, ScalarRow, State, jacobian
from eomgen.symbolic.numeric import evaluate, fifty_digits, tolerances

MORE = 6  # beyond its columns
QUIET = 2  # states in succession that must add no independent row: then no state does
FAR = (0.4,)  # distance from the start of states that distinguish columns: near to it columns are nearly dependent
STEPS = 3  # of Newton's method from a root with 30 digits: each doubles them


def sampled_rows(
    system: System, rows: Sequence[ScalarRow], columns: Sequence[int], seed: int
) -> tuple[np.ndarray, State]:
    """(W at generic states that keep the constraints, along the motions that these allow, the last of these); 50
    digits.

    Of a part that moves by itself a state gives only as many rows as that has motions, however many the system has:
    states are added until they add no independent row.
    """
    parts: list[np.ndarray] = []
    have = quiet = 0
    reduced = Reduced({})
    for state, along in constrained_states(system, Random(seed)):
        parts.append(columns_along(system, rows, columns, state, along))
        have += len(along)
        least = tolerances.ROUNDED_AWAY * max(map(abs, parts[-1].flat), default=0)
        new = [reduced.takes({j: x for j, x in enumerate(row) if abs(x) > least}) for row in parts[-1]]
        quiet = 0 if any(new) else quiet + 1
        reported_apart = len(reduced.rows) == len(columns) or quiet >= QUIET
        if not len(along) or (reported_apart and have >= len(columns) + MORE):
            break
    return np.vstack(parts) if have else np.zeros((0, len(columns)), dtype=object), state


def columns_along(
    system: System, rows: Sequence[ScalarRow], columns: Sequence[int], state: State, along: np.ndarray
) -> np.ndarray:
    """Columns of Y at a state along the motions that the constraints allow."""
    entries = tuple(row[j] for row in rows for j in columns)
    Y = np.array(evaluate(entries, state, fifty_digits()), dtype=object).reshape(len(rows), len(columns))
    found: np.ndarray = along.dot(Y)
    return found


def constrained_states(system: System, rng: Random, *, shaken: bool = False) -> Iterator[tuple[State, np.ndarray]]:
    """Endless pairs (generic state that satisfies the constraints, the motions that they allow there)."""
    symbols, constraints = system.symbols, system.constraints
    size = len(symbols.u)
    J = tuple(x for row in constraints.J for x in row)
    given = {} if shaken else system.scope.values_of_parameters(None)
    while True:
        state = _closed_to_the_last_digit(system, Closure(constraints).generic(rng, shaken=shaken, spreads=FAR) | given)
        numbers = np.array(evaluate((*J, *constraints.sigma), state, fifty_digits()), dtype=object)
        there, sigma = numbers[: len(J)].reshape(-1, size), numbers[len(J) :]
        along, u = _allowed(there, sigma, size, rng)
        state = state | dict(zip(symbols.u, u, strict=True))
        gamma = np.array(evaluate(constraints.gamma, state, fifty_digits()), dtype=object)
        _, a = _allowed(there, gamma, size, rng)
        yield state | dict(zip(symbols.a, a, strict=True)), along


def _closed_to_the_last_digit(system: System, state: State) -> State:
    """A state whose gaps are closed, by Newton's method with 50 digits; of gaps that follow from others any."""
    gaps, free = (*system.constraints.gaps, *system.constraints.norms), system.constraints.movable
    if not gaps:
        return state
    slopes = tuple(x for row in jacobian(gaps, free) for x in row)
    for _ in range(STEPS):
        found = np.array(evaluate((*slopes, *gaps), state, fifty_digits()), dtype=object)
        S, phi = found[: len(slopes)].reshape(-1, len(free)), found[len(slopes) :]
        step = _allowed(S, phi, len(free), None)[1]
        state = state | {q: state[q] + d for q, d in zip(free, step, strict=True)}
    return state


def _allowed(J: np.ndarray, right: np.ndarray, size: int, rng: Random | None) -> tuple[np.ndarray, list[Any]]:
    """(a motion that the constraints allow in each row, an x with J x + right = 0, random where it is free)."""
    number = fifty_digits().number
    kept, K = echelon_in_digits(J, right)
    free = [j for j in range(size) if j not in kept]
    along = np.full((len(free), size), number(0), dtype=object)
    for row, j in enumerate(free):
        along[row, j] = number(1)
        for i in kept:
            along[row, i] = -K.get((i, j), number(0))
    pushed = [number(Fraction(rng.randrange(-1000, 1000), 1000) if rng else 0) for _ in free]
    x = [sum((p * row[k] for p, row in zip(pushed, along, strict=True)), start=number(0)) for k in range(size)]
    for i in kept:
        x[i] = x[i] - K.get((i, size), number(0))
    return along, x


@dataclass(frozen=True)
class Reduced:
    """Sparse rows of 50 digits, each without the pivots of those before it."""

    rows: dict[int, dict[int, Any]]

    def takes(self, row: Mapping[int, Any]) -> bool:
        """True if a row does not follow from these rows; it is then added."""
        left = dict(row)
        for pivot, other in self.rows.items():
            if factor := left.pop(pivot, 0):
                for j, x in other.items():
                    left[j] = left.get(j, 0) - factor * x
        pivot = max(left, key=lambda j: abs(left[j]), default=-1)
        if pivot < 0 or abs(left[pivot]) <= tolerances.FOLLOWS_AT_50 * max(map(abs, row.values()), default=0):
            return False
        size = left.pop(pivot)
        self.rows[pivot] = {j: x / size for j, x in left.items()}
        return True


def echelon_in_digits(W: np.ndarray, right: np.ndarray | None = None) -> tuple[list[int], dict[tuple[int, int], Any]]:
    """Echelon form as of `_echelon_form`, of numbers with 50 digits; a right side becomes one more column."""
    width = W.shape[1]
    if not len(W):
        return [], {}
    left = W.copy() if right is None else np.column_stack([W, right])
    kept: list[int] = []
    K: dict[tuple[int, int], Any] = {}
    for j in range(width):
        r = len(kept)
        pivot = max(range(r, len(left)), key=lambda i: abs(left[i, j]), default=None)
        if pivot is None or not abs(left[pivot, j]) > tolerances.FOLLOWS_AT_50:
            K |= {(kept[i], j): left[i, j] for i in range(r) if abs(left[i, j]) > tolerances.FOLLOWS_AT_50}
            continue
        left[[r, pivot]] = left[[pivot, r]]
        left[r] = left[r] / left[r, j]
        for i in range(len(left)):
            if i != r and left[i, j] != 0:
                left[i] = left[i] - left[i, j] * left[r]
        kept.append(j)
    if right is not None:
        K |= {(kept[i], width): left[i, width] for i in range(len(kept))}
    return kept, K


def in_50_digits(x: Any) -> Any:
    """An exact number, or one that has as many digits already."""
    return fifty_digits().number(x)
