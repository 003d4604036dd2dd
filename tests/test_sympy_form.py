"""The graph to sympy and back."""

from __future__ import annotations

import pytest
import sympy
from hypothesis import given, settings
from random_expressions import POINT, on_graph, smooth, trigonometric, with_floats

from eomgen.errors import DerivationError
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.print.sympy_form import RateSymbol, scalar_from_sympy, symbol, to_sympy


@pytest.fixture
def graph() -> Graph:
    return Graph()


@given(smooth | trigonometric)
@settings(deadline=None)
def test_there_and_back_is_the_same_function(tree):
    """scalar_from_sympy(to_sympy(f)) = f"""
    graph = Graph()
    f = on_graph(tree, graph)
    symbols = {name: graph.symbol(name) for name in POINT}
    back = scalar_from_sympy(to_sympy([f])[0], symbols)
    assert equal_at_random_states([(f, back)]).equal


@given(smooth | trigonometric)
@settings(deadline=None)
def test_sympy_computes_the_same_value(tree):
    """The sympy form at a point = the tree computed with floats."""
    graph = Graph()
    form = to_sympy([on_graph(tree, graph)])[0]
    value = form.subs({symbol(name): sympy.Rational(str(v)) for name, v in POINT.items()}).evalf(20)
    assert float(value) == pytest.approx(with_floats(tree, POINT), rel=1e-9, abs=1e-9)


def test_every_operation_goes_there_and_back(graph):
    """All functions, powers, choices and comparisons."""
    x, y = graph.symbol("x"), graph.symbol("y")
    symbols = {"x": x, "y": y}
    unary = "sqrt sin cos tan asin acos atan sinh cosh tanh exp log abs sign"
    outputs = [graph.call(op, x / 7) for op in unary.split()]
    outputs += [graph.call(op, x, y) for op in ("atan2", "min", "max", "less", "less_equal")]
    outputs += [graph.pow(x, y), x**12, 1 / (x * y), graph.pi * x, -x, x - y]
    outputs += [graph.select(graph.call("less", x, y), x, 2 * y)]
    back = [scalar_from_sympy(form, symbols) for form in to_sympy(outputs)]
    assert equal_at_random_states(list(zip(outputs, back, strict=True)), states=4).equal


def test_sympy_spellings_are_read(graph):
    """sec, csc, cot, E, Rational, Or and Not in a Piecewise."""
    x, y = graph.symbol("x"), graph.symbol("y")
    sx, sy = symbol("x"), symbol("y")
    read = lambda e: scalar_from_sympy(e, {"x": x, "y": y})  # noqa: E731 - short for the test
    assert read(sympy.sec(sx)) is 1 / graph.call("cos", x)
    assert equal_at_random_states([(read(sympy.cot(sx)), graph.call("cos", x) / graph.call("sin", x))]).equal
    assert read(sympy.E) is graph.call("exp", 1)
    assert read(sympy.Rational(3, 4) * sx) is 3 * x / 4
    pieces = sympy.Piecewise((1, sympy.Or(sx < 1, sy > 2)), (2, True), evaluate=False)
    expected = graph.select(graph.call("max", graph.call("less", x, 1), graph.call("less", 2, y)), 1, 2)
    assert equal_at_random_states([(read(pieces), expected)], states=6).equal


def test_a_rate_is_printed_with_dots():
    """theta1' is \\dot{\\theta}_{1}, x'' is \\ddot{x}; a rate is not the symbol without the prime."""
    assert sympy.latex(symbol("theta1'")) == r"\dot{\theta}_{1}"
    assert sympy.latex(symbol("x''") ** 2) == r"\ddot{x}^{2}"
    assert isinstance(symbol("theta'"), RateSymbol)
    assert symbol("theta'") != symbol("theta")
    assert symbol("theta'") == symbol("theta'")


def test_symbols_are_real_and_numbers_exact(graph):
    """3/4 x stays 3/4 x over a real x."""
    (form,) = to_sympy([3 * graph.symbol("x") / 4])
    assert form == sympy.Rational(3, 4) * sympy.Symbol("x", real=True)
    assert to_sympy([0, 2]) == [sympy.Integer(0), sympy.Integer(2)]


@pytest.mark.parametrize(
    ("expression", "message"),
    [
        (sympy.gamma(sympy.Symbol("x")), "'gamma' has no counterpart"),
        (sympy.Symbol("unknown"), "unknown symbol 'unknown'"),
        (0.5 * sympy.Symbol("x"), "decimal number 0.5"),
        (sympy.oo, "no counterpart"),
        (sympy.I * sympy.Symbol("x"), "no counterpart"),
        (sympy.Piecewise((1, sympy.Symbol("x") > 0)), "without a value for every case"),
    ],
)
def test_what_the_graph_does_not_have_is_named(graph, expression, message):
    """An error, never a guess."""
    with pytest.raises(DerivationError, match=message):
        scalar_from_sympy(expression, {"x": graph.symbol("x")})


def test_a_sum_of_many_terms_is_made_at_once(graph):
    """x_0 + ... + x_4999 becomes one Add, and a deep chain needs no recursion."""
    total = sum((graph.symbol(f"x{i}") for i in range(5000)), start=0)
    (form,) = to_sympy([total])
    assert len(form.args) == 5000
