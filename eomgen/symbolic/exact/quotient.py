"""Sums of terms with divisors and square roots, without common factors.

A sum of terms with divisors -> numerator and denominator without a common factor.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import chain
from math import gcd

from eomgen.frozen import dataclass
from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.polynomials import Polynomials, RationalPolynomial
from eomgen.symbolic.exact.terms import (
    HALF,
    Key,
    Monomial,
    Terms,
    TooLarge,
    common_monomial,
    constant,
    inverse,
    monomial_product,
)
from eomgen.symbolic.expression import Fraction, Number, Scalar, tidy

MOST_TERMS = 40  # of a sum that is looked at for powers
LARGEST_PRODUCT = 20_000  # terms of the numerator times terms of the denominator, for a common divisor to be sought


def reduced(expansion: Expansion, terms: Terms) -> tuple[Terms, Terms]:
    """(numerator, denominator) without common factor as polynomials in cosines and sines, in each of their forms.

    Raises:
        TooLarge: the expansion's limit is reached.
    """
    numerator, denominator = over_one_denominator(expansion, terms)
    if not numerator:
        return {}, constant(1)
    if len(denominator) > 1 or any(w for _, w in denominator):
        numerator, denominator = _without_common_divisor(expansion, numerator, denominator)
    return numerator, denominator


def over_one_denominator(expansion: Expansion, terms: Terms) -> tuple[Terms, Terms]:
    """(numerator, denominator) without negative powers, common factors left where they are."""
    numerator, powers = expansion.cleared(terms)
    denominator = constant(1)
    for atom, e in powers.items():
        denominator = expansion.product(denominator, expansion.power(expansion.atoms.opaque[atom].arguments[0], e))
    for part in (numerator, denominator):
        below = tuple((atom, -e) for atom, e in common_monomial(part) if e < 0)
        if below:
            numerator = expansion.product(numerator, {(below, ()): 1})
            denominator = expansion.product(denominator, {(below, ()): 1})
    return numerator, denominator


def in_half_angles(expansion: Expansion, numerator: Terms, denominator: Terms) -> tuple[Terms, Terms] | None:
    """The quotient in sines and cosines of x/2, reduced: sin(x)/(1 + cos(x)) is sin(x/2)/cos(x/2).

    None where neither of the two holds 1 + cos(x) or 1 - cos(x).
    """
    for part in (denominator, numerator):
        for monomial, w in part:
            whole = w and w[0] == "cos" and part.get((monomial, ()), 0)
            if w and whole and abs(whole) == abs(part[monomial, w]):
                half: Terms = {((), ("cos", tuple((angle, tidy(c * HALF)) for angle, c in w[1]))): 1}
                times = (expansion.product(x, half) for x in (numerator, denominator))
                return _without_common_divisor(expansion, *times)
    return None


def _without_common_divisor(expansion: Expansion, numerator: Terms, denominator: Terms) -> tuple[Terms, Terms]:
    """The quotient reduced as it is; or with no roots of numbers below, where that is no longer."""
    found = _divided(expansion, numerator, denominator)
    rational = _rational_below(expansion, *found)
    if rational is None:
        return found
    other = _divided(expansion, *rational)
    return min(other, found, key=lambda quotient: sum(map(len, quotient)))


def _divided(expansion: Expansion, numerator: Terms, denominator: Terms) -> tuple[Terms, Terms]:
    if len(numerator) * len(denominator) > LARGEST_PRODUCT:
        return numerator, denominator
    try:
        ring = Polynomials((numerator, denominator), expansion.product)
        above, below = ring.of(numerator), ring.of(denominator)
    except TooLarge:
        return numerator, denominator
    if len(above.terms) * len(below.terms) > LARGEST_PRODUCT:
        return numerator, denominator
    above, below = ring.without_common_divisor(above, below)
    return ring.terms(above), ring.terms(below)


def _rational_below(expansion: Expansion, above: Terms, below: Terms) -> tuple[Terms, Terms] | None:
    """Both times the conjugates of the denominator: (a + sqrt(3) b)(a - sqrt(3) b) = a^2 - 3 b^2.

    A divisor with a root in it, (a + sqrt(3) b)^2 written out, is common to both where it divides each term above.
    None where no root of a number is below, or the products would be too large.
    """
    roots = _roots(below)
    if not roots:
        return None
    parts = _coprime_parts(roots)
    largest = (len(above) + len(below)) * len(below) ** (2 ** len(parts))
    if largest > min(LARGEST_PRODUCT, expansion.limit - expansion.work):
        return None
    for p in parts:
        conjugate = {key: -c if any(root % p == 0 for root in _roots((key,))) else c for key, c in below.items()}
        above, below = expansion.product(above, conjugate), expansion.product(below, conjugate)
    return above, below


def _roots(terms: Iterable[Key]) -> set[int]:
    """The numbers whose roots stand in the terms."""
    return {-atom for monomial, _ in terms for atom, _ in monomial if atom < 0}


def _coprime_parts(numbers: Iterable[int]) -> list[int]:
    """Numbers without common divisor of which these are products: each of their roots has a sign of its own."""
    parts: list[int] = []
    pending = sorted(numbers)
    while pending:
        n = pending.pop()
        other = next((p for p in parts if gcd(n, p) > 1), None)
        if other is None:
            parts += [n] if n > 1 else []
            continue
        common = gcd(n, other)
        if common != other:
            parts.remove(other)
            pending += [common, other // common]
        pending.append(n // common)
    return sorted(parts)


def powers_in(expansion: Expansion, terms: Terms) -> list[tuple[Terms, int]]:
    """The terms as a product of powers: 16 + 72 c^2 + 81 c^4 is (4 + 9 c^2)^2; as they are where too large."""
    if not 1 < len(terms) <= MOST_TERMS or any(e < 0 for monomial, _ in terms for _, e in monomial):
        return [(terms, 1)]
    try:
        ring = Polynomials((terms,), expansion.product)
        number, parts = ring.of_one_degree(ring.of(terms)).square_free()
    except TooLarge:
        return [(terms, 1)]
    if all(e == 1 for _, e in parts):
        return [(terms, 1)]
    return [(constant(number), 1), *((ring.terms(part), e) for part, e in parts)]


# -------- radicals --------------------------------------------------------------------------------------------
# A quotient times square roots -> the same with one root: what is square outside, all else under it.
#
#     above/below sqrt(f1) sqrt(f2) ... = above'/below' |a/b| sqrt(n/d)
#
# Wherever the left side has a value both sides have the same one. By factors p of n/d: p^2 leaves the root as |p|, as
# p where its sign is known; sqrt(p)/p is 1/sqrt(p) where p > 0, and an f of which the root is taken is positive
# itself.


LARGEST_DEGREE = 24
MOST_TERMS_UNDER_A_ROOT = 60  # of what is factored

Quotients = Sequence[tuple[Terms, Terms]]  # (numerator, denominator)


@dataclass(frozen=True)
class Radical:
    """above/below |bare_above/bare_below| sqrt(number * product of under_above / product of under_below)"""

    above: Terms
    below: Terms
    bare_above: Terms
    bare_below: Terms
    number: Number
    under_above: tuple[Terms, ...]
    under_below: tuple[Terms, ...]


def one_root(expansion: Expansion, above: Terms, below: Terms, roots: Sequence[Terms]) -> Radical | None:
    """above/below times the square roots of all `roots`, as one root; None where that takes too much work.

    The work is bounded by the size of what is factored, and does not count as the expansion's.
    """
    spent = expansion.work
    try:
        fractions = [over_one_denominator(expansion, f) for f in roots]
        ring = Polynomials([above, below, *(part for pair in fractions for part in pair)], expansion.product)
        return _Roots(expansion, ring, above, below, fractions).joined()
    except TooLarge:
        return None
    finally:
        expansion.work = spent


class _Roots:
    """The polynomials of above/below and the factors of the product under the roots."""

    def __init__(
        self, expansion: Expansion, ring: Polynomials, above: Terms, below: Terms, fractions: Quotients
    ) -> None:
        self.expansion, self.ring = expansion, ring
        self.above, self.below = self._element(above), self._element(below)
        self.number = Fraction(1)
        self.powers: dict[RationalPolynomial, int] = {}
        self.positive: set[RationalPolynomial] = set()
        for pair in fractions:
            found = [self._factors(terms) for terms in pair]
            for (number, factors), other, sign in zip(found, reversed(pair), (1, -1), strict=True):
                self.number *= number**sign
                for p, e in factors:
                    self.powers[p] = self.powers.get(p, 0) + sign * e
                if number > 0 and expansion.all_positive(other):
                    self.positive |= self._sure(factors)

    def _element(self, terms: Terms) -> RationalPolynomial:
        return self.ring.of_one_degree(self.ring.of(terms))

    def _factors(self, terms: Terms) -> tuple[Number, list[tuple[RationalPolynomial, int]]]:
        """The number, and the irreducible factors with their powers, positive where all their terms have one sign.

        What is 0 once its terms stand over one divisor is the number 0: a speed at the instant at which it vanishes.
        """
        element = self._element(terms)
        if not element.terms:
            return 0, []
        if len(element.terms) > MOST_TERMS_UNDER_A_ROOT or element.degree > LARGEST_DEGREE:
            raise TooLarge(f"a polynomial of more than {MOST_TERMS_UNDER_A_ROOT} terms or degree {LARGEST_DEGREE}")
        (number, parts), factors = element.factors(), []
        for p, e in parts:
            turned = self._is_positive(-p)
            factors.append((-p if turned else p, e))
            number = number * (-1) ** e if turned else number
        return number, factors

    def _sure(self, factors: list[tuple[RationalPolynomial, int]]) -> set[RationalPolynomial]:
        """The one factor with a sign of its own, positive where the product is."""
        unsure = {p for p, e in factors if e % 2 and not self._is_positive(p)}
        return unsure if len(unsure) == 1 else set()

    def _is_positive(self, p: RationalPolynomial) -> bool:
        return self.expansion.all_positive(self.ring.terms(p))

    def joined(self) -> Radical:
        one = RationalPolynomial.number(1, self.ring.generators)
        bare, under = [one, one], list[list[RationalPolynomial]]([[], []])
        for p, m in self.powers.items():
            sure = p in self.positive or self._is_positive(p)
            side, outside = int(m < 0), abs(m) // 2
            if not sure:
                bare[side] *= p**outside
            elif side:
                self.below *= p**outside
            else:
                self.above *= p**outside
            if m % 2:
                under[self._moved(p, side) if sure else side].append(p)
        self.above, self.below = self.ring.without_common_divisor(self.above, self.below)
        above, below, bare_above, bare_below = map(self.ring.terms, (self.above, self.below, *bare))
        numerators, denominators = (tuple(map(self.ring.terms, parts)) for parts in under)
        return Radical(above, below, bare_above, bare_below, tidy(self.number), numerators, denominators)

    def _moved(self, p: RationalPolynomial, side: int) -> int:
        """The side of the line under the root on which p > 0 stands: sqrt(p)/p = 1/sqrt(p), p/sqrt(p) = sqrt(p)."""
        quotient = (self.above if side else self.below).over(p)
        if quotient is None:
            return side
        if side:
            self.above = quotient
        else:
            self.below = quotient
        return 1 - side


# -------- by parameters ---------------------------------------------------------------------------------------
# Terms -> the same sum as quotients of their own, one for each parameter that it is linear in.
#
#     (I_s + m*r^2/4 + I_c*r^2/(4*(r + p)^2))*theta''
#
# An inertia that is reduced to another shaft reads so, and not over the product of all denominators.


MOST_GROUPS = 8  # parameters that a sum is collected by


def by_parameters(
    expansion: Expansion,
    terms: Terms,
    written: Callable[[Terms], Scalar],
    added: Callable[[Sequence[Scalar]], Scalar],
) -> Scalar | None:
    """The sum as common * sum of parameter * quotient; None where there is one group alone.

    The common factor is the product of the moving atoms that all terms have.

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
    """The atoms within a denominator or a root."""
    opaque = expansion.atoms.opaque.get(atom)
    sums = () if opaque is None else opaque.arguments
    return {other for terms in sums for monomial, _ in terms for other, _ in monomial}


def _is_symbol(expansion: Expansion, atom: int) -> bool:
    node = expansion.atoms.nodes.get(atom)
    return node is not None and node.op == "symbol"


def _is_still(expansion: Expansion, atom: int) -> bool:
    return atom >= 0 and atom in expansion.atoms.nodes and expansion.graph.is_constant(expansion.atoms.nodes[atom])
