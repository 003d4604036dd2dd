"""Assembly, state -> accelerations with more digits than doubles have."""

from __future__ import annotations

from typing import Any

import numpy as np

from eomgen.mechanics.equations.assembly import Assembly
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.dense import dense_solution, independent, scaled_condition, weighted, without_rounding
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import LEAST_CHANGE, REFINED_AT_50

SINGULAR = 1e13  # condition number from which a mass matrix counts as singular in double precision
REFINEMENTS = 40  # each adds the digits that the condition number leaves of 16


def accelerations_at(assembly: Assembly, state: State) -> np.ndarray:
    """a from M a = forcing + J^T lam, J a + gamma = 0 at a state, right to double precision whatever the condition.

    Raises:
        NoValue: some motion that the ties allow moves no mass at the state.
    """
    return np.array([float(x) for x in exact_accelerations(assembly, state)])


def exact_accelerations(assembly: Assembly, state: State) -> list[Any]:
    """The same with more than 20 digits: solved in doubles, what is left of the right side solved for again.

    Raises:
        NoValue: some motion that the ties allow moves no mass at the state.
    """
    n, k = len(assembly.M), len(assembly.J)
    if n == 0:
        return []
    entries = [x for row in (*assembly.M, *assembly.J) for x in row]
    values = evaluate((*entries, *assembly.forcing, *assembly.gamma), state, fifty_digits())
    wide = np.array(values[: n * (n + k)], dtype=object).reshape(n + k, n)
    M, J = wide[:n].astype(float), without_rounding(wide[n:].astype(float))
    if scaled_condition(weighted(M, J)) > SINGULAR:  # what no mass measures the ties may say
        raise NoValue("the mass matrix is singular")
    wide[n:] *= np.any(J, axis=1, keepdims=True)
    bordered = np.block([[M, -J.T], [J, np.zeros((k, k))]])
    regular = k == 0 or independent(J, smallest=LEAST_CHANGE)
    right = np.array([*values[n * (n + k) : len(values) - k], *(-y for y in values[len(values) - k :])], dtype=object)
    x = np.zeros(n + k, dtype=object)
    for _ in range(REFINEMENTS):
        size = max(map(abs, right))
        if size == 0:
            return list(x[:n])
        left = (right / size).astype(float)
        step = dense_solution(bordered, left, regular=regular, smallest=LEAST_CHANGE).astype(object) * size
        x = x + step
        right = right - np.concatenate([wide[:n] @ step[:n] - wide[n:].T @ step[n:], wide[n:] @ step[:n]])
        if max(map(abs, step[:n])) <= REFINED_AT_50 * max(map(abs, x[:n])):
            return list(x[:n])
    raise NoValue("the accelerations are not determined to 20 digits")
