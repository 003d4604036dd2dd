"""A sum of terms with divisors -> numerator and denominator without a common factor."""

from __future__ import annotations

from collections.abc import Iterable
from math import gcd

from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.polynomials import Polynomials
from eomgen.symbolic.exact.terms import HALF, Key, Terms, TooLarge, common_monomial, constant
from eomgen.symbolic.expression.exact_numbers import tidy

MOST_TERMS = 40  # of a sum that is looked at for powers
LARGEST_PRODUCT = 20_000  # terms of the numerator times terms of the denominator, for a common divisor to be sought


def reduced(expansion: Expansion, terms: Terms) -> tuple[Terms, Terms]:
    """(numerator, denominator) without common factor as polynomials in cosines and sines, in each of their forms.

    Raises:
        TooLarge: the expansion's limit is reached.
    """
    numerator, denominator = fraction_of(expansion, terms)
    if not numerator:
        return {}, constant(1)
    if len(denominator) > 1 or any(w for _, w in denominator):
        numerator, denominator = _without_common_divisor(expansion, numerator, denominator)
    return numerator, denominator


def fraction_of(expansion: Expansion, terms: Terms) -> tuple[Terms, Terms]:
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
