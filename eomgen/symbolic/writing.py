"""Sums of terms -> nodes as a textbook writes them: monomials in a fixed order, each with its shortest waves."""

from __future__ import annotations

from fractions import Fraction

from eomgen.symbolic.expansion import Expansion
from eomgen.symbolic.graph import Node, Number, Scalar
from eomgen.symbolic.shortest import Factors, shortest
from eomgen.symbolic.terms import Monomial, Terms, Wave, common_number, scaled, tidy


class Writer:
    """Writes the terms of one expansion as nodes of its graph."""

    def __init__(self, expansion: Expansion) -> None:
        self.atoms, self.graph, self.positive = expansion.atoms, expansion.graph, expansion.positive
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
            total = self.graph.add(total, self._quotient(parts[below], below))
        return total

    def _quotient(self, above: Terms, below: Monomial) -> Scalar:
        """The terms over sums; a single one with the root of such a sum under one root: sqrt(g/(M + m))."""
        if self.positive and len(above) == 1:
            ((monomial, w), c), *_ = above.items()
            merged, root = self._one_root(tuple(sorted((*monomial, *below))))
            if root != 1:
                left = tuple((atom, e) for atom, e in merged if e < 0 and self.atoms.is_a(atom, "sum"))
                rest = tuple(item for item in merged if item not in left)
                return self.graph.div(self.graph.mul(self._polynomial({(rest, w): c}), root), self._divisor(left))
        return self.graph.div(self._polynomial(above), self._divisor(below))

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
        monomial, root = self._one_root(monomial) if self.positive else (monomial, 1)
        above, below = self.atoms.monomial_nodes(
            monomial, {atom: self._atom(atom) for atom, _ in monomial if atom >= 0}
        )
        return self.graph.mul(above, root), below

    def _one_root(self, monomial: Monomial) -> tuple[Monomial, Scalar]:
        """The roots of positive symbols and sums and of the number as one: sqrt(2) sqrt(g) sqrt(l)/l = sqrt(2 g/l)."""
        exponents = dict(monomial)
        roots = {atom: inside for atom in exponents if (inside := self._under(atom)) is not None}
        sums = [atom for atom in exponents if self.atoms.is_a(atom, "sqrt") and atom not in roots]
        if not roots and not sums:
            return monomial, 1
        above: Scalar = 1
        below: Scalar = 1
        beside: Scalar = 1
        for atom in sums:  # sqrt(2) sqrt(4 a + 2 b) = 2 sqrt(2 a + b)
            f = self.atoms.opaque[atom].arguments[0]
            number = self.content(f)
            above = self.graph.mul(above, tidy(number))
            beside = self.graph.mul(beside, self.graph.sqrt(self.sum(scaled(f, 1 / number))))
            del exponents[atom]
        for atom in [*(a for a in exponents if a < 0), *roots]:
            del exponents[atom]
            under = roots.get(atom)
            if under is not None and exponents.get(under, 0) < 0:
                exponents[under] += 1
                below = self.graph.mul(below, self._atom(under))
            else:
                above = self.graph.mul(above, -atom if under is None else self._atom(under))
        rest = tuple((atom, e) for atom, e in sorted(exponents.items()) if e)
        return rest, self.graph.mul(self.graph.sqrt(self.graph.div(above, below)), beside)

    def _under(self, atom: int) -> int | None:
        """The positive symbol, or the sum that one divides by, whose root the atom is."""
        if not self.atoms.is_a(atom, "sqrt"):
            return None
        inside = self.atoms.nodes[atom].args[0]
        if type(inside) is not Node or not (inside.index in self.positive or self.atoms.is_a(inside.index, "sum")):
            return None
        return inside.index

    def _applied(self, op: str, arguments: list[Scalar]) -> Scalar:
        if op == "select":
            return self.graph.select(*arguments)
        if op == "pow":
            return self.graph.pow(arguments[0], arguments[1])
        return self.graph.call(op, *arguments)


def is_rate(x: Node) -> bool:
    """True for a symbol that moves: theta', theta''."""
    return x.op == "symbol" and x.name.endswith("'")
