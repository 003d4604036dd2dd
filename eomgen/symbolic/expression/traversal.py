"""Expressions -> their nodes, arguments before results, and the names of a model as symbols of one graph.

Expressions -> their nodes, arguments before results; and how many operations that is.

The loops run in the order of `Node.index`, never by recursion: a chain of 50 links is thousands of nodes deep.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from operator import attrgetter
from typing import Any

from eomgen.frozen import dataclass
from eomgen.symbolic.expression.graph import CONSTANTS, Graph
from eomgen.symbolic.expression.node import Node, Owner, Scalar, op_bits
from eomgen.symbolic.expression.rational import Fraction

FREE = frozenset(("symbol", "pi", "neg"))
_INDEX = attrgetter("index")


@dataclass(frozen=True)
class Count:
    """Number of operations that an evaluation takes.

    Args:
        total: at every call, once the parameters are fixed.
        hoisted: apart from those, once for given parameters.
    """

    total: int
    hoisted: int


def order(outputs: Iterable[Scalar], given: Mapping[Node, Any] | frozenset[Node] = frozenset()) -> list[Node]:
    """Every node that the outputs need, arguments before results; what is `given` is not looked into."""
    return sorted(_needed(outputs, given), key=_INDEX)


MOST_WHOLE = 10**9  # of the whole numbers of a fraction that stands in formulas


def holds_many_digits(x: Scalar) -> bool:
    """True if a number with all its digits, as of a double, occurs in a scalar: that is a number and no formula."""
    leaves = [a for node in order((x,)) for a in node.args if isinstance(a, Fraction | int)]
    plain = [x] if isinstance(x, Fraction | int) else leaves
    return any(max(abs(Fraction(a).numerator), Fraction(a).denominator) > MOST_WHOLE for a in plain)


def _needed(outputs: Iterable[Scalar], given: Mapping[Node, Any] | frozenset[Node] = frozenset()) -> set[Node]:
    seen = {x for x in outputs if type(x) is Node}
    stack = [x for x in seen if x not in given] if given else list(seen)
    pop, push, add = stack.pop, stack.append, seen.add
    while stack:
        for a in pop().args:
            if type(a) is Node and a not in seen:
                add(a)
                if not given or a not in given:
                    push(a)
    return seen


def united(outputs: Sequence[Scalar]) -> tuple[Owner, list[Scalar]]:
    """(graph, outputs) with the constants that have no graph of their own taken into that of the others."""
    home = next((x.graph for x in outputs if type(x) is Node and x.graph is not CONSTANTS), CONSTANTS)
    return home, [home.adopted(x) for x in outputs]


def operations(outputs: Iterable[Scalar], parameters: Iterable[Node] = ()) -> Count:
    """The operations in the outputs, each sub-expression once.

    Every + - * / power and function is one; signs, symbols, pi, and what depends on exact constants only are free.
    What depends on `parameters` only is hoisted.
    """
    parameters = frozenset(parameters)
    if not parameters:
        symbol = op_bits("symbol")
        return Count(sum(1 for x in _needed(outputs) if x.op not in FREE and x.ops & symbol), 0)
    constant, fixed, moving = 0, 1, 2  # what a node depends on at most: exact constants, parameters, anything
    kind: dict[Node, int] = {}
    counts = [0, 0, 0]
    for x in order(outputs):
        if x.op == "symbol":
            kind[x] = fixed if x in parameters else moving
            continue
        of = constant
        for a in x.args:
            if type(a) is Node and kind[a] > of:
                of = kind[a]
        kind[x] = of
        if x.op not in FREE:
            counts[of] += 1
    return Count(total=counts[moving], hoisted=counts[fixed])


# -------- symbols ---------------------------------------------------------------------------------------------
# Names of a model -> plain symbols of one graph.
#
# q, u and a are symbols, not functions of time: the dot is a rule for printing and a total derivative for deriving.


@dataclass(frozen=True)
class Symbols:
    """The symbols of one derivation.

    Args:
        graph: the graph that owns them.
        t: time [s].
        parameters: every parameter by name, in the model's order.
        inputs: every named input by name, in the model's order.
        q: generalized coordinates, nq, named `theta`.
        u: generalized speeds, nu, named `theta'` where u is a rate, else by the speed's name.
        a: accelerations u', nu, named `theta''` or `w1'`.
        lam: multipliers of the constraint rows, k, named `lam(constraint, row)`, row from 1.
        unknowns: numbers that are requested, by name, in the model's order.
        z: states of first order, nz, by name, in the model's order.
    """

    graph: Graph
    t: Node
    parameters: dict[str, Node]
    inputs: dict[str, Node]
    q: tuple[Node, ...]
    u: tuple[Node, ...]
    a: tuple[Node, ...]
    lam: tuple[Node, ...] = ()
    unknowns: dict[str, Node] = field(default_factory=dict)
    z: tuple[Node, ...] = ()

    @property
    def x(self) -> tuple[Node, ...]:
        """The whole state, x = (q, u, z)."""
        return self.q + self.u + self.z

    @property
    def places(self) -> tuple[Node, ...]:
        """Everything that may have any value at rest, (q, z)."""
        return self.q + self.z
