"""Roots in closed form: each satisfies its equation, none is missing, and exact values fold."""

from __future__ import annotations

import math
from random import Random

import pytest
from each import each

from eomgen.mechanics.equilibrium.places import outside_of_turns
from eomgen.symbolic.exact.normal_forms import sign_of_terms, simplest
from eomgen.symbolic.exact.solving import has_period, roots
from eomgen.symbolic.expression.derivatives import substituted
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node, Scalar
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.print.text import to_text

NAMES = "x a b c g l m v".split()


def scalars(*texts: str) -> tuple[dict[str, Node], list[Scalar]]:
    """The symbols NAMES by name, and the texts as scalars of one graph."""
    graph = Graph()
    names = {name: graph.symbol(name) for name in NAMES}
    return names, [parse(text).evaluate({**names, "pi": graph.pi}) for text in texts]


def solved(text: str) -> list[str]:
    names, (equation,) = scalars(text)
    positive = [names[name] for name in NAMES if name != "x"]
    return [to_text(root) for root in roots(equation, names["x"], positive)]


KNOWN = {
    "2*x - g*l": ["1/2*g*l"],
    "x^2 - 3*x + 2": ["1", "2"],
    "g*x^2/2 - v*x": ["0", "2*v/g"],
    "x^2*g - 2*l": ["-sqrt(2*l/g)", "sqrt(2*l/g)"],
    "x^3 - 8*l^3": ["2*l"],
    "x^4 - 5*l^2*x^2 + 4*l^4": ["-2*l", "-l", "2*l", "l"],
    "1/x - 2/(x + l)": ["l"],
    "(x - l)^2*(x + m)": ["-m", "l"],
    "3*cos(x) - 2": ["-acos(2/3)", "acos(2/3)"],
    "sin(x)*(3*cos(x) - 2)": ["-acos(2/3)", "0", "acos(2/3)", "pi"],
    "sin(2*x) - cos(x)": ["-pi/2", "5*pi/6", "pi/2", "pi/6"],
    "m*g*cos(x) + b*sin(x) - m*g": ["0", "2*atan(b/(g*m))"],
    "g*cos(x) - b*sin(x)": ["atan(g/b)", "atan(g/b) + pi"],
    "cos(x - a) - 1/2": ["a + pi/3", "a - pi/3"],
    "l*cos(x) - l*cos(a)": ["-a", "a"],
    "a*exp(-2*b*x) - c": ["log(a/c)/(2*b)"],
    "exp(-2*x) - 3*exp(-x) + 2": ["0", "-log(2)"],
    "sqrt(x + 1) + x - 5": ["3"],
    "sqrt(x^2 + l^2) - 2*l": ["-sqrt(3)*l", "sqrt(3)*l"],
    "abs(x - l) - 2*l": ["-l", "3*l"],
    "x*abs(x) - l^2": ["l"],
    "abs(x) + l": [],
    "log(x/l) - b": ["l*exp(b)"],
    "cos(2*x) + 3*cos(x) + 1": ["-pi/2", "pi/2"],
    "cos(x) - 2": [],
    "x^2 + l^2": [],
}


@each("text", KNOWN)
def test_the_real_roots_are_found_and_no_others(text):
    """The textbook's solutions, one turn of those in angles."""
    names, (equation, *expected) = scalars(text, *KNOWN[text])
    found = roots(equation, names["x"], [names[name] for name in NAMES if name != "x"])
    rng = Random(2)
    values = {names[name]: rng.uniform(0.5, 1.5) for name in NAMES}
    turned = [sorted(round(z, 9) for z in evaluate(side, values, FLOAT)) for side in (found, expected)]
    assert turned[0] == pytest.approx(turned[1])


@each("text", [*KNOWN, "a*x^2 + b*x - c", "a*sin(x) + b*cos(x) - a/2", "5*sin(x)^2 + 3*cos(x) - 1"])
def test_every_root_satisfies_its_equation(text):
    """equation(root) = 0"""
    names, (equation,) = scalars(text)
    rng = Random(3)
    for root in roots(equation, names["x"], [names[name] for name in NAMES if name != "x"]):
        (residual,) = substituted((equation,), {names["x"]: root})
        tried = ({names[name]: rng.uniform(0.5, 2.0) for name in NAMES} for _ in range(20))
        values = [v for state in tried if math.isfinite(v := evaluate((residual,), state, FLOAT)[0])]
        assert values and max(map(abs, values)) < 1e-9


@each("text", ["x - cos(x)", "x*exp(x) - a", "x^5 - x - a", "cos(x) + cos(a*x)"])
def test_an_equation_without_closed_roots_has_none(text):
    """Nothing is made of numbers."""
    assert solved(text) == []


def test_a_period_is_seen():
    """cos(x - a) and 3 cos(2 x) have the period 2 pi, x + cos(x) and cos(x/2) have not."""
    names, equations = scalars("cos(x - a) - b", "3*cos(2*x) + sin(x)", "x + cos(x)", "cos(x/2)")
    turn = 2 * names["x"].graph.pi
    assert [has_period(e, names["x"], turn) for e in equations] == [True, True, False, False]


