"""Sums of terms -> nodes as a textbook writes them: monomials in a fixed order, each with its shortest waves."""

from __future__ import annotations

from collections import Counter
from functools import reduce
from operator import and_

from eomgen.symbolic.exact.atoms import RADIAN
from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.quotient import powers_in
from eomgen.symbolic.exact.radicals import Radical, one_root
from eomgen.symbolic.exact.spheres import shortest_on
from eomgen.symbolic.exact.terms import (
    ONE,
    AngleSum,
    Key,
    Monomial,
    Terms,
    Wave,
    common_monomial,
    common_number,
    constant,
    inverse,
    terms_times,
)
from eomgen.symbolic.exact.trigonometric_form import Factors, shortest
from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Node, Number, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.print.text import text_size


class Writer:
    """Writes the terms of one expansion as nodes of its graph."""

    def __init__(self, expansion: Expansion) -> None:
        self.atoms, self.graph, self.positive = expansion.atoms, expansion.graph, expansion.positive
        self._expansion = expansion
        self._written_atoms: dict[int, Scalar] = {}
        self._monomials: dict[Monomial, tuple[Scalar, Scalar]] = {}
        self._roots: dict[tuple[tuple[tuple[Key, Number], ...], ...], Scalar] = {}

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
        if len(above) == 1:
            ((monomial, w), c), *_ = above.items()
            merged, root = self._one_root(tuple(sorted((*monomial, *below))))
            if root != 1:
                left = tuple((atom, e) for atom, e in merged if e < 0 and self.atoms.is_a(atom, "sum"))
                rest = tuple(item for item in merged if item not in left)
                return self.graph.div(self.graph.mul(self._polynomial({(rest, w): c}), root), self._divisor(left))
        return self.graph.div(self._polynomial(above), self._divisor(below))

    def factored(self, common: Monomial, rest: Terms) -> Scalar:
        """common * (rest), sines and cosines that every term of the rest holds in front of it."""
        above, below = self._monomial(common)
        return self.graph.div(self.graph.mul(above, self._by_common_waves(rest)), below)

    def _by_common_waves(self, terms: Terms) -> Scalar:
        """sin(theta)*(3*g + 20*R*cos(theta)*theta'^2)"""
        if len(terms) < 2 or any(e < 0 and self.atoms.is_a(a, "sum") for monomial, _ in terms for a, e in monomial):
            return self.sum(terms)
        if not any(w for _, w in terms):
            return self._polynomial(terms)
        written = [(c, monomial, _powers(factors)) for c, monomial, factors in self.written(terms)]
        common = reduce(and_, (powers for _, _, powers in written))
        total: Scalar = 0
        for c, monomial, powers in written:
            total = self.graph.add(total, self.term(c, monomial, _factors(powers - common)))
        return self.graph.mul(self.term(1, (), _factors(common)), total)

    def content(self, *sums: Terms) -> Fraction:
        """The rational number common to every coefficient as written (27/2 cos^2, not 27/4 + 27/4 cos(2 theta))."""
        return common_number(c for terms in sums for c, _, _ in self.written(terms))

    def leads_with_minus(self, terms: Terms) -> bool:
        """Whether the first term as written has a minus sign."""
        return bool(terms) and self.written(terms)[0][0] < 0

    def _divisor(self, below: Monomial) -> Scalar:
        product: Scalar = 1
        for atom, e in below:
            product = self.graph.mul(product, self.graph.pow(self._atom(atom), -e))
        return product

    def _polynomial(self, terms: Terms) -> Scalar:
        total: Scalar = 0
        for c, monomial, factors in self.written(terms):
            total = self.graph.add(total, self.term(c, monomial, factors))
        return total

    def written(self, terms: Terms) -> list[tuple[Number, Monomial, Factors]]:
        """(coefficient, monomial, sines and cosines) of each term as it is written."""
        for sphere in self._expansion.spheres:
            terms = shortest_on(sphere, terms)
        groups: dict[Monomial, dict[Wave, Number]] = {}
        for (monomial, w), c in terms.items():
            groups.setdefault(monomial, {})[w] = c
        return [
            (sign * c, monomial, turned)
            for monomial in sorted(groups, key=self.atoms.place)
            for c, factors in shortest(groups[monomial])
            for sign, turned in (_forward(factors),)
        ]

    def term(self, c: Number, monomial: Monomial, factors: Factors) -> Scalar:
        """c * monomial * sines and cosines"""
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
        if monomial not in self._monomials:
            rest, root = self._one_root(monomial)
            above, below = self.atoms.monomial_nodes(rest, {atom: self._atom(atom) for atom, _ in rest if atom >= 0})
            self._monomials[monomial] = self.graph.mul(above, root), below
        return self._monomials[monomial]

    def _one_root(self, monomial: Monomial) -> tuple[Monomial, Scalar]:
        """(the rest, all roots as one): sqrt(2) sqrt(g) sqrt(l)/l = sqrt(2 g/l), sqrt(4 a + 2) = sqrt(2 (2 a + 1))."""
        exponents = dict(monomial)
        roots = [atom for atom in exponents if self.atoms.is_a(atom, "sqrt")]
        if not roots:
            return monomial, 1
        found: list[Terms] = [constant(-atom) for atom in exponents if atom < 0]
        for atom in roots:
            inside = self.atoms.opaque[atom].arguments[0]
            under = self.atoms.nodes[atom].args[0]
            if type(under) is Node and exponents.get(under.index, 0) < 0 and self._may_divide_root(under.index):
                exponents[under.index] += 1
                inside = self._expansion.reciprocal(inside)
            found.append(inside)
        rest = tuple((atom, e) for atom, e in sorted(exponents.items()) if e and atom >= 0 and atom not in roots)
        return rest, self._root(tuple(found))

    def _may_divide_root(self, atom: int) -> bool:
        """Whether sqrt(f)/f may be written 1/sqrt(f): f is a positive symbol, or a sum."""
        return atom in self.positive or self.atoms.is_a(atom, "sum")

    def _root(self, found: tuple[Terms, ...]) -> Scalar:
        """The square roots of all these as one, squares taken out."""
        key = tuple(tuple(sorted(f.items())) for f in found)
        if key not in self._roots:
            radical = one_root(self._expansion, constant(1), constant(1), found)
            self._roots[key] = self._apart(found) if radical is None else self.radical(radical)
        return self._roots[key]

    def _apart(self, found: tuple[Terms, ...]) -> Scalar:
        product: Scalar = 1
        for f in found:
            product = self.graph.mul(product, self.graph.sqrt(self.sum(f)))
        return product

    def radical(self, x: Radical) -> Scalar:
        """above/below |bare| sqrt(...)"""
        graph = self.graph
        bare = self._size(graph.div(self.in_factors(x.bare_above), self.in_factors(x.bare_below)))
        sign = -1 if x.number < 0 else 1
        above, below = self._product(({ONE: sign}, *x.under_above)), self._product(x.under_below)
        number = abs(Fraction(x.number))
        if above == 1 and number.numerator == 1 and type(below) is Node:
            root = graph.div(1, graph.sqrt(graph.mul(number.denominator, below)))
        else:
            root = graph.sqrt(graph.mul(tidy(number), graph.div(above, below)))
        outside = graph.mul(self.in_factors(x.above), graph.mul(bare, root))
        return graph.div(outside, self.in_powers(x.below))

    def _size(self, x: Scalar) -> Scalar:
        """|x|; x or -x of a number without symbols."""
        sign = self._expansion.sign_of_constant(x)
        return self.graph.call("abs", x) if sign is None else self.graph.mul(sign, x)

    def _product(self, parts: tuple[Terms, ...]) -> Scalar:
        """The product, or what comes of multiplying it out where that is no longer."""
        product: Scalar = 1
        total = constant(1)
        for part in parts:
            product = self.graph.mul(product, self.in_factors(part))
            total = self._expansion.product(total, part)
        whole = self.in_factors(total)
        return whole if text_size(whole) <= text_size(product) else product

    def in_powers(self, terms: Terms) -> Scalar:
        """The terms in factors, (4 + 9*cos(theta)^2)^2 as the power that it is."""
        product: Scalar = 1
        for part, e in powers_in(self._expansion, terms):
            product = self.graph.mul(product, self.graph.pow(self.in_factors(part), e))
        return product

    def in_factors(self, terms: Terms) -> Scalar:
        """The terms with what they have in common outside: l*(M + m*sin(theta)^2)."""
        common = common_monomial(terms)
        inverted, factor = inverse(common)
        number = self.content(terms) if len(terms) > 1 else Fraction(1)
        return tidy(number) * self.factored(
            common, terms_times(terms, {(inverted, ()): tidy(Fraction(factor) / number)})
        )

    def _applied(self, op: str, arguments: list[Scalar]) -> Scalar:
        if op == "select":
            return self.graph.select(*arguments)
        if op == "pow":
            return self.graph.pow(arguments[0], arguments[1])
        return self.graph.call(op, *arguments)


def _forward(factors: Factors) -> tuple[int, Factors]:
    """(sign, factors) with the first symbol of every angle positive: sin(-theta) = -sin(theta)."""
    sign, turned = 1, []
    for kind, angle, e in factors:
        if next((c for atom, c in angle if atom != RADIAN), 1) < 0:
            angle = tuple((atom, -c) for atom, c in angle)
            sign *= -1 if kind == "sin" and e % 2 else 1
        turned.append((kind, angle, e))
    return sign, tuple(turned)


def _powers(factors: Factors) -> Counter[tuple[str, AngleSum]]:
    return Counter({(kind, angle): e for kind, angle, e in factors})


def _factors(powers: Counter[tuple[str, AngleSum]]) -> Factors:
    return tuple((kind, angle, e) for (kind, angle), e in powers.items())


def is_rate(x: Node) -> bool:
    """True for a symbol that moves: theta', theta''."""
    return x.op == "symbol" and x.name.endswith("'")
