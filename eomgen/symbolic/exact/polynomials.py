"""Polynomials over the rational numbers: products, common divisors, factors.

Sums of terms <-> polynomials in their atoms and in the cosine and sine of each axis.

Cosine and sine of one axis are independent generators there, so one function has many forms: s^2 eliminated; c^2
eliminated; or, where all powers of an axis are even or all are odd, the same degree throughout by 1 = c^2 + s^2. In
the last one a common factor or a square is found wherever there is one: 1 + m^2 s^2 - c^2 + 2 m s c is no square to
look at, but s^2 + m^2 s^2 + 2 m s c is s^2 (1 + m^2) + 2 m s c.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from math import comb, isqrt

from eomgen.symbolic.exact.rational_polynomial import Exponents, PowerSum, RationalPolynomial
from eomgen.symbolic.exact.terms import (
    AngleSum,
    Monomial,
    Terms,
    TooLarge,
    Wave,
    common_monomial,
    common_number,
    inverse,
    terms_plus,
    terms_scaled,
    terms_times,
)
from eomgen.symbolic.exact.unit_quaternions import of_one_degree, with_square_replaced
from eomgen.symbolic.expression import Fraction, Number, tidy

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


# -------- factoring -------------------------------------------------------------------------------------------
# Sums of terms -> their factors as polynomials in the atoms; bounded work.
#
# The cosine and sine of one angle may be atoms too: a polynomial in them is factored as if they were independent,
# which finds fewer factors than there are, and none that is wrong.


LARGEST_DEGREE = 24
MOST_TERMS = 400


def factored(f: Terms) -> list[tuple[Terms, int]]:
    """The factors of f that hold more than one term, and their multiplicities; f itself where it is too large.

    f must hold no waves. Monomials and numbers are left out of the list.
    """
    f = _over(f, common_monomial(f))
    found = _polynomial(f)
    if found is None:
        return [(f, 1)]
    ring, polynomial = found
    return [(ring.terms(part), n) for part, n in polynomial.factors()[1] if len(part.terms) > 1]


def square_root(f: Terms) -> Terms | None:
    """g with g^2 = f, its first coefficient positive; None where f is no square."""
    common = common_monomial(f)
    if any(w for _, w in f) or any(e % 2 for _, e in common):
        return None
    outside: Monomial = tuple((atom, e // 2) for atom, e in common)
    if len(f) == 1:
        single = _root_of(next(iter(f.values())))
        return None if single is None else {(outside, ()): single}
    found = _polynomial(_over(f, common))
    if found is None:
        return None
    ring, polynomial = found
    number, parts = polynomial.square_free()
    single = _root_of(number)
    if single is None or any(n % 2 for _, n in parts):
        return None
    root: Terms = {(outside, ()): single}
    for part, n in parts:
        for _ in range(n // 2):
            root = terms_times(root, ring.terms(part))
    return terms_scaled(root, -1) if root[min(root)] < 0 else root


def _over(f: Terms, common: Monomial) -> Terms:
    inverted, _ = inverse(common)
    return terms_times(f, {(inverted, ()): 1})


def _root_of(c: Number) -> Number | None:
    """The rational root of c, or None."""
    if c < 0:
        return None
    root = Fraction(isqrt(c.numerator), isqrt(c.denominator))
    return tidy(root) if root * root == c else None


def _polynomial(f: Terms) -> tuple[Polynomials, RationalPolynomial] | None:
    """The polynomial, and its generators; None where f is too large or no polynomial."""
    if len(f) > MOST_TERMS or any(w or any(e < 0 for _, e in monomial) for monomial, w in f):
        return None
    ring = Polynomials((f,))
    polynomial = ring.of(f)
    return None if not ring.generators or polynomial.degree > LARGEST_DEGREE else (ring, polynomial)


# -------- powers ----------------------------------------------------------------------------------------------
# Waves as polynomials in the sines and cosines of a few axes, by de Moivre: cos(m a) + i sin(m a) = (c + i s)^m.


LARGEST_MULTIPLE = 12  # of a wave to be written in powers
KEPT = 20_000  # waves and sets of angles of which the form is cached


def power_form(waves: Mapping[Wave, Number], axes: tuple[AngleSum, ...]) -> PowerSum | None:
    """The waves as a polynomial in cosine and sine of each axis, s^2 eliminated; None where that is too large.

    It is the sum of the forms that the waves have by themselves, in which no s^2 is left.
    """
    found: dict[Exponents, Number] = {}
    for w, c in waves.items():
        multiples = _multiples(w[1], axes) if w else (0,) * len(axes)
        if multiples is None or sum(map(abs, multiples)) > LARGEST_MULTIPLE:
            return None
        cosine, sine = _circle(multiples)
        for powers, share in (sine if w and w[0] == "sin" else cosine).items():
            found[powers] = found.get(powers, 0) + c * share
    return {powers: tidy(c) for powers, c in found.items() if c}


def in_powers(terms: Terms, axes: tuple[AngleSum, ...]) -> Iterator[tuple[Monomial, Exponents, Number]]:
    """(monomial, exponents of cosine and sine of each axis, coefficient) of each term, s^2 eliminated.

    Raises:
        TooLarge: a wave of too high a multiple of its angle.
    """
    groups: dict[Monomial, dict[Wave, Number]] = {}
    for (monomial, w), c in terms.items():
        groups.setdefault(monomial, {})[w] = c
    for monomial, waves in groups.items():
        powers = power_form(waves, axes)
        if powers is None:
            raise TooLarge("a wave of too high a multiple of its angle")
        yield from ((monomial, exponents, c) for exponents, c in powers.items())


def axes_of(waves: Iterable[Wave]) -> tuple[AngleSum, ...]:
    """Angles of which those of all waves are whole combinations.

    Angles that always come in one proportion are one axis: sin(a) cos(b + c) has the axes a and b + c.
    """
    return _axes_of(tuple(w[1] for w in waves if w))


@lru_cache(maxsize=KEPT)
def _axes_of(angles: tuple[AngleSum, ...]) -> tuple[AngleSum, ...]:
    rows = list(map(dict, angles))
    groups: dict[tuple[Fraction, ...], list[tuple[int, Fraction]]] = {}
    for angle in sorted({angle for row in rows for angle in row}):
        column = [row.get(angle, 0) for row in rows]
        lead = Fraction(next(c for c in column if c))
        groups.setdefault(tuple(c / lead for c in column), []).append((angle, lead))
    axes = []
    for pattern, members in groups.items():
        common = common_number(lead for _, lead in members)
        unit = common_number([*(c * common for c in pattern if c), Fraction(1)])  # 1, or a fraction for half-angles
        axes.append(tuple((angle, tidy(lead / common * unit)) for angle, lead in members))
    return tuple(axes)


@lru_cache(maxsize=KEPT)
def _multiples(k: AngleSum, axes: tuple[AngleSum, ...]) -> tuple[int, ...] | None:
    """k as whole multiples of the axes, or None."""
    entries = dict(k)
    multiples = []
    for axis in axes:
        angle, unit = axis[0]
        multiple = Fraction(entries.get(angle, 0)) / unit
        if multiple.denominator != 1:
            return None
        for member, c in axis:
            if entries.pop(member, 0) != multiple * c:
                return None
        multiples.append(multiple.numerator)
    return None if entries else tuple(multiples)


@lru_cache(maxsize=KEPT)
def _circle(multiples: tuple[int, ...]) -> tuple[PowerSum, PowerSum]:
    """(cos, sin) of a whole combination of the axes, s^2 eliminated, from the product of (c + i s)^m over the axes."""
    if not multiples:
        return {(): 1}, {}
    (real, imaginary), (c, s) = _circle(multiples[:-1]), _one_axis(multiples[-1])
    return _joined((real, c, 1), (imaginary, s, -1)), _joined((real, s, 1), (imaginary, c, 1))


@lru_cache(maxsize=2 * LARGEST_MULTIPLE + 1)
def _one_axis(m: int) -> tuple[PowerSum, PowerSum]:
    """(cos(m a), sin(m a)) in powers of cos a and sin a, by de Moivre, s^2 eliminated."""
    n, sense = abs(m), 1 if m >= 0 else -1
    cosine: PowerSum = {(n - j, j): (-1) ** (j // 2) * comb(n, j) for j in range(0, n + 1, 2)}
    sine: PowerSum = {(n - j, j): sense * (-1) ** (j // 2) * comb(n, j) for j in range(1, n + 1, 2)}
    return eliminated(cosine, 0, "cos"), eliminated(sine, 0, "cos")


def _joined(*products: tuple[PowerSum, PowerSum, int]) -> PowerSum:
    total: dict[Exponents, Number] = {}
    for left, right, sign in products:
        for powers, c in left.items():
            for pair, d in right.items():
                total[(*powers, *pair)] = total.get((*powers, *pair), 0) + sign * c * d
    return {powers: c for powers, c in total.items() if c}


def eliminated(polynomial: PowerSum, axis: int, keep: str) -> PowerSum:
    """The polynomial with s^2 = 1 - c^2 (keep "cos") or c^2 = 1 - s^2 (keep "sin") substituted for one axis."""
    pair = (2 * axis, 2 * axis + 1)
    return with_square_replaced(polynomial, pair[keep == "cos"], pair)
