"""Equations of motion, state -> accelerations with more digits than doubles have."""

from __future__ import annotations

from typing import Any

import numpy as np

from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.records import dataclass
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.dense import balanced, closed_entries, independent, scaled_condition, weighted
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import LEAST_CHANGE, REFINED_AT_50

SINGULAR = 1e13  # condition number from which a mass matrix counts as singular in double precision
BITS = 200  # of whole numbers that stand for numbers of 50 digits
REFINEMENTS = 40  # each adds the digits that the condition number leaves of 16


def accelerations_at(equations: EquationsOfMotion, state: State) -> np.ndarray:
    """a from M a = forcing + J^T lam, J a + gamma = 0 at a state, right to double precision whatever the condition.

    Raises:
        NoValue: some motion that the ties allow moves no mass at the state.
    """
    return np.array([float(x) for x in exact_accelerations(equations, state)])


def exact_accelerations(equations: EquationsOfMotion, state: State) -> list[Any]:
    """The same with more digits than doubles have: what they leave of the right side is solved for again.

    Raises:
        NoValue: some motion that the ties allow moves no mass at the state.
    """
    n, k = len(equations.M), len(equations.J)
    if n == 0:
        return []
    entries = [x for row in (*equations.M, *equations.J) for x in row]
    values = evaluate((*entries, *equations.forcing, *equations.gamma), state, fifty_digits())
    wide = np.array(values[: n * (n + k)], dtype=object).reshape(n + k, n)
    M, J = wide[:n].astype(float), closed_entries(wide[n:].astype(float))
    if scaled_condition(weighted(M, J)) > SINGULAR:  # what no mass measures the ties may say
        raise NoValue("the mass matrix is singular")
    wide[n:] *= J != 0
    regular = k == 0 or independent(J, smallest=LEAST_CHANGE)
    inverse = _inverse(np.block([[M, -J.T], [J, np.zeros((k, k))]]), regular=regular)
    right = np.array([*values[n * (n + k) : len(values) - k], *(-y for y in values[len(values) - k :])], dtype=object)
    return _refined(wide, n, right, inverse)


def _inverse(A: np.ndarray, *, regular: bool) -> np.ndarray:
    """Its inverse in doubles, scaled first; where rows follow from others that which leaves least."""
    scaled, rows, columns = balanced(A)
    try:
        found = np.linalg.inv(scaled) if regular else np.linalg.pinv(scaled, rcond=LEAST_CHANGE)
    except np.linalg.LinAlgError as error:
        raise NoValue("the equations of motion are singular") from error
    return np.asarray(columns[:, None] * found * rows)


def _refined(wide: np.ndarray, n: int, right: np.ndarray, inverse: np.ndarray) -> list[Any]:
    """a of M a - J^T lam = b, J a = -gamma, `wide` M over J: each correction adds the digits that doubles are sure of.

    Raises:
        NoValue: they add none.
    """
    A, x, left = Whole.of(wide), np.zeros(len(right), dtype=object), right
    for _ in range(REFINEMENTS):
        size = max(map(abs, left))
        if size == 0:
            return list(x[:n])
        step = (inverse @ (left / size).astype(float)).astype(object) * size
        x = x + step
        below, pushes = A.times(x[:n]), A.transposed_times(np.concatenate([np.zeros(n, dtype=object), x[n:]]))
        left = right - below + np.concatenate([pushes, np.zeros(len(x) - n, dtype=object)])
        if max(map(abs, step[:n])) <= REFINED_AT_50 * max(map(abs, x[:n])):
            return list(x[:n])
    raise NoValue("the accelerations are not determined to the digits of doubles")


@dataclass(frozen=True)
class Whole:
    """A matrix or vector as whole numbers times a unit: its products take a tenth of the time of those of 50 digits."""

    entries: np.ndarray
    unit: Any

    @staticmethod
    def of(values: np.ndarray) -> Whole:
        unit = fifty_digits().number(1) * (max(map(abs, values.ravel()), default=1) or 1) / 2**BITS
        return Whole(np.frompyfunc(int, 1, 1)(values / unit), unit)

    def times(self, x: np.ndarray) -> np.ndarray:
        """A x"""
        other = Whole.of(x)
        return np.asarray((self.entries @ other.entries) * (self.unit * other.unit))

    def transposed_times(self, x: np.ndarray) -> np.ndarray:
        """A^T x"""
        return Whole(self.entries.T, self.unit).times(x)
