"""Laws of the hash-consed graph: equal constructions are one node, and folding changes no value."""

from __future__ import annotations

import pytest
from hypothesis import given
from random_expressions import POINT, on_graph, smooth, trigonometric, values_at, with_floats

from eomgen.errors import DerivationError
from eomgen.symbolic.expression.formula import function
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node, collected, linear_terms
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.print.text import to_text


@pytest.fixture
def graph() -> Graph:
    return Graph()


@pytest.fixture
def x(graph):
    return graph.symbol("x")


@pytest.fixture
def y(graph):
    return graph.symbol("y")


@given(smooth | trigonometric)
def test_folding_changes_no_value(tree):
    """value(fold(tree)) = tree computed with floats."""
    graph = Graph()
    value = evaluate([on_graph(tree, graph)], values_at(POINT, graph), FLOAT)[0]
    expected = with_floats(tree, POINT)
    assert value == pytest.approx(expected, rel=1e-9, abs=1e-9)


@given(smooth | trigonometric)
def test_an_expression_minus_itself_is_zero(tree):
    """a - a = 0, built twice."""
    graph = Graph()
    assert on_graph(tree, graph) - on_graph(tree, graph) == 0


def test_equal_constructions_are_the_same_node(x, y):
    """x + y = y + x and x y = y x, held once."""
    assert x + y is y + x
    assert x * y is y * x
    assert (x - y) is -(y - x)
    assert 2 * x * y is x * (y * 2)


def test_arguments_come_before_results(x, y):
    """index(argument) < index(result)."""
    total = (x + y) * x
    assert all(a.index < total.index for a in total.args)


def test_zero_and_one_fold(x):
    """0 x = 0, 1 x = x, x + 0 = x, x - x = 0, x / x = 1."""
    assert 0 * x == 0
    assert 1 * x is x
    assert x + 0 is x
    assert x - x == 0
    assert x / x == 1


def test_like_terms_collect(x, y):
    """x + x = 2 x; 3 x y - 2 x y = x y; (x + y) - y = x."""
    assert x + x is 2 * x
    assert 3 * (x * y) - 2 * (x * y) is x * y
    assert (x + y) - y is x
    assert y + (x - y) is x


def test_a_coefficient_is_positive_and_stands_first(x, y):
    """(-2 x) y = -(2 (x y))"""
    product = (-2 * x) * y
    assert product.op == "neg"
    assert product.args[0].args == (2, x * y)


def test_sine_squared_and_cosine_squared_make_one(graph, x, y):
    """k sin^2 + k cos^2 = k, for one k, also where k is a square of the other kind."""
    s, c = graph.call("sin", x), graph.call("cos", x)
    assert s * s + c * c == 1
    assert 3 * s * s + 3 * (c * c) == 3
    assert y * (s * s) + y * (c * c) is y
    assert (y * (s * s) + x * (c * c)).op == "add"
    other = graph.call("cos", y)
    assert (s * s + other * other).op == "add"
    assert (other * other) * (s * s) + (other * other) * (c * c) is other * other


def test_roots_of_numbers_are_exact(graph, x):
    """sqrt(12) = 2 sqrt(3); 3 sqrt(2) sqrt(2) = 6; sqrt(2) sqrt(3) = sqrt(6); x / sqrt(2) = x sqrt(2) / 2."""
    root2, root3 = graph.sqrt(2), graph.sqrt(3)
    assert graph.sqrt(Fraction(9, 4)) == Fraction(3, 2)
    assert graph.sqrt(12) is 2 * root3
    assert (3 * root2) * root2 == 6
    assert root2 * root3 is graph.sqrt(6)
    assert x / root2 is Fraction(1, 2) * (x * root2)
    with pytest.raises(DerivationError, match="negative number"):
        graph.sqrt(-2)


def test_sines_know_signs_and_quarter_turns(graph, x):
    """sin(-x) = -sin x; sin(x + pi/2) = cos x; cos(x + pi) = -cos x; sin(pi - x) = sin x."""
    sin, cos, pi = (lambda a: graph.call("sin", a)), (lambda a: graph.call("cos", a)), graph.pi
    assert sin(-x) is -sin(x)
    assert cos(-2 * x) is cos(2 * x)
    assert sin(x + pi / 2) is cos(x)
    assert cos(x + pi) is -cos(x)
    assert sin(pi - x) is sin(x)
    assert sin(x - 7 * pi) is -sin(x)


