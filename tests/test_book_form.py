"""Formulas as the author of a textbook prints them."""

from __future__ import annotations

from random import Random

import pytest
from each import each
from slow_run import usual

from eomgen.symbolic.exact.book_forms import book_form
from eomgen.symbolic.exact.normal_forms import equal, readable
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.work import Work
from eomgen.symbolic.print.latex import Notation, Setter
from eomgen.symbolic.print.length import length_of, length_of_latex, length_of_name
from eomgen.symbolic.print.text import to_text

PARAMETERS = "M m m1 m2 m3 G P a b c h k l l1 l2 R I J g alpha".split()
MOVING = "t x y r s theta theta1 theta2 phi".split()
RATES = [f"{q}'" for q in MOVING[1:]]
ACCELERATIONS = [f"{q}''" for q in MOVING[1:]]


def names_of(graph: Graph) -> dict[str, Node]:
    parameters = {name: graph.constant(name) for name in PARAMETERS}
    moving = {name: graph.symbol(name) for name in (*MOVING, *RATES, *ACCELERATIONS)}
    return {**parameters, **moving, "pi": graph.pi}


def read(text: str) -> Node:
    """In a graph of its own: nothing that was written before is known there."""
    return parse(text, longest=10**6).evaluate(names_of(Graph()))


def printed(text: str) -> str:
    return to_text(book_form(read(text), Work.ANSWER))


@pytest.mark.parametrize(
    ("given", "wanted"),
    [
        ("M*x'' + m*x'' + m*cos(alpha)*s''", "(M + m)*x'' + m*cos(alpha)*s''"),
        (
            "4*R*theta'' + 9*R*cos(theta)^2*theta'' - 9*R*cos(theta)*sin(theta)*theta'^2",
            "R*(4 + 9*cos(theta)^2)*theta'' - 9*R*cos(theta)*sin(theta)*theta'^2",
        ),
        ("r*l*sqrt(l^2 - r^2)/(l^2 - r^2)", "l*r/sqrt(l^2 - r^2)"),
        (
            "r^2*sqrt(2*l^2 - 2*r^2*sin(theta)^2)*cos(theta)*sin(theta)/(sqrt(2)*l^2 - sqrt(2)*r^2*sin(theta)^2)",
            "r^2*cos(theta)*sin(theta)/sqrt(l^2 - r^2*sin(theta)^2)",
        ),
        ("4*l^2*theta'' + 2*r^2*theta'' + 4*r*theta'*r'", "2*(2*l^2 + r^2)*theta'' + 4*r*r'*theta'"),
        ("-m1*g*sin(theta1) - 2*m2*g*sin(theta1)", "-(m1 + 2*m2)*g*sin(theta1)"),
        ("M*g + m*g - m*sin(alpha)*s''", "(M + m)*g - m*sin(alpha)*s''"),
        ("(a*G + b*G + 2*a*P + 2*b*P)/(2*h)", "(G + 2*P)*(a + b)/(2*h)"),
        ("3*M^2*g + 4*M*m*g + m^2*g", "(M + m)*(3*M + m)*g"),
        ("M*x'^2/2 + m*x'^2/2 + m*cos(alpha)*x'*s' + m*s'^2/2", "1/2*(M + m)*x'^2 + m*cos(alpha)*x'*s' + 1/2*m*s'^2"),
        ("I + m1*l^2 + m2*l^2", "(m1 + m2)*l^2 + I"),
        ("R*sin(alpha) + x + s*cos(alpha)", "x + s*cos(alpha) + R*sin(alpha)"),
        ("(a*sin(phi) + b*sin(phi))/(a + b)", "sin(phi)"),
        ("a*sin(x)^2 + b*cos(x)^2 + a*cos(x)^2", "a + b*cos(x)^2"),
        ("a*(m*sin(x)^2*y'' + m*cos(x)^2*y'')", "m*a*y''"),
        ("-a*x'' + b*x''", "(b - a)*x''"),
        ("x - k - x*a + k*a", "x - a*x + a*k - k"),
        ("-3*M*R*cos(theta)*theta'' + 3*M*R*sin(theta)*theta'^2", "3*M*R*(sin(theta)*theta'^2 - cos(theta)*theta'')"),
        ("sqrt(g/l)*a + sqrt(g/l)*b", "(a + b)*sqrt(g/l)"),
        ("-1/2*m*g*sin(alpha)*t^2/M", "-m*g*sin(alpha)/(2*M)*t^2"),
        ("J*x'' + J*y''", "J*(x'' + y'')"),
        ("m*l*theta1'^2 + 2*m*l*theta1'*theta2' + m*l*theta2'^2", "m*l*(theta1' + theta2')^2"),
        (
            "m1*l1*cos(x)*x'' + 2*m2*l1*cos(x)*x'' - m1*l1*sin(x)*x'^2 - 2*m2*l1*sin(x)*x'^2 + m2*g",
            "(m1 + 2*m2)*l1*(cos(x)*x'' - sin(x)*x'^2) + m2*g",
        ),
        (
            "(4*I*(a + b)^2*x'' + J*a^2*x'' + m*a^2*(a + b)^2*x'')/(4*(a + b)^2)",
            "(1/4*m*a^2 + I + a^2*J/(4*(a + b)^2))*x''",
        ),
        ("(m*l^2*g*a + k*b^2)/(m*l^2)", "b^2*k/(m*l^2) + a*g"),
        ("sqrt(m1*a^2 - 2*m1*a*b + m1*b^2 + m2*(a + b)^2)", "sqrt(m1*(a - b)^2 + m2*(a + b)^2)"),
        ("a^2 + h^2 + 2*a*b*cos(x) + 2*a*c*sin(x)", "a^2 + h^2 + 2*a*b*cos(x) + 2*a*c*sin(x)"),
        ("m1*a + m1*b + m2*a + m2*b + sqrt(g^2 + l^2)", "(m1 + m2)*(a + b) + sqrt(g^2 + l^2)"),
        (
            "a*g*m*cos(alpha) - 3*b*g*M*cos(alpha)/(10*a) - 9*b*g*m*cos(alpha)/(10*a) + b*g*m*cos(alpha)"
            " - g*R*m1*sin(alpha) - 9/10*g*m*cos(alpha) - 7/10*g*m*sin(alpha) + m2*a*g - m2*b*g",
            "m2*(a - b)*g - (7/10*m + m1*R)*g*sin(alpha) + (m*(10*a - 9)*(b + a) - 3*M*b)*g*cos(alpha)/(10*a)",
        ),
    ],
)
def test_formulas_are_collected_and_factored_as_an_author_does(given: str, wanted: str):
    """Per acceleration and product of rates, coefficients in factors; out of parentheses where that is shorter."""
    assert printed(given) == wanted


