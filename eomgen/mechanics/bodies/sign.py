"""Scope -> the parameters that stand for positive numbers, of whose squares roots may be taken."""

from __future__ import annotations

from eomgen.mechanics.bodies.scope import Scope
from eomgen.model.part import leaves_of
from eomgen.model.parts import Model
from eomgen.model.values import exact_parameters
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.graph import Node


def positive_parameters(scope: Scope) -> frozenset[Node]:
    """The parameters whose value is positive, that the model calls `positive`, or that are a mass or a length."""
    model, symbols = scope.model, scope.symbols
    values = exact_parameters(model)
    sizes = _sizes(model)
    return frozenset(
        node
        for name, node in symbols.parameters.items()
        if model.parameters[name].positive or (values[name] > 0 if name in values else name in sizes)
    )


def _sizes(model: Model) -> frozenset[str]:
    """The names that stand alone where a negative number is an error: masses, lengths and radii of bodies."""
    leaves = (leaf for body in model.bodies.values() for leaf in leaves_of(body, ()))
    signed = (leaf.value for leaf in leaves if getattr(leaf.rule, "sign", "") and isinstance(leaf.value, Expression))
    return frozenset(value.text for value in signed if len(value.code) == 1 and value.literal is None)
