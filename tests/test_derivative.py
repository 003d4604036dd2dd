"""Laws of the derivatives on the graph."""

from __future__ import annotations

import math

import pytest
from each import each
from hypothesis import given
from random_expressions import POINT, on_graph, smooth, trigonometric, values_at, with_floats

from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.derivatives import (
    depends_on,
    derivative,
    gradient,
    jacobian,
    substituted,
    tangent,
    tangents,
)
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = pytest.mark.slow

STEP = 1e-5


def difference(tree, name: str) -> float:
    """(f(x - 2h) - 8 f(x - h) + 8 f(x + h) - f(x + 2h)) / 12 h"""
    at = [with_floats(tree, {**POINT, name: POINT[name] + k * STEP}) for k in (-2, -1, 1, 2)]
    return (at[0] - 8 * at[1] + 8 * at[2] - at[3]) / (12 * STEP)


@given(smooth | trigonometric)
def test_the_derivative_is_the_limit_of_differences(tree):
    """df/dx = lim (f(x + h) - f(x - h)) / 2h"""
    graph = Graph()
    exact = derivative(on_graph(tree, graph), graph.symbol("x"))
    value = evaluate([exact], values_at(POINT, graph), FLOAT)[0]
    assert value == pytest.approx(difference(tree, "x"), rel=1e-6, abs=1e-6)


@given(smooth | trigonometric)
def test_forward_and_reverse_agree(tree):
    """The gradient's entries are the derivatives."""
    graph = Graph()
    f = on_graph(tree, graph)
    symbols = [graph.symbol(name) for name in POINT]
    backward = evaluate(gradient(f, symbols), values_at(POINT, graph), FLOAT)
    forward = evaluate([derivative(f, s) for s in symbols], values_at(POINT, graph), FLOAT)
    assert backward == pytest.approx(forward, rel=1e-9, abs=1e-9)


@each("name", ["sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log", "sqrt", "abs"])
@each("point", [0.3, 0.8])
def test_every_function_has_its_rule(name, point):
    """f'(x) against a difference, at two points."""
    graph = Graph()
    x = graph.symbol("x")
    slope = evaluate([derivative(graph.call(name, x), x)], {x: point}, FLOAT)[0]
    f = abs if name == "abs" else getattr(math, name)
    assert slope == pytest.approx((f(point + STEP) - f(point - STEP)) / (2 * STEP), rel=1e-7)


@each("name", ["atan2", "pow", "min", "max"])
@each("argument", [0, 1])
@each("point", [(0.3, 0.8), (1.7, 0.6)])
def test_every_function_of_two_has_its_rules(name, argument, point):
    """df/da and df/db against differences, on both sides of a = b."""
    graph = Graph()
    symbols = graph.symbol("x"), graph.symbol("y")
    f = graph.pow(*symbols) if name == "pow" else graph.call(name, *symbols)
    at = {"atan2": math.atan2, "pow": math.pow, "min": min, "max": max}[name]
    up, down = list(point), list(point)
    up[argument] += STEP
    down[argument] -= STEP
    values = dict(zip(symbols, point, strict=True))
    slopes = evaluate([derivative(f, symbols[argument]), gradient(f, symbols)[argument]], values, FLOAT)
    assert slopes == pytest.approx([(at(*up) - at(*down)) / (2 * STEP)] * 2, rel=1e-7, abs=1e-9)


def test_a_choice_is_differentiated_on_the_side_that_is_taken():
    """d/dx (x^2 if x < y else 3 x) = 2 x if x < y else 3; sign and comparisons are constant."""
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    f = graph.select(graph.call("less", x, y), x * x, 3 * x) + graph.call("sign", x) + graph.call("less", x, y)
    for slope in (derivative(f, x), gradient(f, (x,))[0]):
        assert evaluate([slope], {x: 0.5, y: 1.0}, FLOAT) == [1.0]
        assert evaluate([slope], {x: 2.0, y: 1.0}, FLOAT) == [3.0]


