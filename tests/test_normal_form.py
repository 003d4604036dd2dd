"""The normal form: exact equality, and results written as in a textbook."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_expressions import on_graph, polynomials, smooth, trigonometric

from eomgen.errors import DerivationError
from eomgen.symbolic.exact import normal_forms as normal_form_module
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.exact.normal_forms import (
    cancelled,
    collected_in,
    common_factor,
    equal,
    normal_form,
    readable,
    readable_all,
    simplest,
)
from eomgen.symbolic.exact.polynomials import power_form
from eomgen.symbolic.exact.terms import TooLarge, wave
from eomgen.symbolic.expression.derivatives import gradient, tangent
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Node
from eomgen.symbolic.print.text import to_text

HALF = Fraction(1, 2)


@pytest.fixture
def graph() -> Graph:
    return Graph()


@pytest.fixture
def the(graph):
    """the("m theta theta'") gives symbols, parameters first as a model declares them."""
    for name in ("M", "m", "R", "l", "l1", "l2", "g", "k"):
        graph.symbol(name)
    return lambda names: tuple(graph.symbol(name) for name in names.split())


def sin(a):
    return a.graph.call("sin", a)


def cos(a):
    return a.graph.call("cos", a)


def test_a_common_sine_is_cancelled_though_its_square_is_written_by_the_cosine(graph, the):
    """(c s x + c s^2 y)/s = c x + c s y"""
    x, y, theta = the("x y theta")
    c, s = cos(theta), sin(theta)
    found = simplest(graph.div(c * s * x + c * s * s * y, s))
    assert equal_at_random_states([(found, c * x + c * s * y)]).equal
    assert "/" not in to_text(found)
    assert "/" not in to_text(simplest(graph.div(s * s * s * x + s * (1 - c * c) * y, s * s)))


# -- equality -------------------------------------------------------------------------------------


@given(trigonometric)
def test_the_form_of_equals_is_the_same(tree):
    """form((f + x)^2) = form(f^2 + 2 x f + x^2), and differs from that of another function."""
    graph = Graph()
    f, x = on_graph(tree, graph), graph.symbol("x")
    a, b = (f + x) * (f + x), f * f + 2 * (x * f) + x * x
    assert normal_form(a) == normal_form(b)
    assert normal_form(a - b).is_zero
    assert normal_form(a) != normal_form(b + sin(x))
    assert equal(a, b)
    assert not equal(a, b + sin(x))


@given(trigonometric | polynomials, trigonometric)
def test_the_form_decides_as_random_states_do(tree, other):
    """equal(f, g) = equal at random exact states."""
    graph = Graph()
    f, g = on_graph(tree, graph), on_graph(other, graph)
    assert equal(f, g) == equal_at_random_states([(f, g)]).equal


def test_identities_of_sines_are_decided(graph, the):
    """s^2 + c^2 = 1, double, half and shifted angles, products to sums."""
    a, b = the("a b")
    assert equal(1 - cos(a) ** 2, sin(a) ** 2)
    assert equal(sin(2 * a), 2 * sin(a) * cos(a))
    assert equal(2 * cos(a / 2) ** 2, 1 + cos(a))
    assert equal(cos(a - b), cos(a) * cos(b) + sin(a) * sin(b))
    assert equal(sin(a + graph.pi / 3), sin(a) / 2 + graph.sqrt(3) / 2 * cos(a))
    assert equal(sin(a * (b + 2)), sin(a * b) * cos(2 * a) + cos(a * b) * sin(2 * a))
    assert not equal(cos(a - b), cos(a) * cos(b) - sin(a) * sin(b))


def test_quotients_are_decided(graph, the):
    """(x^2 - l^2)/(x - l) = x + l; tan + cot = 1/(s c); 1/sqrt(f) = sqrt(f)/f; nested fractions."""
    a, x, l = the("a x l")
    assert equal((x * x - l * l) / (x - l), x + l)
    assert not equal((x * x - l * l) / (x - l), x - l)
    assert equal(sin(a) / cos(a) + cos(a) / sin(a), 1 / (sin(a) * cos(a)))
    root = graph.sqrt(x * x + l * l)
    assert equal(1 / root, root / (x * x + l * l))
    assert equal(1 / (1 + 1 / (x + l)), (x + l) / (x + l + 1))
    assert equal(1 / (x / (x + l) + l / (x + l)), 1)


def test_relations_between_other_functions_are_decided_at_states(graph, the):
    """exp(2 x) = exp(x)^2; exp(x (x + 1)) = exp(x^2 + x) already as atoms."""
    (x,) = the("x")
    exp = lambda a: graph.call("exp", a)  # noqa: E731 - as in the formula
    assert equal(exp(2 * x), exp(x) ** 2)
    assert not equal(exp(2 * x), 2 * exp(x))
    assert normal_form(exp(x * (x + 1)) - exp(x * x + x)).is_zero


def test_work_is_bounded(the):
    """(a + b + c + d)^8 against a limit of 100 products; `equal` then decides at states."""
    a, b, c, d = the("a b c d")
    total = (a + b + c + d) ** 8
    with pytest.raises(TooLarge):
        normal_form(total, limit=100)
    assert readable(total, limit=100) is total
    assert equal(total, (d + c + b + a) ** 8, limit=100)
    assert not equal(total, (d + c + b - a) ** 8, limit=100)


@settings(max_examples=30)
@given(
    st.dictionaries(
        st.tuples(st.sampled_from(("cos", "sin")), st.integers(-3, 3), st.integers(-3, 3)), st.integers(-5, 5)
    )
)
def test_waves_in_powers_hold_no_square_of_a_sine_and_are_the_same_function(chosen):
    """cos(2 a + b) = (2 C^2 - 1) c - 2 S C s: of each axis C^n or S C^n."""
    a, b = 0.7, -1.9
    waves: dict = {}
    for (kind, m, n), c in chosen.items():
        w, sign = wave(kind, tuple((k, x) for k, x in ((1, m), (2, n)) if x))
        waves[w] = waves.get(w, 0) + sign * c
    axes = (((1, 1),), ((2, 1),))
    found = power_form(waves, axes)
    C, S, c, s = math.cos(a), math.sin(a), math.cos(b), math.sin(b)
    written = sum(x * C**i * S**j * c**k * s**l for (i, j, k, l), x in found.items())
    angles = {1: a, 2: b}
    value = sum(
        x * (getattr(math, w[0])(sum(k * angles[angle] for angle, k in w[1])) if w else 1) for w, x in waves.items()
    )
    assert all(found.values()) and all(j < 2 and l < 2 for _, j, _, l in found)
    assert written == pytest.approx(value, abs=1e-9)


def test_where_the_work_is_not_enough_nothing_is_written(the, monkeypatch):
    """Three divisors are brought to one before anything is written: that ends here."""
    a, b, x, y = the("a b x y")
    f = a / (2 + cos(x)) + b / (3 + sin(y)) + a * b / (5 + cos(x + y))
    assert len(normal_form(f, limit=50).terms) == 3
    monkeypatch.setattr(normal_form_module, "Writer", None)
    assert simplest(f, limit=50) is f
    with pytest.raises(TypeError):
        simplest(f, limit=5000)


# -- reading --------------------------------------------------------------------------------------


@given(trigonometric | polynomials)
@settings(deadline=None)
def test_what_is_readable_is_the_same_function(tree):
    """readable(f) = f, exactly."""
    graph = Graph()
    f = on_graph(tree, graph)
    assert equal_at_random_states([(readable(f), f), (cancelled(f), f)]).equal


@given(smooth)
@settings(deadline=None)
def test_what_is_readable_is_the_same_function_with_any_functions(tree):
    """readable(f) = f = cancelled(f) with roots, quotients, exponentials."""
    graph = Graph()
    f = on_graph(tree, graph)
    assert equal_at_random_states([(readable(f), f), (cancelled(f), f)]).equal


def test_kinetic_energies_read_as_in_a_textbook(the):
    """Ellipsograph, spherical pendulum, and what a sum of squares of velocities leaves."""
    M, m, R, l, theta, w, psi, phi_rate = the("M m R l theta theta' psi phi'")
    ellipsograph = M * R**2 * (Fraction(39, 2) - Fraction(27, 2) * sin(theta) ** 2) * w**2
    assert to_text(readable(ellipsograph)) == "6*M*R^2*theta'^2 + 27/2*M*R^2*cos(theta)^2*theta'^2"
    spherical = (
        HALF
        * m
        * (
            (l * cos(theta) * cos(psi) * w - l * sin(theta) * sin(psi) * phi_rate) ** 2
            + (l * cos(theta) * sin(psi) * w + l * sin(theta) * cos(psi) * phi_rate) ** 2
            + (l * sin(theta) * w) ** 2
        )
    )
    text = to_text(readable(spherical))
    assert sorted(text.split(" + ")) == ["1/2*m*l^2*sin(theta)^2*phi'^2", "1/2*m*l^2*theta'^2"]


def double_pendulum(the, relative: bool):
    m, l1, l2, theta1, theta2, w1, w2 = the("m l1 l2 theta1 theta2 theta1' theta2'")
    second, rate = (theta1 + theta2, w1 + w2) if relative else (theta2, w2)
    vx = l1 * cos(theta1) * w1 + l2 * cos(second) * rate
    vy = l1 * sin(theta1) * w1 + l2 * sin(second) * rate
    return readable(HALF * m * (vx * vx + vy * vy))


def test_a_difference_of_angles_stays_one(the):
    """T of the double pendulum holds cos(theta1 - theta2)."""
    assert to_text(double_pendulum(the, relative=False)) == (
        "1/2*m*l1^2*theta1'^2 + m*l1*l2*cos(theta1 - theta2)*theta1'*theta2' + 1/2*m*l2^2*theta2'^2"
    )


def test_a_relative_angle_stands_alone(the):
    """With theta2 relative only cos(theta2) is left."""
    text = to_text(double_pendulum(the, relative=True))
    assert "m*l1*l2*cos(theta2)*theta1'^2" in text
    assert "cos(theta1" not in text


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        (lambda a, b, c: sin(a) * cos(a), {"sin(a)*cos(a)", "cos(a)*sin(a)"}),
        (lambda a, b, c: sin(2 * a) / 2, {"sin(a)*cos(a)", "cos(a)*sin(a)"}),
        (lambda a, b, c: 1 - cos(a) ** 2, {"sin(a)^2"}),
        (lambda a, b, c: cos(a - b) ** 2, {"cos(a - b)^2"}),
        (lambda a, b, c: cos(a) * cos(b) - sin(a) * sin(b), {"cos(a + b)"}),
        (lambda a, b, c: sin(a) * cos(b), {"sin(a)*cos(b)", "cos(b)*sin(a)"}),
        (lambda a, b, c: sin(a) * cos(b + c), {"sin(a)*cos(b + c)", "cos(b + c)*sin(a)"}),
        (lambda a, b, c: cos(a) * sin(a + b), {"cos(a)*sin(a + b)", "sin(a + b)*cos(a)"}),
        (lambda a, b, c: sin(a) * sin(a + b) + cos(b) / 2, {"cos(b) - 1/2*cos(2*a + b)"}),
        (lambda a, b, c: cos(a) ** 2 * sin(b) ** 2, {"cos(a)^2*sin(b)^2", "sin(b)^2*cos(a)^2"}),
        (lambda a, b, c: 1 - cos(a), {"1 - cos(a)"}),
        (lambda a, b, c: Fraction(4, 3) - cos(a) ** 2, {"1/3 + sin(a)^2"}),
        (lambda a, b, c: sin(a) ** 4 + sin(a) ** 2 * cos(a) ** 2, {"sin(a)^2"}),
        (lambda a, b, c: sin(a) / cos(a) * b, {"b*tan(a)", "tan(a)*b"}),
    ],
)
def test_the_shortest_form_is_chosen(the, written, expected):
    """Powers of sines and cosines, or angles added, whichever has fewer terms."""
    assert to_text(readable(written(*the("a b c")))) in expected


def test_accelerations_come_first_then_rates(the):
    """m l^2 theta'' + m l theta'^2 ... + m g l sin(theta)."""
    m, l, g, theta, w, a = the("m l g theta theta' theta''")
    text = to_text(readable(m * g * l * sin(theta) + m * l * w**2 + m * l**2 * a))
    assert text == "m*l^2*theta'' + m*l*theta'^2 + m*l*g*sin(theta)"


