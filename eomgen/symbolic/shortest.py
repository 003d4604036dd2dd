"""A sum of waves -> the shortest way to write it: 27/2 cos(theta)^2, cos(theta1 - theta2), sin(theta) cos(theta).

Candidates: the waves themselves; powers of sines and cosines with s^2 or c^2 eliminated, angle by angle; powers along
each direction of the angles (theta1 - theta2 is one), which keeps the energies of long chains short. The candidate with
the fewest terms wins, then the one without multiple angles, then the one with fewer minus signs.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from itertools import product
from math import comb, gcd

from eomgen.symbolic.graph import Number
from eomgen.symbolic.terms import Vector, Wave, common_number, tidy

Waves = dict[Wave, Number]
Factors = tuple[tuple[str, Vector, int], ...]  # (function, angle, exponent)
Sum = tuple[tuple[Number, Factors], ...]
Powers = tuple[tuple[int, int], ...]  # for each axis the exponents of its cosine and sine
Polynomial = dict[Powers, Number]

LARGEST_DEGREE = 12  # of a wave to be written in powers
MOST_AXES = 6
MOST_CHOICES = 64  # of forms along the directions, tried all


def shortest(waves: Waves) -> Sum:
    """The sum of coefficient * wave, written in as few terms as the candidates allow.

    Args:
        waves: {wave: coefficient}; () is the wave 1.
    """
    if len(waves) == 1 and not _has_multiple(waves):
        return _as_waves(waves)
    candidates = [_as_waves(waves), _by_directions(waves)]
    whole = _in_powers(waves)
    if whole is not None:
        candidates.append(whole)
    candidates.append(_by_support(waves))
    return min(candidates, key=_length)


def _length(terms: Sum) -> tuple[int, int, int, int]:
    multiple = sum(1 for _, factors in terms if any(_is_multiple(k) for _, k, _ in factors))
    negative = sum(1 for c, _ in terms if c < 0)
    return len(terms), multiple, negative, sum(e for _, factors in terms for _, _, e in factors)


def _is_multiple(k: Vector) -> bool:
    return k[0][0] >= 0 and gcd(*(c.numerator for _, c in k)) > 1


def _has_multiple(waves: Waves) -> bool:
    return any(w and _is_multiple(w[1]) for w in waves)


def _as_waves(waves: Waves) -> Sum:
    return tuple((c, ((w[0], w[1], 1),) if w else ()) for w, c in sorted(waves.items()))


# -- along directions ---------------------------------------------------------------------------


def _by_directions(waves: Waves) -> Sum:
    """Powers of cos and sin of one combination of angles each: cos(2a - 2b) = 2 cos(a - b)^2 - 1."""
    directions: dict[Vector, Waves] = {}
    for w, c in waves.items():
        if w:
            directions.setdefault(_direction(w[1]), {})[w] = c
    forms = [_forms(rays) for rays in directions.values()]
    best: Sum | None = None
    count = 1
    for options in forms:
        count *= len(options)
    choices = product(*forms) if count <= MOST_CHOICES else [[min(options, key=_size_of_form) for options in forms]]
    for choice in choices:
        number: Number = waves.get((), 0)
        rest: list[tuple[Number, Factors]] = []
        for shift, terms in choice:
            number = tidy(number + shift)
            rest += terms
        candidate = ((number, ()), *rest) if number else tuple(rest)
        if best is None or _length(candidate) < _length(best):
            best = candidate
    return best if best is not None else _as_waves(waves)


Form = tuple[Number, Sum]  # a plain number and the terms beside it


def _size_of_form(form: Form) -> tuple[int, int, int, int]:
    return _length(form[1])


def _forms(rays: Waves) -> list[Form]:
    """The waves of one direction: as they are, with s^2 eliminated, and with c^2 eliminated."""
    forms: list[Form] = [(0, _as_waves(rays))]
    polynomial, axes = _polynomial(rays) or ({}, ())
    if axes and any(_is_multiple(w[1]) or w[1] != axes[0] for w in rays if w):
        for keep in ("cos", "sin"):
            reduced = _eliminated(polynomial, 0, keep)
            number = reduced.pop(((0, 0),), 0)
            forms.append((number, _as_sum(reduced, axes)))
    return forms


def _direction(k: Vector) -> Vector:
    """k divided by the largest number that leaves whole multiples."""
    common = common_number(c for _, c in k)
    return tuple((angle, tidy(c / common)) for angle, c in k)


# -- by the angles that occur together --------------------------------------------------------


def _by_support(waves: Waves) -> Sum:
    """The waves that hold the same angles together in powers, part by part."""
    parts: dict[tuple[int, ...], Waves] = {}
    for w, c in waves.items():
        parts.setdefault(tuple(angle for angle, _ in w[1]) if w else (), {})[w] = c
    terms: list[tuple[Number, Factors]] = []
    for part in parts.values():
        candidates: list[Sum] = [_as_waves(part), _by_directions(part), _in_powers(part) or _as_waves(part)]
        best: Sum = min(candidates, key=_length)
        terms += best
    return _merged(terms)


def _merged(terms: Iterable[tuple[Number, Factors]]) -> Sum:
    total: dict[Factors, Number] = {}
    for c, factors in terms:
        total[factors] = tidy(total.get(factors, 0) + c)
    return tuple((c, factors) for factors, c in sorted(total.items()) if c)


# -- powers of sines and cosines --------------------------------------------------------------------


def _in_powers(waves: Waves) -> Sum | None:
    """Everything in powers of sines and cosines of the axes; None where that is too large."""
    found = _polynomial(waves)
    if found is None:
        return None
    polynomial, axes = found
    for axis in range(len(axes)):
        options = [_eliminated(polynomial, axis, keep) for keep in ("cos", "sin")]
        polynomial = min(options, key=lambda option: _length(_as_sum(option, axes)))
    return _as_sum(polynomial, axes)


def power_form(waves: Waves, axes: tuple[Vector, ...]) -> Polynomial | None:
    """The waves as a polynomial in the axes' cosines and sines, s^2 eliminated; None where that is too large."""
    polynomial: Polynomial = {}
    for w, c in waves.items():
        multiples = _multiples(w[1], axes) if w else (0,) * len(axes)
        if multiples is None or sum(abs(m) for m in multiples) > LARGEST_DEGREE:
            return None
        for powers, share in _wave_in_powers(w[0] if w else "cos", multiples).items():
            polynomial[powers] = tidy(polynomial.get(powers, 0) + c * share)
    polynomial = {powers: c for powers, c in polynomial.items() if c}
    for axis in range(len(axes)):
        polynomial = _eliminated(polynomial, axis, "cos")
    return polynomial


