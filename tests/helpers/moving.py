"""A system written as text, and its expressions as numbers at a random state and along the motion through it."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Any

import numpy as np

import eomgen
from eomgen.mechanics.dynamics import formulations as recursive
from eomgen.mechanics.dynamics.system import System
from eomgen.proof.states import real_state
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.node import Node, Scalar
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits

State = dict[Node, Any]


def written(text: str, space: str = "plane") -> System:
    """The system of a model without its first lines."""
    return System.of(eomgen.loads(f'eomgen = 1\nname = "test"\nspace = "{space}"\n{text}'))


def state_of(system: System, seed: int = 1) -> State:
    """A random state, at 50 digits."""
    return real_state(system, Random(seed))


def at(scalars: Sequence[Scalar], state: State) -> np.ndarray:
    """The values at a state."""
    return np.array([float(x) for x in evaluate(tuple(scalars), state, fifty_digits())])


def solved(system: System, values: dict[str, float]) -> tuple[np.ndarray, np.ndarray]:
    """(a, lam) of M a = forcing + J^T lam, J a + gamma = 0 at a state; what is not named is 0."""
    equations = recursive.assembled_by_recursion(system)
    symbols = system.symbols
    state = {s: fifty_digits().number(0) for s in (*symbols.x, symbols.t)}
    by_name = symbols.parameters | {s.name: s for s in symbols.x}
    state |= {by_name[name]: fifty_digits().number(1) * value for name, value in values.items()}
    M, J = (np.array([at(row, state) for row in rows]) for rows in (equations.M, equations.J))
    n, k = len(M), len(J)
    right = np.concatenate([at(equations.forcing, state), -at(equations.gamma, state)])
    found = np.linalg.solve(np.block([[M, -J.T], [J, np.zeros((k, k))]]), right)
    return found[:n], found[n:]


def rate(system: System, scalars: Sequence[Scalar], state: State) -> np.ndarray:
    """Time derivative of functions of q and t by central differences along the motion through the state."""
    h = fifty_digits().number(1) / 10**15
    late, early = (evaluate(tuple(scalars), moved(system, state, sign * h), fifty_digits()) for sign in (1, -1))
    return np.array([float((a - b) / (2 * h)) for a, b in zip(late, early, strict=True)])


def moved(system: System, state: State, h: Any) -> State:
    """The state a time h later, to first order."""
    later = dict(state)
    rates = evaluate(system.scope.rates, state, fifty_digits())
    for q, q_rate in zip(system.scope.symbols.q, rates, strict=True):
        later[q] = state[q] + h * q_rate
    later[system.scope.symbols.t] = state[system.scope.symbols.t] + h
    return later


def equal(left: Sequence[Scalar], right: Sequence[Scalar]) -> bool:
    """Whether two rows of expressions are the same functions."""
    return equal_at_random_states(list(zip(left, right, strict=True))).equal
