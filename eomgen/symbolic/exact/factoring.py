"""Sums of terms -> their factors as polynomials in the atoms; bounded work.

The cosine and sine of one angle may be atoms too: a polynomial in them is factored as if they were independent, which
finds fewer factors than there are, and none that is wrong.
"""

from __future__ import annotations

from math import isqrt

from eomgen.symbolic.exact.polynomials import Polynomials
from eomgen.symbolic.exact.rational_polynomial import RationalPolynomial
from eomgen.symbolic.exact.terms import Monomial, Terms, common_monomial, inverse, terms_scaled, terms_times
from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Number
from eomgen.symbolic.expression.rational import Fraction

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