@each(
    "text, folded",
    {
        "sin(acos(2/3))": "1/3*sqrt(5)",
        "cos(acos(x))": "x",
        "cos(2*atan(x))": "(1 - x^2)/(1 + x^2)",
        "sin(2*asin(x))": "2*x*sqrt(1 - x^2)",
        "acos(-1/2)": "2*pi/3",
        "sin(atan2(3, -4))": "3/5",
        "cos(2*atan2(-3, 4))": "0.28",
        "cos(atan2(1, -1) + x)": "-1/2*sqrt(2)*cos(x) - 1/2*sqrt(2)*sin(x)",
        "asin(sqrt(3)/2)": "pi/3",
        "atan(-1)": "-pi/4",
        "exp(-log(x))": "1/x",
        "exp(2*log(x) + a)": "x^2*exp(a)",
    }.items(),
)
def test_functions_of_inverse_functions_fold(text, folded):
    """sin(acos(x)) = sqrt(1 - x^2), and so on, on construction."""
    names, (a, b) = scalars(text, folded)
    assert a is b or to_text(a) == folded
    values = {names[name]: 0.3 for name in NAMES}
    assert evaluate((a,), values, FLOAT) == pytest.approx(evaluate((b,), values, FLOAT))


def test_the_direction_of_what_stays_the_same_is_that_of_its_triangle():
    """cos(atan2(h, b)) = b/sqrt(b^2 + h^2) of constants; what moves may come to (0, 0), which has no direction."""
    graph = Graph()
    h, b, x = graph.constant("h"), graph.constant("b"), graph.symbol("x")
    fixed, moving = (graph.call("cos", graph.call("atan2", y, b)) for y in (h, x))
    assert to_text(fixed) == "b/sqrt(b^2 + h^2)"
    assert to_text(moving) == "cos(atan2(x, b))"


@each("function", ["sin", "cos"])
@each("angle", ["3*acos(x) + a", "asin(x) - 2*acos(a)", "4*atan(x) + pi/3", "-atan(x) + acos(1/3)"])
def test_sines_of_multiples_of_inverse_functions_keep_their_value(function, angle):
    """sin(n y + rest) by the addition theorem, against the library's functions."""
    names, (folded,) = scalars(f"{function}({angle})")
    arguments = {"x": 0.4, "a": -0.7, "pi": math.pi}
    expected = getattr(math, function)(parse(angle).evaluate(arguments))
    assert evaluate((folded,), {names["x"]: 0.4, names["a"]: -0.7}, FLOAT)[0] == pytest.approx(expected)


@each(
    "text, short",
    {
        "sqrt(l^2)": "l",
        "l*sqrt(g/l)": "sqrt(g*l)",
        "sqrt(m^2*g)": "m*sqrt(g)",
        "sqrt(g/(l*(m + a)^2))": "sqrt(g*l)/(l*(a + m))",
        "sqrt(1 - b^2/l^2)": "sqrt(l^2 - b^2)/l",
        "m/sqrt(g*l)": "m*sqrt(1/(g*l))",
        "2*sqrt(g*l^3)": "2*l*sqrt(g*l)",
        "l*m*sqrt(g/(2*l))": "1/2*m*sqrt(2*g*l)",
    }.items(),
)
def test_roots_of_squares_of_positive_symbols_are_taken(text, short):
    """sqrt(l^2) = l where l > 0; the rest of a root stands under one root."""
    names, (a, b) = scalars(text, short)
    found = simplest(a, positive=[names[name] for name in NAMES])
    values = {names[name]: 0.5 + 0.1 * k for k, name in enumerate(NAMES)}
    assert evaluate((found,), values, FLOAT) == pytest.approx(evaluate((b,), values, FLOAT))
    assert len(to_text(found)) <= len(short) + 2


def test_roots_of_squares_of_other_symbols_are_their_magnitudes():
    """sqrt(x^2) is |x|."""
    names, (a,) = scalars("sqrt(x^2)")
    assert to_text(simplest(a)) == "abs(x)"
    assert evaluate((simplest(a, positive=[names["a"]]),), {names["x"]: -2.0}, FLOAT) == [2.0]


def test_the_sign_of_a_sum_is_that_of_its_terms():
    """k/m + c^2 is positive, -(k/m) negative, k - m unknown, 0 zero."""
    names, sums = scalars("a/m + x^2", "-(a/m)", "a - m", "a - a")
    assert [sign_of_terms(each, [names["a"], names["m"]]) for each in sums] == [1, -1, None, 0]


@each(
    "text, outside",
    {
        "sin(x) + 2*cos(3*x - a)": "",
        "sin(x/2) + cos(a)": "x",
        "x*sin(x)": "x",
        "sin(a*x)": "a x",
        "cos(x + sin(b))": "",
        "m*sin(2*x)/(1 + cos(a)^2)": "m",
        "cos(x + b^2) + sqrt(1 + sin(a))": "b",
    }.items(),
)
def test_what_stands_in_waves_alone_is_the_same_after_a_turn(text, outside):
    """f(x + 2 pi) = f(x) of every symbol that is not seen outside of them."""
    names, (f,) = scalars(text)
    found = {x.name for x in outside_of_turns([f])}
    assert found == set(outside.split())
    for x in names.values():
        assert x.name in found or has_period(f, x, 2 * f.graph.pi)


def test_a_short_form_is_of_what_was_asked():
    """sqrt(x^2) is |x|, of a positive x it is x, and with no work allowed it stays: whatever was asked before."""
    names, (f, g) = scalars("sqrt(x^2)", "(x + a)*(x + m) - x^2")
    for _ in range(2):
        assert to_text(simplest(f)) == "abs(x)"
        assert to_text(simplest(f, positive=[names["x"]])) == "x"
        assert simplest(g, 0) is g
        assert simplest(g) is not g
        assert simplest(g, most=1) is g
