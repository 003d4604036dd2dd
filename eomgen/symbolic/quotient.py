"""A sum of terms with divisors -> numerator and denominator without a common factor, by sympy.polys."""

from __future__ import annotations

from fractions import Fraction

from eomgen.symbolic.expansion import Expansion
from eomgen.symbolic.graph import Number
from eomgen.symbolic.powers import axes_of, power_form
from eomgen.symbolic.terms import Terms, Vector, Wave, common_monomial, constant, plus, tidy

MOST_AXES = 4  # angles, for a common divisor to be sought in their sines too
LARGEST_PRODUCT = 20_000  # terms of the numerator times terms of the denominator, for a common divisor to be sought

Axes = tuple[Vector, ...]
Exponents = tuple[int, ...]
Polynomial = dict[Exponents, Number]  # in the atoms, then the cosine and sine of each axis


def reduced(expansion: Expansion, terms: Terms) -> tuple[Terms, Terms]:
    """(numerator, denominator) without common factor as polynomials, s^2 = 1 - c^2 used, then c^2 = 1 - s^2.

    Raises:
        TooLarge: the expansion's limit is reached.
    """
    numerator, denominator = _fraction(expansion, terms)
    if not numerator:
        return {}, constant(1)
    if len(denominator) > 1 or any(w for _, w in denominator):
        numerator, denominator = _without_common_divisor(expansion, numerator, denominator)
    return numerator, denominator


def _fraction(expansion: Expansion, terms: Terms) -> tuple[Terms, Terms]:
    """(numerator, denominator) without negative powers."""
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


def _without_common_divisor(expansion: Expansion, numerator: Terms, denominator: Terms) -> tuple[Terms, Terms]:
    from sympy.polys.domains import QQ
    from sympy.polys.rings import PolyRing

    if len(numerator) * len(denominator) > LARGEST_PRODUCT:
        return numerator, denominator
    axes = axes_of([w for part in (numerator, denominator) for _, w in part])
    atoms = sorted({atom for part in (numerator, denominator) for monomial, _ in part for atom, _ in monomial})
    above, below = (_polynomial(part, atoms, axes) for part in (numerator, denominator))
    if above is None or below is None or len(above) * len(below) > LARGEST_PRODUCT:
        return numerator, denominator
    names = [f"a{i}" for i in range(len(atoms))] + [f"{f}{i}" for i in range(len(axes)) for f in "cs"]
    ring = PolyRing(names, QQ)
    elements = [ring.from_dict({e: QQ(c.numerator, c.denominator) for e, c in p.items()}) for p in (above, below)]
    _, above, below = elements[0].cofactors(elements[1])
    if len(axes) <= MOST_AXES and any(any(e[len(atoms) + 1 :: 2]) for e in below.monoms()):
        first = len(atoms)
        above, below = (_in_sines(ring, part, range(first, len(names), 2)) for part in (above, below))
        _, above, below = above.cofactors(below)
    numerator, denominator = (_terms(expansion, part, atoms, axes) for part in (above, below))
    return numerator, denominator


def _in_sines(ring, polynomial, cosines):
    """The same function with c^2 = 1 - s^2 used: a common factor s shows."""
    total = ring.zero
    for exponents, c in polynomial.terms():
        part, rest = ring.one * c, list(exponents)
        for i in cosines:
            part *= (1 - ring.gens[i + 1] ** 2) ** (exponents[i] // 2)
            rest[i] %= 2
        total += part.mul_monom(tuple(rest))
    return total


def _polynomial(terms: Terms, atoms: list[int], axes: Axes) -> Polynomial | None:
    groups: dict[tuple, dict[Wave, Number]] = {}
    for (monomial, w), c in terms.items():
        groups.setdefault(monomial, {})[w] = c
    polynomial: Polynomial = {}
    for monomial, waves in groups.items():
        powers = power_form(waves, axes)
        if powers is None:
            return None
        exponents = dict(monomial)
        head = tuple(exponents.get(atom, 0) for atom in atoms)
        for pairs, c in powers.items():
            polynomial[(*head, *(e for pair in pairs for e in pair))] = c
    return polynomial


def _terms(expansion: Expansion, polynomial, atoms: list[int], axes: Axes) -> Terms:
    """A polynomial of sympy's ring as a sum of terms."""
    total: Terms = {}
    for exponents, c in polynomial.terms():
        monomial = tuple((atom, e) for atom, e in zip(atoms, exponents, strict=False) if e)
        part: Terms = {(monomial, ()): _number(c)}
        for i, axis in enumerate(axes):
            for kind, e in zip(("cos", "sin"), exponents[len(atoms) + 2 * i :][:2], strict=True):
                for _ in range(e):
                    part = expansion.product(part, {((), (kind, axis)): 1})
        total = plus(total, part)
    return total


def _number(c) -> Number:
    """An element of sympy's QQ as an exact number of ours."""
    return tidy(Fraction(int(c.numerator), int(c.denominator)))
