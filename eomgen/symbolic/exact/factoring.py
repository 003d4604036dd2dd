"""Sums of terms -> their factors as polynomials in the atoms, by sympy.polys; bounded work.

The cosine and sine of one angle may be atoms too: a polynomial in them is factored as if they were independent, which
finds fewer factors than there are, and none that is wrong.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from eomgen.symbolic.exact.squares import holds_no_square
from eomgen.symbolic.exact.terms import Monomial, Terms, common_monomial, inverse, terms_scaled, terms_times
from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Number
from eomgen.symbolic.expression.rational import Fraction

LARGEST_DEGREE = 24
MOST_TERMS = 400
PLACES = 10  # at which a polynomial is tried before its factors are lifted


def factored(f: Terms) -> list[tuple[Terms, int]]:
    """The factors of f that hold more than one term, and their multiplicities; f itself where it is too large.

    f must hold no waves. Monomials and numbers are left out of the list.
    """
    inverted, _ = inverse(common_monomial(f))
    f = terms_times(f, {(inverted, ()): 1})
    found = _polynomial(f)
    if found is None:
        return [(f, 1)]
    polynomial, atoms = found
    _, parts = irreducible(polynomial)
    return [(_terms(part, atoms), n) for part, n in parts if len(part) > 1]


@lru_cache(maxsize=2000)
def irreducible(polynomial: Any) -> tuple[Any, tuple[tuple[Any, int], ...]]:
    """(number, irreducible factors and their powers) of an element of sympy's ring; remembered, as formulas recur.

    Wang's algorithm factors at random places first. With three of them, sympy's own choice, one run in five takes a
    thousand times as long as the others, where by chance a polynomial splits at all three and nowhere else.
    """
    from sympy.polys.polyconfig import using

    with using(EEZ_NUMBER_OF_CONFIGS=PLACES):
        number, parts = polynomial.factor_list()
    return number, tuple(parts)


def square_root(f: Terms) -> Terms | None:
    """g with g^2 = f, its first coefficient positive; None where f is no square."""
    common = common_monomial(f)
    if any(w for _, w in f) or any(e % 2 for _, e in common):
        return None
    inverted, _ = inverse(common)
    if len(f) == 1:
        single = _root_of(Fraction(next(iter(f.values()))))
        return None if single is None else {(tuple((atom, e // 2) for atom, e in common), ()): single}
    found = _polynomial(terms_times(f, {(inverted, ()): 1}))
    if found is None:
        return None
    polynomial, atoms = found
    if holds_no_square(polynomial):
        return None
    number, parts = polynomial.sqf_list()
    outside = _root_of(Fraction(int(number.numerator), int(number.denominator)))
    if outside is None or any(n % 2 for _, n in parts):
        return None
    root: Terms = {(tuple((atom, e // 2) for atom, e in common), ()): outside}
    for part, n in parts:
        for _ in range(n // 2):
            root = terms_times(root, _terms(part, atoms))
    return terms_scaled(root, -1) if root[min(root)] < 0 else root


def _root_of(c: Fraction) -> Number | None:
    """The rational root of c, or None."""
    from math import isqrt

    if c < 0:
        return None
    root = Fraction(isqrt(c.numerator), isqrt(c.denominator))
    return tidy(root) if root * root == c else None


def _polynomial(f: Terms) -> tuple[Any, list[int]] | None:
    """(element of sympy's ring, the atoms that are its generators); None where f is too large or no polynomial."""
    from sympy.polys.domains import QQ
    from sympy.polys.rings import PolyRing

    exponents = [dict(monomial) for monomial, _ in f]
    atoms = sorted({atom for powers in exponents for atom in powers})
    degree = max((sum(powers.values()) for powers in exponents), default=0)
    negative = any(e < 0 for powers in exponents for e in powers.values())
    if not atoms or negative or degree > LARGEST_DEGREE or len(f) > MOST_TERMS or any(w for _, w in f):
        return None
    ring = PolyRing([f"a{i}" for i in range(len(atoms))], QQ)
    entries = zip(exponents, f.values(), strict=True)
    return ring.from_dict({_key(powers, atoms): QQ(c.numerator, c.denominator) for powers, c in entries}), atoms


def _key(powers: dict[int, int], atoms: Sequence[int]) -> tuple[int, ...]:
    return tuple(powers.get(atom, 0) for atom in atoms)


def _terms(polynomial: Any, atoms: Sequence[int]) -> Terms:
    """An element of sympy's ring as a sum of terms."""
    total: Terms = {}
    for exponents, c in polynomial.terms():
        monomial: Monomial = tuple((atom, e) for atom, e in zip(atoms, exponents, strict=True) if e)
        total[monomial, ()] = tidy(Fraction(int(c.numerator), int(c.denominator)))
    return total
