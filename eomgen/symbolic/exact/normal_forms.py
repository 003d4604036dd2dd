"""Expressions -> their normal form: exact equality, and results as a person writes them.

A function that is polynomial in sines, cosines, coordinates, rates and parameters has one form as a sum of monomials
times cos(k . angles) or sin(k . angles); two of them are equal when the forms are. All work is bounded by `limit`,
a number of products of terms; where it is not enough, what is readable stays as it was.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import field
from typing import Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.exact.expansion import Expansion, expanded
from eomgen.symbolic.exact.quotient import one_root, reduced
from eomgen.symbolic.exact.terms import ONE, Key, Terms, TooLarge, common_monomial, terms_scaled
from eomgen.symbolic.exact.writing import Writer, is_rate
from eomgen.symbolic.expression import (
    Node,
    Number,
    Owner,
    Scalar,
    Vector,
    depends_on,
    order,
    substituted,
    tangent,
    tidy,
    united,
)
from eomgen.symbolic.numeric import Work
from eomgen.symbolic.print import has_nested_quotient, products_of, text_size

__all__ = [
    "Legibly",
    "NormalForm",
    "TooLarge",
    "cancelled",
    "collected_in",
    "common_factor",
    "equal",
    "in_whole_numbers",
    "normal_form",
    "quotients",
    "readable",
    "readable_all",
    "simplest",
    "simplest_sum",
    "written_shortest",
]

A_TERM = 16  # characters of one term of many, at least on the average


@dataclass(frozen=True)
class NormalForm:
    """The sum of coefficient * monomial * wave.

    Args:
        graph: the graph whose nodes the monomials and waves name by index.
        terms: ((monomial, wave), coefficient), ascending.
    """

    graph: Owner = field(compare=False)
    terms: tuple[tuple[Key, Number], ...]

    @property
    def is_zero(self) -> bool:
        return not self.terms


def normal_form(x: Scalar, limit: int = Work.ANSWER) -> NormalForm:
    """The normal form of x.

    Raises:
        TooLarge: more than `limit` products of terms.
    """
    expansion, (terms,) = expanded((x,), limit)
    return NormalForm(expansion.graph, tuple(sorted(terms.items())))


def equal(a: Scalar, b: Scalar, limit: int = Work.ANSWER) -> bool:
    """True if a and b are the same function.

    This is decided by the normal form for rational functions of sines, cosines and symbols. Where roots or other
    functions are left over, or the form is too large, at random states (exact in a prime field where that is possible).
    """
    difference = a - b
    if type(difference) is not Node:
        return difference == 0
    try:
        expansion, (terms,) = expanded((difference,), limit)
        numerator, _ = expansion.cleared(terms)
    except TooLarge:
        return equal_at_random_states([(a, b)]).equal
    if not numerator or not _has_relations(expansion):
        return not numerator
    return equal_at_random_states([(a, b)]).equal


def _has_relations(expansion: Expansion) -> bool:
    """True if atoms may depend on one another in a way that the form does not know: exp(2 x) = exp(x)^2."""
    nodes, pi = expansion.atoms.nodes, expansion.graph.pi.index
    if any(sphere[0] in nodes for sphere in expansion.unit_quaternions):  # a power of e0 below a line
        return True
    return pi in nodes or any(opaque.op != "sum" for opaque in expansion.atoms.opaque.values())


def readable(x: Scalar, limit: int = Work.ANSWER, positive: Collection[Node] = ()) -> Scalar:
    """x multiplied out and written shortly: 27/2*M*R^2*cos(theta)^2*theta'^2, cos(theta1 - theta2).

    Accelerations come first, then rates, then the rest, each in the order of declaration. x itself where that takes
    more than `limit` products of terms.

    Args:
        positive: symbols that stand for positive numbers: sqrt(m^2*g) is then m*sqrt(g).
    """
    return readable_all((x,), limit, positive)[0]


def written_terms(x: Scalar, limit: int, positive: Collection[Node] = ()) -> tuple[Scalar, ...] | None:
    """The terms of x multiplied out, each as it is written; None: that takes more than `limit` products of terms."""
    if type(x) is not Node:
        return () if x == 0 else (x,)
    expansion = Expansion(x.graph, limit, positive)
    writer = Writer(expansion)
    try:
        return tuple(writer.term(*each) for each in writer.written(expansion.of(x)))
    except TooLarge:
        return None


def readable_all(
    outputs: Sequence[Scalar], limit: int = Work.ANSWER, positive: Collection[Node] = (), most: int | None = None
) -> tuple[Scalar, ...]:
    """`readable` of several expressions that share their parts; those beyond the limit stay as they are.

    Args:
        most: terms of all of them, beyond which all stay as they are.
    """
    graph, outputs = united(outputs)
    expansion = Expansion(graph, limit, positive)
    writer = Writer(expansion)
    known: dict[Any, tuple[Scalar, int]] = graph.found(readable_all)
    how = (limit, expansion.positive)
    written, terms = [], 0
    for x in outputs:
        if (x, how) not in known:
            expansion.work = 0
            try:
                found = expansion.of(x)
                known[x, how] = writer.sum(found), len(found)
            except TooLarge:
                written.append(x)
                continue
        form, count = known[x, how]
        terms += count
        if most is not None and terms > most:
            return tuple(outputs)
        written.append(form)
    return tuple(written)


def collected_in(x: Scalar, symbols: Sequence[Node], limit: int = Work.ANSWER) -> dict[Node | None, Scalar]:
    """x = sum of coefficient * symbol + rest, as {symbol: coefficient, None: rest}, readable; zeros are left out.

    Raises:
        DerivationError: x is not linear in the symbols.
    """
    try:
        expansion, (terms,) = expanded((x,), limit)
        parts = _linear_parts(expansion, terms, symbols)
    except TooLarge:
        return _linear_by_derivative(x, symbols)
    writer = Writer(expansion)
    return {symbol: writer.sum(part) for symbol, part in parts.items() if part}


def _linear_parts(expansion: Expansion, terms: Terms, symbols: Sequence[Node]) -> dict[Node | None, Terms]:
    by_index = {symbol.index: symbol for symbol in symbols}
    inside = [a for opaque in expansion.atoms.opaque.values() for a in opaque.arguments]
    if any(atom in by_index for a in inside for monomial, _ in a for atom, _ in monomial):
        raise _not_linear(symbols)
    parts: dict[Node | None, Terms] = {symbol: {} for symbol in (*symbols, None)}
    for (monomial, w), c in terms.items():
        held = [(atom, e) for atom, e in monomial if atom in by_index]
        if len(held) > 1 or (held and held[0][1] != 1) or (w and any(angle in by_index for angle, _ in w[1])):
            raise _not_linear(symbols)
        symbol = by_index[held[0][0]] if held else None
        parts[symbol][tuple(item for item in monomial if item not in held), w] = c
    return parts


def _linear_by_derivative(x: Scalar, symbols: Sequence[Node]) -> dict[Node | None, Scalar]:
    coefficients = [tangent((x,), {symbol: 1})[0] for symbol in symbols]
    if any(depends_on(coefficient, symbols) for coefficient in coefficients):
        raise _not_linear(symbols)
    rest = substituted((x,), dict.fromkeys(symbols, 0))[0]
    found: dict[Node | None, Scalar] = {**dict(zip(symbols, coefficients, strict=True)), None: rest}
    return {symbol: part for symbol, part in found.items() if type(part) is Node or part != 0}


def _not_linear(symbols: Sequence[Node]) -> DerivationError:
    return DerivationError(f"the expression is not linear in {', '.join(symbol.name for symbol in symbols)}")


def common_factor(
    outputs: Sequence[Scalar], limit: int = Work.ANSWER, kept: Sequence[Node] = ()
) -> tuple[Number, Scalar]:
    """(number, product): the rational number and the powers of parameters and coordinates that every term holds.

    M*R^2*theta'' + M*g*R*sin(theta) -> M*R. Negative powers too, so that dividing by them leaves no fractions.
    (1, 1) where the limit is reached or there is nothing to divide.

    Args:
        kept: symbols that are no part of it.
    """
    try:
        expansion, forms = expanded(outputs, limit)
    except TooLarge:
        return 1, 1
    together: Terms = {}
    for terms in forms:
        together |= {(monomial, ()): 1 for monomial, _ in terms}
    if not together:
        return 1, 1
    stays = {symbol.index for symbol in kept}
    common = tuple(
        (atom, e) for atom, e in common_monomial(together) if atom not in stays and _is_still(expansion, atom)
    )
    writer = Writer(expansion)
    return tidy(writer.content(*forms)), writer.factored(common, {ONE: 1})


def _is_still(expansion: Expansion, atom: int) -> bool:
    node = expansion.atoms.nodes[atom]
    return node.op == "symbol" and not is_rate(node)


def cancelled(x: Scalar, limit: int = Work.ANSWER, positive: Collection[Node] = ()) -> Scalar:
    """x as one readable quotient without common factors; x itself where that takes too much work.

    Args:
        positive: symbols that stand for positive numbers.
    """
    try:
        expansion, (terms,) = expanded((x,), limit, positive)
        writer = Writer(expansion)
        return quotients(expansion, writer, terms)[-1]
    except TooLarge:
        return x


def simplest(x: Scalar, limit: int = Work.ANSWER, positive: Collection[Node] = (), most: int | None = None) -> Scalar:
    """The shortest of x multiplied out, x as one quotient without common factors, and that with its factors outside.

    Args:
        most: terms; a longer sum stays as it is where that is shorter than so many terms are.
    """
    if type(x) is not Node:
        return _simplest(x, limit, positive, most)
    how = (limit, frozenset(positive), most)
    known: dict[tuple[Any, ...], Scalar] = x.graph.found(simplest)
    if (x, *how) not in known:
        found = known[x, *how] = _simplest(x, limit, positive, most)
        known.setdefault((found, *how), found)
    return known[x, *how]


def _simplest(x: Scalar, limit: int, positive: Collection[Node], most: int | None) -> Scalar:
    try:
        expansion, (terms,) = expanded((x,), limit, positive)
        if most is not None and len(terms) > most and text_size(x) < A_TERM * len(terms):
            return x
        return written_shortest(expansion, terms)
    except TooLarge:
        return x


def simplest_sum(expansion: Expansion, terms: Terms) -> Scalar:
    """The same of a sum of terms, by as much work as the expansion may take."""
    expansion.work = 0
    try:
        return written_shortest(expansion, terms)
    except TooLarge:
        return expansion.atoms.node(terms)


def written_shortest(expansion: Expansion, terms: Terms) -> Scalar:
    """The same of a sum of terms.

    Raises:
        TooLarge: it takes more work than the expansion has left.
    """
    quotient = reduced(expansion, terms)  # first: where the work is not enough, nothing is written
    writer = Writer(expansion)
    plain = writer.sum(terms)
    forms = list(dict.fromkeys((plain, *_forms_of(expansion, writer, quotient, (terms, plain)))))
    return rebuilt_as_written(forms[0] if len(forms) == 1 else min(forms, key=_length))


def legible(x: Scalar, limit: int, positive: Collection[Node], long: int) -> Scalar:
    """x at its simplest; as it came where that is more than `long` characters, and longer than it came."""
    found = simplest(x, limit, positive)
    size = text_size(found)
    return x if size > long and text_size(x) < size else found


@dataclass(frozen=True)
class Legibly:
    """Scalars as a person writes them, each made so once.

    Args:
        work: products of terms for one of them.
        positive: symbols that stand for positive numbers.
        longest: characters of what is made readable; longer ones stay as they are (None: all are).
    """

    work: int
    positive: Collection[Node] = ()
    longest: int | None = None
    _found: dict[Node, Scalar] = field(default_factory=dict, init=False, repr=False, compare=False)

    def __call__(self, x: Scalar) -> Scalar:
        """x at its simplest."""
        if type(x) is not Node:
            return x
        if x not in self._found:
            stays = self.longest is not None and text_size(x) > self.longest
            self._found[x] = x if stays else simplest(x, self.work, self.positive)
        return self._found[x]

    def vector(self, v: Iterable[Scalar]) -> Vector:
        """The vector with its three components at their simplest."""
        return Vector(map(self, v))


def quotients(expansion: Expansion, writer: Writer, terms: Terms) -> list[Scalar]:
    """The sum as quotients without common factors: with its factors outside, with one root, and over a lone term."""
    return _forms_of(expansion, writer, reduced(expansion, terms))


def _forms_of(
    expansion: Expansion, writer: Writer, quotient: tuple[Terms, Terms], whole: tuple[Terms, Scalar] | None = None
) -> list[Scalar]:
    """The same of a quotient.

    Args:
        whole: the sum that it is, and how that is written, where that was done.
    """
    above, below = in_whole_numbers(writer, *quotient)
    forms = [expansion.graph.div(writer.in_factors(above), writer.in_powers(below))]
    common = common_monomial(above)
    roots = tuple((atom, e) for atom, e in common if expansion.atoms.is_a(atom, "sqrt"))
    if roots and len(above) * len(below) > 1:
        found = [expansion.atoms.opaque[atom].arguments[0] for atom, _ in roots]
        rest = {(tuple(item for item in monomial if item not in roots), w): c for (monomial, w), c in above.items()}
        radical = one_root(expansion, rest, below, found)
        forms += [] if radical is None else [writer.radical(radical)]
    if len(below) == 1:
        lone = expansion.product(above, expansion.reciprocal(below))
        forms.append(writer.sum(lone) if whole is None or lone != whole[0] else whole[1])
    return forms


def _length(x: Scalar) -> float:
    """Length of the text of x; one with a quotient within a quotient counts as half as long again."""
    return text_size(x) * (1.5 if has_nested_quotient(x) else 1)


def in_whole_numbers(writer: Writer, numerator: Terms, denominator: Terms) -> tuple[Terms, Terms]:
    """The same quotient with whole coefficients, without common number, the denominator's first term positive."""
    above, below = writer.content(numerator), writer.content(denominator)
    ratio = above / below
    sign = -1 if writer.leads_with_minus(denominator) else 1
    return terms_scaled(numerator, sign * ratio.numerator / above), terms_scaled(
        denominator, sign * ratio.denominator / below
    )


