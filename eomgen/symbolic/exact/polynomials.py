"""Sums of terms <-> polynomials in their atoms and in the cosine and sine of each axis: elements of a ring of sympy's.

Cosine and sine of one axis are independent generators there, so one function has many forms: s^2 eliminated; c^2
eliminated; or, where all powers of an axis are even or all are odd, the same degree throughout by 1 = c^2 + s^2. In
the last one a common factor or a square is found wherever there is one: 1 + m^2 s^2 - c^2 + 2 m s c is no square to
look at, but s^2 + m^2 s^2 + 2 m s c is s^2 (1 + m^2) + 2 m s c.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from eomgen.symbolic.exact.expansion import Expansion
from eomgen.symbolic.exact.powers import axes_of, power_form
from eomgen.symbolic.exact.terms import AngleSum, Monomial, Terms, TooLarge, Wave, terms_plus
from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Number
from eomgen.symbolic.expression.rational import Fraction

MOST_AXES = 4  # angles, for other forms than that in cosines

Exchange = tuple[int, int, int, tuple[int, int]]
Element = Any  # of sympy's PolyRing


class Polynomials:
    """The ring that holds the given sums of terms.

    Args:
        expansion: owner of the terms.
        parts: sums without negative powers.
    Raises:
        TooLarge: a wave is no polynomial of the axes of all waves.
    """

    def __init__(self, expansion: Expansion, parts: Sequence[Terms]) -> None:
        from sympy.polys.domains import QQ
        from sympy.polys.rings import PolyRing

        self._expansion = expansion
        self._axes: tuple[AngleSum, ...] = axes_of([w for part in parts for _, w in part])
        self._atoms = sorted({atom for part in parts for monomial, _ in part for atom, _ in monomial})
        cosines = [f"{f}{i}" for i in range(len(self._axes)) for f in "cs"]
        self._domain = QQ
        self.ring = PolyRing([*(f"a{i}" for i in range(len(self._atoms))), *cosines], QQ)

    def of(self, terms: Terms) -> Element:
        """The sum with s^2 = 1 - c^2 used."""
        groups: dict[Monomial, dict[Wave, Number]] = {}
        for (monomial, w), c in terms.items():
            groups.setdefault(monomial, {})[w] = c
        polynomial = {}
        for monomial, waves in groups.items():
            powers = power_form(waves, self._axes)
            if powers is None:
                raise TooLarge("a wave of too high a multiple of its angle")
            exponents = dict(monomial)
            head = tuple(exponents.get(atom, 0) for atom in self._atoms)
            for pairs, c in powers.items():
                key = (*head, *(e for pair in pairs for e in pair))
                polynomial[key] = self._domain(c.numerator, c.denominator)
        return self.ring.from_dict(polynomial)

    def terms(self, element: Element) -> Terms:
        """An element as a sum of terms."""
        total: Terms = {}
        for exponents, c in element.terms():
            monomial = tuple((atom, e) for atom, e in zip(self._atoms, exponents, strict=False) if e)
            part: Terms = {(monomial, ()): tidy(Fraction(int(c.numerator), int(c.denominator)))}
            for i, axis in self._columns():
                for kind, e in zip(("cos", "sin"), exponents[i : i + 2], strict=True):
                    for _ in range(e):
                        part = self._expansion.product(part, {((), (kind, axis)): 1})
            total = terms_plus(total, part)
        return total

    def without_common_divisor(self, above: Element, below: Element) -> tuple[Element, Element]:
        """(above, below) of the same quotient, without what they have in common in any of the forms."""
        above, below = _coprime(above, below)
        if 0 < len(self._axes) <= MOST_AXES:
            for form in (self.in_sines, self.of_one_degree):
                if not below.is_ground:
                    above, below = _coprime(form(above), form(below))
        return above, below

    def in_sines(self, element: Element) -> Element:
        """The same function with c^2 = 1 - s^2 used: a common factor s shows."""
        for i, _ in self._columns():
            element = self._each(element, i, lambda c, s: (c % 2, s, c // 2, (1, -1)))
        return element

    def of_one_degree(self, element: Element) -> Element:
        """The same function, of one degree in c and s for each axis whose powers are all even or all odd."""
        for i, _ in self._columns():
            degrees = {e[i] + e[i + 1] for e in element.monoms()}
            if len({degree % 2 for degree in degrees}) == 1:
                top = max(degrees)
                element = self._each(element, i, _to_degree(top))
        return element

    def _columns(self) -> Iterable[tuple[int, AngleSum]]:
        """(place of the cosine among the generators, axis); the sine follows."""
        return ((len(self._atoms) + 2 * k, axis) for k, axis in enumerate(self._axes))

    def _each(self, element: Element, i: int, change: Callable[[int, int], Exchange]) -> Element:
        """Every c^m s^n as c^k s^l f^j; f = 1 - s^2 for (1, -1), c^2 + s^2 for (0, 1)."""
        cosine, sine = self.ring.gens[i : i + 2]
        total = self.ring.zero
        for exponents, number in element.terms():
            k, l, j, (one, sign) = change(*exponents[i : i + 2])
            f = one + (0 if one else cosine**2) + sign * sine**2
            total += (f**j * number).mul_monom((*exponents[:i], k, l, *exponents[i + 2 :]))
        return total


def _to_degree(top: int) -> Callable[[int, int], Exchange]:
    return lambda c, s: (c, s, (top - c - s) // 2, (0, 1))


def _coprime(above: Element, below: Element) -> tuple[Element, Element]:
    """The two without their common divisor, negative powers cleared in both: x^-2/(1 + x^-1) is 1/(x^2 + x)."""
    lowest = [min(*powers, 0) for powers in zip(*above.monoms(), *below.monoms(), strict=True)]
    if any(lowest):
        above, below = (part.mul_monom(tuple(-e for e in lowest)) for part in (above, below))
    _, above, below = above.cofactors(below)
    return above, below
