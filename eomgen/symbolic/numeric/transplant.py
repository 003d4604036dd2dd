"""Scalars of one graph -> the same functions of the symbols of another."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from eomgen.errors import DerivationError
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.functions import NAMES, function, over
from eomgen.symbolic.expression.graph import Graph, Node, Scalar
from eomgen.symbolic.numeric.evaluation import Arithmetic, evaluate

_FUNCTIONS: dict[str, Callable[..., Any]] = {name: (lambda *args, name=name: function(name, *args)) for name in NAMES}
_RING: dict[str, Callable[..., Any]] = {
    "neg": operator.neg,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": over,
    "pow": operator.pow,
}


def transplanted(scalars: Sequence[Scalar], graph: Graph, meanings: Mapping[str, Scalar]) -> tuple[Scalar, ...]:
    """The scalars with each symbol replaced by what its name means in another graph.

    Raises:
        DerivationError: a symbol has no meaning there, or an operation cannot be carried over.
    """
    values: dict[Node, Scalar] = {}
    for symbol in symbols_of(scalars):
        if symbol.name not in meanings:
            raise DerivationError(f"'{symbol.name}' has no meaning here")
        values[symbol] = meanings[symbol.name]
    own: dict[str, Callable[..., Any]] = {"pi": lambda: graph.pi, "select": graph.select}
    own |= {name: partial(graph.call, name) for name in ("less", "less_equal", "sampled")}
    onto = Arithmetic("graph", lambda c: c, _RING | _FUNCTIONS | own, _refused)
    return tuple(evaluate(tuple(scalars), values, onto))


def _refused(node: Node) -> Scalar:
    raise DerivationError(f"'{node.op}' cannot be carried over")