def test_sines_have_exact_values(graph):
    """sin(pi/6) = 1/2, cos(pi/6) = sqrt(3)/2, sin(3 pi/4) = sqrt(2)/2, cos(pi) = -1; 0 is exact."""
    pi = graph.pi
    assert graph.call("sin", pi / 6) == Fraction(1, 2)
    assert graph.call("cos", pi / 6) is graph.sqrt(3) / 2
    assert graph.call("sin", 3 * pi / 4) is graph.sqrt(2) / 2
    assert graph.call("cos", pi) == -1
    assert graph.call("sin", 0) == 0
    assert graph.call("cos", pi / 2) == 0
    assert graph.call("sin", pi / 5).op == "sin"


def test_comparisons_fold_where_they_are_decided(graph, x, y):
    """1 < 2 is 1; x < x is 0; x <= x is 1; a choice between equals is none."""
    assert graph.call("less", 1, 2) == 1
    assert graph.call("less", x, x) == 0
    assert graph.call("less_equal", x, x) == 1
    assert graph.call("max", x, x) is x
    assert graph.select(graph.call("less", x, y), Fraction(1, 2), Fraction(1, 2)) == Fraction(1, 2)
    assert graph.select(1, x, y) is x


def test_a_float_does_not_enter_a_derivation(graph, x):
    """0.1 x raises."""
    with pytest.raises(TypeError, match="exact numbers only"):
        0.1 * x


def test_an_expression_is_neither_true_nor_false(x):
    """bool(x) raises, so that `if x:` is no silent mistake."""
    with pytest.raises(TypeError, match="neither true nor false"):
        bool(x)


def test_huge_powers_are_refused_at_once(graph, x):
    """9^(9^9), (10^4096)^4096 and x^(10^6) raise; 1^(10^9) = 1."""
    for base, exponent in ((9, 9**9), (10**4096, 4096), (Fraction(1, 9), 9**9), (x, 10**6)):
        with pytest.raises(DerivationError, match="too large"):
            graph.pow(base, exponent)
    assert graph.pow(1, 10**9) == 1


def test_division_by_zero_is_an_error(graph, x):
    """x / 0 raises."""
    with pytest.raises(DerivationError, match="division by zero"):
        x / 0


def test_a_shared_sum_is_opened_once(graph, x, y):
    """a_{n+1} = a_n + a_{n-1} has 2^n paths and two terms: the Fibonacci numbers."""
    a, b = x, y
    for _ in range(90):
        a, b = b, a + b
    assert linear_terms(a) == {x: 1779979416004714189, y: 2880067194370816120}


def test_collected_puts_like_terms_together(graph, x, y):
    """(x - pi/2) + (y - x) = y - pi/2"""
    assert collected((x - graph.pi / 2) + (y - x)) is y - graph.pi / 2


@pytest.mark.parametrize(
    "operation",
    [
        lambda a, b: a - b,
        lambda a, b: b - a,
        lambda a, b: a + b,
        lambda a, b: a / b,
        lambda a, b: b / a,
        lambda a, b: a**b,
        lambda a, b: function("min", a, b),
        lambda a, b: function("atan2", b, a),
    ],
)
def test_a_constant_meets_an_expression_in_its_graph(operation, x):
    """Every argument of a node is of its own graph: else the order of index is no order of evaluation."""
    constant = function("sqrt", 7) - function("sqrt", 5) / 3
    waiting = [operation(x, constant)]
    while waiting:
        node = waiting.pop()
        assert node.graph is x.graph
        waiting += [a for a in node.args if type(a) is Node]


def test_sine_squared_and_cosine_squared_meet_in_any_order_of_factors(graph):
    """(m (l sin t)) (l sin t) + (l cos t) (m (l cos t)) = m l^2"""
    m, l, t = (graph.symbol(name) for name in ("m", "l", "t"))
    s, c = graph.call("sin", t), graph.call("cos", t)
    total = (m * (l * s)) * (l * s) + (l * c) * (m * (l * c))
    assert to_text(total) == "m*l^2"
