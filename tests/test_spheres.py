"""Symbols on a unit sphere in sums of terms: equal functions have one form, and print shortly."""

from __future__ import annotations

from math import prod
from random import Random

import pytest

from eomgen.symbolic.exact.book_forms import book_form
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.exact.normal_forms import equal, readable
from eomgen.symbolic.exact.polynomials import of_one_degree, with_square_replaced
from eomgen.symbolic.exact.sums import with_squares
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.print.text import to_text


@pytest.fixture
def four():
    """A graph with a unit quaternion."""
    graph = Graph()
    symbols = tuple(graph.symbol(f"e{k}") for k in range(4))
    graph.hold_on_sphere(symbols)
    return symbols


def test_a_norm_is_one(four):
    """(e . e)^2 x = x"""
    x = four[0].graph.symbol("x")
    norm = sum((e * e for e in four), start=0)
    assert to_text(readable(norm * norm * x)) == "x"
    assert equal(norm, 1)
    assert not equal(four[0] * four[0] + four[1] * four[1], 1)


def test_a_form_on_the_sphere_is_the_shorter_one(four):
    """e0^2 + e1^2 - e2^2 - e3^2 = 1 - 2 e2^2 - 2 e3^2, and 4 e0^2 e1^2 stays what it is."""
    e0, e1, e2, e3 = four
    assert to_text(readable(e0 * e0 + e1 * e1 - e2 * e2 - e3 * e3)) == "1 - 2*e2^2 - 2*e3^2"
    assert to_text(readable(4 * e0 * e0 * e1 * e1)) == "4*e0^2*e1^2"


def test_what_is_divided_by_a_component_is_still_compared_rightly(four):
    """(1 - e1^2 - e2^2 - e3^2)/e0 = e0"""
    e0, e1, e2, e3 = four
    assert equal((1 - e1 * e1 - e2 * e2 - e3 * e3) / e0, e0)
    assert not equal((1 - e1 * e1 - e2 * e2) / e0, e0)


@pytest.mark.parametrize("sphere", [(0, 1, 2, 3), (1, 2)], ids=["quaternion", "cosine and sine among others"])
@pytest.mark.parametrize("seed", range(4))
def test_forms_on_the_sphere_are_the_same_function(seed, sphere):
    """A polynomial, with one square used up, and brought to one degree, at a point of the sphere."""
    rng = Random(seed)
    polynomial = {tuple(rng.randint(0, 3) for _ in range(4)): rng.randint(1, 9) for _ in range(5)}
    v = [rng.uniform(-1, 1) for _ in range(4)]
    length = sum(v[i] ** 2 for i in sphere) ** 0.5
    point = [x / length if i in sphere else x for i, x in enumerate(v)]

    def at(form):
        return sum(c * prod(x**e for x, e in zip(point, powers, strict=True)) for powers, c in form.items())

    for k in sphere:
        replaced = with_square_replaced(polynomial, k, sphere)
        assert at(replaced) == pytest.approx(at(polynomial)) and all(powers[k] < 2 for powers in replaced)
    assert at(of_one_degree(polynomial, sphere)) == pytest.approx(at(polynomial))


def test_a_readable_form_is_the_same_function(four):
    """At random exact points of the sphere."""
    e0, e1, e2, e3 = four
    x = (e0 * e1 + e2 * e3) * (e0 * e0 - e3 * e3 + 2 * e1 * e2) * (e0 + e1) ** 2
    assert equal_at_random_states([(readable(x), x)]).equal


def test_parameters_stand_in_parentheses_before_what_moves():
    """I3 w2 w3 - I2 w2 w3 = (I3 - I2) w2 w3"""
    graph = Graph()
    I1, I2, I3 = (graph.constant(f"I{k}") for k in (1, 2, 3))
    w2, w3, a = graph.symbol("w2"), graph.symbol("w3"), graph.symbol("w1'")
    assert to_text(book_form(I1 * a - I2 * w2 * w3 + I3 * w2 * w3)) == "I1*w1' + (I3 - I2)*w2*w3"
    assert to_text(book_form((I2 * w2 * w3 - I3 * w2 * w3) / I1)) == "(I2 - I3)*w2*w3/I1"


def test_squares_of_sums_are_left():
    """1/2 C (cos(a) p' + s')^2 beside 1/2 A a'^2"""
    graph = Graph()
    A, C = graph.constant("A"), graph.constant("C")
    a, p, s, r = (graph.symbol(name) for name in ("a", "p'", "s'", "a'"))
    turning = graph.call("cos", a) * p + s
    energy = (A * r * r + C * turning * turning) / 2
    assert to_text(with_squares(readable(energy))) == "1/2*A*a'^2 + 1/2*C*(cos(a)*p' + s')^2"
