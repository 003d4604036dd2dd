"""A sum as a person collects it: in factors, in parentheses, squares as squares."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import field
from typing import Any, TypeVar

from eomgen.frozen import dataclass
from eomgen.symbolic.exact.expansion import Expansion, expanded
from eomgen.symbolic.exact.polynomials import RationalPolynomial
from eomgen.symbolic.exact.quotient import powers_in, reduced
from eomgen.symbolic.exact.terms import (
    ONE,
    AngleSum,
    Monomial,
    Terms,
    TooLarge,
    common_number,
    content,
    terms_scaled,
    terms_times,
)
from eomgen.symbolic.exact.writing import Writer
from eomgen.symbolic.expression import Fraction, Node, Number, Scalar, order, tidy
from eomgen.symbolic.numeric import Work
from eomgen.symbolic.print import decimal_of, is_base, length_of

# -------- sum parts -------------------------------------------------------------------------------------------
# A sum as a list of parts, each a number times powers: what they have in common, and how they are grouped.
#
# part = c * product of base^exponent,   base: an atom of an expansion, or the sine or cosine of an angle


Base = int | tuple[str, AngleSum]  # an atom, or the sine or cosine of an angle
Powers = tuple[tuple[Base, int], ...]  # in the order in which they were met; exponents may be negative
SumPart = tuple[Number, Powers]
SumParts = list[SumPart]


def doubled(c: Number, powers: Powers) -> SumPart | None:
    """c*sin(a)^n*cos(a)^n as c/2^n*sin(2*a)^n; None where no angle has both."""
    exponents = dict(powers)
    for (kind, angle), e in ((base, e) for base, e in powers if not isinstance(base, int)):
        if kind == "sin" and e > 0 and exponents.get(("cos", angle)) == e:
            twice: Base = ("sin", tuple((a, 2 * k) for a, k in angle))
            rest = times_powers(powers, ((("sin", angle), -e), (("cos", angle), -e), (twice, e)))
            return tidy(Fraction(c) / 2**e), rest
    return None


def is_negative(parts: SumParts) -> bool:
    """True if every part has a minus."""
    return all(c < 0 for c, _ in parts)


def negated(parts: SumParts) -> SumParts:
    """Minus the sum."""
    return [(-c, powers) for c, powers in parts]


def grouped_by(parts: SumParts, chosen: Callable[[Base], bool]) -> dict[Powers, SumParts]:
    """The terms by the product of their chosen bases, without it; in the order in which it is first met."""
    groups: dict[Powers, SumParts] = {}
    for c, powers in parts:
        key = tuple([item for item in powers if chosen(item[0])])
        rest = tuple([item for item in powers if item not in key]) if key else powers
        groups.setdefault(tuple(sorted(key, key=repr)) if len(key) > 1 else key, []).append((c, rest))
    return groups


def times_powers(a: Powers, b: Powers) -> Powers:
    """a b, without what cancels."""
    if not b:
        return a
    exponents = dict(a)
    for base, e in b:
        exponents[base] = exponents.get(base, 0) + e
    return tuple((base, e) for base, e in exponents.items() if e)


def without_common(parts: SumParts) -> tuple[Number, Powers, SumParts]:
    """(number, powers, rest): what all terms hold, and what is left of them; a negative number if all are."""
    number: Number = common_number(c for c, _ in parts)
    if decimal_of(number) is not None and any(abs(Fraction(c)) != number for c, _ in parts):
        number = 1  # of 0.00018125 and 0.000161 nobody takes out 2.5e-7
    number = -number if is_negative(parts) else number
    lowest: dict[Base, int] = {}
    terms: dict[Base, int] = {}  # that hold the base
    for _, powers in parts:
        for base, e in powers:
            lowest[base] = min(lowest.get(base, e), e)
            terms[base] = terms.get(base, 0) + 1
    lowest = {base: e if terms[base] == len(parts) else min(e, 0) for base, e in lowest.items()}
    # the root of a number has no inverse that is one
    common = tuple((base, e) for base, e in lowest.items() if e and not (isinstance(base, int) and base < 0))
    inverted = tuple((base, -e) for base, e in common)
    rest = [
        (c if number == 1 else tidy(Fraction(c) / Fraction(number)), times_powers(powers, inverted))
        for c, powers in parts
    ]
    return tidy(number), common, rest


def in_tangents_of(parts: SumParts, angle: AngleSum) -> SumParts:
    """sin(x)^i*cos(x)^j as tan(x)^i, in each of the terms."""
    as_tangent: dict[Base, Base] = {("sin", angle): ("tan", angle)}
    return [
        (c, tuple((as_tangent.get(base, base), e) for base, e in powers if base != ("cos", angle)))
        for c, powers in parts
    ]


# -------- collected sums --------------------------------------------------------------------------------------
# SumParts -> the sum as a person collects it: in factors, in parentheses, each coefficient at its shortest.
#
# (M + m)*X'' + m*cos(alpha)*s'',    m*l*(cos(q)*q'' - sin(q)*q'^2),    a^2 + 2*a*b + c


MOST_FACTORED = 40  # terms of a sum that is looked through for factors
MOST_NESTED = 8  # terms of a sum of which several factors are tried outside of parts: a + b*(c + d); of longer ones one
LARGEST_DEGREE = 16  # of a sum that is looked through for factors
BRACKETS = 1  # marks that a sum may be longer in factors: (M + m)*g is M*g + m*g
DEEPER = 10  # marks that parentheses within parentheses must save
INSIDE = 1  # marks that a number must save in the parentheses before which it stands: (1/3*m1 + m2)*l1^2
LARGEST_RATIO = 99  # of two decimals that stand as whole numbers behind a common one: 0.02*(2*a + b)
MERGED = 6  # marks that one coefficient of several accelerations and rates must save
MOST_SHARED = 3  # factors that several terms of a sum hold, of which each is tried outside of them
MOST_TRIED = 150  # sums that are formed for one scalar in search of shorter ones

_Form = TypeVar("_Form")


def _once(form: Callable[[CollectedSums, SumParts], _Form]) -> Callable[[CollectedSums, SumParts], _Form]:
    """Caches a form of a sum, so that it is computed once for each sum."""

    def found(book: CollectedSums, parts: SumParts) -> _Form:
        key = (form, *parts)
        if key not in book.known:
            book.known[key] = form(book, parts)
        known: _Form = book.known[key]
        return known

    return found


@dataclass(frozen=True)
class CollectedSums:
    """Writes sums of products of powers."""

    expansion: Expansion
    writer: Writer
    tried: Counter[str] = field(default_factory=Counter)
    known: dict[tuple[Any, ...], Any] = field(default_factory=dict)
    terms: dict[SumPart, Scalar] = field(default_factory=dict)

    @_once
    def sum(self, parts: SumParts) -> Scalar:
        """The sum, collected, with what all terms hold before it where that is shorter."""
        if len(parts) < 2:
            return self._term(*parts[0]) if parts else 0
        number, common, rest = without_common(parts)
        apart = self._collected(parts)
        if len(parts) > MOST_FACTORED or (number == 1 and not common and not self._may_factor(rest)):
            return apart
        whole = self._times(number, common, self._factors(rest))
        free = BRACKETS if common else 0
        deeper = DEEPER * max(0, _depth(whole) - max(1, _depth(apart)))
        return whole if length_of(whole) + deeper <= length_of(apart) + free else apart

    def coordinates_first(self, parts: SumParts) -> SumParts:
        """The parts with the coordinates first, X + s*cos(alpha) + R*sin(alpha).

        The order is unchanged where all terms have a common factor.
        """
        if without_common(parts)[1]:
            return parts
        return sorted(
            parts, key=lambda part: not any(isinstance(base, int) and self._moves(base) for base, _ in part[1])
        )

    @_once
    def product(self, parts: SumParts) -> Scalar:
        """The sum in factors, what all terms hold before it."""
        if len(parts) < 2:
            return self.sum(parts)
        number, common, rest = without_common(parts)
        return self._times(number, common, self._factors(rest))

    def _times(self, number: Number, common: Powers, factors: Sequence[tuple[SumParts, int]]) -> Scalar:
        """number * common * factors, a minus in front only where no factor can take it."""
        for part, e in factors:
            if len(part) == 1 and not part[0][1]:
                number = tidy(number * Fraction(part[0][0]) ** e)
        factors = [(part, e) for part, e in factors if len(part) > 1 or part[0][1]]
        minus = number * (-1) ** sum(e for part, e in factors if is_negative(part)) < 0
        written = [(negated(part) if is_negative(part) else part, e) for part, e in factors]
        if minus:
            mixed = [k for k, (part, e) in enumerate(written) if e % 2 and any(c < 0 for c, _ in part)]
            if mixed:
                part, e = written[mixed[0]]
                written[mixed[0]] = (negated(part), e)
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

    def _product(self, total: Scalar, factors: Sequence[tuple[SumParts, int]]) -> Scalar:
        graph = self.writer.graph
        for part, e in factors:
            total = graph.mul(total, graph.pow(self._collected(part), e))
        return total

    @_once
    def _collected(self, parts: SumParts) -> Scalar:
        """The sum with one term for each product of what accelerates and turns, each coefficient at its shortest."""
        if len(parts) < 2:
            return self.sum(parts)
        groups = grouped_by(parts, self._is_kinetic)
        if not any(groups):
            return self._still(parts)
        apart = self.added([self._with(key, part) for key, part in groups.items()])
        if not 1 < len(groups) <= len(parts) <= MOST_FACTORED:
            return apart
        forms = [form for form in (self._merged(groups), self._by_coefficients(parts)) if form is not None]
        best = min(forms, key=length_of, default=apart)
        return best if length_of(best) + MERGED <= length_of(apart) else apart

    def _merged(self, groups: Mapping[Powers, SumParts]) -> Scalar | None:
        """coefficient*(a sum of what moves) for all that has the same coefficient: m*l*(cos(q)*q'' - sin(q)*q'^2)."""
        sums: dict[tuple[Powers, tuple[SumPart, ...]], SumParts] = {}
        for key, part in groups.items():
            number, common, rest = without_common(part)
            still = tuple(sorted((item for item in common if not self._moves(item[0])), key=repr))
            moving = tuple(item for item in common if item not in still)
            sums.setdefault((still, tuple(rest)), []).append((number, times_powers(moving, key)))
        if len(sums) == len(groups) or ((), ((1, ()),)) in sums:
            return None
        terms = []
        for (still, alike), inside in sums.items():
            number, common, left = without_common(inside)
            factors = [*self._factors(list(alike)), *self._factors(left)]
            terms.append(self._times(number, times_powers(still, common), factors))
        return self.added(terms)

    def _by_coefficients(self, parts: SumParts) -> Scalar | None:
        """coefficient*(what moves), each sum of what moves once: m*b*(sin(a)*(p'' + q'') + cos(a)*(p' + q')^2)."""
        parameters = grouped_by(parts, lambda base: not self._moves(base))
        groups = parameters if len(parameters) > 1 else grouped_by(parts, lambda base: not self._is_kinetic(base))
        if not 1 < len(groups) < len(parts):
            return None
        sums: dict[tuple[Powers, tuple[SumPart, ...]], SumParts] = {}
        for key, inside in groups.items():
            number, common, rest = without_common(inside)
            sums.setdefault((common, tuple(rest)), []).append((number, key))
        terms = []
        for (common, moving), coefficients in sums.items():
            number, still, rest = without_common(coefficients)
            factors = [*self._factors(rest), *self._factors(list(moving))]
            terms.append(self._times(number, times_powers(still, common), factors))
        return self.added(terms)

    def _with(self, key: Powers, part: SumParts) -> Scalar:
        """coefficient * key"""
        if len(part) == 1:
            return self._term(part[0][0], times_powers(part[0][1], key))
        if not key:
            return self.sum(part)
        number, common, rest = without_common(part)
        return self._times(number, times_powers(common, key), self._factors(rest))

    def _still(self, parts: SumParts) -> Scalar:
        """A sum in which nothing has a rate: with one term for each product of what moves, or as it is."""
        apart = self.added([self._term(c, powers) for c, powers in parts])
        if len(parts) > MOST_FACTORED:
            return apart
        forms = []
        for chosen in (self._moves, self._is_root):
            groups = grouped_by(parts, chosen)
            if 1 < len(groups) < len(parts):
                forms.append(self.added([self._with(key, part) for key, part in groups.items()]))
        if len(parts) > 2:
            forms += self._nested(parts)
        best = min(forms, key=length_of, default=apart)
        return best if length_of(best) <= length_of(apart) else apart

    def _nested(self, parts: SumParts) -> list[Scalar]:
        """factor*(...) + ..., for each factor or divisor that several terms hold and not all; of long sums for one.

        Of a short sum only the highest power is factored out: a^2 + 2*a*b + c reads better than a*(a + 2*b) + c.
        """
        long = len(parts) > MOST_NESTED
        highest: dict[Base, int] = {}
        for base, e in (item for _, powers in parts for item in powers):
            highest[base] = max(e, highest.get(base, 0))
        held: dict[tuple[Base, bool], SumParts] = {}
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

    def _may_factor(self, parts: SumParts) -> bool:
        return len(self._factors(parts)) > 1

    @_once
    def _factors(self, parts: SumParts) -> list[tuple[SumParts, int]]:
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
        factors: list[tuple[SumParts, int]] = []
        for part, n in found:
            written = [
                (c, tuple((base, e) for base, e in zip(bases, exponents, strict=True) if e))
                for exponents, c in sorted(part.terms, key=lambda item: met.get(item[0], len(met)))
            ]
            factors.append((written, n))
        return [([(number, ())], 1), *factors] if number != 1 else factors

    def in_tangents(self, above: SumParts, below: SumParts) -> list[tuple[SumParts, SumParts]]:
        """Both over cos(x)^n: a*sin(x)^2/(a*sin(x)^2 + b*cos(x)^2) is a*tan(x)^2/(a*tan(x)^2 + b)."""
        held = [powers for _, powers in (*above, *below)]
        if len(below) > 1:
            for base in dict.fromkeys(base for powers in held for base, _ in powers):
                if not isinstance(base, int) and not self._moves(base):
                    both = (("sin", base[1]), ("cos", base[1]))
                    if len({sum(e for b, e in powers if b in both) for powers in held}) == 1:
                        return [(in_tangents_of(above, base[1]), in_tangents_of(below, base[1]))]
        return []

    # -- nodes --------------------------------------------------------------------------------

    def _term(self, c: Number, powers: Powers) -> Scalar:
        """c * powers; sin(a)*cos(a) as sin(2*a)/2 where that is shorter."""
        if (c, powers) not in self.terms:
            self.terms[c, powers] = self._shorter_term(c, powers)
        return self.terms[c, powers]

    def _shorter_term(self, c: Number, powers: Powers) -> Scalar:
        plain, twice = self._product_of(c, powers), doubled(c, powers)
        if twice is None:
            return plain
        double = self._product_of(*twice)
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


def _depth(x: Scalar) -> int:
    """Nesting depth of parentheses, those of functions not counted."""
    if type(x) is not Node:
        return 0
    depths: dict[Node, int] = x.graph.found(_depth)
    for node in order((x,), depths):
        if node not in depths:
            bracketed = node.op in ("mul", "div", "pow")
            inside = [depths[a] + (bracketed and a.op in ("add", "sub")) for a in node.args if type(a) is Node]
            depths[node] = 0 if is_base(node) else max(inside, default=0)
    return depths[x]


def _has_minus(x: Scalar) -> bool:
    return x.op == "neg" if type(x) is Node else x < 0


def _bare(x: Scalar) -> Scalar:
    if type(x) is not Node:
        return -x if x < 0 else x
    return x.args[0] if x.op == "neg" else x


# -------- squares of sums -------------------------------------------------------------------------------------
# A scalar -> the same with squares of sums as squares: 1/2*I_3*(cos(theta)*phi' + psi')^2, not its three terms.


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
