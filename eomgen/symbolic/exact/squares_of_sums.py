"""A scalar -> the same with squares of sums as squares: 1/2*I_3*(cos(theta)*phi' + psi')^2, not its three terms."""

from __future__ import annotations

from collections.abc import Collection

from eomgen.symbolic.exact.expansion import Expansion, expanded
from eomgen.symbolic.exact.quotient import powers_in, reduced
from eomgen.symbolic.exact.terms import (
    ONE,
    Monomial,
    Terms,
    TooLarge,
    content,
    terms_scaled,
    terms_times,
)
from eomgen.symbolic.exact.writing import Writer
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.work import Work


def with_squares(x: Scalar, limit: int = Work.ENTRY, positive: Collection[Node] = ()) -> Scalar:
    """x with the parts that are squares of sums, of one product of parameters each, as squares."""
    if type(x) is not Node:
        return x
    try:
        expansion, (terms,) = expanded((x,), limit, positive)
        above, below = reduced(expansion, terms)
        writer = Writer(expansion)
        number = content(below) if len(below) > 1 else Fraction(1)
        top = _by_parameters(expansion, writer, terms_scaled(above, 1 / number))
        return expansion.graph.div(top, writer.in_powers(terms_scaled(below, 1 / number)))
    except TooLarge:
        return x


def _parted(expansion: Expansion, monomial: Monomial) -> tuple[Monomial, Monomial]:
    """(what stays the same of a product of powers, what moves)."""
    graph, nodes = expansion.graph, expansion.atoms.nodes
    still = tuple(item for item in monomial if item[0] < 0 or graph.is_constant(nodes[item[0]]))
    return still, tuple(item for item in monomial if item not in still)


def _by_parameters(expansion: Expansion, writer: Writer, terms: Terms) -> Scalar:
    """sum of (product of parameters) * (what moves), a square of a sum as a square"""
    groups: dict[Monomial, Terms] = {}
    for (monomial, w), c in terms.items():
        still, moving = _parted(expansion, monomial)
        groups.setdefault(still, {})[moving, w] = c
    total: Scalar = 0
    rest: Terms = {}
    for still, part in groups.items():
        square = _square(expansion, writer, part)
        if square is None:
            rest |= terms_times(part, {(still, ()): 1})
        else:
            total = expansion.graph.add(total, writer.factored(still, {ONE: 1}) * square)
    return expansion.graph.add(writer.sum(rest), total)


def _square(expansion: Expansion, writer: Writer, part: Terms) -> Scalar | None:
    """number * (a + b + ...)^2, where the part is that."""
    found = powers_in(expansion, part) if len(part) > 1 else []
    squared = [terms for terms, e in found if e == 2 and len(terms) > 1]
    others = [terms for terms, e in found if not (e == 2 and len(terms) > 1)]
    if len(squared) != 1 or any(set(terms) != {ONE} for terms in others):
        return None
    number: Scalar = 1
    for terms in others:
        number = number * terms[ONE]
    return number * expansion.graph.pow(writer.sum(squared[0]), 2)
