"""Expressions as text: what a textbook writes, and what our own grammar reads back."""

from __future__ import annotations

import math
from collections import defaultdict
from fractions import Fraction

import pytest
from cpu_limit import cpu_limit
from each import each
from hypothesis import given, settings
from hypothesis import strategies as st

from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.print.layout import Product, terms
from eomgen.symbolic.print.text import named_parts, text_size, to_text, with_definitions


class Names(defaultdict):
    """The symbols of a graph by name, made when they are asked for."""

    def __init__(self, graph: Graph) -> None:
        super().__init__()
        self.graph = graph
        self["pi"] = graph.pi

    def __missing__(self, name: str) -> Node:
        self[name] = self.graph.symbol(name)
        return self[name]


def read(text: str, graph: Graph | None = None):
    return parse(text, longest=10**7).evaluate(Names(graph or Graph()))


@each(
    "text",
    [
        "6*M*R^2*theta'^2 + 27/2*M*R^2*cos(theta)^2*theta'^2",
        "1/2*m*l^2*sin(theta)^2*phi'^2 - m*l*g*cos(theta)",
        "1/2*x",
        "3/(2*y)",
        "1/x",
        "x/(y*z)",
        "theta - pi/2",
        "-3*pi/4 - theta",
        "0.0825*m",
        "0.04/y",
        "8.464e-7*m*theta'^2",
        "(0.001)^x",
        "1/128*x",
        "3/80*x",
        "k*(1 - l/r)",
        "-k*x*(1 - l/r)",
        "1 - cos(x)",
        "x - 1",
        "a - b + c",
        "-a - b",
        "(a + b)^2/c^2",
        "M*(1 + sin(x)^2)*theta'",
        "2^x",
        "x^(1/3)",
        "(a + b)^(1/3)",
        "(1/2)^x",
        "(x^y)^z",
        "x^(y^z)",
        "x^(-y)",
        "x^12",
        "sqrt(2)*x",
        "sqrt(a^2 + b^2)",
        "sqrt(14*g*l/3)",
        "4*sqrt(g*h/13)",
        "1/2*sqrt(x/3)",
        "sqrt(14*g/(3*l))",
        "a*sqrt((a + b)/3)/c",
        "1/3*sqrt(2)",
        "k*(l - r)",
        "k*(l + r - s)",
        "a/(y - x)",
        "c - k*(x - y)",
        "atan2(a, b)",
        "min(a, 2 + b)",
        "m*l*theta'' + m*g",
        "v*abs(v)",
        "3",
        "-27/2",
        "0",
    ],
)
def test_what_is_written_as_in_a_textbook_is_printed_as_it_is(text):
    """to_text(read(text)) = text: rational first, symbols, functions, sums, rates; signs in the sum."""
    assert to_text(read(text)) == text


@each(
    "text, printed",
    [
        ("-(a - b)", "b - a"),
        ("-a + b", "b - a"),
        ("a - (b + c)", "a - b - c"),
        ("x*x*x*y/x", "x^2*y"),
        ("pi/2*x", "1/2*pi*x"),
        ("x/2/y", "x/(2*y)"),
        ("theta'^2*cos(theta)*M", "M*cos(theta)*theta'^2"),
        ("-1*(a + b)/c", "-(a + b)/c"),
        ("-a/(x - 1)", "a/(1 - x)"),
        ("a/(pi - 4)^2 + b/(pi - 2)", "a/(4 - pi)^2 + b/(pi - 2)"),
        ("x/(pi - 4)", "-x/(4 - pi)"),
        ("1/(a*b)^2", "1/(a^2*b^2)"),
        ("-x^2*-y", "x^2*y"),
    ],
)
def test_signs_and_powers_are_collected(text, printed):
    """Equal factors become a power, a minus goes into the sum."""
    assert to_text(read(text)) == printed


def test_terms_come_in_the_order_in_which_they_were_added():
    """((t1 + t2) - t3) + t4, though the graph sorts the two arguments of each sum."""
    graph = Graph()
    x, y, z, w = (graph.symbol(n) for n in "xyzw")
    t1, t2, t3, t4, t5 = x * y, z * w, x * x, w * w, y * y
    assert to_text(t4 + t5 - t3 - t2 + t1) == "w^2 + y^2 - x^2 - z*w + x*y"
    assert to_text(t4 + t5 + t3 + t2 - t1) == "w^2 + y^2 + x^2 + z*w - x*y"


def scalars(graph: Graph):
    """Random expressions over three positive symbols."""
    symbols = [graph.symbol(n) for n in ("a", "b", "theta'")]
    leaves = st.sampled_from(symbols) | st.fractions(-3, 3, max_denominator=5).map(lambda f: f + 0) | st.integers(-3, 3)
    positive = st.sampled_from(symbols)

    def grow(inner):
        return st.one_of(
            st.tuples(inner, inner).map(lambda p: p[0] + p[1]),
            st.tuples(inner, inner).map(lambda p: p[0] - p[1]),
            st.tuples(inner, inner).map(lambda p: p[0] * p[1]),
            st.tuples(inner, positive).map(lambda p: p[0] / p[1]),
            st.tuples(inner, positive, positive).map(lambda p: p[0] / (p[1] * p[2] + 1)),
            inner.map(lambda x: -x),
            st.tuples(inner, st.integers(0, 10)).map(lambda p: p[0] ** p[1] if type(p[0]) is Node else p[0]),
            st.tuples(positive, inner).map(lambda p: graph.pow(p[0], graph.call("sin", p[1]))),
            st.tuples(positive, st.fractions(-2, 2, max_denominator=3)).map(lambda p: graph.pow(*p)),
            st.tuples(st.sampled_from(["sin", "cos", "atan", "tanh", "abs"]), inner).map(lambda p: graph.call(*p)),
            st.tuples(st.sampled_from(["min", "max", "atan2"]), inner, positive).map(lambda p: graph.call(*p)),
        )

    return st.recursive(leaves, grow, max_leaves=12)


