"""Scope -> the parameters that stand for positive numbers, of whose squares roots may be taken."""

from __future__ import annotations

from eomgen.mechanics.scope import Scope
from eomgen.model.values import exact_parameters
from eomgen.symbolic.graph import Node


def positive_parameters(scope: Scope) -> frozenset[Node]:
    """The parameters whose value is positive, or that the model calls `positive`."""
    model, symbols = scope.model, scope.symbols
    values = exact_parameters(model)
    return frozenset(
        node for name, node in symbols.parameters.items()
        if model.parameters[name].positive or (name in values and values[name] > 0)
    )  # fmt: skip