def random_formula(seed: int) -> str:
    """A sum of products of parameters, circular functions and rates, at times over another one."""
    choose = Random(seed)

    def product() -> str:
        number = choose.choice(["", "2*", "1/2*", "3/4*", "6*", "-", "-5*"])
        factors = choose.choices(PARAMETERS[:12], k=choose.randint(1, 3))
        angle = choose.choice(["theta", "phi", "theta - phi", "2*theta", "alpha"])
        waves = choose.choices([f"cos({angle})", f"sin({angle})", f"sin({angle})^2"], k=choose.randint(0, 2))
        moving = choose.choices(["x", "r", "theta'", "phi'", "theta''", "phi''"], k=choose.randint(0, 2))
        return number + "*".join([*factors, *waves, *moving])

    def total(terms: int) -> str:
        return " + ".join(f"({product()})" for _ in range(terms))

    whole = f"({total(choose.randint(1, 4))})*({total(choose.randint(1, 3))}) + {total(choose.randint(0, 3) + 1)}"
    below = choose.choice(["1", "1", "a + b", "M + m*sin(alpha)^2", "r", "sin(theta)", "sqrt(a + r^2)"])
    return f"({whole})/({below})"


@pytest.mark.slow
@each("seed", usual(range(125), 2))
def test_a_formula_keeps_its_value_and_is_found_again(seed: int):
    """book_form(x) = x as a function; made again, and anywhere else, it is the same text.

    Slow: of many random formulas, each written three times.
    """
    given = random_formula(seed)
    x = read(given)
    found = book_form(x, Work.ANSWER)
    assert equal(x, found)
    text = to_text(found)
    assert printed(given) == text
    assert printed(text) == text


@pytest.mark.slow
@each("seed", range(15))
def test_a_formula_is_about_as_short_as_multiplied_out_or_shorter(seed: int):
    """A pair of parentheses costs a mark more than it saves at most: (M + m)*g."""
    x = read(random_formula(seed))
    found, out = book_form(x, Work.ANSWER), readable(x, Work.ANSWER)
    assert length_of(found) <= length_of(out) + to_text(found).count("(")


@pytest.mark.slow
@each("seed", range(15))
def test_the_length_of_a_scalar_is_that_of_its_latex(seed: int):
    """length_of(x) = length_of_latex(LaTeX of x): one rule, without typesetting."""
    x = read(random_formula(seed))
    for y in (x, book_form(x, Work.ANSWER), readable(x, Work.ANSWER)):
        assert length_of(y) == length_of_latex(Setter().set(y).tex), to_text(y)


@each("name", ["theta", "theta1''", "m_cart", "x_1_2", "Ixx1", "lam(bar, 1)", "psi'", "R_stick_x"])
def test_the_length_of_a_name_is_that_of_its_latex(name: str):
    assert length_of_name(name) == length_of_latex(Notation().latex(name))


def test_a_long_sum_is_only_collected():
    """Work is counted: of 60 terms no factors are sought, and what is too large stays as it came."""
    long = " + ".join(f"cos({k}*theta)*x''*k" for k in range(1, 61))
    assert printed(long).count("x''") == 1
    x = read("(a + b + c + k)^9*(M + m)^9")
    assert book_form(x, Work.PART) is x


def test_a_formula_is_one_however_its_sum_was_written():
    """8 e - 12 cos - 9 cos^3 = 8 e + 3 (3 sin^2 - 7) cos: of the two, with e = cos(pi/15), the shorter."""
    wanted = "18*(8*cos(pi/15) - 12*cos(x) - 9*cos(x)^3)*sin(x)/(4 + 9*cos(x)^2)^2"
    for given in (wanted, "18*(3*(3*sin(x)^2 - 7)*cos(x) + 8*cos(pi/15))*sin(x)/(4 + 9*cos(x)^2)^2"):
        graph = Graph()
        scalar = parse(given).evaluate({"x": graph.symbol("x"), "pi": graph.pi})
        assert to_text(book_form(scalar)) == wanted
