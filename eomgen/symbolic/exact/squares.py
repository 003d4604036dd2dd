"""A polynomial -> whether it surely holds no square, without its factors.

Were f = g^2 h with g of some degree in x, then so would be its image at numbers for all other generators, modulo a
prime, where the degree of f in x is kept; and image and derivative would have a common divisor.
"""

from __future__ import annotations

from random import Random
from typing import Any

from eomgen.symbolic.numeric.evaluation import PRIME


def holds_no_square(f: Any) -> bool:
    """True where no square of a polynomial, but of a number, divides f; False where that is not certain.

    Args:
        f: an element of sympy's ring over the rational numbers.
    """
    terms = [(powers, int(c.numerator), int(c.denominator)) for powers, c in f.terms()]
    if any(below % PRIME == 0 for _, _, below in terms):
        return False
    degrees = [max(column) for column in zip(*(powers for powers, _, _ in terms), strict=True)]
    rng = Random(1)
    places = [rng.randrange(2, PRIME) for _ in degrees]
    up, down = (
        [_powers(x, n) for x, n in zip(numbers, degrees, strict=True)]
        for numbers in (places, [pow(x, -1, PRIME) for x in places])
    )
    values = []
    for powers, above, below in terms:
        value = above * pow(below, -1, PRIME) if below != 1 else above
        for table, e in zip(up, powers, strict=True):
            if e:
                value = value * table[e] % PRIME
        values.append((powers, value))
    return all(_is_simple(_image(values, k, n, down[k])) for k, n in enumerate(degrees) if n)


def _powers(x: int, n: int) -> list[int]:
    found = [1]
    for _ in range(n):
        found.append(found[-1] * x % PRIME)
    return found


def _image(values: list[tuple[tuple[int, ...], int]], k: int, degree: int, down: list[int]) -> list[int]:
    """The coefficients of generator k, the highest first, numbers put in for all others."""
    found = [0] * (degree + 1)
    for powers, value in values:
        found[degree - powers[k]] += value * down[powers[k]]
    return [c % PRIME for c in found]


def _is_simple(f: list[int]) -> bool:
    """Whether f keeps its degree, and has nothing in common with its derivative."""
    n = len(f) - 1
    if not f[0]:
        return False
    a, b = f, _stripped([c * (n - i) % PRIME for i, c in enumerate(f[:-1])])
    while b:
        a, b = b, _remainder(a, b)
    return len(a) == 1


def _remainder(a: list[int], b: list[int]) -> list[int]:
    a, inverse = list(a), pow(b[0], -1, PRIME)
    while len(a) >= len(b):
        factor = a[0] * inverse % PRIME
        for i, c in enumerate(b):
            a[i] = (a[i] - factor * c) % PRIME
        a = a[1:]
    return _stripped(a)


def _stripped(a: list[int]) -> list[int]:
    """Without leading zeros."""
    return a[next((i for i, c in enumerate(a) if c), len(a)) :]
