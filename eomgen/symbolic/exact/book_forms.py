"""A scalar -> the same as the author of a textbook prints it; decided by its length as a person reads it.

What multiplies one product of accelerations, rates and multipliers stands in one parenthesis, in factors:

    (M + m)*X'' + m*cos(alpha)*s'',    R*(4 + 9*cos(theta)^2)*theta'',    (a + b)*(G + 2*P)/(2*h)

A coefficient is multiplied out or in factors, whichever is shorter; where they are equally long it is in factors. All
is made from the normal form, so the result depends on the function alone and made again it stays as it is. All work is
counted: a long sum is only collected.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from eomgen.symbolic.exact.expansion import Expansion, expanded
from eomgen.symbolic.exact.normal_forms import in_whole_numbers, quotients
from eomgen.symbolic.exact.quotient import by_parameters, in_half_angles, reduced
from eomgen.symbolic.exact.sums import LARGEST_RATIO, MOST_NESTED, CollectedSums, SumParts
from eomgen.symbolic.exact.terms import Terms, TooLarge, common_number
from eomgen.symbolic.exact.writing import Writer
from eomgen.symbolic.expression import Fraction, Node, Number, Scalar, holds_op, order, substituted, symbols_of, tidy
from eomgen.symbolic.numeric import Work
from eomgen.symbolic.print import decimal_of, has_nested_quotient, length_of, rebuilt_as_written, text_size, to_text

LONGEST = 3000  # characters of a quotient that is written anew
AGAIN = 3  # times that a quotient is written anew, until it stays as it is


def book_form(
    x: Scalar, limit: int = Work.ENTRY, positive: Collection[Node] = (), *, most: int | None = None
) -> Scalar:
    """x as the author of a textbook prints it; x itself where that takes more than `limit` products of terms.

    Args:
        positive: symbols that stand for positive numbers.
        most: terms of what is written.
    Raises:
        TooLarge: more than `most` terms, where that is given, or more work to count them.
    """
    if type(x) is not Node:
        return x
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