def test_roots_and_functions_are_read_inside_too(graph, the):
    """sqrt(x^2 + ...) holds a tidy sum; a divisor is one fraction."""
    l, x, theta = the("l x theta")
    distance = graph.sqrt((x - l * cos(theta)) ** 2 + l**2 * sin(theta) ** 2)
    assert to_text(readable(distance)) == "sqrt(l^2 - 2*l*x*cos(theta) + x^2)"
    assert to_text(readable(graph.call("exp", x * (x + 1)))) == "exp(x^2 + x)"
    assert to_text(readable((l * x + x) / (1 + x))) == "(l*x + x)/(1 + x)"


def test_several_share_one_expansion_and_the_large_ones_stay(the):
    """readable_all = readable of each."""
    a, b, c = the("a b c")
    small, large = (a + b) * (a - b), (a + b + c) ** 8
    written = readable_all((small, large, 3), limit=60)
    assert to_text(written[0]) == "a^2 - b^2"
    assert written[1] is large
    assert written[2] == 3


def test_a_long_sum_stays_in_the_parentheses_in_which_it_is_shorter(the):
    """(M + m + k)^3 (R + l)^2 has 30 terms: written out where more are allowed, as it came where fewer are."""
    M, m, k, R, l = the("M m k R l")
    short = (M + m + k) ** 3 * (R + l) ** 2
    assert simplest(short, most=29) is short
    assert to_text(simplest(short, most=30)).count("+") == 29
    long = sum((short - (j + 1) * M * m * k * R * l for j in range(8)), start=0)
    assert to_text(simplest(long, most=20)) == to_text(simplest(long))


