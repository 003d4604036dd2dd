"""A scalar -> the same as the author of a textbook prints it; decided by its length as a person reads it.

What multiplies one product of accelerations, rates and multipliers stands in one parenthesis, in factors:

    (M + m)*X'' + m*cos(alpha)*s'',    R*(4 + 9*cos(theta)^2)*theta'',    (a + b)*(G + 2*P)/(2*h)

A coefficient is multiplied out or in factors, whichever is shorter; where they are equally long it is in factors. All
is made from the normal form, so the result depends on the function alone and made again it stays as it is. All work is
counted: a long sum is only collected.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import field
from typing import Any

from eomgen.records import dataclass
from eomgen.symbolic.exact.by_parameters import by_parameters
from eomgen.symbolic.exact.expansion import Expansion, expanded
from eomgen.symbolic.exact.normal_form import in_whole_numbers, quotients
from eomgen.symbolic.exact.quotient import in_half_angles, reduced
from eomgen.symbolic.exact.rational_polynomial import RationalPolynomial
from eomgen.symbolic.exact.terms import AngleSum, Terms, TooLarge, common_number
from eomgen.symbolic.exact.writing import Writer
from eomgen.symbolic.expression.derivative import substituted, symbols_of
from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Node, Number, Scalar
from eomgen.symbolic.expression.node import holds_op
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.decimals import decimal_of
from eomgen.symbolic.print.layout import is_base, rebuilt_as_written
from eomgen.symbolic.print.length import length_of
from eomgen.symbolic.print.printed import has_nested_quotient
from eomgen.symbolic.print.text import text_size, to_text

MOST_FACTORED = 40  # terms of a sum that is looked through for factors
MOST_NESTED = 8  # terms of a sum of which several factors are tried outside of parts: a + b*(c + d); of longer ones one
LARGEST_DEGREE = 16  # of a sum that is looked through for factors
BRACKETS = 1  # marks that a sum may be longer in factors: (M + m)*g is M*g + m*g
DEEPER = 10  # marks that parentheses within parentheses must save
INSIDE = 1  # marks that a number must save in the parentheses before which it stands: (1/3*m1 + m2)*l1^2
LARGEST_RATIO = 99  # of two decimals that stand as whole numbers behind a common one: 0.02*(2*a + b)
MERGED = 6  # marks that one coefficient of several accelerations and rates must save
MOST_SHARED = 3  # factors that several terms of a sum hold, of which each is tried outside of them
LONGEST = 3000  # characters of a quotient that is written anew
AGAIN = 3  # times that a quotient is written anew, until it stays as it is
MOST_TRIED = 150  # sums that are formed for one scalar in search of shorter ones

Base = int | tuple[str, AngleSum]  # an atom, or the sine or cosine of an angle
Powers = tuple[tuple[Base, int], ...]  # in the order in which they were met; exponents may be negative
Part = tuple[Number, Powers]
Parts = list[Part]


def book_form(x: Scalar, limit: int = Work.ENTRY, positive: Collection[Node] = ()) -> Scalar:
    """x as the author of a textbook prints it; x itself where that takes more than `limit` products of terms.

    Args:
        positive: symbols that stand for positive numbers.
    """
    if type(x) is not Node:
        return x
    form, settled = _written(x, limit, positive)
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


def _written(x: Scalar, limit: int, positive: Collection[Node]) -> tuple[Scalar, bool]:
    """(the shortest of its forms, whether it is that of the function and not of how the sum was parted)."""
    try:
        expansion, (found,) = expanded((x,), limit, positive)
        terms = {key: found[key] for key in sorted(found)}  # whatever was written before
        writer = Writer(expansion)
        book = _Book(expansion, writer)
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


def _of_its_parameters(expansion: Expansion, writer: Writer, book: _Book, terms: Terms) -> list[Scalar]:
    """The sum with one quotient for each parameter that it is linear in, where there are several."""
    try:
        found = by_parameters(expansion, terms, lambda f: _quotient(expansion, writer, book, f), book.added)
    except TooLarge:
        return []
    return [] if found is None else [found]


def _quotient(expansion: Expansion, writer: Writer, book: _Book, terms: Terms) -> Scalar:
    """numerator / denominator, without common factor."""
    return _quotients(expansion, writer, book, terms)[0]


def _quotients(expansion: Expansion, writer: Writer, book: _Book, terms: Terms) -> list[Scalar]:
    """numerator / denominator, without common factor; the same in half angles, and in tangents of one that rests."""
    quotient = reduced(expansion, terms)
    halves = in_half_angles(expansion, *quotient)
    forms = []
    for found in (quotient, halves):
        if found is not None:
            above, below = _as_measured(*(_parts(writer, part) for part in in_whole_numbers(writer, *found)))
            forms += [(above, below), *book.in_tangents(above, below)]
    return [expansion.graph.div(book.product(above), book.product(below)) for above, below in forms]


def _as_measured(above: Parts, below: Parts) -> tuple[Parts, Parts]:
    """(0.0041*m - 0.0284*n)/b, and not (41*m - 284*n)/(10000*b)."""
    number = common_number(c for c, _ in below)
    over = [(tidy(Fraction(c) / number), powers) for c, powers in above]
    if all(decimal_of(c) is None for c, _ in over) or not any(abs(Fraction(c)) > LARGEST_RATIO for c, _ in above):
        return above, below
    return over, [(tidy(Fraction(c) / number), powers) for c, powers in below]


def _in_tangents(parts: Parts, angle: AngleSum) -> Parts:
    """sin(x)^i*cos(x)^j as tan(x)^i, in each of the terms."""
    as_tangent: dict[Base, Base] = {("sin", angle): ("tan", angle)}
    return [
        (c, tuple((as_tangent.get(base, base), e) for base, e in powers if base != ("cos", angle)))
        for c, powers in parts
    ]


def _parts(writer: Writer, terms: Terms) -> Parts:
    return [
        (c, (*monomial, *(((kind, angle), e) for kind, angle, e in factors)))
        for c, monomial, factors in writer.written(terms)
    ]


@dataclass(frozen=True)
class _Book:
    """Writes sums of products of powers."""

    expansion: Expansion
    writer: Writer
    tried: Counter[str] = field(default_factory=Counter)
    known: dict[tuple[Part, ...], Scalar] = field(default_factory=dict)  # each sum is collected once
    terms: dict[Part, Scalar] = field(default_factory=dict)

    def sum(self, parts: Parts) -> Scalar:
        """The sum, collected, with what all terms hold before it where that is shorter."""
        if len(parts) < 2:
            return self._term(*parts[0]) if parts else 0
        number, common, rest = _without_common(parts)
        apart = self._collected(parts)
        if len(parts) > MOST_FACTORED or (number == 1 and not common and not self._may_factor(rest)):
            return apart
        whole = self._times(number, common, self._factors(rest))
        free = BRACKETS if common else 0
        deeper = DEEPER * max(0, _depth(whole) - max(1, _depth(apart)))
        return whole if length_of(whole) + deeper <= length_of(apart) + free else apart

    def coordinates_first(self, parts: Parts) -> Parts:
        """As places are read, X + s*cos(alpha) + R*sin(alpha); the same order where all terms share something."""
        if _without_common(parts)[1]:
            return parts
        return sorted(
            parts, key=lambda part: not any(isinstance(base, int) and self._moves(base) for base, _ in part[1])
        )

    def product(self, parts: Parts) -> Scalar:
        """The sum in factors, what all terms hold before it."""
        if len(parts) < 2:
            return self.sum(parts)
        number, common, rest = _without_common(parts)
        return self._times(number, common, self._factors(rest))

    def _times(self, number: Number, common: Powers, factors: Sequence[tuple[Parts, int]]) -> Scalar:
        """number * common * factors, a minus in front only where no factor can take it."""
        for part, e in factors:
            if len(part) == 1 and not part[0][1]:
                number = tidy(number * Fraction(part[0][0]) ** e)
        factors = [(part, e) for part, e in factors if len(part) > 1 or part[0][1]]
        minus = number * (-1) ** sum(e for part, e in factors if _is_negative(part)) < 0
        written = [(_turned(part) if _is_negative(part) else part, e) for part, e in factors]
        if minus:
            mixed = [k for k, (part, e) in enumerate(written) if e % 2 and any(c < 0 for c, _ in part)]
            if mixed:
                part, e = written[mixed[0]]
                written[mixed[0]] = (_turned(part), e)
                minus = False
        sign, size = (-1 if minus else 1), abs(Fraction(number))
        apart = self._product(self._term(sign * size, common), written)
        if size.denominator == 1:
            return apart
        inside = next((k for k, (_, e) in enumerate(written) if e == 1), None)
        if inside is None:
            return apart
        written[inside] = ([(tidy(size * c), powers) for c, powers in written[inside][0]], 1)
        within = self._product(self._term(sign, common), written)
        measured = decimal_of(size) is not None and any(
            abs(Fraction(c)) > LARGEST_RATIO for part, _ in factors for c, _ in part
        )
        return within if measured or length_of(within) + INSIDE < length_of(apart) else apart

    def _product(self, total: Scalar, factors: Sequence[tuple[Parts, int]]) -> Scalar:
        graph = self.writer.graph
        for part, e in factors:
            total = graph.mul(total, graph.pow(self._collected(part), e))
        return total

    def _collected(self, parts: Parts) -> Scalar:
        """The sum with one term for each product of what accelerates and turns, each coefficient at its shortest."""
        if len(parts) < 2:
            return self.sum(parts)
        key = tuple(parts)
        if key not in self.known:
            self.known[key] = self._by_what_moves(parts)
        return self.known[key]

    def _by_what_moves(self, parts: Parts) -> Scalar:
        groups = _grouped(parts, self._is_kinetic)
        if not any(groups):
            return self._still(parts)
        apart = self.added([self._with(key, part) for key, part in groups.items()])
        if not 1 < len(groups) <= len(parts) <= MOST_FACTORED:
            return apart
        forms = [form for form in (self._merged(groups), self._by_coefficients(parts)) if form is not None]
        best = min(forms, key=length_of, default=apart)
        return best if length_of(best) + MERGED <= length_of(apart) else apart

    def _merged(self, groups: Mapping[Powers, Parts]) -> Scalar | None:
        """coefficient*(a sum of what moves) for all that has the same coefficient: m*l*(cos(q)*q'' - sin(q)*q'^2)."""
        sums: dict[tuple[Powers, tuple[Part, ...]], Parts] = {}
        for key, part in groups.items():
            number, common, rest = _without_common(part)
            still = tuple(sorted((item for item in common if not self._moves(item[0])), key=repr))
            moving = tuple(item for item in common if item not in still)
            sums.setdefault((still, tuple(rest)), []).append((number, _times_powers(moving, key)))
        if len(sums) == len(groups) or ((), ((1, ()),)) in sums:
            return None
        terms = []
        for (still, alike), inside in sums.items():
            number, common, left = _without_common(inside)
            factors = [*self._factors(list(alike)), *self._factors(left)]
            terms.append(self._times(number, _times_powers(still, common), factors))
        return self.added(terms)

    def _by_coefficients(self, parts: Parts) -> Scalar | None:
        """coefficient*(what moves), each sum of what moves once: m*b*(sin(a)*(p'' + q'') + cos(a)*(p' + q')^2)."""
        parameters = _grouped(parts, lambda base: not self._moves(base))
        groups = parameters if len(parameters) > 1 else _grouped(parts, lambda base: not self._is_kinetic(base))
        if not 1 < len(groups) < len(parts):
            return None
        sums: dict[tuple[Powers, tuple[Part, ...]], Parts] = {}
        for key, inside in groups.items():
            number, common, rest = _without_common(inside)
            sums.setdefault((common, tuple(rest)), []).append((number, key))
        terms = []
        for (common, moving), coefficients in sums.items():
            number, still, rest = _without_common(coefficients)
            factors = [*self._factors(rest), *self._factors(list(moving))]
            terms.append(self._times(number, _times_powers(still, common), factors))
        return self.added(terms)

    def _with(self, key: Powers, part: Parts) -> Scalar:
        """coefficient * key"""
        if len(part) == 1:
            return self._term(part[0][0], _times_powers(part[0][1], key))
        if not key:
            return self.sum(part)
        number, common, rest = _without_common(part)
        return self._times(number, _times_powers(common, key), self._factors(rest))

    def _still(self, parts: Parts) -> Scalar:
        """A sum in which nothing has a rate: with one term for each product of what moves, or as it is."""
        apart = self.added([self._term(c, powers) for c, powers in parts])
        if len(parts) > MOST_FACTORED:
            return apart
        forms = []
        for chosen in (self._moves, self._is_root):
            groups = _grouped(parts, chosen)
            if 1 < len(groups) < len(parts):
                forms.append(self.added([self._with(key, part) for key, part in groups.items()]))
        if len(parts) > 2:
            forms += self._nested(parts)
        best = min(forms, key=length_of, default=apart)
        return best if length_of(best) <= length_of(apart) else apart

    def _nested(self, parts: Parts) -> list[Scalar]:
        """factor*(...) + ..., for each factor or divisor that several terms hold and not all; of long sums for one.

        Of a short sum only the highest power is taken out: a^2 + 2*a*b + c reads better than a*(a + 2*b) + c.
        """
        long = len(parts) > MOST_NESTED
        highest: dict[Base, int] = {}
        for base, e in (item for _, powers in parts for item in powers):
            highest[base] = max(e, highest.get(base, 0))
        held: dict[tuple[Base, bool], Parts] = {}
        for part in parts:
            for base, e in part[1]:
                if long or e < 0 or e == highest[base]:
                    held.setdefault((base, e > 0), []).append(part)
        shared = [inside for inside in held.values() if 1 < len(inside) < len(parts)]
        found = []
        for inside in sorted(shared, key=len, reverse=True)[: 1 if long else MOST_SHARED]:
            self.tried["sums"] += 1
            if self.tried["sums"] <= MOST_TRIED:
                place = parts.index(inside[0])
                pieces = [[x for x in part if x not in inside] for part in (parts[:place], parts[place:])]
                before, after = ([self.sum(piece)] if piece else [] for piece in pieces)
                found.append(self.added([*before, self.product(inside), *after]))
        return found

    # -- factors ------------------------------------------------------------------------------

    def _may_factor(self, parts: Parts) -> bool:
        return len(self._factors(parts)) > 1

    def _factors(self, parts: Parts) -> list[tuple[Parts, int]]:
        """Irreducible factors of a sum as a polynomial in its bases, and their powers; the sum itself where none is."""
        if len(parts) > MOST_FACTORED or any(e < 0 for _, powers in parts for _, e in powers):
            return [(parts, 1)]
        bases = list(dict.fromkeys(base for _, powers in parts for base, _ in powers))
        place = {base: k for k, base in enumerate(bases)}
        polynomial: dict[tuple[int, ...], Number] = {}
        for c, powers in parts:
            exponents = [0] * len(bases)
            for base, e in powers:
                exponents[place[base]] += e
            polynomial[tuple(exponents)] = c
        f = RationalPolynomial.of(polynomial)
        if f.degree > LARGEST_DEGREE or f.is_number:
            return [(parts, 1)]
        number, found = f.factors()
        if len(found) == 1 and found[0][1] == 1:
            return [(parts, 1)]
        met = {exponents: k for k, exponents in enumerate(polynomial)}
        factors: list[tuple[Parts, int]] = []
        for part, n in found:
            written = [
                (c, tuple((base, e) for base, e in zip(bases, exponents, strict=True) if e))
                for exponents, c in sorted(part.terms, key=lambda item: met.get(item[0], len(met)))
            ]
            factors.append((written, n))
        return [([(number, ())], 1), *factors] if number != 1 else factors

    def in_tangents(self, above: Parts, below: Parts) -> list[tuple[Parts, Parts]]:
        """Both over cos(x)^n: a*sin(x)^2/(a*sin(x)^2 + b*cos(x)^2) is a*tan(x)^2/(a*tan(x)^2 + b)."""
        held = [powers for _, powers in (*above, *below)]
        if len(below) > 1:
            for base in dict.fromkeys(base for powers in held for base, _ in powers):
                if not isinstance(base, int) and not self._moves(base):
                    both = (("sin", base[1]), ("cos", base[1]))
                    if len({sum(e for b, e in powers if b in both) for powers in held}) == 1:
                        return [(_in_tangents(above, base[1]), _in_tangents(below, base[1]))]
        return []

    # -- nodes --------------------------------------------------------------------------------

    def _term(self, c: Number, powers: Powers) -> Scalar:
        """c * powers; sin(a)*cos(a) as sin(2*a)/2 where that is shorter."""
        if (c, powers) not in self.terms:
            self.terms[c, powers] = self._shorter_term(c, powers)
        return self.terms[c, powers]

    def _shorter_term(self, c: Number, powers: Powers) -> Scalar:
        plain = self._product_of(c, powers)
        doubled = _doubled(c, powers)
        if doubled is None:
            return plain
        double = self._product_of(*doubled)
        return double if length_of(double) < length_of(plain) else plain

    def _product_of(self, c: Number, powers: Powers) -> Scalar:
        monomial = tuple(sorted((base, e) for base, e in powers if isinstance(base, int)))
        factors = tuple((*base, e) for base, e in powers if not isinstance(base, int))
        return self.writer.term(tidy(c), monomial, factors)

    def added(self, terms: Sequence[Scalar]) -> Scalar:
        """The sum in this order, a term without a minus first; as written, whatever was written before."""
        graph = self.writer.graph
        signed = [(_has_minus(x), _bare(x)) for x in terms]
        first = next((k for k, (minus, _) in enumerate(signed) if not minus), None)
        if first is None:
            return graph.neg(self.added([x for _, x in signed]))
        total = signed[first][1]
        for minus, x in (*signed[:first], *signed[first + 1 :]):
            if type(total) is Node and type(x) is Node:
                total = graph.held("sub" if minus else "add", (total, x))
            else:
                total = graph.add(total, graph.neg(x) if minus else x)
        return total

    def _is_kinetic(self, base: Base) -> bool:
        node = self.expansion.atoms.nodes.get(base) if isinstance(base, int) else None
        return node is not None and node.op == "symbol" and (node.name.endswith("'") or node.name.startswith("lam("))

    def _is_root(self, base: Base) -> bool:
        return isinstance(base, int) and self.expansion.atoms.is_a(base, "sqrt")

    def _moves(self, base: Base) -> bool:
        graph, nodes = self.expansion.graph, self.expansion.atoms.nodes
        if isinstance(base, int):
            return base >= 0 and not graph.is_constant(nodes[base])
        return any(angle >= 0 and not graph.is_constant(nodes[angle]) for angle, _ in base[1])


def _doubled(c: Number, powers: Powers) -> Part | None:
    """c*sin(a)^n*cos(a)^n as c/2^n*sin(2*a)^n; None where no angle has both."""
    exponents = dict(powers)
    for (kind, angle), e in ((base, e) for base, e in powers if not isinstance(base, int)):
        if kind == "sin" and e > 0 and exponents.get(("cos", angle)) == e:
            twice: Base = ("sin", tuple((a, 2 * k) for a, k in angle))
            rest = _times_powers(powers, ((("sin", angle), -e), (("cos", angle), -e), (twice, e)))
            return tidy(Fraction(c) / 2**e), rest
    return None


def _depth(x: Scalar) -> int:
    """How many parentheses stand within one another, those of functions not counted."""
    depths: dict[Node, int] = {}
    for node in order((x,)):
        bracketed = node.op in ("mul", "div", "pow")
        inside = [depths[a] + (bracketed and a.op in ("add", "sub")) for a in node.args if type(a) is Node]
        depths[node] = 0 if is_base(node) else max(inside, default=0)
    return depths[x] if type(x) is Node else 0


def _has_minus(x: Scalar) -> bool:
    return x.op == "neg" if type(x) is Node else x < 0


def _bare(x: Scalar) -> Scalar:
    if type(x) is not Node:
        return -x if x < 0 else x
    return x.args[0] if x.op == "neg" else x


def _is_negative(parts: Parts) -> bool:
    return all(c < 0 for c, _ in parts)


def _turned(parts: Parts) -> Parts:
    return [(-c, powers) for c, powers in parts]


def _grouped(parts: Parts, chosen: Callable[[Base], bool]) -> dict[Powers, Parts]:
    """The terms by the product of their chosen bases, without it; in the order in which it is first met."""
    groups: dict[Powers, Parts] = {}
    for c, powers in parts:
        key = tuple(sorted((item for item in powers if chosen(item[0])), key=repr))
        groups.setdefault(key, []).append((c, tuple(item for item in powers if item not in key)))
    return groups


def _times_powers(a: Powers, b: Powers) -> Powers:
    exponents = dict(a)
    for base, e in b:
        exponents[base] = exponents.get(base, 0) + e
    return tuple((base, e) for base, e in exponents.items() if e)


def _without_common(parts: Parts) -> tuple[Number, Powers, Parts]:
    """(number, powers, rest): what all terms hold, and what is left of them; a negative number if all are."""
    number: Number = common_number(c for c, _ in parts)
    if decimal_of(number) is not None and any(abs(Fraction(c)) != number for c, _ in parts):
        number = 1  # of 0.00018125 and 0.000161 nobody takes out 2.5e-7
    number = -number if _is_negative(parts) else number
    bases: Iterable[Base] = dict.fromkeys(base for _, powers in parts for base, _ in powers)
    exponents = [dict(powers) for _, powers in parts]
    lowest = {base: min(each.get(base, 0) for each in exponents) for base in bases}
    # the root of a number has no inverse that is one
    common = tuple((base, e) for base, e in lowest.items() if e and not (isinstance(base, int) and base < 0))
    inverted = tuple((base, -e) for base, e in common)
    rest = [(tidy(Fraction(c) / Fraction(number)), _times_powers(powers, inverted)) for c, powers in parts]
    return tidy(number), common, rest