GRAPH = Graph()
STATE = {GRAPH.symbol("a"): 1.25, GRAPH.symbol("b"): 0.7, GRAPH.symbol("theta'"): 1.9}


def number(x) -> float:
    return float(evaluate([x], STATE, FLOAT)[0])


@pytest.mark.slow
@settings(max_examples=300, deadline=None)
@given(scalars(GRAPH))
def test_the_grammar_reads_back_what_is_printed(x):
    """parse(to_text(x)) has the value of x, and text_size is no less than the length."""
    text = to_text(x)
    back = parse(text).evaluate(Names(GRAPH))
    expected, found = number(x), number(back)
    if math.isfinite(expected) and abs(expected) < 1e12:
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-9)
    assert text_size(x) >= len(text)
    assert to_text(x) == text


@settings(max_examples=100, deadline=None)
@given(st.lists(scalars(GRAPH), min_size=1, max_size=3))
def test_definitions_put_back_give_the_expressions(expressions):
    """Each name is defined before its use; with all put in, the texts have the values of the expressions."""
    definitions, texts = with_definitions(expressions, 0, taken={"z2"})
    names = Names(GRAPH)
    values = dict(names)
    assert "z2" not in dict(definitions)
    for name, text in definitions:
        parsed = parse(text)
        assert all(n in values or not n.startswith("z") for n in parsed.names)
        values[name] = parsed.evaluate({**{n: names[n] for n in parsed.names}, **values})
    for x, text in zip(expressions, texts, strict=True):
        parsed = parse(text)
        found, expected = number(parsed.evaluate({**{n: names[n] for n in parsed.names}, **values})), number(x)
        if math.isfinite(expected) and abs(expected) < 1e12:
            assert found == pytest.approx(expected, rel=1e-9, abs=1e-9)


def tower(height: int):
    """sin(x^2 + 1) (x + 2) put into itself: a tree that doubles at every level."""
    graph = Graph()
    x = graph.symbol("x")
    for _ in range(height):
        x = graph.call("sin", x * x + 1) * (x + 2)
    return x


def test_an_exponentially_large_tree_is_measured_and_named_at_the_cost_of_its_graph():
    """40 levels print to more than 10^12 characters; 40 names print them in short lines."""
    x = tower(40)
    with cpu_limit(10):
        assert text_size(x) > 10**12
        definitions, (text,) = with_definitions([x], 100)
    assert len(definitions) <= 81 and max(len(t) for _, t in definitions) <= 120 and len(text) <= 120


def test_a_short_expression_needs_no_names():
    """Names are given only where the limit is passed."""
    x = read("sin(a + b)^2 + cos(a + b)*sin(a + b)")
    assert named_parts([x], 200) == ()
    assert with_definitions([x, 3], 200)[0] == []


def test_a_long_sum_is_cut():
    """A sum of 1000 products, no part used twice, still becomes lines near the limit."""
    x = read(" + ".join(f"a{n}*b{n}" for n in range(1000)))
    definitions, texts = with_definitions([x], 300)
    assert max(len(t) for t in [*texts, *(t for _, t in definitions)]) <= 400


@pytest.mark.slow
def test_a_deep_expression_needs_no_depth_of_the_interpreter():
    """sin(1 + sin(1 + ...)) 5000 deep is printed by a loop."""
    graph = Graph()
    x = graph.symbol("x")
    for _ in range(5000):
        x = graph.call("sin", x) + 1
    assert to_text(x).count("sin(") == 5000


def test_a_sum_that_shares_its_parts_is_flattened_by_multiplicity():
    """s(n+1) = s(n) + 3 s(n-1)...: each node is opened once, so 60 doublings are at once a coefficient."""
    graph = Graph()
    a, b = graph.symbol("a"), graph.symbol("b")
    s, r = a + b, a - 2 * b
    for _ in range(60):
        s, r = r, s + r
    with cpu_limit(10):
        assert {leaf for _, leaf in terms(s)} == {a, b}


def test_factors_stand_above_or_below_the_line():
    """-3/2 x y^2 / z^3 = coefficient, powers above, powers below; what is in both cancels."""
    graph = Graph()
    product = Product.of(read("-3/2*x*y^2*w/(z^3*w)", graph))
    x, y, z = (graph.symbol(n) for n in "xyz")
    assert product.coefficient == Fraction(-3, 2)
    assert set(product.numerator) == {(x, 1), (y, 2)} and product.denominator == ((z, 3),)


def test_conditions_are_printed_unambiguously():
    """select(less(a, b), if true, if false)."""
    graph = Graph()
    a, b = graph.symbol("a"), graph.symbol("b")
    assert to_text(graph.select(graph.call("less", a, b), a - b, 0)) == "select(less(a, b), a - b, 0)"