def chain(graph: Graph, n: int, absolute: bool = True) -> tuple[Node, list[Node], list[Node]]:
    """T of n equal point masses on equal links."""
    m, l = graph.symbol("m"), graph.symbol("l")
    q = [graph.symbol(f"q{i}") for i in range(n)]
    u = [graph.symbol(f"q{i}'") for i in range(n)]
    x = y = T = 0
    for i in range(n):
        angle = q[i] if absolute else sum(q[: i + 1], start=0)
        x, y = x + l * sin(angle), y - l * cos(angle)
        vx, vy = tangent((x, y), dict(zip(q, u, strict=True)))
        T = T + HALF * m * (vx * vx + vy * vy)
    return T, q, u


@pytest.mark.slow
def test_the_energy_of_a_long_chain_stays_small(graph):
    """T of 20 links has 210 terms m_ij cos(q_i - q_j) q_i' q_j'; 8 relative links have theirs."""
    T, _, _ = chain(graph, 20)
    text = to_text(readable(T))
    assert text.count(" + ") == 209
    assert "19*m*l^2*cos(q0 - q1)*q0'*q1'" in text
    relative = to_text(readable(chain(Graph(), 8, absolute=False)[0]))
    assert "cos(q1 + q2 + q3)" in relative
    assert "sin" not in relative


