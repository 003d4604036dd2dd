"""Waves as polynomials in the sines and cosines of a few axes, by de Moivre: cos(m a) + i sin(m a) = (c + i s)^m."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from math import comb

from eomgen.symbolic.exact.rational_polynomial import Exponents, PowerSum
from eomgen.symbolic.exact.spheres import with_square_replaced
from eomgen.symbolic.exact.terms import AngleSum, Monomial, Terms, TooLarge, Wave, common_number
from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Number
from eomgen.symbolic.expression.rational import Fraction

LARGEST_DEGREE = 12  # of a wave to be written in powers
KEPT = 20_000  # waves and sets of angles of which the form is remembered


def power_form(waves: Mapping[Wave, Number], axes: tuple[AngleSum, ...]) -> PowerSum | None:
    """The waves as a polynomial in cosine and sine of each axis, s^2 eliminated; None where that is too large.

    It is the sum of the forms that the waves have by themselves, in which no s^2 is left.
    """
    found: dict[Exponents, Number] = {}
    for w, c in waves.items():
        multiples = _multiples(w[1], axes) if w else (0,) * len(axes)
        if multiples is None or sum(map(abs, multiples)) > LARGEST_DEGREE:
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


@lru_cache(maxsize=2 * LARGEST_DEGREE + 1)
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
    """With s^2 = 1 - c^2 (keep "cos") or c^2 = 1 - s^2 (keep "sin") used up for one axis."""
    pair = (2 * axis, 2 * axis + 1)
    return with_square_replaced(polynomial, pair[keep == "cos"], pair)
