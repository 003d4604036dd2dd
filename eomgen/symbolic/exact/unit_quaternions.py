"""Sums of terms over symbols on a unit sphere, e . e = 1, as a unit quaternion's: one form of each, and its shortest.

The first of the symbols stands nowhere squared, e0^2 = 1 - e1^2 - e2^2 - e3^2: so two sums that are equal on the
sphere are the same sum. Written, another square may be used up, or every term brought to one degree by factors e . e:
4 e1^2 - 4 e1^4 - 4 e1^2 e2^2 - 4 e1^2 e3^2 is 4 e0^2 e1^2. Cosine and sine of one angle are such symbols, too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from math import comb

from eomgen.symbolic.exact.rational_polynomial import Exponents, PowerSum
from eomgen.symbolic.exact.terms import Key, Terms
from eomgen.symbolic.expression import Number, tidy

QuaternionSymbols = tuple[int, ...]  # the symbols, by index

LARGEST_DEGREE = 12  # of a sum that is looked at in other forms


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
    if len(polynomial) < 2 or max(map(sum, polynomial)) > LARGEST_DEGREE or min(map(min, polynomial)) < 0:
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
