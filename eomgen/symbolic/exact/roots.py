"""Expressions with square roots of sums -> the same with a symbol for each root, written shortly, and back.

The length of a spring is such a root. Multiplied out with the root as one symbol r, its force keeps its form:
k*(1 - l0/r)*(x2 - x1), and nothing is made rational that was not.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterator, Mapping, Sequence

from eomgen.frozen import dataclass
from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.normal_forms import readable
from eomgen.symbolic.exact.terms import (
    Key,
    Monomial,
    Terms,
    TooLarge,
    common_monomial,
    inverse,
    monomial_product,
    terms_plus,
    terms_scaled,
    terms_times,
)
from eomgen.symbolic.exact.writing import Writer, is_rate
from eomgen.symbolic.expression import (
    ROOT_OF_SUM,
    SUMS,
    Fraction,
    Node,
    Number,
    Scalar,
    holds_op,
    order,
    substituted,
    tidy,
)
from eomgen.symbolic.print import factors, length_of, terms, text_size

ADDED = ("add", "sub")
LARGEST_FACTOR = 120  # a number that is factored out of a sum, numerator and denominator


@dataclass(frozen=True)
class Rooted:
    """Expressions with a symbol for each square root of a sum.

    Args:
        expressions: written with the symbols.
        roots: (symbol, what it stands for), in readable form, each before its use in another one.
    """

    expressions: tuple[Scalar, ...]
    roots: tuple[tuple[Node, Scalar], ...]

    def back(self, expressions: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """The expressions with the roots themselves."""
        known: dict[Node, Scalar] = {}
        for symbol, value in self.roots:
            known[symbol] = substituted((value,), known)[0]
        return substituted(expressions, known) if known else tuple(expressions)


def rooted(expressions: Sequence[Scalar], limit: int) -> Rooted:
    """The expressions with a symbol for each square root r of a sum in them, and for each rate (...)/r.

    Args:
        limit: products of terms for what stands under one root.
    """
    known: dict[Node, Scalar] = {}
    roots: dict[Node, Scalar] = {}
    if not any(holds_op(x, ROOT_OF_SUM) for x in expressions):
        return Rooted(tuple(expressions), ())
    nodes = order(expressions)
    added = {a for node in nodes if node.op in SUMS for a in node.args}
    candidates = {node for node in _above(nodes, is_root_of_sum) & _above(nodes, is_rate) - added if node.op in ADDED}
    rates: set[Node] = set()
    for node in nodes:
        if is_root_of_sum(node):
            inside = substituted((node.args[0],), known)[0]
            value = node.graph.sqrt(_shorter(inside, readable(inside, limit)))
        elif node in candidates and _is_over(known, node) and not _holds(rates, node):
            rates.add(node)
            (value,) = substituted((node,), known)
            value = _over(value, tuple(roots), limit)
        else:
            continue
        if type(value) is Node:
            known[node] = symbol = node.graph.symbol(f"(root {value.index})")  # no name of a model has parentheses
            roots[symbol] = value
    return Rooted(substituted(expressions, known), tuple(roots.items()))


def _shorter(a: Scalar, b: Scalar) -> Scalar:
    return a if text_size(a) < text_size(b) else b


def is_root_of_sum(node: Scalar) -> bool:
    """True for sqrt(a + b), not for sqrt(2) and sqrt(x^2)."""
    return type(node) is Node and node.op == "sqrt" and type(node.args[0]) is Node and node.args[0].op in SUMS


def _above(nodes: Sequence[Node], holds: Callable[[Node], bool]) -> set[Node]:
    """The nodes for which it holds, and all that are made of them; in evaluation order."""
    found: set[Node] = set()
    for node in nodes:
        if holds(node) or any(type(a) is Node and a in found for a in node.args):
            found.add(node)
    return found


def _holds(parts: Container[Node], node: Node) -> bool:
    return any(part in parts for part in order((node,)))


def _is_over(roots: Container[Node], node: Node) -> bool:
    """True for a sum every term of which is divided by one and the same root."""
    divisors = [
        {base for base, _ in factors(1 if term is None else term).denominator if base in roots}
        for _, term in terms(node)
    ]
    return bool(set.intersection(*divisors))


def _over(x: Scalar, divisors: Sequence[Node], limit: int) -> Scalar:
    """x readable over its roots; x itself where that takes too much work."""
    try:
        return readable_over(x, divisors, limit)
    except TooLarge:
        return x


def readable_over(x: Scalar, roots: Sequence[Node], limit: int, positive: Collection[Node] = ()) -> Scalar:
    """x multiplied out but for what is divided by the symbols `roots`: k*(1 - l0/r)*(x2 - x1).

    Raises:
        TooLarge: that takes more than `limit` products of terms.
    """
    if type(x) is not Node:
        return x
    expansion = Expansion(x.graph, limit, positive)
    found = expansion.of(x)
    writer = Writer(expansion)
    atoms = {symbol.index for symbol in roots}
    divided = _by_powers(found, atoms)
    rest = {key: c for key, c in found.items() if not any(key in part for part in divided)}
    factor_of: dict[tuple[tuple[Key, Number], ...], Terms] = {}
    for part in divided:
        factor, sum_ = _primitive(writer, part)
        key = tuple(sorted(sum_.items()))
        factor_of[key] = terms_plus(factor_of.get(key, {}), factor)
    apart, together = (_put_together(writer, rest, factor_of, atoms, beside) for beside in (False, True))
    return apart if length_of(apart) < length_of(together) else together


def _put_together(
    writer: Writer,
    rest: Terms,
    factor_of: Mapping[tuple[tuple[Key, Number], ...], Terms],
    atoms: set[int],
    beside: bool,
) -> Scalar:
    """rest + sum of factor * sum; with `beside`, each factor takes from the rest what goes with its sum."""
    products: list[Scalar] = []
    for key, factor in factor_of.items():
        sum_ = dict(key)
        more = _beside(rest, sum_, next(iter(factor.values()))) if beside else {}
        rest = terms_plus(rest, terms_times(more, sum_), -1)
        products.append(_taken_out(writer, terms_plus(more, factor), atoms) * writer.sum(sum_))
    return sum(products, start=writer.sum(rest))


def _by_powers(terms: Terms, atoms: set[int]) -> list[Terms]:
    """The terms that are divided by an atom, those with the same powers of the atoms together."""
    parts: dict[Monomial, Terms] = {}
    for (monomial, w), c in terms.items():
        powers = tuple((atom, e) for atom, e in monomial if atom in atoms)
        if any(e < 0 for _, e in powers):
            parts.setdefault(powers, {})[monomial, w] = c
    return [parts[powers] for powers in sorted(parts)]


def _primitive(writer: Writer, terms: Terms) -> tuple[Terms, Terms]:
    """(factor, sum): the common monomial, the common number where it is a small one, the sign, and what is left."""
    common = common_monomial(terms)
    number = writer.content(terms)
    if max(number.numerator, number.denominator) > LARGEST_FACTOR:
        number = Fraction(1)
    inverted, share = inverse(common)
    sum_ = terms_times(terms, {(inverted, ()): tidy(share / number)})
    sign = -1 if writer.leads_with_minus(sum_) else 1
    return {(common, ()): sign * tidy(number)}, terms_scaled(sum_, sign)


def _beside(terms: Terms, sum_: Terms, number: Number) -> Terms:
    """The one-term factor whose product with the sum, taken away, shortens the terms most; nothing where none does.

    Args:
        number: of the factor that is looked for, preferred where taking it away makes the terms no longer.
    """
    best: Terms = {}
    shortest = (False, len(terms))
    for monomial, ratio in _ratios(terms, sum_):
        equal = number if (number > 0) == (ratio > 0) else -number
        for other, c in ((False, equal), (True, ratio)):
            found: Terms = {(monomial, ()): c}
            left = len(terms_plus(terms, terms_times(found, sum_), -1))
            if left <= len(terms) - other and (not best or (other, left) < shortest):
                best, shortest = found, (other, left)
    return best


def _ratios(terms: Terms, sum_: Terms) -> Iterator[tuple[Monomial, Number]]:
    """(monomial, number) that makes one term of the sum one of the terms, and divides by nothing that this does not."""
    for (monomial, w), c in sum_.items():
        inverted, share = inverse(monomial)
        for (other, v), d in terms.items():
            if v == w:
                quotient, more = monomial_product(other, inverted)
                if _below(quotient) <= _below(other):
                    yield quotient, tidy(Fraction(d) * share * more / Fraction(c))


def _below(monomial: Monomial) -> set[int]:
    """The atoms that it is divided by."""
    return {atom for atom, e in monomial if e < 0}


def _taken_out(writer: Writer, factor: Terms, roots: set[int]) -> Scalar:
    """The factor with what its terms have in common in front: k*(1 - l0/r)."""
    if len(factor) == 1:
        return writer.sum(factor)
    common = tuple((atom, e) for atom, e in common_monomial(factor) if e > 0 or atom not in roots)
    lead = Fraction(factor[min(factor, key=_divisors)])
    inverted, share = inverse(common)
    number = abs(lead) if all(abs(c) == abs(lead) for c in factor.values()) else writer.content(factor)
    number = number if lead > 0 else -number
    return tidy(number) * writer.factored(common, terms_times(factor, {(inverted, ()): tidy(share / number)}))


def _divisors(key: Key) -> int:
    return len(_below(key[0]))