# -------- signs ----------------------------------------------------------------------------------------------
# Expressions -> their sign, where it is the sign of every term.


def sign_of_terms(x: Scalar, positive: Collection[Node]) -> int | None:
    """1 or -1 where all terms of x are positive or all negative, 0 where there are none; None where that is unknown."""
    try:
        expansion, (terms,) = expanded((x,), Work.VALUE, positive)
    except TooLarge:
        return None
    if not terms:
        return 0
    for sign in (1, -1):
        if expansion.all_positive({key: sign * c for key, c in terms.items()}):
            return sign
    return None


def never_vanishes(x: Node) -> bool:
    """True if x is positive, or negative, wherever it has a value, for positive constants: M + m*sin(alpha)^2."""
    constants = tuple(node for node in order((x,)) if node.op == "symbol" and node.graph.is_constant(node))
    try:
        expansion, (terms,) = expanded((x,), Work.ENTRY, constants)
    except TooLarge:
        return False
    return any(expansion.is_positive({key: sign * c for key, c in terms.items()}) for sign in (1, -1))


def rebuilt_as_written(x: Scalar) -> Scalar:
    """x made anew as it is printed: sin(theta)^2/sin(theta), which is printed as sin(theta), is sin(theta)."""
    if not isinstance(x, Node):
        return x
    total: Scalar = 0
    for product in products_of(x):
        above: Any = product.coefficient
        for base, power in product.numerator:
            above = above * base**power
        below: Any = 1
        for base, power in product.denominator:
            below = below * base**power
        total = total + (above if type(below) is int else above / below)
    return total
