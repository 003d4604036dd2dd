"""A sum of waves -> the shortest way to write it: 27/2 cos(theta)^2, cos(theta1 - theta2), sin(theta) cos(theta).

Candidates: the waves themselves; powers of sines and cosines with s^2 or c^2 eliminated, angle by angle; powers along
each direction of the angles (theta1 - theta2 is one), which keeps the energies of long chains short; products of two in
place of pairs. The candidate with the fewest terms wins, then the one without multiple angles, then the one with fewer
minus signs.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from itertools import product
from math import gcd

from eomgen.symbolic.exact.powers import axes_of, eliminated, power_form
from eomgen.symbolic.exact.rational_polynomial import PowerSum
from eomgen.symbolic.exact.terms import AngleSum, Wave, common_number, vector_sum, wave
from eomgen.symbolic.expression.exact_numbers import tidy
from eomgen.symbolic.expression.graph import Number
from eomgen.symbolic.expression.rational import Fraction

Waves = dict[Wave, Number]
Factors = tuple[tuple[str, AngleSum, int], ...]  # (function, angle, exponent)
Sum = tuple[tuple[Number, Factors], ...]

MOST_WAVES = 500  # of a sum that is shortened: more are too long to be read either way
MOST_AXES = 6
MOST_PAIRED = 60  # waves among which pairs are sought
MOST_CHOICES = 64  # of forms along the directions, tried all
KEPT = 4096  # sums of which the shortest form is remembered


def shortest(waves: Waves) -> Sum:
    """The sum of coefficient * wave, written in as few terms as the candidates allow.

    Args:
        waves: {wave: coefficient}; () is the wave 1.
    """
    if len(waves) > MOST_WAVES or (len(waves) == 1 and not _has_multiple(waves)):
        return _as_waves(waves)
    number = common_number(waves.values())
    if number == 1:
        return _shortest(tuple(sorted(waves.items())))
    found = _shortest(tuple(sorted((w, tidy(c / number)) for w, c in waves.items())))
    return tuple((tidy(number * c), factors) for c, factors in found)


@lru_cache(maxsize=KEPT)
def _shortest(items: tuple[tuple[Wave, Number], ...]) -> Sum:
    """The search itself: one sum comes several times on its way into a formula."""
    waves = dict(items)
    pairs, rest = _paired(waves)
    if not pairs:
        return _without_pairs(waves)
    return _best(_without_pairs(waves), _merged([*pairs, *_without_pairs(rest)]))


def _without_pairs(waves: Waves) -> Sum:
    plain = _as_waves(waves)
    return _best(plain, _by_directions(waves), _in_powers(waves) or plain, _by_support(waves))


def _best(*candidates: Sum) -> Sum:
    """The shortest, the first of those that are equally short."""
    fewest = min(map(len, candidates))
    left = [candidate for candidate in candidates if len(candidate) == fewest]
    return left[0] if len(left) == 1 else min(left, key=_length)


def _length(terms: Sum) -> tuple[int, int, int, int]:
    multiple = sum(1 for _, factors in terms if any(_is_multiple(k) for _, k, _ in factors))
    negative = sum(1 for c, _ in terms if c < 0)
    return len(terms), multiple, negative, sum(e for _, factors in terms for _, _, e in factors)


@lru_cache(maxsize=KEPT)
def _is_multiple(k: AngleSum) -> bool:
    return k[0][0] >= 0 and gcd(*(c.numerator for _, c in k)) > 1


def _has_multiple(waves: Waves) -> bool:
    return any(w and _is_multiple(w[1]) for w in waves)


def _as_waves(waves: Waves) -> Sum:
    return tuple((c, ((w[0], w[1], 1),) if w else ()) for w, c in sorted(waves.items()))


# -- along directions ---------------------------------------------------------------------------


def _by_directions(waves: Waves) -> Sum:
    """Powers of cos and sin of one combination of angles each: cos(2a - 2b) = 2 cos(a - b)^2 - 1."""
    directions: dict[AngleSum, Waves] = {}
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
    if _is_one_axis({w[1] for w in rays if w}):
        return forms
    polynomial, axes = _polynomial(rays) or ({}, ())
    if axes and any(_is_multiple(w[1]) or w[1] != axes[0] for w in rays if w):
        for keep in ("cos", "sin"):
            reduced = eliminated(polynomial, 0, keep)
            rest = {powers: c for powers, c in reduced.items() if any(powers)}
            forms.append((reduced.get((0, 0), 0), _as_sum(rest, axes)))
    return forms


def _is_one_axis(angles: set[AngleSum]) -> bool:
    """Whether all is of one angle, which is no multiple of another."""
    return len(angles) == 1 and gcd(*(c.numerator for k in angles for _, c in k)) == 1


def _direction(k: AngleSum) -> AngleSum:
    """k divided by the largest number that leaves whole multiples."""
    common = common_number(c for _, c in k)
    return tuple((angle, tidy(c / common)) for angle, c in k)


# -- in pairs ---------------------------------------------------------------------------------


def _paired(waves: Waves) -> tuple[list[tuple[Number, Factors]], Waves]:
    """(products, the other waves): cos(b) + cos(2 a + b) = 2 cos(a) cos(a + b), and so on, where that is whole."""
    products: list[tuple[Number, Factors]] = []
    rest = dict(waves)
    ordered = sorted(w for w in waves if w)[:MOST_PAIRED]
    for i, v in enumerate(ordered):
        for w in ordered[i + 1 :]:
            if v in rest and w in rest and v[0] == w[0] and abs(rest[v]) == abs(rest[w]):
                product = _product_of_pair(v[0], v[1], w[1], rest[v], rest[v] == rest[w])
                if product is not None:
                    products.append(product)
                    del rest[v], rest[w]
    return products, rest


def _product_of_pair(kind: str, k: AngleSum, l: AngleSum, c: Number, same: bool) -> tuple[Number, Factors] | None:
    """c (f(k) + f(l)), or c (f(k) - f(l)) where not `same`, as one product; None where (k + l)/2 is not whole."""
    halves = [tuple((angle, tidy(Fraction(m) / 2)) for angle, m in vector_sum(k, l, sign)) for sign in (1, -1)]
    if not all(halves) or any(type(m) is not int or angle < 0 for half in halves for angle, m in half):
        return None
    if kind == "cos":
        functions = ("cos", "cos") if same else ("sin", "sin")
    else:
        functions = ("sin", "cos") if same else ("cos", "sin")
    c = 2 * c if same or kind == "sin" else -2 * c
    factors = []
    for function, half in zip(functions, halves, strict=True):
        (name, vector), sign = _named(wave(function, half))
        c *= sign
        factors.append((name, vector, 1))
    return tidy(c), tuple(sorted(factors))


def _named(found: tuple[Wave, int]) -> tuple[tuple[str, AngleSum], int]:
    """A wave that is not 1."""
    w, sign = found
    assert w
    return w, sign


# -- by the angles that occur together --------------------------------------------------------


def _by_support(waves: Waves) -> Sum:
    """The waves that hold the same angles together in powers, part by part."""
    parts: dict[tuple[int, ...], Waves] = {}
    for w, c in waves.items():
        parts.setdefault(tuple(angle for angle, _ in w[1]) if w else (), {})[w] = c
    if len(parts) == 1:
        return _as_waves(waves)  # in one part it is what the other candidates are
    terms: list[tuple[Number, Factors]] = []
    for part in parts.values():
        plain = _as_waves(part)
        alone = len(part) == 1 and not _has_multiple(part)
        terms += plain if alone else _best(plain, _by_directions(part), _in_powers(part) or plain)
    return _merged(terms)


def _merged(terms: Iterable[tuple[Number, Factors]]) -> Sum:
    total: dict[Factors, Number] = {}
    for c, factors in terms:
        total[factors] = tidy(total.get(factors, 0) + c)
    return tuple((c, factors) for factors, c in sorted(total.items()) if c)


# -- in powers ---------------------------------------------------------------------------------


def _in_powers(waves: Waves) -> Sum | None:
    """Everything in powers of sines and cosines of the axes; None where that is too large."""
    found = _polynomial(waves)
    if found is None:
        return None
    polynomial, axes = found
    for axis in range(len(axes)):  # it comes with the sines' squares eliminated
        other = eliminated(polynomial, axis, "sin")
        if len(other) < len(polynomial) or (
            len(other) == len(polynomial) and _size_of_powers(other, axes) < _size_of_powers(polynomial, axes)
        ):
            polynomial = other
    return _as_sum(polynomial, axes)


def _size_of_powers(polynomial: PowerSum, axes: tuple[AngleSum, ...]) -> tuple[int, int, int, int]:
    """`_length` of what will be written of it."""
    doubled = [2 * k + i for k, axis in enumerate(axes) if _is_multiple(axis) for i in (0, 1)]
    multiple = sum(any(powers[i] for i in doubled) for powers in polynomial) if doubled else 0
    negative = sum(c < 0 for c in polynomial.values())
    return len(polynomial), multiple, negative, sum(map(sum, polynomial))


def _polynomial(waves: Waves) -> tuple[PowerSum, tuple[AngleSum, ...]] | None:
    axes = axes_of(waves)
    if len(axes) > MOST_AXES:
        return None
    polynomial = power_form(waves, axes)
    return None if polynomial is None else (polynomial, axes)


def _as_sum(polynomial: PowerSum, axes: tuple[AngleSum, ...]) -> Sum:
    """The polynomial's terms, low powers first."""
    terms = []
    for powers in sorted(polynomial, key=lambda powers: (sum(powers), powers)):
        factors: list[tuple[str, AngleSum, int]] = []
        for axis, c, s in zip(axes, powers[::2], powers[1::2], strict=True):
            factors += [(kind, axis, e) for kind, e in (("sin", s), ("cos", c)) if e]
        terms.append((polynomial[powers], tuple(factors)))
    return tuple(terms)
