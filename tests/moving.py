"""A system written as text, and its expressions as numbers at a random state and along the motion through it."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import Any

import numpy as np

import eomgen
from eomgen.certificate import real_state
from eomgen.mechanics.system import System, system_of
from eomgen.symbolic.evaluation import evaluate, fifty_digits
from eomgen.symbolic.exact import equal_at_random_states
from eomgen.symbolic.graph import Node, Scalar

State = dict[Node, Any]


def written(text: str, space: str = "plane") -> System:
    """The system of a model without its first lines."""
    return system_of(eomgen.loads(f'eomgen = 1\nname = "test"\nspace = "{space}"\n{text}'))


def state_of(system: System, seed: int = 1) -> State:
    """A random state, at 50 digits."""
    return real_state(system, Random(seed))


def at(scalars: Sequence[Scalar], state: State) -> np.ndarray:
    """The values at a state."""
    return np.array([float(x) for x in evaluate(tuple(scalars), state, fifty_digits())])


def rate(system: System, scalars: Sequence[Scalar], state: State) -> np.ndarray:
    """Time derivative of functions of q and t by central differences along the motion through the state."""
    h = fifty_digits().number(1) / 10**15
    late, early = (evaluate(tuple(scalars), _moved(system, state, sign * h), fifty_digits()) for sign in (1, -1))
    return np.array([float((a - b) / (2 * h)) for a, b in zip(late, early, strict=True)])


def _moved(system: System, state: State, h: Any) -> State:
    moved = dict(state)
    rates = evaluate(system.scope.rates, state, fifty_digits())
    for q, q_rate in zip(system.scope.symbols.q, rates, strict=True):
        moved[q] = state[q] + h * q_rate
    moved[system.scope.symbols.t] = state[system.scope.symbols.t] + h
    return moved


def equal(left: Sequence[Scalar], right: Sequence[Scalar]) -> bool:
    """Whether two rows of expressions are the same functions."""
    return equal_at_random_states(list(zip(left, right, strict=True))).equal
