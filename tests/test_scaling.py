"""Linear equations with common factors in rows and columns: solved as they would be without."""

from __future__ import annotations

from fractions import Fraction

from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.exact.linear import LinearSystem, Pivots, monomial, scaled_solution, without_common_factors
from eomgen.symbolic.expression.derivatives import symbols_of
from eomgen.symbolic.expression.formula import sin, sqrt
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.print.text import to_text


def values(scalars):
    number = fifty_digits().number
    return evaluate(
        scalars, {x: number(Fraction(7 + 3 * k, 11)) for k, x in enumerate(symbols_of(scalars))}, fifty_digits()
    )


def test_a_product_is_a_number_times_powers():
    """-3/2 a^2 sqrt(2)/b"""
    g = Graph()
    a, b = g.symbol("a"), g.symbol("b")
    x = monomial(-Fraction(3, 2) * a * a * sqrt(2) / b)
    assert x.number == -Fraction(3, 2)
    assert {str(atom): e for atom, e in x.powers.items()} == {"a": 2, "b": -1, "sqrt(2)": 1}
    assert equal_at_random_states([(x.scalar(), -Fraction(3, 2) * a * a * sqrt(2) / b)]).equal


def test_lengths_and_heights_leave_plain_numbers():
    """A knot of two bars, (2 a, h)/L and (-a, h)/K: rows a and h, columns 1/L and 1/K are taken out."""
    g = Graph()
    a, h = g.symbol("a"), g.symbol("h")
    L, K = sqrt(4 * a * a + h * h), sqrt(a * a + h * h)
    found = without_common_factors([{0: 2 * a / L, 1: -a / K}, {0: h / L, 1: h / K}], [0, 1], {a, h})
    assert all(type(x) is not Node for row in found.rows for x in row.values())


def test_a_root_of_a_quotient_is_two_roots():
    """sqrt(3/f) = sqrt(3)/sqrt(f), so that a bar's length is seen in all of (-3 a/L, sqrt(3/L^2) a, 2 h/L)."""
    g = Graph()
    a, h = g.symbol("a"), g.symbol("h")
    f = 3 * a * a + h * h
    found = without_common_factors([{0: -3 * a / sqrt(f), 1: a * sqrt(3 / f)}, {0: h, 1: a}], [0, 0], {a, h})
    assert all("sqrt(3*a^2" not in to_text(x) for row in found.rows for x in row.values())
    assert monomial(g.sqrt(5 * a)).powers == monomial(g.sqrt(5) * g.sqrt(a)).powers


def test_the_solution_is_that_of_the_equations_as_given():
    """x0, x1 of the same knot under P."""
    g = Graph()
    a, h, P = g.symbol("a"), g.symbol("h"), g.symbol("P")
    L, K = sqrt(4 * a * a + h * h), sqrt(a * a + h * h)
    rows, right = [{0: 2 * a / L, 1: -a / K}, {0: h / L, 1: h / K}], [0, -P]
    x = scaled_solution(LinearSystem(rows, right, 2, values), Pivots(factors={a, h})).constants
    pairs = [(sum((c * x[j] for j, c in row.items()), start=0), b) for row, b in zip(rows, right, strict=True)]
    assert equal_at_random_states(pairs).equal


def test_shares_of_free_unknowns_are_those_of_the_unscaled_ones():
    """a x0 + h x1 = P: x0 = P/a - (h/a) x1."""
    g = Graph()
    a, h, P = g.symbol("a"), g.symbol("h"), g.symbol("P")
    solution = scaled_solution(LinearSystem([{0: a, 1: h}], [P], 2, values), Pivots(factors={a, h}))
    (free,) = solution.free
    j = 1 - free
    total = (a, h)[j] * (solution.constants[j] - solution.shares[j][free] * P) + (a, h)[free] * P
    assert equal_at_random_states([(total, P)]).equal


def test_what_may_vanish_is_not_divided_by():
    """sin(theta) of a coordinate stays in its column."""
    g = Graph()
    theta, a = g.symbol("theta"), g.symbol("a")
    found = without_common_factors([{0: a * sin(theta)}], [1], {a})
    assert equal_at_random_states([(found.rows[0][0], sin(theta))]).equal
