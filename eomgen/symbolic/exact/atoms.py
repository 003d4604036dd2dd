"""The atoms of sums of terms: which node an index stands for, and terms as nodes again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from eomgen.records import dataclass
from eomgen.symbolic.exact.terms import AngleSum, Key, Monomial, Terms
from eomgen.symbolic.expression.graph import Node, Number, Scalar
from eomgen.symbolic.expression.node import Owner

RADIAN = -1  # the index of the angle of a plain number: sin(1)
SortKey = tuple[int | Monomial, ...]  # sorts monomials as they are written


@dataclass(frozen=True)
class Opaque:
    """An atom that is no symbol: a function with its canonical arguments ("sum": an f that one divides by)."""

    op: str
    arguments: tuple[Terms, ...]


@dataclass
class Atoms:
    """The atoms of one expansion; it grows while the expansion meets new ones.

    Args:
        graph: owner of the nodes.
        nodes: the node of every atom and angle, by its index.
        opaque: what those atoms are that are no symbols.
        waves: those that were written, as nodes.
        places: of the monomials that were put in order.
    """

    graph: Owner
    nodes: dict[int, Node] = field(default_factory=dict)
    opaque: dict[int, Opaque] = field(default_factory=dict)
    waves: dict[tuple[str, AngleSum], Scalar] = field(default_factory=dict, repr=False)
    places: dict[Monomial, SortKey] = field(default_factory=dict, repr=False)

    def is_a(self, atom: int, op: str) -> bool:
        """Whether the atom is an opaque one of this op."""
        return atom in self.opaque and self.opaque[atom].op == op

    def node(self, terms: Terms) -> Scalar:
        """The sum as a node, in an order that depends on the terms only."""
        total: Scalar = 0
        for key in sorted(terms, key=lambda key: (self.place(key[0]), key[1])):
            total = self.graph.add(total, self.term(key, terms[key]))
        return total

    def place(self, monomial: Monomial) -> SortKey:
        """Accelerations before squares of rates before rates before the rest; then in the order of declaration."""
        if monomial not in self.places:
            self.places[monomial] = self._place(monomial)
        return self.places[monomial]

    def _place(self, monomial: Monomial) -> SortKey:
        moving: tuple[list[tuple[int, int]], list[tuple[int, int]], list[tuple[int, int]]] = ([], [], [])
        for atom, e in monomial:
            moving[min(2, self._primes(atom))].append((atom, -e))
        still, rates, accelerations = moving
        degrees = (sum(e for _, e in accelerations), sum(e for _, e in rates))
        return (*degrees, tuple(accelerations), tuple(rates), tuple(still))

    def _primes(self, atom: int) -> int:
        node = self.nodes.get(atom)
        if node is None or node.op != "symbol":
            return 0
        name: str = node.args[0]
        return len(name) - len(name.rstrip("'"))

    def term(self, key: Key, c: Number) -> Scalar:
        """c * monomial * wave as a node."""
        monomial, w = key
        above, below = self.monomial_nodes(monomial, self.nodes)
        if w:
            above = self.graph.mul(above, self.wave_node(w[0], w[1]))
        return self.graph.mul(c, self.graph.div(above, below))

    def monomial_nodes(self, monomial: Monomial, written: Mapping[int, Scalar]) -> tuple[Scalar, Scalar]:
        """(numerator, denominator) of a monomial, each atom as it is written."""
        above: Scalar = 1
        below: Scalar = 1
        for atom, e in monomial:
            if atom < 0:
                above = self.graph.mul(above, self.graph.sqrt(-atom))
            elif e > 0:
                above = self.graph.mul(above, self.graph.pow(written[atom], e))
            else:
                below = self.graph.mul(below, self.graph.pow(written[atom], -e))
        return above, below

    def wave_node(self, kind: str, k: AngleSum) -> Scalar:
        """cos or sin of k . angles."""
        if (kind, k) not in self.waves:
            self.waves[kind, k] = self.graph.call(kind, self.angle_node(k))
        return self.waves[kind, k]

    def angle_node(self, k: AngleSum) -> Scalar:
        """k . angles"""
        angle: Scalar = 0
        for atom, c in k:
            angle = self.graph.add(angle, c if atom == RADIAN else self.graph.mul(c, self.nodes[atom]))
        return angle
