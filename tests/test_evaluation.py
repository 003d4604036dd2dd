"""Evaluation in four arithmetics, and counts of operations."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from random_expressions import POINT, on_graph, polynomials, smooth, values_at

from eomgen.errors import DerivationError
from eomgen.symbolic.exact.equality import evaluate_once
from eomgen.symbolic.expression.derivatives import Count, operations, order
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.numeric.evaluation import (
    FLOAT,
    PRIME,
    PRIME_FIELD,
    RATIONAL,
    NoMeaning,
    NoValue,
    evaluate,
    fifty_digits,
)


@pytest.fixture
def graph() -> Graph:
    return Graph()


def test_the_order_puts_arguments_first_and_holds_each_node_once(graph):
    """Every node that is needed, once, after its arguments."""
    x, y = graph.symbol("x"), graph.symbol("y")
    graph.symbol("unused")
    nodes = order([graph.call("sin", x * y) + x, x * y, 3])
    assert nodes.count(x * y) == 1
    assert len(nodes) == 5
    for i, node in enumerate(nodes):
        assert node.op == "symbol" or all(nodes.index(a) < i for a in node.args)


@given(smooth)
def test_fifty_digits_agree_with_floats(tree):
    """The two arithmetics have the same functions."""
    graph, fifty = Graph(), fifty_digits()
    f = on_graph(tree, graph)
    values = values_at(POINT, graph)
    fine = evaluate([f], {s: fifty.number(Fraction(v)) for s, v in values.items()}, fifty)[0]
    assert float(fine) == pytest.approx(evaluate([f], values, FLOAT)[0], rel=1e-9, abs=1e-9)


@given(polynomials)
def test_the_prime_field_is_an_image_of_the_rationals(tree):
    """f(x) mod p = (f mod p)(x mod p)"""
    graph = Graph()
    f = on_graph(tree, graph)
    point = {s: Fraction(v).limit_denominator(50) for s, v in values_at(POINT, graph).items()}
    exact = Fraction(evaluate([f], point, RATIONAL)[0])
    modular = evaluate([f], {s: PRIME_FIELD.number(v) for s, v in point.items()}, PRIME_FIELD)[0]
    assert modular == PRIME_FIELD.number(exact)


def test_the_prime_is_prime_and_has_roots_of_small_numbers(graph):
    """p = 3 mod 4, 2^60 < p < 2^61; sqrt(2), sqrt(3), ..., sqrt(37) exist, and sqrt(2) sqrt(3) = sqrt(6)."""
    from sympy import isprime

    assert isprime(PRIME)
    assert PRIME % 4 == 3
    assert PRIME.bit_length() == 61
    for n in (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37):
        root = evaluate([graph.sqrt(n)], {}, PRIME_FIELD)[0]
        assert root * root % PRIME == n
    two, three, six = evaluate([graph.sqrt(2), graph.sqrt(3), graph.sqrt(6)], {}, PRIME_FIELD)
    assert two * three % PRIME == six


def test_fifty_digits_are_fifty(graph):
    """sqrt(2)^2 = 2 and pi to 1e-49."""
    root, pi = evaluate([graph.sqrt(2), graph.pi], {}, fifty_digits())
    assert abs(root * root - 2) < 1e-48
    assert str(pi).startswith("3.1415926535897932384626433832795028841971693993")


def test_floats_outside_a_domain_are_nan(graph):
    """sqrt(-1), log(0), 1/0, asin(2), exp(1000): not a number, no exception."""
    x = graph.symbol("x")
    outputs = [
        graph.sqrt(x - 2),
        graph.call("log", x - 1),
        1 / (x - 1),
        graph.call("asin", 2 * x),
        graph.call("exp", 1000 * x),
    ]
    assert all(math.isnan(value) for value in evaluate(outputs, {x: 1.0}, FLOAT))


def test_exact_arithmetics_say_what_they_do_not_have(graph):
    """exp has no meaning in a field; 1/0 and the root of no square have no value at this state."""
    x = graph.symbol("x")
    with pytest.raises(NoMeaning, match="'exp' has no meaning in a prime field"):
        evaluate([graph.call("exp", x)], {x: 2}, PRIME_FIELD)
    with pytest.raises(NoValue):
        evaluate([1 / (x - 2)], {x: 2}, PRIME_FIELD)
    with pytest.raises(NoValue):
        evaluate([graph.sqrt(x)], {x: PRIME - 1}, PRIME_FIELD)
    with pytest.raises(NoValue):
        evaluate([graph.sqrt(x)], {x: Fraction(1, 3)}, RATIONAL)
    with pytest.raises(NoValue):
        evaluate([graph.call("asin", x)], {x: fifty_digits().number(2)}, fifty_digits())


def test_every_symbol_without_a_value_is_named(graph):
    """All missing ones at once."""
    with pytest.raises(DerivationError, match="no value for 'x', 'y'"):
        evaluate([graph.symbol("x") + graph.symbol("y")], {}, FLOAT)


def test_a_value_that_is_given_for_an_inner_node_is_used(graph):
    """sin(x) = 2 where it is said so; x is then not needed."""
    s = graph.call("sin", graph.symbol("x"))
    assert evaluate([s * s], {s: 2}, RATIONAL) == [4]


def test_a_value_found_once_is_that_of_a_plan(graph):
    """Without a plan: the same numbers, an inner node that is given is used, what has no value is refused alike."""
    x, y = graph.symbol("x"), graph.symbol("y")
    inner = graph.call("sin", x * y)
    outputs, state = (3, inner, inner * x / (x - y) - 2), {x: 5, y: 7, inner: 11}
    nodes = order(outputs)
    assert evaluate_once(outputs, nodes, state, PRIME_FIELD) == evaluate(outputs, state, PRIME_FIELD)
    for found in (evaluate_once, lambda outputs, _, *how: evaluate(outputs, *how)):
        with pytest.raises(NoValue):
            found(outputs, nodes, state | {y: 5}, PRIME_FIELD)


def test_numbers_pass_through(graph):
    """Outputs may be plain numbers."""
    assert evaluate([3, Fraction(1, 2)], {}, FLOAT) == [3.0, 0.5]


def test_operations_are_counted_once_and_signs_are_free(graph):
    """x y + sin(x y) - 2 (x y)^2: one product, sine, square, 2 *, +, -: 6."""
    x, y = graph.symbol("x"), graph.symbol("y")
    product = x * y
    assert operations([product + graph.call("sin", product) - 2 * (product * product)]) == Count(6, 0)
    assert operations([-x, x, graph.pi, 3]) == Count(0, 0)


def test_exact_constants_are_free_and_parameters_are_hoisted(graph):
    """sqrt(2) pi x + m g: (sqrt(2) pi) is free, its product with x and the sum count, m g is hoisted."""
    x, m, g = graph.symbol("x"), graph.symbol("m"), graph.symbol("g")
    f = (graph.sqrt(2) * graph.pi) * x + m * g
    assert operations([f], parameters=[m, g]) == Count(total=2, hoisted=1)
    assert operations([f]) == Count(total=3, hoisted=0)