def test_the_total_derivative_in_time_is_a_tangent():
    """d/dt (theta'^2 sin(theta) + t) with seeds {theta: theta', theta': theta'', t: 1}."""
    graph = Graph()
    theta, rate, acceleration, t = (graph.symbol(name) for name in ("theta", "theta'", "theta''", "t"))
    f = rate * rate * graph.call("sin", theta) + t
    total = tangent((f,), {theta: rate, rate: acceleration, t: 1})[0]
    by_hand = 2 * rate * acceleration * graph.call("sin", theta) + rate * rate * rate * graph.call("cos", theta) + 1
    assert equal_at_random_states([(total, by_hand)]).equal


@each("rows", [2, 3, 5])
def test_the_jacobian_is_the_same_by_rows_and_by_columns(rows):
    """J_ij = df_i/dx_j, 3 symbols."""
    graph = Graph()
    x, y, z = (graph.symbol(name) for name in "xyz")
    outputs = [x * y, graph.call("sin", y * z), x / z, x * x * z, graph.sqrt(y)][:rows]
    found = jacobian(outputs, (x, y, z))
    expected = [[derivative(f, s) for s in (x, y, z)] for f in outputs]
    pairs = [(a, b) for r, e in zip(found, expected, strict=True) for a, b in zip(r, e, strict=True)]
    assert equal_at_random_states(pairs).equal
    assert [len(row) for row in found] == [3] * rows


def test_each_of_many_tangents_is_the_one_that_is_asked_by_itself():
    """tangents(f, x)_k = tangent(f, {x_k: 1}), the same nodes; asked again nothing is made anew."""
    graph = Graph()
    x, y, z = symbols = [graph.symbol(name) for name in "xyz"]
    outputs = (x * y + graph.call("sin", z), x / y, graph.sqrt(x))
    alone = tuple(tangent(outputs, {s: 1}) for s in symbols)
    size = len(graph)
    assert tangents(outputs, symbols) == alone == tuple(tangent(outputs, {s: 1}) for s in symbols)
    assert len(graph) == size


def test_constants_have_no_derivative():
    """d3/dx = 0, dy/dx = 0, dpi/dx = 0"""
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    assert tangent((3, y, graph.pi, x), {x: 1}) == (0, 0, 0, 1)
    assert gradient(5, (x, y)) == (0, 0)


def test_substitution_is_all_at_once():
    """x y^2 with x -> y, y -> x is y x^2; what holds neither is kept."""
    graph = Graph()
    x, y, z = (graph.symbol(name) for name in "xyz")
    swapped, kept, number = substituted((x * (y * y), graph.call("sin", z), 7), {x: y, y: x})
    assert swapped is y * (x * x)
    assert kept is graph.call("sin", z)
    assert number == 7


@given(smooth | trigonometric)
def test_substituting_values_gives_the_value(tree):
    """f with y := x has the value of f at y = x."""
    graph = Graph()
    x, y = graph.symbol("x"), graph.symbol("y")
    replaced = substituted((on_graph(tree, graph),), {y: x})
    assert not depends_on(replaced[0], (y,))
    value = evaluate(replaced, values_at(POINT, graph), FLOAT)[0]
    assert value == pytest.approx(with_floats(tree, {**POINT, "y": POINT["x"]}), rel=1e-9, abs=1e-9)


def test_a_deep_chain_needs_no_recursion():
    """f_{n+1} = sin(f_n): 20 000 deep, derived forward and backward, substituted and evaluated."""
    graph = Graph()
    x = graph.symbol("x")
    f: Node = x
    for _ in range(20_000):
        f = graph.call("sin", f + 1)
    forward, backward = derivative(f, x), gradient(f, (x,))[0]
    values = evaluate([f, forward, backward, *substituted((f,), {x: 2 * x})], {x: 0.5}, FLOAT)
    assert all(math.isfinite(value) for value in values)
    assert depends_on(f, (x,))
