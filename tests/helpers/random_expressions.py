"""Random expressions for hypothesis: trees that are built on a graph and, independently, computed with floats."""

from __future__ import annotations

import math
from fractions import Fraction

from hypothesis import strategies as st

from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node, Scalar

NAMES = ("x", "y", "theta", "x'")
POINT = {"x": 0.73, "y": 1.31, "theta": 0.42, "x'": -0.57}

_numbers = st.builds(Fraction, st.integers(-4, 4), st.integers(1, 3)) | st.integers(-3, 3)
_leaves = st.sampled_from(NAMES) | _numbers
_BINARY = {"+": lambda a, b: a + b, "-": lambda a, b: a - b, "*": lambda a, b: a * b}
_POLYNOMIAL = {"square": lambda a: a * a, "-": lambda a: -a}


def _grown(functions: tuple[str, ...], children):
    binary = st.tuples(st.sampled_from(tuple(_BINARY)), children, children)
    return binary | st.tuples(st.sampled_from((*functions, *_POLYNOMIAL)), children)


polynomials = st.recursive(_leaves, lambda children: _grown((), children), max_leaves=8)
"""Polynomials."""

_angles = st.builds(
    lambda a, b, c: ("+", ("*", a, "theta"), ("+", ("*", b, "y"), c)),
    st.integers(-2, 2),
    st.sampled_from((0, 1, -1, Fraction(1, 2))),
    st.sampled_from((0, 0, "quarter", "sixth")),
)

trigonometric = st.recursive(
    _leaves, lambda children: _grown((), children) | st.tuples(st.sampled_from(("sin", "cos")), _angles), max_leaves=8
)
"""Polynomials in symbols and in sines and cosines of sums of angles."""

smooth = st.recursive(
    _leaves,
    lambda children: (
        _grown(("sin", "cos", "tanh", "atan"), children)
        | st.tuples(st.just("over"), children, children)
        | st.tuples(st.sampled_from(("root", "exp", "log")), children)
    ),
    max_leaves=8,
)
"""Functions that are smooth everywhere: divisors and radicands are kept positive."""


def on_graph(tree, graph: Graph) -> Scalar:
    """The tree as a scalar of the graph."""
    if not isinstance(tree, tuple):
        if not isinstance(tree, str):
            return tree
        special = {"quarter": graph.pi / 2, "sixth": graph.pi / 6}
        return special[tree] if tree in special else graph.symbol(tree)
    op, *rest = tree
    args = [on_graph(a, graph) for a in rest]
    if op in _BINARY and len(args) == 2:
        return _BINARY[op](*args)
    if op in _POLYNOMIAL:
        return _POLYNOMIAL[op](*args)
    if op == "over":
        return graph.div(args[0], 1 + args[1] * args[1])
    if op in ("root", "log"):
        return graph.call("sqrt" if op == "root" else "log", 1 + args[0] * args[0])
    return graph.call("exp", graph.call("sin", args[0])) if op == "exp" else graph.call(op, args[0])


def with_floats(tree, point: dict[str, float]) -> float:
    """The tree's value, without any graph."""
    if not isinstance(tree, tuple):
        special = {"quarter": math.pi / 2, "sixth": math.pi / 6}
        return float({**special, **point}[tree]) if isinstance(tree, str) else float(tree)
    op, *rest = tree
    args = [with_floats(a, point) for a in rest]
    if op in _BINARY and len(args) == 2:
        return _BINARY[op](*args)
    if op in _POLYNOMIAL:
        return _POLYNOMIAL[op](*args)
    if op == "over":
        return args[0] / (1 + args[1] ** 2)
    if op in ("root", "log"):
        return (math.sqrt if op == "root" else math.log)(1 + args[0] ** 2)
    return math.exp(math.sin(args[0])) if op == "exp" else getattr(math, op)(args[0])


def values_at(point: dict[str, float], graph: Graph) -> dict[Node, float]:
    """The point as values of the graph's symbols."""
    return {graph.symbol(name): value for name, value in point.items()}
