"""Exponentials of sums with logarithms in them: exp(2 log(x) + y) = x^2 exp(y)."""

from __future__ import annotations

from typing import Any

from eomgen.symbolic.expression.node import Node, Owner, Scalar, linear_terms

LARGEST_POWER = 8  # of what stands under a logarithm


def exponential(graph: Owner, a: Scalar) -> Scalar:
    """exp(a) on the graph."""
    logarithms = {x: c for x, c in linear_terms(a).items() if x is not None and _unfolds(x, c)}
    if not logarithms:
        return graph.held("exp", (a,))
    product: Scalar = 1
    for x, c in logarithms.items():
        a = graph.add(a, graph.mul(-c, x))
        product = graph.mul(product, graph.pow(x.args[0], c))
    return graph.mul(product, graph.call("exp", a))


def _unfolds(x: Node, c: Any) -> bool:
    return x.op == "log" and type(c) is int and abs(c) <= LARGEST_POWER
