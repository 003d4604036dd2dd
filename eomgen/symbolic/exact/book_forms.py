"""A scalar -> the same as the author of a textbook prints it; decided by its length as a person reads it.

What multiplies one product of accelerations, rates and multipliers stands in one parenthesis, in factors:

    (M + m)*X'' + m*cos(alpha)*s'',    R*(4 + 9*cos(theta)^2)*theta'',    (a + b)*(G + 2*P)/(2*h)

A coefficient is multiplied out or in factors, whichever is shorter; where they are equally long it is in factors. All
is made from the normal form, so the result depends on the function alone and made again it stays as it is. All work is
counted: a long sum is only collected.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterator, Mapping, Sequence
from typing import Any

from eomgen.frozen import dataclass
from eomgen.symbolic.exact.expansion import Expansion, expanded
from eomgen.symbolic.exact.normal_forms import in_whole_numbers, normal_form, quotients, readable, rebuilt_as_written
from eomgen.symbolic.exact.quotient import by_parameters, in_half_angles, reduced
from eomgen.symbolic.exact.sums import BRACKETS, LARGEST_RATIO, MOST_NESTED, CollectedSums, SumParts, with_squares
from eomgen.symbolic.exact.terms import (
    Key,
    Monomial,
    Terms,
    TooLarge,
    common_monomial,
    common_number,
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
    symbols_of,
    tidy,
)
from eomgen.symbolic.numeric import Work
from eomgen.symbolic.print import Product, decimal_of, has_nested_quotient, length_of, terms, text_size, to_text

LONGEST = 3000  # characters of a quotient that is written anew
AGAIN = 3  # times that a quotient is written anew, until it stays as it is


def book_form(
    x: Scalar,
    limit: int = Work.ENTRY,
    positive: Collection[Node] = (),
    *,
    most: int | None = None,
    roots: Sequence[Node] = (),
    squares: bool = False,
) -> Scalar:
    """x as the author of a textbook prints it; x itself where that takes more than `limit` products of terms.

    Args:
        positive: symbols that stand for positive numbers.
        most: terms of what is written.
        roots: symbols of `Rooted`: what is divided by them is not multiplied out.
        squares: sums of parameters may stand before squares of sums that are left, where that is shorter.
    Raises:
        TooLarge: more than `most` terms, where that is given, or more work to count them.
    """
    if type(x) is not Node:
        return x
    if roots:
        if most is not None and len(normal_form(x, limit).terms) > most:
            raise TooLarge(f"more than {most} terms")
        return readable_over(x, roots, limit, positive)
    short = _in_book_form(x, limit, positive, most)
    left = with_squares(x, limit, positive) if squares else short
    return left if length_of(left) + BRACKETS < length_of(short) else short


def _in_book_form(x: Node, limit: int, positive: Collection[Node], most: int | None) -> Scalar:
    form, settled = _written(x, limit, positive, most=most)
    if settled or text_size(form) > LONGEST:
        return form
    found, texts = [form], [to_text(form)]
    for _ in range(AGAIN):  # a sum of quotients may be parted in several ways: the shortest that it comes back to
        form, _ = _written(rebuilt_as_written(found[-1]), limit, positive)
        text = to_text(form)
        if text in texts:
            cycle = list(zip(found, texts, strict=True))[texts.index(text) :]
            return min(cycle, key=lambda each: (_length(each[0]), each[1]))[0]
        found.append(form)
        texts.append(text)
    return found[-1]


def _written(x: Scalar, limit: int, positive: Collection[Node], *, most: int | None = None) -> tuple[Scalar, bool]:
    """(the shortest of its forms, True if that depends on the function alone and not on how the sum was split)."""
    try:
        expansion, (found,) = expanded((x,), limit, positive)
    except TooLarge:
        if most is not None:
            raise
        return x, True
    if most is not None and len(found) > most:
        raise TooLarge(f"a sum of more than {most} terms")
    try:
        terms = {key: found[key] for key in sorted(found)}  # whatever was written before
        writer = Writer(expansion)
        book = CollectedSums(expansion, writer)
        parted = any(e < 0 and atom in expansion.atoms.opaque for monomial, _ in terms for atom, e in monomial)
        divided = any(e < 0 for monomial, _ in terms for _, e in monomial)
        divided = parted or (divided and len(terms) <= MOST_NESTED)
        forms = _quotients(expansion, writer, book, terms) if divided else []
        whole = len(forms)
        forms.append(book.sum(book.coordinates_first(_parts(writer, terms))))
        if any(expansion.atoms.is_a(atom, "sqrt") for monomial, _ in terms for atom, _ in monomial):
            forms += map(rebuilt_as_written, quotients(expansion, writer, terms))
    except TooLarge:
        return x, True
    if divided:
        forms += _of_its_parameters(expansion, writer, book, terms)
    best = min(range(len(forms)), key=lambda k: _length(forms[k]))
    form, settled = _roots_read(forms[best], limit, positive), not parted or best < whole
    other = _roots_as_letters(x, limit, positive) if type(x) is Node else None
    return (form if other is None or _length(other) >= _length(form) else other), settled


def _roots_as_letters(x: Node, limit: int, positive: Collection[Node]) -> Scalar | None:
    """x with each root of a sum as one letter, and its square where a divisor is its sum: r*l/sqrt(l^2 - r^2).

    None where there are none.
    """
    every = order((x,)) if holds_op(x, "sqrt") else []
    roots = [node for node in every if node.op == "sqrt" and _is_sum(node.args[0])]
    inner = {node for root in roots for node in order((root.args[0],))}
    graph: Any = x.graph
    letters, known = dict[Node, Node](), dict[Node, Scalar]()
    try:
        for k, root in enumerate(each for each in roots if each not in inner):
            number, inside = _without_number(root.args[0], limit, positive)
            rest = graph.sqrt(inside)
            if type(rest) is not Node or rest.op != "sqrt":  # the number was all of it
                continue
            letter = graph.symbol(f"root {k}")
            letters[letter] = rest
            known[root] = graph.mul(graph.sqrt(number), letter)
    except TooLarge:
        return None
    if not letters:
        return None
    for below in (node.args[1] for node in every if node.op == "div" and _is_sum(node.args[1])):
        for letter, root in letters.items():
            ratio, _ = _written(graph.div(below, root.args[0]), limit, positive)
            if not symbols_of((ratio,)):
                known.setdefault(below, graph.mul(ratio, graph.mul(letter, letter)))
    (lettered,) = substituted((x,), known)
    form, _ = _written(lettered, limit, (*positive, *letters))
    return substituted((form,), letters)[0]


def _without_number(x: Node, limit: int, positive: Collection[Node]) -> tuple[Number, Scalar]:
    """(number, rest) of a sum: the number that leaves the shortest rest.

    Twice the common one is tried, too: what is expanded holds squares of sines as sums of cosines.
    """
    _, (terms,) = expanded((x,), limit, positive)
    common = abs(Fraction(common_number(terms.values())))
    graph: Any = x.graph
    read = {n: _written(graph.div(x, tidy(n)), limit, positive)[0] for n in (Fraction(1), common, 2 * common)}
    number = min(read, key=lambda n: _length(read[n]))
    return tidy(number), read[number]


def _is_sum(x: Scalar) -> bool:
    return type(x) is Node and x.op in ("add", "sub")


def _roots_read(x: Scalar, limit: int, positive: Collection[Node]) -> Scalar:
    """x with what stands under its roots in book form, too."""
    if not holds_op(x, "sqrt"):
        return x
    inside = [node.args[0] for node in order((x,)) if node.op == "sqrt" and type(node.args[0]) is Node]
    if not inside:
        return x
    read = substituted((x,), {f: book_form(f, limit, positive) for f in inside})[0]
    return read if _length(read) < _length(x) else x


def _length(x: Scalar) -> float:
    """A quotient within a quotient counts as half as long again."""
    return length_of(x) * (1.5 if has_nested_quotient(x) else 1)


def _of_its_parameters(expansion: Expansion, writer: Writer, book: CollectedSums, terms: Terms) -> list[Scalar]:
    """The sum with one quotient for each parameter that it is linear in, where there are several."""
    try:
        found = by_parameters(expansion, terms, lambda f: _quotient(expansion, writer, book, f), book.added)
    except TooLarge:
        return []
    return [] if found is None else [found]


def _quotient(expansion: Expansion, writer: Writer, book: CollectedSums, terms: Terms) -> Scalar:
    """numerator / denominator, without common factor."""
    return _quotients(expansion, writer, book, terms)[0]


def _quotients(expansion: Expansion, writer: Writer, book: CollectedSums, terms: Terms) -> list[Scalar]:
    """numerator / denominator, without common factor; the same in half angles, and in tangents of one that rests."""
    quotient = reduced(expansion, terms)
    halves = in_half_angles(expansion, *quotient)
    forms = []
    for found in (quotient, halves):
        if found is not None:
            above, below = _as_measured(*(_parts(writer, part) for part in in_whole_numbers(writer, *found)))
            forms += [(above, below), *book.in_tangents(above, below)]
    return [expansion.graph.div(book.product(above), book.product(below)) for above, below in forms]


def _as_measured(above: SumParts, below: SumParts) -> tuple[SumParts, SumParts]:
    """(0.0041*m - 0.0284*n)/b, and not (41*m - 284*n)/(10000*b)."""
    number = common_number(c for c, _ in below)
    over = [(tidy(Fraction(c) / number), powers) for c, powers in above]
    if all(decimal_of(c) is None for c, _ in over) or not any(abs(Fraction(c)) > LARGEST_RATIO for c, _ in above):
        return above, below
    return over, [(tidy(Fraction(c) / number), powers) for c, powers in below]


def _parts(writer: Writer, terms: Terms) -> SumParts:
    return [
        (c, (*monomial, *(((kind, angle), e) for kind, angle, e in factors)))
        for c, monomial, factors in writer.written(terms)
    ]


# -------- roots of sums --------------------------------------------------------------------------------------
# Expressions with square roots of sums -> the same with a symbol for each root, written shortly, and back.
# The length of a spring is such a root. Multiplied out with the root as one symbol r, its force keeps its form,
# k*(1 - l0/r)*(x2 - x1), and nothing is made rational that was not.


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

    @staticmethod
    def of(expressions: Sequence[Scalar], limit: int) -> Rooted:
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
        candidates = {
            node for node in _above(nodes, is_root_of_sum) & _above(nodes, is_rate) - added if node.op in ADDED
        }
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

    def back(self, expressions: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """The expressions with the roots themselves."""
        known: dict[Node, Scalar] = {}
        for symbol, value in self.roots:
            known[symbol] = substituted((value,), known)[0]
        return substituted(expressions, known) if known else tuple(expressions)


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
        {base for base, _ in Product.of(1 if term is None else term).denominator if base in roots}
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
