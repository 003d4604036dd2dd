"""A quotient times square roots -> the same with one root: what is square outside, all else under it.

    above/below sqrt(f1) sqrt(f2) ... = above'/below' |a/b| sqrt(n/d)

Wherever the left side has a value both sides have the same one. By factors p of n/d: p^2 leaves the root as |p|, as p
where its sign is known; sqrt(p)/p is 1/sqrt(p) where p > 0, and an f of which the root is taken is positive itself.
"""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.records import dataclass
from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.polynomials import Polynomials
from eomgen.symbolic.exact.quotient import fraction_of
from eomgen.symbolic.exact.rational_polynomial import RationalPolynomial
from eomgen.symbolic.exact.terms import Terms, TooLarge
from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Number
from eomgen.symbolic.expression.rational import Fraction

LARGEST_DEGREE = 24
MOST_TERMS = 60  # of what is factored

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
        fractions = [fraction_of(expansion, f) for f in roots]
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
        """The number, and the irreducible factors with their powers, positive where all their terms have one sign."""
        element = self._element(terms)
        if len(element.terms) > MOST_TERMS or element.degree > LARGEST_DEGREE:
            raise TooLarge(f"a polynomial of more than {MOST_TERMS} terms or degree {LARGEST_DEGREE}")
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
