"""Equality at random exact states."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import given
from random_expressions import on_graph, smooth, trigonometric

from eomgen.errors import DerivationError
from eomgen.symbolic.exact.equality import equal_at_random_states, equal_at_real_states, exact_state
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import PRIME_FIELD, RATIONAL, NoMeaning, evaluate, fifty_digits


@pytest.fixture
def graph() -> Graph:
    return Graph()


@pytest.fixture
def angles(graph):
    return graph.symbol("a"), graph.symbol("b")


def sin(a):
    return a.graph.call("sin", a)


def cos(a):
    return a.graph.call("cos", a)


@pytest.mark.parametrize("arithmetic", [PRIME_FIELD, RATIONAL])
def test_sines_and_cosines_of_a_state_belong_together(graph, angles, arithmetic):
    """s^2 + c^2 = 1; sin(a + b), sin(2 a), cos(a/2)^2 and quarter turns by the addition theorems."""
    a, b = angles
    identities = [
        (sin(a) * sin(a), 1 - cos(a) * cos(a)),
        (sin(a + b), sin(a) * cos(b) + cos(a) * sin(b)),
        (cos(3 * a - b), cos(3 * a) * cos(b) + sin(3 * a) * sin(b)),
        (sin(2 * a), 2 * sin(a) * cos(a)),
        (2 * cos(a / 2) ** 2, 1 + cos(a)),
        (sin(a + 1), sin(a) * graph.call("cos", 1) + cos(a) * graph.call("sin", 1)),
    ]
    flat = [x for pair in identities for x in pair]
    state = exact_state(flat, Random(3), arithmetic)
    values = evaluate(flat, state.values, arithmetic)
    assert values[::2] == values[1::2]
    assert state.independent


@pytest.mark.parametrize("turn", ["pi/6", "pi/4", "pi/3"])
def test_turns_of_pi_have_their_roots_in_the_field(graph, angles, turn):
    """sin(a + pi/6) = sin a cos(pi/6) + cos a sin(pi/6), decided exactly."""
    a, _ = angles
    angle = graph.pi / int(turn[-1])
    verdict = equal_at_random_states([(sin(a + angle), sin(a) * cos(angle) + cos(a) * sin(angle))])
    assert (verdict.equal, verdict.arithmetic) == (True, "prime field")


@pytest.mark.slow
@given(trigonometric)
def test_an_expression_equals_itself_written_otherwise(tree):
    """f (x + y) = f x + f y, and not with one more term."""
    graph = Graph()
    f, x, y = on_graph(tree, graph), graph.symbol("x"), graph.symbol("y")
    verdict = equal_at_random_states([(f * (x + y), f * x + f * y)])
    assert verdict.equal
    assert not equal_at_random_states([(f * (x + y), f * x + f * y + cos(x))]).equal


@given(smooth)
def test_a_planted_difference_is_found(tree):
    """f is not f + sin(x) / 1000, whatever functions f holds."""
    graph = Graph()
    f, x = on_graph(tree, graph), graph.symbol("x")
    verdict = equal_at_random_states([(x, x), (f, f + sin(x) / 1000)])
    assert not verdict.equal
    assert verdict.culprit == 1


def test_an_angle_is_independent_of_its_sine(graph, angles):
    """sin(a) is not a."""
    a, _ = angles
    assert not equal_at_random_states([(sin(a), a)]).equal


def test_equal_functions_in_both_are_enough_for_the_field(graph, angles):
    """exp(a) b = b exp(a): no digits are needed."""
    a, b = angles
    e = graph.call("exp", a)
    assert equal_at_random_states([((e + 1) * b, b * e + b)]).arithmetic == "prime field"


def test_dependent_functions_are_decided_with_fifty_digits(graph, angles):
    """exp(a) exp(-a) = 1, sqrt(a^2) = a > 0, asin(sin(a/4)) = a/4, sin(t (a + b)) = sin(t a + t b)."""
    a, b = angles
    exp, t = (lambda x: graph.call("exp", x)), graph.symbol("t")
    for pair in [
        (exp(a) * exp(-a), 1),
        (graph.sqrt(a * a), a),
        (graph.call("asin", sin(a / 4)), a / 4),
        (sin(t * (a + b)), sin(t * a + t * b)),
    ]:
        verdict = equal_at_random_states([pair])
        assert (verdict.equal, verdict.arithmetic) == (True, "50 digits")
    assert not equal_at_random_states([(graph.sqrt(a * a), -a)]).equal


def test_a_root_keeps_its_sign(graph, angles):
    """sqrt(a) sqrt(b) = sqrt(a b), not - sqrt(a b)."""
    a, b = angles
    assert equal_at_random_states([(graph.sqrt(a) * graph.sqrt(b), graph.sqrt(a * b))]).equal
    assert not equal_at_random_states([(graph.sqrt(a) * graph.sqrt(b), -graph.sqrt(a * b))]).equal


def test_rates_take_both_signs(graph):
    """|v| is not v."""
    v = graph.symbol("v'")
    assert not equal_at_random_states([(abs(v), v)], states=8).equal


def test_the_same_seed_gives_the_same_state(graph, angles):
    """Reproducible from run to run."""
    f = sin(angles[0]) + angles[1]
    states = [exact_state([f], Random(7)) for _ in range(2)]
    assert states[0].values == states[1].values


def test_what_no_field_has_is_refused_there(graph, angles):
    """The sine of pi/7 and a root of something that moves are sent to another arithmetic."""
    for f in (sin(graph.pi / 7), graph.sqrt(angles[0])):
        with pytest.raises(NoMeaning):
            exact_state([f], Random(1))


def test_expressions_without_any_value_are_an_error(graph, angles):
    """sqrt(-1 - a^2) is real nowhere."""
    root = graph.sqrt(-1 - angles[0] * angles[0])
    with pytest.raises(DerivationError, match="no real state"):
        equal_at_random_states([(root, 2 * root)])


def test_a_root_that_exists_only_where_one_symbol_is_largest_finds_a_state(graph, angles):
    """sqrt(l^2 - x^2 - y^2), the height of a pendulum in Cartesian coordinates; sqrt(-z), of what hangs below"""
    (x, y), l, z = angles, graph.symbol("l"), graph.symbol("z")
    height, depth = graph.sqrt(l * l - x * x - y * y), graph.sqrt(-z)
    for root in (height, depth):
        assert equal_at_random_states([((root + 1) * x, x * root + x)]).equal
        assert not equal_at_random_states([(root, root + x / 1000)]).equal


def test_a_state_at_which_rounding_decides_says_nothing(graph):
    """(1/x + y)^2 - 1/x^2 - 2 y/x = y^2 where no digit of y is left, x = 1e-66; y^2 and y differ at the next one."""
    x, y = graph.symbol("x"), graph.symbol("y")
    digits = fifty_digits()
    rows = [[{x: digits.number(z), y: digits.number(2)} for z in (Fraction(1, 10**66), 3)]]
    same = (1 / x + y) * (1 / x + y) - 1 / (x * x) - 2 * y / x
    assert equal_at_real_states([(same, y * y)], given=rows).equal
    assert not equal_at_real_states([(same, y)], given=rows).equal


def test_a_difference_that_is_rounding_of_large_numbers_is_none():
    """L^2 - x^2 - 1, L = sqrt(x^2 + 1), at x = 1e200/3: of 50 digits noise of 1e350, of 480 digits 0; -0.001 is not."""
    graph = Graph()
    x = graph.symbol("x")
    L = graph.sqrt(x * x + 1)
    state = {x: fifty_digits().number(Fraction(10**200, 3))}
    for form in (L * (L + x) - x * L - x * x - 1, (L - x) * (L + x) - 1):
        assert equal_at_real_states([(form, 0)], states=0, given=[[state]]).equal
        assert not equal_at_real_states([(form, Fraction(1, 1000))], states=0, given=[[state]]).equal
