"""Names of a model -> plain symbols of one graph.

q, u and a are symbols, not functions of time: the dot is a rule for printing and a total
derivative for deriving.
"""

from __future__ import annotations

from dataclasses import field

from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Graph, Node


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
        lam: multipliers of the closing rows, k, named `lam(tie, row)`, row from 1.
        unknowns: numbers that are asked, by name, in the model's order.
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
