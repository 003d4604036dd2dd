"""Distances keep their form: expressions over roots are the same functions, written with the roots as symbols."""

from __future__ import annotations

import pytest

from eomgen.symbolic.exact.book_forms import Rooted, is_root_of_sum, readable_over
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.exact.terms import TooLarge
from eomgen.symbolic.expression.derivatives import gradient, tangent
from eomgen.symbolic.expression.formula import cos, sin, sqrt
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Scalar
from eomgen.symbolic.print.text import to_text

LIMIT = 2000


@pytest.fixture
def symbols() -> dict[str, Scalar]:
    graph = Graph()
    return {name: graph.symbol(name) for name in "k l0 c a b theta x G m theta' x'".split()}


def distance(s: dict[str, Scalar]) -> Scalar:
    """Between (x, b) and a point of a crank."""
    dx, dy = s["a"] * sin(s["theta"]) - s["x"], s["b"] - s["a"] * cos(s["theta"])
    return sqrt(dx * dx + dy * dy)


def written(x: Scalar) -> tuple[str, Scalar]:
    """(text with r for the first root and v for the second symbol, the expression with its roots)."""
    over = Rooted.of((x,), LIMIT)
    short = readable_over(over.expressions[0], [symbol for symbol, _ in over.roots], LIMIT)
    names = {symbol: name for (symbol, _), name in zip(over.roots, "rvw", strict=False)}
    return to_text(short, names), over.back((short,))[0]


def test_the_force_of_a_spring_is_factored(symbols):
    """-d/dx k (r - l0)^2/2 = k (1 - l0/r) (a sin theta - x)"""
    k, l0, x = symbols["k"], symbols["l0"], symbols["x"]
    stretch = distance(symbols) - l0
    force = -gradient(k * stretch * stretch / 2, (x,))[0]
    text, same = written(force)
    assert text == "k*(1 - l0/r)*(a*sin(theta) - x)"
    assert equal_at_random_states([(same, force)]).equal


def test_a_spring_is_found_beside_other_forces(symbols):
    """6 k x merges with k x of the spring, and is taken apart again"""
    k, l0, x = symbols["k"], symbols["l0"], symbols["x"]
    stretch = distance(symbols) - l0
    force = -gradient(k * stretch * stretch / 2 + 3 * k * x * x, (x,))[0]
    text, same = written(force)
    assert text == "k*(1 - l0/r)*(a*sin(theta) - x) - 6*k*x"
    assert equal_at_random_states([(same, force)]).equal


def test_an_attraction_is_a_sum_over_the_cube_of_the_distance(symbols):
    """-d/dx (-G m / r) = G m (a sin theta - x) / r^3"""
    force = -gradient(-symbols["G"] * symbols["m"] / distance(symbols), (symbols["x"],))[0]
    text, same = written(force)
    assert text == "G*m*(a*sin(theta) - x)/r^3"
    assert equal_at_random_states([(same, force)]).equal


def test_the_rate_of_a_distance_has_a_symbol_of_its_own(symbols):
    """c v (a sin theta - x)/r, v = r'"""
    dx, dy = symbols["a"] * sin(symbols["theta"]) - symbols["x"], symbols["b"] - symbols["a"] * cos(symbols["theta"])
    r = sqrt(dx * dx + dy * dy)
    rates = tangent((dx, dy), {symbols["theta"]: symbols["theta'"], symbols["x"]: symbols["x'"]})
    v = dx / r * rates[0] + dy / r * rates[1]
    force = symbols["c"] * v * dx / r
    text, same = written(force)
    assert text == "c*v*(a*sin(theta) - x)/r"
    assert equal_at_random_states([(same, force)]).equal


def test_roots_of_numbers_and_squares_are_no_roots_of_sums(symbols):
    """sqrt(2), sqrt(x^2)"""
    x = symbols["x"]
    assert not any(is_root_of_sum(root) for root in (sqrt(2), sqrt(x * x), x, 2))
    assert is_root_of_sum(sqrt(x * x + 1))
    assert Rooted.of((x * sqrt(2), 3), LIMIT).roots == ()


def test_what_takes_too_much_work_is_refused(symbols):
    """(a + b + ...)^20"""
    total = sum(symbols.values(), start=0)
    with pytest.raises(TooLarge):
        readable_over(total**20, (), 100)
