"""Polynomials over the rational numbers: products, common divisors, factors.

Sums of terms <-> polynomials in their atoms and in the cosine and sine of each axis.

Cosine and sine of one axis are independent generators there, so one function has many forms: s^2 eliminated; c^2
eliminated; or, where all powers of an axis are even or all are odd, the same degree throughout by 1 = c^2 + s^2. In
the last one a common factor or a square is found wherever there is one: 1 + m^2 s^2 - c^2 + 2 m s c is no square to
look at, but s^2 + m^2 s^2 + 2 m s c is s^2 (1 + m^2) + 2 m s c.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache, lru_cache
from math import comb, isqrt, prod
from typing import Any

from eomgen.frozen import dataclass
from eomgen.symbolic.exact.terms import (
    AngleSum,
    Key,
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
KEPT_WAVES = 20_000  # waves and sets of angles of which the form is cached


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


@lru_cache(maxsize=KEPT_WAVES)
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


@lru_cache(maxsize=KEPT_WAVES)
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


@lru_cache(maxsize=KEPT_WAVES)
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


# -------- by FLINT --------------------------------------------------------------------------------------------
# Polynomials over the rational numbers: products, common divisors, factors; by FLINT.
#
# The library is met here alone, and loaded when a polynomial first needs it. The form of the results is fixed:
# a common divisor has the leading coefficient 1; a factor has whole coefficients without common divisor, the leading
# one positive; factors stand in one order. The leading term is that of the highest power of the first generator, then
# of the second, and so on.

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


# -------- unit quaternions ------------------------------------------------------------------------------------
# Sums of terms over symbols on a unit sphere, e . e = 1, as a unit quaternion's: one form of each, and its shortest.
#
# The first of the symbols stands nowhere squared, e0^2 = 1 - e1^2 - e2^2 - e3^2: so two sums that are equal on the
# sphere are the same sum. Written, another square may be used up, or every term brought to one degree by factors e . e:
# 4 e1^2 - 4 e1^4 - 4 e1^2 e2^2 - 4 e1^2 e3^2 is 4 e0^2 e1^2. Cosine and sine of one angle are such symbols, too.

QuaternionSymbols = tuple[int, ...]  # the symbols, by index

DEGREE_ON_SPHERE = 12  # of a sum that is looked at in other forms


def with_square_replaced(polynomial: PowerSum, k: int, sphere: Sequence[int]) -> PowerSum:
    """The polynomial with e_k^2 = 1 - (the other squares).

    Args:
        k, sphere: places of one symbol and of all among the exponents.
    """
    others = [i for i in sphere if i != k]
    found: dict[Exponents, Number] = {}
    for exponents, c in polynomial.items():
        n = exponents[k] // 2
        if not n:
            _add(found, exponents, c)
            continue
        rest = (*exponents[:k], exponents[k] % 2, *exponents[k + 1 :])
        for (_, *powers), share in _multinomials(len(sphere), n):
            _add(found, _raised(rest, others, powers), share * c if sum(powers) % 2 == 0 else -share * c)
    return {exponents: c for exponents, c in found.items() if c}


def of_one_degree(polynomial: PowerSum, sphere: Sequence[int]) -> PowerSum:
    """The terms even on the sphere brought to one degree by factors e . e, and so the odd ones."""
    degrees = {exponents: sum(exponents[i] for i in sphere) for exponents in polynomial}
    largest = {odd: max((d for d in degrees.values() if d % 2 == odd), default=0) for odd in (0, 1)}
    found: dict[Exponents, Number] = {}
    for exponents, c in polynomial.items():
        degree = degrees[exponents]
        for powers, share in _multinomials(len(sphere), (largest[degree % 2] - degree) // 2):
            _add(found, _raised(exponents, sphere, powers), share * c)
    return {exponents: c for exponents, c in found.items() if c}


def _add(total: dict[Exponents, Number], exponents: Exponents, c: Number) -> None:
    total[exponents] = tidy(total.get(exponents, 0) + c)


def _raised(exponents: Exponents, places: Sequence[int], powers: Sequence[int]) -> Exponents:
    """The exponents after multiplication by the squares at these places to these powers."""
    raised = list(exponents)
    for i, p in zip(places, powers, strict=True):
        raised[i] += 2 * p
    return tuple(raised)


def reduced_on(sphere: QuaternionSymbols, terms: Terms) -> Terms:
    """The sum with the square of the sphere's first symbol used up."""
    if not any(atom == sphere[0] and e > 1 for monomial, _ in terms for atom, e in monomial):
        return terms
    return _by_parts(sphere, terms, lambda polynomial: with_square_replaced(polynomial, 0, range(len(sphere))))


def shortest_on(sphere: QuaternionSymbols, terms: Terms) -> Terms:
    """The sum with as few terms as its forms on the sphere have, each monomial of the other symbols by itself."""
    return _by_parts(sphere, terms, _shortest)


def _shortest(polynomial: PowerSum) -> PowerSum:
    if len(polynomial) < 2 or max(map(sum, polynomial)) > DEGREE_ON_SPHERE or min(map(min, polynomial)) < 0:
        return polynomial
    sphere = range(len(next(iter(polynomial))))
    forms = [polynomial, of_one_degree(polynomial, sphere)]
    forms += [with_square_replaced(polynomial, k, sphere) for k in sphere[1:]]
    return min(forms, key=lambda form: (len(form), sum(map(sum, form))))


def _by_parts(sphere: QuaternionSymbols, terms: Terms, change: Callable[[PowerSum], PowerSum]) -> Terms:
    """The sum, of which `change` replaces what each product of other symbols and waves is multiplied by."""
    parts: dict[Key, dict[Exponents, Number]] = {}
    for (monomial, w), c in terms.items():
        exponents = dict(monomial)
        own = tuple(exponents.pop(atom, 0) for atom in sphere)
        parts.setdefault((tuple(exponents.items()), w), {})[own] = c
    found: Terms = {}
    for (rest, w), polynomial in parts.items():
        changed = polynomial if min(map(min, polynomial)) < 0 else change(polynomial)
        for own, c in changed.items():
            held = [(atom, e) for atom, e in zip(sphere, own, strict=True) if e]
            found[tuple(sorted((*rest, *held))), w] = c
    return found


@cache
def _multinomials(count: int, n: int) -> tuple[tuple[Exponents, int], ...]:
    """(x_1 + ... + x_count)^n as (exponents, coefficient)."""
    if count == 1:
        return (((n,), 1),)
    return tuple(
        ((p, *rest), comb(n, p) * share) for p in range(n + 1) for rest, share in _multinomials(count - 1, n - p)
    )
