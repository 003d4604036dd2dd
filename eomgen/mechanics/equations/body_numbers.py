"""System, state -> numbers of its expressions there, and their rates along the motion through it, by differences."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from eomgen.mechanics.equations.system import System
from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits, floats_of


@dataclass(frozen=True)
class BodyNumbers:
    """Values of expressions at a state, and along the motion through it."""

    system: System
    state: State

    def at(self, scalars: tuple[Scalar, ...], shift: int = 0) -> list[Any]:
        """Values at the state, or a step of 1e-15 later (shift = 1) or earlier (-1) on the path with constant u."""
        return evaluate(scalars, self._beside[shift] if shift else self.state, fifty_digits())

    @cached_property
    def _beside(self) -> dict[int, State]:
        return {sign: self._shifted(sign) for sign in (1, -1)}

    def _shifted(self, sign: int) -> State:
        """The state a step of 1e-15 later or earlier."""
        arithmetic, values, symbols = fifty_digits(), dict(self.state), self.system.scope.symbols
        h = sign * _step(arithmetic)
        for q, rate in zip(symbols.q, evaluate(self.system.scope.rates, self.state, arithmetic), strict=True):
            values[q] = values[q] + h * rate
        values[symbols.t] = values[symbols.t] + h
        return values

    def array(self, scalars: Any) -> np.ndarray:
        """Values as floats, in the shape of the nested tuples."""
        flat, shape = _flattened(scalars)
        return np.array(floats_of(self.at(flat))).reshape(shape)

    def rate(self, scalars: Any) -> np.ndarray:
        """Time derivative at a = 0 by central differences."""
        flat, shape = _flattened(scalars)
        after, before = self.at(flat, 1), self.at(flat, -1)
        step = _step(fifty_digits())
        return np.array([float((x - y) / (2 * step)) for x, y in zip(after, before, strict=True)]).reshape(shape)


def _step(arithmetic: Any) -> Any:
    return arithmetic.number(1) / arithmetic.number(10**15)


def _flattened(scalars: Any) -> tuple[tuple[Scalar, ...], tuple[int, ...]]:
    """A scalar tuple or a tuple of rows, flat, and its shape."""
    if scalars and isinstance(scalars[0], tuple):
        return tuple(x for row in scalars for x in row), (len(scalars), len(scalars[0]))
    return tuple(scalars), (len(scalars),)