# -- taking apart ---------------------------------------------------------------------------------


def test_an_equation_is_collected_in_its_accelerations(the):
    """m l (cos(theta) x'' + l theta'') + 3 m g l sin(theta)"""
    m, l, g, theta, ax, at = the("m l g theta x'' theta''")
    parts = collected_in(m * l * (ax * cos(theta) + l * at) + 3 * m * g * l * sin(theta), (ax, at))
    texts = {symbol: to_text(part) for symbol, part in parts.items()}
    assert texts == {ax: "m*l*cos(theta)", at: "m*l^2", None: "3*m*l*g*sin(theta)"}


@pytest.mark.parametrize("limit", [200_000, 5])
def test_what_is_not_linear_is_not_collected(graph, the, limit):
    """x^2, x y, sin(x), exp(x), 1/(1 + x), with and without expanding."""
    x, y, a = the("x y a")
    for f in (x * x, x * y, sin(x), graph.call("exp", x), 1 / (1 + x)):
        with pytest.raises(DerivationError, match="not linear in x, y"):
            collected_in(f + a, (x, y), limit)


def test_a_large_expression_is_collected_by_its_derivatives(the):
    """The same parts where the limit is reached."""
    x, a, b = the("x a b")
    f = (a + b) ** 6 * x + a
    small, large = collected_in(f, (x,), limit=10), collected_in(f, (x,))
    assert small.keys() == large.keys()
    assert all(equal(small[key], large[key]) for key in small)


