"""Terms -> the same sum as quotients of their own, one for each parameter that it is linear in.

    (I_s + m*r^2/4 + I_c*r^2/(4*(r + p)^2))*theta''

An inertia that is reduced to another shaft reads so, and not over the product of all denominators.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import chain

from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.terms import Monomial, Terms, common_monomial, inverse, monomial_product
from eomgen.symbolic.expression.graph import Scalar

MOST_GROUPS = 8  # parameters that a sum is collected by


def by_parameters(
    expansion: Expansion,
    terms: Terms,
    written: Callable[[Terms], Scalar],
    added: Callable[[Sequence[Scalar]], Scalar],
) -> Scalar | None:
    """What moves and is common * sum of parameter * quotient; None where fewer than two parameters part the terms.

    Args:
        terms: a sum with denominators.
        written: a sum as one quotient without common factors.
        added: a sum of terms in this order.
    """
    linear = _linear(expansion, terms)
    moving = tuple((atom, e) for atom, e in common_monomial(terms) if not _is_still(expansion, atom))
    inverted, factor = inverse(moving)
    groups: dict[Monomial, Terms] = {}
    for (monomial, wave), c in terms.items():
        key = tuple(item for item in monomial if item[0] in linear)
        rest, number = monomial_product(monomial, inverted)
        groups.setdefault(key, {})[rest, wave] = c * number * factor
    if not 1 < len(groups) <= MOST_GROUPS:
        return None
    graph = expansion.graph
    total = added([written(groups[key]) for key in sorted(groups, key=expansion.atoms.place)])
    for atom, e in moving:
        total = graph.mul(total, graph.pow(expansion.atoms.nodes[atom], e))
    return total


def _linear(expansion: Expansion, terms: Terms) -> set[int]:
    """The parameters that stand in some terms with the power 1, and nowhere else."""
    powers: dict[int, set[int]] = {}
    for atom, e in chain.from_iterable(monomial for monomial, _ in terms):
        powers.setdefault(atom, set()).add(e)
    inside = {other for atom in powers for other in _atoms_in(expansion, atom)}
    return {
        atom
        for atom, found in powers.items()
        if found == {1} and atom not in inside and _is_still(expansion, atom) and _is_symbol(expansion, atom)
    }


def _atoms_in(expansion: Expansion, atom: int) -> set[int]:
    """Those of a denominator or a root."""
    opaque = expansion.atoms.opaque.get(atom)
    sums = () if opaque is None else opaque.arguments
    return {other for terms in sums for monomial, _ in terms for other, _ in monomial}


def _is_symbol(expansion: Expansion, atom: int) -> bool:
    node = expansion.atoms.nodes.get(atom)
    return node is not None and node.op == "symbol"


def _is_still(expansion: Expansion, atom: int) -> bool:
    return atom >= 0 and atom in expansion.atoms.nodes and expansion.graph.is_constant(expansion.atoms.nodes[atom])