def _polynomial(waves: Waves) -> tuple[Polynomial, tuple[Vector, ...]] | None:
    axes = axes_of(waves)
    if len(axes) > MOST_AXES:
        return None
    polynomial = power_form(waves, axes)
    return None if polynomial is None else (polynomial, axes)


def axes_of(waves: Iterable[Wave]) -> tuple[Vector, ...]:
    """Angles of which those of all waves are whole combinations.

    Angles that always come in one proportion are one axis: sin(a) cos(b + c) has the axes a and b + c.
    """
    rows = [dict(w[1]) for w in waves if w]
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


def _multiples(k: Vector, axes: tuple[Vector, ...]) -> tuple[int, ...] | None:
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


def _wave_in_powers(kind: str, multiples: tuple[int, ...]) -> Polynomial:
    """cos or sin of a whole combination of the axes, from the product of (c + i s)^m."""
    real: Polynomial = {(): 1}
    imaginary: Polynomial = {}
    for m in multiples:
        c_part, s_part = _one_axis(m)
        real, imaginary = (
            _joined((real, c_part, 1), (imaginary, s_part, -1)),
            _joined((real, s_part, 1), (imaginary, c_part, 1)),
        )
    return real if kind == "cos" else imaginary


def _one_axis(m: int) -> tuple[dict[tuple[int, int], int], dict[tuple[int, int], int]]:
    """(cos(m a), sin(m a)) in powers of cos a and sin a, by de Moivre."""
    n, sense = abs(m), 1 if m >= 0 else -1
    cosine = {(n - j, j): (-1) ** (j // 2) * comb(n, j) for j in range(0, n + 1, 2)}
    sine = {(n - j, j): sense * (-1) ** (j // 2) * comb(n, j) for j in range(1, n + 1, 2)}
    return cosine, sine


def _joined(*products: tuple[Polynomial, dict[tuple[int, int], int], int]) -> Polynomial:
    total: Polynomial = {}
    for left, right, sign in products:
        for powers, c in left.items():
            for pair, d in right.items():
                total[(*powers, pair)] = total.get((*powers, pair), 0) + sign * c * d
    return {powers: c for powers, c in total.items() if c}


def _eliminated(polynomial: Polynomial, axis: int, keep: str) -> Polynomial:
    """With s^2 = 1 - c^2 (keep "cos") or c^2 = 1 - s^2 (keep "sin") used up for one axis."""
    total: Polynomial = {}
    for powers, coefficient in polynomial.items():
        c, s = powers[axis]
        kept, gone = (c, s) if keep == "cos" else (s, c)
        for j in range(gone // 2 + 1):
            pair = (kept + 2 * j, gone % 2) if keep == "cos" else (gone % 2, kept + 2 * j)
            key = (*powers[:axis], pair, *powers[axis + 1 :])
            total[key] = tidy(total.get(key, 0) + coefficient * comb(gone // 2, j) * (-1) ** j)
    return {powers: c for powers, c in total.items() if c}


def _as_sum(polynomial: Polynomial, axes: tuple[Vector, ...]) -> Sum:
    """The polynomial's terms, low powers first."""
    terms = []
    for powers in sorted(polynomial, key=lambda powers: (sum(c + s for c, s in powers), powers)):
        factors: list[tuple[str, Vector, int]] = []
        for axis, (c, s) in zip(axes, powers, strict=True):
            factors += [(kind, axis, e) for kind, e in (("sin", s), ("cos", c)) if e]
        terms.append((polynomial[powers], tuple(factors)))
    return tuple(terms)
