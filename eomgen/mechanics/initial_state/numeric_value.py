"""Scope -> Worth: what scalars are worth at the model's parameters, with 50 digits, and whether they vanish there.

Parameters without a value, and symbols that were left free, are something at random.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from random import Random
from typing import Any

from eomgen.mechanics.bodies.scope import Scope
from eomgen.mechanics.initial_state.values_at_rest import values_of_parameters
from eomgen.model.values import constant_parameters, exact_parameters
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.sure_numbers import number_of, numbers_of
from eomgen.symbolic.numeric.tolerances import ZERO_AT_50


def known_parameters(scope: Scope) -> dict[Node, float]:
    """The parameters that have values."""
    return {scope.symbols.parameters[name]: float(x) for name, x in exact_parameters(scope.model).items()}


def known_exactly(scope: Scope) -> dict[Node, Scalar]:
    """The parameters that have values, as exact constants: 1/3, sqrt(2), pi/6."""
    return {scope.symbols.parameters[name]: x for name, x in constant_parameters(scope.model, scope.graph).items()}


def shown_numbers(scalars: Sequence[Scalar | None], values: Mapping[Node, Scalar | float]) -> list[float | None]:
    """The scalars as numbers, None where something in one has no value; nan where it has none itself."""
    ready = [x is not None and set(symbols_of((x,))) <= values.keys() for x in scalars]
    known = [x for x, is_ready in zip(scalars, ready, strict=True) if is_ready and x is not None]
    found = iter(numbers_of(known, values))
    return [next(found) if is_ready else None for is_ready in ready]


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
        found = number_of(x, self._known)
        return None if math.isnan(found) else found

    @cached_property
    def _values(self) -> dict[Node, Any]:
        return values_of_parameters(self.scope, Random(1))

    @cached_property
    def _known(self) -> dict[Node, Scalar]:
        return known_exactly(self.scope)
