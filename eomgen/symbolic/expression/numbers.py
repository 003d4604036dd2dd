"""Exact numbers: `int` and `Fraction`, a whole one always as `int`."""

from __future__ import annotations

from math import isqrt

from eomgen.errors import DerivationError
from eomgen.symbolic.expression.rational import EXACT, Fraction
from eomgen.symbolic.expression.splines import Sampled

Number = int | Fraction

LARGEST_NUMBER = 65_536  # bits of a power of exact numbers: 9**9**9 is refused, not computed


def exact(a: object) -> Number:
    """a as an exact number, a whole one as int."""
    if type(a) is int:
        return a
    if isinstance(a, EXACT):
        return a.numerator if a.denominator == 1 else a if type(a) is Fraction else Fraction(a)
    raise TypeError(f"a derivation holds exact numbers only, not {a!r} of type {type(a).__name__}")


def tidy(a: Number) -> Number:
    """a, a whole one as int."""
    return a.numerator if type(a) is Fraction and a.denominator == 1 else a


def exact_power(base: Number, exponent: int) -> Number:
    """base ** exponent for a whole exponent > 0.

    Raises:
        DerivationError: the result would have more than LARGEST_NUMBER bits.
    """
    bits = max(abs(base.numerator), base.denominator).bit_length() * exponent
    if abs(base) not in (0, 1) and bits > LARGEST_NUMBER:
        raise DerivationError(f"a power of an exact number is too large: about 2**{bits}")
    return tidy(base**exponent)


def root_of(c: Number) -> tuple[Number, int]:
    """(outside, inside) with sqrt(c) = outside * sqrt(inside), inside a whole number; squares extracted."""
    c = Fraction(c)
    inside = c.numerator * c.denominator  # sqrt(p/q) = sqrt(p q) / q
    outside = Fraction(1, c.denominator)
    root = isqrt(inside)
    if root * root == inside:
        return tidy(outside * root), 1
    factor = 2
    while factor * factor <= inside and factor < 10_000:
        while inside % (factor * factor) == 0:
            inside //= factor * factor
            outside *= factor
        factor += 1
    return tidy(outside), inside


def folded_at(name: str, a: Number) -> Number | None:
    """The exact value of a function at an exact number, or None where there is none."""
    if name == "abs":
        return -a if a < 0 else a
    if name == "sign":
        return 1 if a > 0 else -1 if a < 0 else 0
    if a == 0 and name in ("asin", "atan", "sinh", "tanh"):
        return 0
    if a == 0 and name in ("exp", "cosh"):
        return 1
    if a == 1 and name in ("log", "acos"):
        return 0
    return None


def binary_folded_at(name: str, a: Number, b: Number) -> Number | None:
    """The exact value of a function of two exact numbers, or None where there is none."""
    if name == "min":
        return min(a, b)
    if name == "max":
        return max(a, b)
    if name == "less":
        return int(a < b)
    if name == "less_equal":
        return int(a <= b)
    if name == "sampled":
        sampled = Sampled.of(b)
        return None if sampled.pi_power else tidy(sampled.spline.at(Fraction(a)))
    return 0 if name == "atan2" and a == 0 and b > 0 else None
