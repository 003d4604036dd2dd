"""Scope -> Worth: what scalars are worth at the model's parameters, with 50 digits, and whether they vanish there.

Parameters without a value, and symbols that were left free, are something at random.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from random import Random
from typing import Any

from eomgen.mechanics.bodies.scope import Scope
from eomgen.mechanics.initial_state.values_at_rest import values_of_parameters
from eomgen.model.values import exact_parameters
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import FLOAT, NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50


def known_parameters(scope: Scope) -> dict[Node, float]:
    """The parameters that have values."""
    return {scope.symbols.parameters[name]: float(x) for name, x in exact_parameters(scope.model).items()}


def numbers_of(scalars: Sequence[Scalar | None], values: Mapping[Node, float]) -> list[float | None]:
    """The scalars as numbers, None where one has none."""
    ready = [x is not None and set(symbols_of((x,))) <= values.keys() for x in scalars]
    kept = [x for x, is_ready in zip(scalars, ready, strict=True) if is_ready and x is not None]
    found = iter(evaluate(kept, values, FLOAT))
    return [float(next(found)) + 0.0 if is_ready else None for is_ready in ready]


@dataclass(frozen=True)
class Worth:
    """Values of scalars.

    Args:
        scope: of the model.
        tolerance: what counts as zero.
    """

    scope: Scope
    tolerance: float = ZERO_AT_50

    def of(self, scalars: Iterable[Scalar]) -> list[Any]:
        """The values, with 50 digits."""
        wanted, values, rng = tuple(scalars), self._values, Random(2)
        for x in symbols_of(wanted):
            if x not in values:
                values[x] = fifty_digits().number(Fraction(rng.randint(20, 60), 40))
        return evaluate(wanted, values, fifty_digits())

    def vanish(self, scalars: Iterable[Scalar]) -> bool:
        """Whether all are zero."""
        return all(abs(x) < self.tolerance for x in self.of(scalars))

    def number(self, x: Scalar) -> float | None:
        """A scalar as a number; None where something in it has no value."""
        if any(symbol not in self._known for symbol in symbols_of((x,))):
            return None
        try:
            return float(evaluate((x,), self._known, fifty_digits())[0]) + 0.0
        except (NoValue, ZeroDivisionError):
            return None

    @cached_property
    def _values(self) -> dict[Node, Any]:
        return values_of_parameters(self.scope, Random(1))

    @cached_property
    def _known(self) -> dict[Node, Any]:
        return values_of_parameters(self.scope, None)