def test_the_common_factor_of_an_equation(graph, the):
    """3 M R^2 theta'' + 6 M g R sin(theta) has 3 M R; rates and coordinates in functions stay."""
    M, R, g, l, theta, a, w = the("M R g l theta theta'' theta'")
    assert common_factor([3 * M * R**2 * a + 6 * M * g * R * sin(theta)]) == (3, M * R)
    assert common_factor([M * w * R, 2 * M * w]) == (1, M)
    assert common_factor([a + g / l * sin(theta)]) == (1, 1 / l)
    assert common_factor([M * a / 2 + M * g], kept=[M]) == (HALF, 1)
    assert common_factor([M + R]) == (1, 1)
    assert common_factor([0, 0]) == (1, 1)


def test_a_solved_form_is_cancelled(the):
    """(m g l sin(theta)) / (m l^2) = g sin(theta) / l; cart and pendulum by Cramer's rule."""
    M, m, l, g, theta, w = the("M m l g theta theta'")
    c, s = cos(theta), sin(theta)
    assert to_text(cancelled((m * g * l * s * m) / (3 * m * l * l * m))) == "g*sin(theta)/(3*l)"
    A, B, D = M + m, m * l * c, m * l * l
    F, G = m * l * s * w**2, -m * g * l * s
    x_acceleration = cancelled((F * D - B * G) / (A * D - B * B))
    text = to_text(x_acceleration)
    assert text.endswith("/(M + m*sin(theta)^2)")
    assert equal(x_acceleration, (m * s * (l * w**2 + g * c)) / (M + m * s**2))


def test_common_divisors_with_roots_of_numbers_cancel(graph, the):
    """(m^2 - 3 k^2)/(m - sqrt(3) k) = m + sqrt(3) k, and 1/(m - sqrt(3) k) is left as it is."""
    m, k = the("m k")
    root, other = graph.sqrt(3), graph.sqrt(2)
    assert to_text(cancelled((m * m - 3 * k * k) / (m - root * k))) == "sqrt(3)*k + m"
    assert to_text(cancelled(k / (m - root * k))) == "k/(m - sqrt(3)*k)"
    square = m * m + (5 - 2 * root) * k * k
    below = m**4 + (10 - 4 * root) * m * m * k * k + (37 - 20 * root) * k**4
    assert equal(cancelled(square * (4 + other) * k / below), (4 + other) * k / square)
    assert to_text(cancelled(square * square * k / below)) == "k"


def test_common_divisors_with_sines_cancel(the):
    """(1 - c^2)/s = s; (s^2 - a^2)/(s - a) = s + a."""
    theta, a = the("theta k")
    c, s = cos(theta), sin(theta)
    assert to_text(cancelled((1 - c * c) / s)) == "sin(theta)"
    assert to_text(cancelled(((2 + c) * a + (2 + c) * a * a) / (2 + c))) == "k^2 + k"
    assert cancelled(theta - theta) == 0
    assert to_text(cancelled(a * (2 * theta - 2 * a) / (theta + a))) == "2*k*(theta - k)/(theta + k)"


def test_equations_of_a_chain_agree_with_themselves_read(graph):
    """dT/dq of 5 links, read, is dT/dq."""
    T, q, _ = chain(graph, 5)
    found = gradient(T, q)
    assert equal_at_random_states(list(zip(readable_all(found), found, strict=True))).equal


def test_constants_without_a_graph_are_taken_in(the):
    """sqrt(2) and cos(3/10) of the table of functions meet expressions of any graph."""
    from eomgen.symbolic.expression.formula import cos as cos_of
    from eomgen.symbolic.expression.formula import sqrt as sqrt_of

    (x,) = the("x")
    assert readable_all((sqrt_of(2), x * (x + 1)))[0] is x.graph.sqrt(2)
    assert equal_at_random_states([(x + cos_of(Fraction(3, 10)), cos_of(Fraction(3, 10)) + x)]).equal
    assert equal(sqrt_of(8), 2 * sqrt_of(2))
    assert common_factor([x.graph.pi * x * x, sqrt_of(2) * x]) == (1, x)
