"""Expressions as scalars: what is calculated with formulas is a formula of the same value."""

from __future__ import annotations

from fractions import Fraction

import pytest

from eomgen.symbolic.expression.formula import Expression, cos, selected, sin
from eomgen.symbolic.expression.text import as_expression, parse

A, B = parse("x + 2*y"), parse("-x/y^2")
VALUES = {"x": Fraction(3, 7), "y": Fraction(-5, 2), "pi": 3}
COMPOSED = {
    "+": lambda a, b: a + b - 3 + (a - b),
    "-": lambda a, b: Fraction(1, 2) - a - (b - a) - (a + b),
    "*": lambda a, b: a * b * 2 - 5 * (a * b),
    "/": lambda a, b: a / b / (b / a) + 1 / a,
}


@pytest.mark.parametrize("law", COMPOSED.values(), ids=list(COMPOSED))
def test_a_formula_of_formulas_has_the_value_of_the_values(law):
    """f(A, B) at x is f(A(x), B(x)), and its text says the same."""
    made = law(A, B)
    expected = law(A.evaluate(VALUES), B.evaluate(VALUES))
    assert made.evaluate(VALUES) == expected
    assert parse(made.text).evaluate(VALUES) == expected


def test_numbers_are_calculated_and_what_changes_nothing_is_left_out():
    """0 + a, a - 0, 1 a, a/1 are a; 0 a is 0; 1/2 + 1/3 = 5/6."""
    assert all(x.text == "x + 2*y" for x in (0 + A, A - 0, 1 * A, A / 1))
    assert (0 * A).literal == 0
    assert (as_expression(Fraction(1, 2)) + Fraction(1, 3)).literal == Fraction(5, 6)


def test_sines_of_formulas_are_formulas():
    """sin and cos go into the text; of 0 they are numbers."""
    assert sin(A).evaluate({"x": 0.3, "y": 0.1, "pi": 3.0}) == pytest.approx(0.479425538604203)
    assert cos(parse("x")).text == "cos(x)" and sin(Expression.number(0)) == 0 and cos(Expression.number(0)) == 1


def test_a_piecewise_law_chooses_by_the_value():
    """if_below where a <= bound: at the bound itself too."""
    assert [selected(s, 2, "below", "above") for s in (1, 2, Fraction(5, 2))] == ["below", "below", "above"]
