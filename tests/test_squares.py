"""Whether a polynomial holds a square, against its square-free decomposition by sympy."""

from __future__ import annotations

from random import Random

from sympy import QQ, ring

from eomgen.symbolic.exact.squares import holds_no_square

R, *GENERATORS = ring("x y z", QQ)


def polynomial(rng: Random, terms: int, degree: int):
    """A random one, its coefficients fractions."""
    found = R.zero
    for _ in range(terms):
        term = R.ground_new(QQ(rng.choice((-3, -2, -1, 1, 2, 5)), rng.randint(1, 4)))
        for x in GENERATORS:
            term *= x ** rng.randint(0, degree)
        found += term
    return found


def test_no_square_is_said_only_where_there_is_none_and_nearly_always_there():
    """f = prod of p_i^e_i by sympy: some e_i > 1, or none."""
    rng = Random(4)
    missed = 0
    for _ in range(120):
        f = polynomial(rng, rng.randint(1, 4), 2) * polynomial(rng, rng.randint(1, 3), 1) ** rng.choice((0, 1, 2))
        if not f or f.is_ground:
            continue
        simple = all(e == 1 for _, e in f.sqf_list()[1])
        assert simple or not holds_no_square(f)
        missed += simple and not holds_no_square(f)
    assert missed == 0
