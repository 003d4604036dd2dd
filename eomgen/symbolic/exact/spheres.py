"""Sums of terms over symbols on a unit sphere, e . e = 1, as a unit quaternion's: one form of each, and its shortest.

The first of the symbols stands nowhere squared, e0^2 = 1 - e1^2 - e2^2 - e3^2: so two sums that are equal on the
sphere are the same sum. Written, another square may be used up, or every term brought to one degree by factors e . e:
4 e1^2 - 4 e1^4 - 4 e1^2 e2^2 - 4 e1^2 e3^2 is 4 e0^2 e1^2.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product
from math import factorial

from eomgen.symbolic.exact.terms import Key, Terms
from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Number

SphereSymbols = tuple[int, ...]  # the symbols, by index
Exponents = tuple[int, ...]  # one for each symbol of the sphere
SpherePolynomial = dict[Exponents, Number]

LARGEST_DEGREE = 12  # of a sum that is looked at in other forms


def with_square_replaced(polynomial: SpherePolynomial, k: int) -> SpherePolynomial:
    """The polynomial with e_k^2 = 1 - (the other squares)."""
    found: SpherePolynomial = {}
    for exponents, c in polynomial.items():
        n, rest = exponents[k] // 2, (*exponents[:k], exponents[k] % 2, *exponents[k + 1 :])
        for powers in _up_to(len(exponents) - 1, n):
            share = _multinomial((n - sum(powers), *powers)) * (-1) ** sum(powers)
            others = (*powers[:k], 0, *powers[k:])
            key = tuple(e + 2 * p for e, p in zip(rest, others, strict=True))
            found[key] = tidy(found.get(key, 0) + share * c)
    return {key: c for key, c in found.items() if c}


def of_one_degree(polynomial: SpherePolynomial) -> SpherePolynomial:
    """The even terms brought to one degree by factors e . e, and so the odd ones."""
    found: SpherePolynomial = {}
    largest = {odd: max((sum(e) for e in polynomial if sum(e) % 2 == odd), default=0) for odd in (0, 1)}
    for exponents, c in polynomial.items():
        n = (largest[sum(exponents) % 2] - sum(exponents)) // 2
        for powers in _up_to(len(exponents), n):
            if sum(powers) == n:
                key = tuple(e + 2 * p for e, p in zip(exponents, powers, strict=True))
                found[key] = tidy(found.get(key, 0) + _multinomial(powers) * c)
    return {key: c for key, c in found.items() if c}


def reduced_on(sphere: SphereSymbols, terms: Terms) -> Terms:
    """The sum with the square of the sphere's first symbol used up."""
    if not any(atom == sphere[0] and e > 1 for monomial, _ in terms for atom, e in monomial):
        return terms
    return _by_parts(sphere, terms, lambda polynomial: with_square_replaced(polynomial, 0))


def shortest_on(sphere: SphereSymbols, terms: Terms) -> Terms:
    """The sum with as few terms as its forms on the sphere have, each monomial of the other symbols by itself."""
    return _by_parts(sphere, terms, _shortest)


def _shortest(polynomial: SpherePolynomial) -> SpherePolynomial:
    if len(polynomial) < 2 or max(map(sum, polynomial)) > LARGEST_DEGREE or min(map(min, polynomial)) < 0:
        return polynomial
    forms = [polynomial, of_one_degree(polynomial)]
    forms += [with_square_replaced(polynomial, k) for k in range(1, len(next(iter(polynomial))))]
    return min(forms, key=lambda form: (len(form), sum(map(sum, form))))


def _by_parts(sphere: SphereSymbols, terms: Terms, change: Callable[[SpherePolynomial], SpherePolynomial]) -> Terms:
    """The sum, of which `change` replaces what each product of other symbols and waves is multiplied by."""
    parts: dict[Key, SpherePolynomial] = {}
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


def _up_to(count: int, n: int) -> Sequence[Exponents]:
    """All exponents of so many symbols that add up to n at most."""
    return [powers for powers in product(range(n + 1), repeat=count) if sum(powers) <= n]


def _multinomial(powers: Exponents) -> int:
    found = factorial(sum(powers))
    for p in powers:
        found //= factorial(p)
    return found
