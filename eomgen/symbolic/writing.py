"""Sums of terms -> nodes as a textbook writes them: monomials in a fixed order, each with its shortest waves."""

from __future__ import annotations

from fractions import Fraction

from eomgen.symbolic.expansion import Expansion
from eomgen.symbolic.graph import Node, Number, Scalar
from eomgen.symbolic.shortest import Factors, shortest
from eomgen.symbolic.terms import Monomial, Terms, Wave, common_number


class Writer:
    """Writes the terms of one expansion as nodes of its graph."""

    def __init__(self, expansion: Expansion) -> None:
        self.atoms, self.graph = expansion.atoms, expansion.graph
        self._written_atoms: dict[int, Scalar] = {}

    def sum(self, terms: Terms) -> Scalar:
        """The terms added up; those over one divisor share one fraction."""
        parts: dict[Monomial, Terms] = {}
        for (monomial, w), c in terms.items():
            below = tuple((atom, e) for atom, e in monomial if e < 0 and self.atoms.is_a(atom, "sum"))
            above = tuple(item for item in monomial if item not in below)
            parts.setdefault(below, {})[above, w] = c
        total: Scalar = 0
        for below in sorted(parts):
            total = self.graph.add(total, self.graph.div(self._polynomial(parts[below]), self._divisor(below)))
        return total

    def factored(self, common: Monomial, rest: Terms) -> Scalar:
        """common * (rest)"""
        above, below = self._monomial(common)
        return self.graph.div(self.graph.mul(above, self.sum(rest)), below)

    def content(self, *sums: Terms) -> Fraction:
        """The rational number common to every coefficient as written (27/2 cos^2, not 27/4 + 27/4 cos(2 theta))."""
        return common_number(c for terms in sums for c, _, _ in self._written(terms))

    def leads_with_minus(self, terms: Terms) -> bool:
        """Whether the first term as written has a minus sign."""
        return bool(terms) and self._written(terms)[0][0] < 0

    def _divisor(self, below: Monomial) -> Scalar:
        product: Scalar = 1
        for atom, e in below:
            product = self.graph.mul(product, self.graph.pow(self._atom(atom), -e))
        return product

    def _polynomial(self, terms: Terms) -> Scalar:
        total: Scalar = 0
        for c, monomial, factors in self._written(terms):
            total = self.graph.add(total, self._term(c, monomial, factors))
        return total

    def _written(self, terms: Terms) -> list[tuple[Number, Monomial, Factors]]:
        groups: dict[Monomial, dict[Wave, Number]] = {}
        for (monomial, w), c in terms.items():
            groups.setdefault(monomial, {})[w] = c
        return [
            (c, monomial, factors)
            for monomial in sorted(groups, key=self.atoms.place)
            for c, factors in shortest(groups[monomial])
        ]

    def _term(self, c: Number, monomial: Monomial, factors: Factors) -> Scalar:
        above, below = self._monomial(monomial)
        for kind, angle, e in factors:
            above = self.graph.mul(above, self.graph.pow(self.atoms.wave_node(kind, angle), e))
        return self.graph.mul(c, self.graph.div(above, below))

    def _atom(self, atom: int) -> Scalar:
        """The atom, the arguments of a function written out."""
        if atom not in self._written_atoms:
            opaque = self.atoms.opaque.get(atom)
            node: Scalar = self.atoms.nodes[atom]
            if opaque is not None:
                arguments = [self.sum(a) for a in opaque.arguments]
                node = arguments[0] if opaque.op == "sum" else self._applied(opaque.op, arguments)
            self._written_atoms[atom] = node
        return self._written_atoms[atom]

    def _monomial(self, monomial: Monomial) -> tuple[Scalar, Scalar]:
        """(numerator, denominator)"""
        return self.atoms.monomial_nodes(monomial, {atom: self._atom(atom) for atom, _ in monomial if atom >= 0})

    def _applied(self, op: str, arguments: list[Scalar]) -> Scalar:
        if op == "select":
            return self.graph.select(*arguments)
        if op == "pow":
            return self.graph.pow(arguments[0], arguments[1])
        return self.graph.call(op, *arguments)


def is_rate(x: Node) -> bool:
    """True for a symbol that moves: theta', theta''."""
    return x.op == "symbol" and x.name.endswith("'")
