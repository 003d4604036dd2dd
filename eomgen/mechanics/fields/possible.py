"""System -> Possible: motions that the ties allow, to the third order, in numbers of 50 digits.

    phi = 0,   J u + sigma = 0,   J a + gamma = 0,   J a' + d/dt(J a + gamma) at a' = 0 = 0

What must vanish along every motion (the rate of a centre that stays, the curvature of a straight way) is tried at two
of them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from random import Random
from typing import Any

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.constraints.closure import generic_state, of_50_digits
from eomgen.mechanics.equations.system import System
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import tangent
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.spatial import Vector, vector_of
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.newton import Newton
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50

CORRECTED = Newton(steps=4)  # each step adds about 15 digits
SEEDS = (1, 2)


@dataclass(frozen=True)
class Possible:
    """The motions of a system.

    Args:
        system: the system.
        shaken: parameters have values of their own, so that nothing holds for the model's values alone.
    """

    system: System
    shaken: bool = False

    @cached_property
    def jerks(self) -> tuple[Node, ...]:
        """Symbols of a', one for each speed."""
        symbols = self.system.symbols
        return tuple(symbols.graph.symbol(a.name + "'") for a in symbols.a)

    def rate(self, x: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """d/dt of functions of q, u, a and t; it holds the symbols of a'."""
        symbols, scope = self.system.symbols, self.system.scope
        flow = {**scope.flow, **dict(zip(symbols.u, symbols.a, strict=True))}
        return tangent(tuple(x), {**flow, **dict(zip(symbols.a, self.jerks, strict=True))})

    def rate_of(self, x: Vector) -> Vector:
        """d/dt of a vector, 3."""
        return vector_of(self.rate(x))

    def vanish(self, *scalars: Scalar) -> bool:
        """Whether all of them are zero along every motion.

        Raises:
            DerivationError: the ties do not close, or there is no state at which the scalars have values.
        """
        left = [x for x in scalars if type(x) is Node or x != 0]
        return not left or all(self._vanish_at(left, state) for state in self.states)

    def _vanish_at(self, scalars: Sequence[Scalar], state: State) -> bool:
        try:
            values = evaluate(scalars, state, fifty_digits())
        except (NoValue, ZeroDivisionError):
            raise DerivationError(
                "the motion is singular near the start", "coordinates", mend="start apart from the dead centre"
            ) from None
        return bool(max(map(abs, values)) < ZERO_AT_50)

    @cached_property
    def states(self) -> tuple[State, ...]:
        """Values of every symbol along two motions."""
        return tuple(self._state(Random(seed)) for seed in SEEDS)

    def _state(self, rng: Random) -> State:
        ties, symbols = self.system.ties, self.system.symbols
        state = generic_state(ties, rng, shaken=self.shaken)
        state |= {node: of_50_digits(rng.uniform(-1, 1)) for node in self.jerks}
        rows = tuple(row.velocity for row in ties.closing)
        J = tuple(x for row in ties.J for x in row)
        for unknowns in (symbols.u, symbols.a, self.jerks):
            state = _closed(J, rows, unknowns, state)
            rows = self.rate(rows)
        return state


def _closed(J: Sequence[Scalar], rows: Sequence[Scalar], unknowns: Sequence[Node], state: State) -> State:
    """The state with the nearest values of the unknowns at which the rows, linear in them by J, vanish."""
    if not rows or not unknowns:
        return state
    slopes = np.array([float(x) for x in evaluate(J, state, fifty_digits())]).reshape(len(rows), len(unknowns))
    found = CORRECTED.root(_LinearRows(tuple(rows), slopes, tuple(unknowns)), state)
    if math.isnan(found.left):
        raise DerivationError(
            "the motion is singular near the start", "coordinates", mend="start apart from the dead centre"
        )
    return found.x


@dataclass(frozen=True)
class _LinearRows:
    """Rows that are linear in the unknowns."""

    rows: tuple[Scalar, ...]
    matrix: np.ndarray
    unknowns: tuple[Node, ...]

    def left(self, state: State) -> Sequence[Any]:
        return evaluate(self.rows, state, fifty_digits())

    def slopes(self, state: State) -> np.ndarray:
        return self.matrix

    def moved(self, state: State, step: Sequence[Any]) -> State:
        return state | {node: state[node] + d for node, d in zip(self.unknowns, step, strict=True)}
