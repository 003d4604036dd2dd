"""Expressions with square roots of sums -> the same with a symbol for each root, written shortly, and back.

The length of a spring is such a root. Multiplied out with the root as one symbol r, its force keeps its form:
k*(1 - l0/r)*(x2 - x1), and nothing is made rational that was not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from eomgen.symbolic.derivative import substituted
from eomgen.symbolic.evaluation import order
from eomgen.symbolic.expansion import Expansion
from eomgen.symbolic.graph import Node, Scalar
from eomgen.symbolic.layout import SUMS
from eomgen.symbolic.normal_form import readable
from eomgen.symbolic.terms import (
    Monomial,
    Terms,
    common_monomial,
    inverse,
    monomial_product,
    plus,
    scaled,
    tidy,
    times,
)
from eomgen.symbolic.writing import Writer

LARGEST_FACTOR = 120  # a number that is taken out of a sum, numerator and denominator


@dataclass(frozen=True)
class Rooted:
    """Expressions with a symbol for each square root of a sum.

    Args:
        expressions: written with the symbols.
        roots: (symbol, the root that it stands for), the inner ones first; what stands under it is readable.
    """

    expressions: tuple[Scalar, ...]
    roots: tuple[tuple[Node, Node], ...]

    @property
    def symbols(self) -> tuple[Node, ...]:
        return tuple(symbol for symbol, _ in self.roots)

    def back(self, expressions: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """The expressions with the roots themselves."""
        known: dict[Node, Scalar] = {}
        for symbol, root in self.roots:
            known[symbol] = substituted((root,), known)[0]
        return substituted(expressions, known) if known else tuple(expressions)


def rooted(expressions: Sequence[Scalar], limit: int) -> Rooted:
    """The expressions with a symbol for each square root of a sum in them.

    Args:
        limit: products of terms for what stands under one root.
    """
    known: dict[Node, Scalar] = {}
    roots: dict[Node, Node] = {}
    for node in order(expressions):
        if is_root_of_sum(node):
            inside = readable(substituted((node.args[0],), known)[0], limit)
            root = node.graph.sqrt(inside)
            if type(root) is Node and is_root_of_sum(root):
                symbol = node.graph.symbol(f"sqrt({root.index})")
                known[node] = symbol
                roots[symbol] = root
    written = substituted(expressions, known) if known else tuple(expressions)
    return Rooted(written, tuple(roots.items()))


def is_root_of_sum(node: Node) -> bool:
    """True for sqrt(a + b), not for sqrt(2) and sqrt(x^2)."""
    return node.op == "sqrt" and type(node.args[0]) is Node and node.args[0].op in SUMS


def readable_over(x: Scalar, divisors: Sequence[Node], limit: int) -> Scalar:
    """x multiplied out but for what is divided by the symbols `divisors`: k*(1 - l0/r)*(x2 - x1).

    Raises:
        TooLarge: that takes more than `limit` products of terms.
    """
    if type(x) is not Node:
        return x
    expansion = Expansion(x.graph, limit)
    terms = expansion.of(x)
    writer = Writer(expansion)
    atoms = {symbol.index for symbol in divisors}
    rest = {key: c for key, c in terms.items() if not _below(key[0], atoms)}
    total: Scalar = 0
    for part in _parts(terms, atoms):
        factor, sum_ = _primitive(writer, part)
        beside = _beside(rest, sum_)
        rest = plus(rest, times(beside, sum_), -1)
        if writer.leads_with_minus(sum_):
            factor, beside, sum_ = scaled(factor, -1), scaled(beside, -1), scaled(sum_, -1)
        total = total + _taken_out(writer, beside, factor) * writer.sum(sum_)
    return writer.sum(rest) + total


def _below(monomial: Monomial, atoms: set[int]) -> Monomial:
    """The negative powers of the atoms."""
    return tuple((atom, e) for atom, e in monomial if atom in atoms and e < 0)


def _parts(terms: Terms, atoms: set[int]) -> list[Terms]:
    """The terms that are divided by the atoms, those with one divisor together."""
    parts: dict[Monomial, Terms] = {}
    for (monomial, w), c in terms.items():
        below = _below(monomial, atoms)
        if below:
            parts.setdefault(below, {})[monomial, w] = c
    return [parts[below] for below in sorted(parts)]


def _primitive(writer: Writer, terms: Terms) -> tuple[Terms, Terms]:
    """(factor, sum): the common monomial, the common number where it is a small one, and what is left."""
    common = common_monomial(terms)
    number = writer.content(terms)
    if max(number.numerator, number.denominator) > LARGEST_FACTOR:
        number = Fraction(1)
    inverted, share = inverse(common)
    return {(common, ()): tidy(number)}, times(terms, {(inverted, ()): tidy(share / number)})


def _beside(terms: Terms, sum_: Terms) -> Terms:
    """The one-term factor whose product with the sum, taken away, shortens the terms most; nothing where none does."""
    best: Terms = {}
    shortest = len(terms)
    for (monomial, w), c in sum_.items():
        inverted, share = inverse(monomial)
        for (other, v), d in terms.items():
            if v == w:
                quotient, more = monomial_product(other, inverted)
                found: Terms = {(quotient, ()): tidy(Fraction(d) * share * more / Fraction(c))}
                left = len(plus(terms, times(found, sum_), -1))
                if left < shortest:
                    best, shortest = found, left
    return best


def _taken_out(writer: Writer, beside: Terms, factor: Terms) -> Scalar:
    """beside + factor with what both have in common in front: k*(1 - l0/r)."""
    if not beside:
        return writer.sum(factor)
    both = plus(beside, factor)
    common = tuple((atom, e) for atom, e in common_monomial(both) if e > 0)
    lead = Fraction(next(iter(beside.values())))
    inverted, share = inverse(common)
    return tidy(lead) * writer.factored(common, times(both, {(inverted, ()): tidy(share / lead)}))
