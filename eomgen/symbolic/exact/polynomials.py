"""Sums of terms <-> polynomials in their atoms and in the cosine and sine of each axis.

Cosine and sine of one axis are independent generators there, so one function has many forms: s^2 eliminated; c^2
eliminated; or, where all powers of an axis are even or all are odd, the same degree throughout by 1 = c^2 + s^2. In
the last one a common factor or a square is found wherever there is one: 1 + m^2 s^2 - c^2 + 2 m s c is no square to
look at, but s^2 + m^2 s^2 + 2 m s c is s^2 (1 + m^2) + 2 m s c.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from eomgen.symbolic.exact.powers import axes_of, in_powers
from eomgen.symbolic.exact.rational_polynomial import PowerSum, RationalPolynomial
from eomgen.symbolic.exact.spheres import of_one_degree, with_square_replaced
from eomgen.symbolic.exact.terms import AngleSum, Terms, terms_plus, terms_times

MOST_AXES = 4  # angles, for other forms than that in cosines


class Polynomials:
    """The generators of the given sums of terms: atoms, then cosine and sine of each axis.

    Args:
        product: of sums of terms, for the waves of a polynomial.
    Raises:
        TooLarge: a wave is no polynomial of the axes of all waves.
    """

    def __init__(self, parts: Sequence[Terms], product: Callable[[Terms, Terms], Terms] = terms_times) -> None:
        self._product = product
        self._axes: tuple[AngleSum, ...] = axes_of([w for part in parts for _, w in part])
        self._atoms = sorted({atom for part in parts for monomial, _ in part for atom, _ in monomial})
        self.generators = len(self._atoms) + 2 * len(self._axes)

    def of(self, terms: Terms) -> RationalPolynomial:
        """The sum with s^2 = 1 - c^2 used."""
        polynomial = {}
        for monomial, powers, c in in_powers(terms, self._axes):
            exponents = dict(monomial)
            polynomial[*(exponents.get(atom, 0) for atom in self._atoms), *powers] = c
        return RationalPolynomial.of(polynomial)

    def terms(self, polynomial: RationalPolynomial) -> Terms:
        """A polynomial as a sum of terms."""
        total: Terms = {}
        for exponents, c in polynomial.terms:
            part: Terms = {(tuple((atom, e) for atom, e in zip(self._atoms, exponents, strict=False) if e), ()): c}
            for pair, axis in self._pairs():
                for kind, i in zip(("cos", "sin"), pair, strict=True):
                    for _ in range(exponents[i]):
                        part = self._product(part, {((), (kind, axis)): 1})
            total = terms_plus(total, part)
        return total

    def without_common_divisor(
        self, above: RationalPolynomial, below: RationalPolynomial
    ) -> tuple[RationalPolynomial, RationalPolynomial]:
        """(above, below) of the same quotient, without what they have in common in any of the forms."""
        above, below = above.without_common_divisor(below)
        if 0 < len(self._axes) <= MOST_AXES:
            for form in (self.in_sines, self.of_one_degree):
                if not below.is_number:
                    above, below = form(above).without_common_divisor(form(below))
        return above, below

    def in_sines(self, polynomial: RationalPolynomial) -> RationalPolynomial:
        """The same function with c^2 = 1 - s^2 used: a common factor s shows."""
        return self._each(polynomial, lambda form, pair: with_square_replaced(form, pair[0], pair))

    def of_one_degree(self, polynomial: RationalPolynomial) -> RationalPolynomial:
        """The same function, of one degree in c and s for each axis whose powers are all even or all odd."""
        return self._each(polynomial, _of_one_degree)

    def _pairs(self) -> Iterable[tuple[tuple[int, int], AngleSum]]:
        """(places of cosine and sine among the generators, axis)"""
        first = len(self._atoms)
        return (((first + 2 * k, first + 2 * k + 1), axis) for k, axis in enumerate(self._axes))

    def _each(
        self, polynomial: RationalPolynomial, change: Callable[[PowerSum, tuple[int, int]], PowerSum]
    ) -> RationalPolynomial:
        form: PowerSum = dict(polynomial.terms)
        for pair, _ in self._pairs():
            form = change(form, pair)
        return RationalPolynomial.of(form)


def _of_one_degree(form: PowerSum, pair: tuple[int, int]) -> PowerSum:
    odd = {sum(exponents[i] for i in pair) % 2 for exponents in form}
    return of_one_degree(form, pair) if len(odd) == 1 else form
