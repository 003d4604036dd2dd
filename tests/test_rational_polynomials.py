"""Polynomials over the rational numbers: their laws, and the values that sympy gives."""

from __future__ import annotations

from math import gcd, prod
from random import Random

import pytest
import sympy

from eomgen.symbolic.exact.polynomials import RationalPolynomial
from eomgen.symbolic.exact.terms import TooLarge
from eomgen.symbolic.expression.rational import Fraction


def polynomial(rng, terms, generators=3, degree=2):
    """A random one, its coefficients fractions, not 0."""
    while True:
        found = RationalPolynomial.of(
            {
                tuple(rng.randint(0, degree) for _ in range(generators)): Fraction(
                    rng.randint(-9, 9), rng.randint(1, 6)
                )
                for _ in range(terms)
            }
        )
        if found.terms:
            return found


def value(f, at):
    return sum(c * prod(x**e for x, e in zip(at, exponents, strict=True)) for exponents, c in f.terms)


def point(rng, generators=3):
    return [Fraction(rng.randint(2, 99), rng.randint(1, 9)) for _ in range(generators)]


@pytest.mark.slow
@pytest.mark.parametrize("find", [RationalPolynomial.factors, RationalPolynomial.square_free])
def test_the_factors_multiply_to_the_polynomial_in_whole_numbers(find):
    """f = c prod p^n; each p in whole numbers without common divisor, the leading one positive."""
    rng = Random(3)
    for _ in range(40):
        f = polynomial(rng, 3) * polynomial(rng, 2) ** rng.choice((1, 2, 3)) * polynomial(rng, 1)
        number, parts = find(f)
        at = point(rng)
        assert number * prod(value(p, at) ** n for p, n in parts) == value(f, at)
        for p, _ in parts:
            numbers = [c for _, c in p.terms]
            assert p.leading > 0 and all(type(c) is int for c in numbers) and gcd(*numbers) == 1


def test_a_square_is_found_and_no_other_power():
    """(p q)^2 r is what it is for p, q, r without squares."""
    x_y = RationalPolynomial.of({(1, 0): 1, (0, 1): 2})
    r = RationalPolynomial.of({(2, 0): 3, (0, 0): 1})
    number, parts = (x_y**2 * r).scaled(Fraction(-5, 4)).square_free()
    assert number == Fraction(-5, 4) and dict(parts) == {x_y: 2, r: 1}


def test_two_polynomials_lose_what_they_have_in_common():
    """(f d)/(g d) = f/g for f, g without a common divisor; f d over d is f, and f over d is nothing."""
    rng = Random(5)
    for _ in range(30):
        f, g, d = (polynomial(rng, n) for n in (3, 4, 2))
        above, below = (f * d).without_common_divisor(g * d)
        least = f.without_common_divisor(g)
        assert above * least[1] == below * least[0]
        assert [part.degree for part in (above, below)] == [part.degree for part in least]
        assert (f * d).over(d) == f
    x, y = (RationalPolynomial.of({e: 1, (0, 0): 1}) for e in ((1, 0), (0, 1)))
    assert x.over(y) is None


def test_a_polynomial_with_negative_powers_is_refused_where_it_would_be_factored():
    with pytest.raises(TooLarge, match="negative powers"):
        RationalPolynomial.of({(-1, 0): 1, (0, 2): 1}).factors()


def test_negative_powers_are_cleared_before_a_common_divisor_is_sought():
    """above/below stays what it is, and the two are polynomials."""
    rng = Random(0)
    above, below = polynomial(rng, 5, generators=4), polynomial(rng, 6, generators=4)
    below = RationalPolynomial.of({(a, b - 2, c, d): x for (a, b, c, d), x in below.terms})
    up, down = above.without_common_divisor(below)
    assert all(e >= 0 for part in (up, down) for exponents, _ in part.terms for e in exponents)
    at = point(rng, 4)
    assert value(above, at) * value(down, at) == value(up, at) * value(below, at)


def test_a_divisor_of_polynomials_in_many_generators_is_not_sought_for_hours():
    """15 generators to the fifth power: integers of 5^15 digits in sympy's way; powers cancel."""
    rng = Random(0)
    f, g = (polynomial(rng, n, generators=15, degree=5) for n in (5, 9))
    x = RationalPolynomial.of({(1,) * 15: 1})
    assert (f * x).without_common_divisor(g * x * x)[1] == (f.without_common_divisor(g * x))[1]


def in_sympy(f):
    """The polynomial as sympy has it."""
    x = sympy.symbols("x:3")
    return sympy.Add(
        *(
            sympy.Rational(int(c.numerator), int(c.denominator)) * sympy.prod([b**e for b, e in zip(x, n, strict=True)])
            for n, c in f.terms
        )
    )


@pytest.mark.slow
def test_factors_are_those_of_sympy():
    """The number before them, and each irreducible factor with its power, but for its sign."""
    rng = Random(7)
    for _ in range(15):
        f, g, h = (polynomial(rng, n) for n in (3, 2, 2))
        number, factors = (f * g * g * h).factors()
        theirs = sympy.factor_list(in_sympy(f * g * g * h))[1]
        assert len(theirs) == len(factors)
        ours = [(sympy.expand(in_sympy(each)), n) for each, n in factors]
        for p, k in theirs:
            assert (sympy.expand(p), k) in ours or (sympy.expand(-p), k) in ours
        assert sympy.expand(number * sympy.prod([p**n for p, n in ours]) - in_sympy(f * g * g * h)) == 0
