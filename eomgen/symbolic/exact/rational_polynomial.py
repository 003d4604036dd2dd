"""Polynomials over the rational numbers: products, common divisors, factors; by FLINT.

The library is met here alone, and loaded when a polynomial first needs it. The form of the results is fixed: a
common divisor has the leading coefficient 1; a factor has whole coefficients without common divisor, the leading one
positive; factors stand in one order. The leading term is that of the highest power of the first generator, then of the
second, and so on.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache
from math import prod
from typing import Any

from eomgen.frozen import dataclass
from eomgen.symbolic.exact.terms import TooLarge, common_number
from eomgen.symbolic.expression import Fraction, Number, tidy

LARGEST_IMAGE = 10_000_000  # product of the degrees up to which a common divisor is sought: beyond it takes seconds
KEPT = 2_000  # polynomials of which the factors are cached, as formulas recur

Exponents = tuple[int, ...]  # one for each generator
PowerSum = Mapping[Exponents, Number]
Element = Any  # of a library's ring
FactorPowers = tuple[tuple["RationalPolynomial", int], ...]


@dataclass(frozen=True)
class RationalPolynomial:
    """A sum of products of powers of generators, which are named by their place.

    Args:
        terms: (exponents, coefficient), the leading term first; no coefficient is 0.
    """

    terms: tuple[tuple[Exponents, Number], ...]

    @staticmethod
    def of(terms: PowerSum) -> RationalPolynomial:
        return RationalPolynomial(tuple(sorted(((e, tidy(c)) for e, c in terms.items() if c), reverse=True)))

    @staticmethod
    def number(c: Number, generators: int) -> RationalPolynomial:
        return RationalPolynomial.of({(0,) * generators: c})

    @property
    def is_number(self) -> bool:
        return not any(any(exponents) for exponents, _ in self.terms)

    @property
    def leading(self) -> Number:
        """The coefficient of the leading term."""
        return self.terms[0][1]

    @property
    def degree(self) -> int:
        """The largest sum of exponents."""
        return max((sum(exponents) for exponents, _ in self.terms), default=0)

    def __neg__(self) -> RationalPolynomial:
        return self.scaled(-1)

    def __mul__(self, other: RationalPolynomial) -> RationalPolynomial:
        return _read(_element(self) * _element(other))

    def __pow__(self, n: int) -> RationalPolynomial:
        return _read(_element(self) ** n)

    def scaled(self, c: Number) -> RationalPolynomial:
        """c times this."""
        return RationalPolynomial(tuple((exponents, tidy(c * number)) for exponents, number in self.terms))

    def over(self, divisor: RationalPolynomial) -> RationalPolynomial | None:
        """The quotient; None where the divisor leaves a remainder."""
        quotient, remainder = divmod(_element(self), _element(divisor))
        return None if remainder else _read(quotient)

    def without_common_divisor(self, other: RationalPolynomial) -> tuple[RationalPolynomial, RationalPolynomial]:
        """The two of the same quotient, negative powers cleared in both: x^-2/(1 + x^-1) is 1/(x^2 + x).

        The divisor's leading coefficient is 1; where one of the two is a single term, their numbers' is taken out. One
        of high degree in many generators (15 to the fifth power) is not sought.
        """
        above, below = _without_common_powers(self, other)
        if min(len(above.terms), len(below.terms)) == 1:
            number = common_number(c for part in (above, below) for _, c in part.terms)
            return above.scaled(1 / number), below.scaled(1 / number)
        if _image(above, below) > LARGEST_IMAGE:
            return above, below
        f, g = _element(above), _element(below)
        common = f.gcd(g)
        leading = _read(common).leading
        return _read(f // common).scaled(leading), _read(g // common).scaled(leading)

    def factors(self) -> tuple[Number, FactorPowers]:
        """(number, irreducible factors and their powers)"""
        return _factors(self)

    def square_free(self) -> tuple[Number, FactorPowers]:
        """(number, polynomials without squares and their powers, each power once)"""
        parts: dict[int, Element] = {}
        for part, n in _element(self).factor_squarefree()[1]:
            parts[n] = parts[n] * part if n in parts else part
        return _canonical(self, ((part, n) for n, part in parts.items()))


@lru_cache(maxsize=KEPT)
def _factors(f: RationalPolynomial) -> tuple[Number, FactorPowers]:
    return _canonical(f, _element(f).factor()[1])


def _canonical(f: RationalPolynomial, parts: Iterable[tuple[Element, int]]) -> tuple[Number, FactorPowers]:
    """The parts in whole numbers without common divisor and in their order, and the number before them."""
    factors = [(_primitive(part), n) for element, n in parts if not (part := _read(element)).is_number]
    number = Fraction(f.leading) / prod(part.leading**n for part, n in factors)
    return tidy(number), tuple(sorted(factors, key=lambda item: (item[0].terms[0][0][:1], item[1], item[0].terms)))


def _primitive(f: RationalPolynomial) -> RationalPolynomial:
    """The polynomial scaled to whole coefficients without common divisor, the leading one positive."""
    common = common_number(c for _, c in f.terms)
    return f.scaled(1 / common if f.leading > 0 else -1 / common)


def _without_common_powers(*both: RationalPolynomial) -> tuple[RationalPolynomial, ...]:
    """The polynomials, each divided by the lowest powers of the generators in any of them."""
    lowest = [min(powers) for powers in zip(*(exponents for f in both for exponents, _ in f.terms), strict=True)]
    return tuple(
        RationalPolynomial(
            tuple((tuple(e - d for e, d in zip(powers, lowest, strict=True)), c) for powers, c in f.terms)
        )
        for f in both
    )


def _image(f: RationalPolynomial, g: RationalPolynomial) -> int:
    """The product of the degrees in each generator: a bound for the work of finding a divisor."""
    return prod(max(1, *powers) for powers in zip(*(exponents for exponents, _ in (*f.terms, *g.terms)), strict=True))


def _names(generators: int) -> list[str]:
    return [f"x{i}" for i in range(generators)]


def _element(f: RationalPolynomial) -> Element:
    if min(map(min, (e or (0,) for e, _ in f.terms))) < 0:
        raise TooLarge("a polynomial with negative powers")
    from flint import Ordering, fmpq, fmpq_mpoly_ctx  # loaded where polynomials are

    ring = fmpq_mpoly_ctx.get(_names(len(f.terms[0][0])), Ordering.lex)
    return ring.from_dict({exponents: fmpq(c.numerator, c.denominator) for exponents, c in f.terms})


def _read(element: Element) -> RationalPolynomial:
    terms = ((tuple(map(int, e)), Fraction(int(c.numerator), int(c.denominator))) for e, c in element.terms())
    return RationalPolynomial(tuple((e, tidy(c)) for e, c in terms))
