"""A number leaves an exact form with all its digits, however much cancels in the form."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from each import each
from slider_crank import SLIDER_CRANK
from slow_run import in_slow_run

import eomgen
from eomgen.symbolic.expression.formula import cos, sqrt
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.numeric.arithmetic import balls, number_of, numbers_of
from eomgen.symbolic.numeric.digits import ball_of, precision
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

GRAPH = Graph()
X, Y = GRAPH.symbol("x"), GRAPH.symbol("y")


@in_slow_run
@pytest.mark.slow
def test_the_force_on_a_slider_at_nice_angles_is_mass_times_acceleration():
    """F = m (r w^2 cos a + r^2 w^2 cos 2a/R + r^4 w^2 sin^2 a cos^2 a/R^3), R = sqrt(L^2 - r^2 sin^2 a).

    Formed by hand with 40 digits for r = 0.24, L = 0.35, w = 110, m = 0.9.
    """
    true = {"pi/6": 3407.9598222043, "pi/4": 2163.0166227127, "pi/3": 496.4243187697}
    requested = [f'a{k} = {{ value = "reaction_x(B)", at = "a = {angle}" }}' for k, angle in enumerate(true)]
    requested += [f't{k} = {{ value = "reaction_x(B)", at = "t = {angle}/w" }}' for k, angle in enumerate(true)]
    answers = eomgen.solve(eomgen.loads(SLIDER_CRANK + "\n".join(requested)))
    for k, force in enumerate(true.values()):
        assert answers[f"a{k}"].value == pytest.approx(force, rel=1e-12)
        assert answers[f"t{k}"].value == pytest.approx(force, rel=1e-12)


@each("x", [Fraction(1, 10**k) for k in (1, 5, 9, 15, 40)])
def test_what_cancels_in_a_form_takes_no_digit_of_its_number(x):
    """(1 - cos x)/x^2 = 1/2 - x^2/24 + ..., (sqrt(1 + x) - sqrt(1 - x))/x = 1 + x^2/8 + ..."""
    versine = (1 - cos(X)) / X**2
    roots = (sqrt(1 + X) - sqrt(1 - X)) / X
    small = float(x) ** 2
    assert numbers_of((versine, roots), {X: x}) == pytest.approx(
        [0.5 - small / 24 + small**2 / 720, 1 + small / 8 + 7 * small**2 / 128], rel=small**3 / 25 + 1e-15
    )


def test_a_form_that_doubles_get_wrong_is_seen_by_this_test():
    """At x = 1e-9 doubles say 0 for (1 - cos x)/x^2: what the door is for."""
    assert evaluate(((1 - cos(X)) / X**2,), {X: 1e-9}, FLOAT) == [0.0]


def test_an_exact_constant_as_a_value_is_not_rounded_first():
    """1/(x^2 - 2 + 1e-30) at x = sqrt(2) is 1e30; with the double next to sqrt(2) it is 2.2e15."""
    assert number_of(1 / (X**2 - 2 + Fraction(1, 10**30)), {X: sqrt(2)}) == pytest.approx(1e30, rel=1e-14)


DISGUISED = {X: 3 + 2 * sqrt(2), Y: (1 + sqrt(2)) ** 2}  # the same number
ZERO = sqrt(X) - sqrt(Y)


def test_a_form_that_is_zero_in_disguise_is_zero():
    """sqrt(x) - sqrt(y) at x = 3 + 2 sqrt(2), y = (1 + sqrt(2))^2"""
    assert number_of(ZERO, DISGUISED) == 0.0


def test_an_edge_of_a_domain_is_met_whatever_rounding_does():
    """acos(1 + 0) = 0, sqrt(0) = 0 and the sign of 0 is 0, the 0 in disguise; 0 < 0 does not hold, 0 <= 0 does."""
    call = GRAPH.call
    edges = (call("acos", 1 + ZERO), sqrt(ZERO), call("sign", ZERO), call("less", ZERO, 0), call("less_equal", ZERO, 0))
    assert numbers_of(edges, DISGUISED) == [0.0, 0.0, 0.0, 0.0, 1.0]


def test_what_has_no_number_is_nan_and_takes_nothing_along():
    """1/0 in disguise, sqrt(-1) and log(0) are nan; what stands beside them is not."""
    *none, fine = numbers_of((1 / ZERO, sqrt(-X), GRAPH.call("log", ZERO), X - 2 * sqrt(2)), DISGUISED)
    assert all(math.isnan(x) for x in none) and fine == 3.0


def test_a_branch_that_is_not_taken_needs_no_number():
    """x > 0: sqrt(x), else sqrt(-x)."""
    root = GRAPH.select(GRAPH.call("less", 0, X), sqrt(X), sqrt(-X))
    assert numbers_of((root,), {X: 4}) == numbers_of((root,), {X: -4}) == [2.0]


WIDE = Fraction(1, 10**25)
FUNCTIONS = "sqrt sin cos tan asin acos atan sinh cosh tanh exp log abs".split()


@each("x", [Fraction(3, 10), Fraction(999999, 1000000), Fraction(1, 10**12)])
@each("name", FUNCTIONS)
def test_a_ball_holds_the_true_value(name, x):
    """The ball of f around x, 1e-25 wide, holds f with 120 digits at both ends of it."""
    f = balls().functions[name]
    with precision(100):
        ball = f(ball_of(x, float(WIDE)))
    with precision(400):
        assert all(
            ball.contains(f(ball_of(end)).mid())
            for end in (x - WIDE * Fraction(999, 1000), x + WIDE * Fraction(999, 1000))
        )
    assert ball.rad() <= 1e-10 * abs(ball) + 1e-20


@each("op", "add sub mul div pow atan2 min max".split())
def test_a_ball_of_two_arguments_holds_the_true_value(op):
    """As of one argument, at the four corners."""
    a, b, d, f = Fraction(17, 10), Fraction(-23, 10), WIDE * Fraction(999, 1000), balls().functions[op]
    with precision(100):
        ball = f(ball_of(a, float(WIDE)), ball_of(b, float(WIDE)))
    with precision(400):
        corners = [f(ball_of(x), ball_of(y)).mid() for x in (a - d, a + d) for y in (b - d, b + d)]
    assert all(map(ball.contains, corners)) and ball.rad() < 1e-20


def test_where_nothing_can_be_said_a_ball_has_no_end_and_where_there_is_no_value_it_is_nan():
    """0 in the ball of a divisor, a logarithm or a power; an angle of no direction."""
    near, two, f = ball_of(0, 1e-9), ball_of(2), balls().functions
    open_ = [f["div"](two, near), f["log"](near), f["pow"](near, ball_of(-0.5)), f["atan2"](near, near)]
    none = [f["div"](two, ball_of(0)), f["log"](-two), f["pow"](-two, ball_of(0.5)), f["sqrt"](-two), f["asin"](two)]
    assert not any(x.is_finite() or x.is_nan() for x in open_) and all(x.is_nan() for x in none)
    for name in ("add", "mul", "div", "min"):  # they are passed on
        assert f[name](open_[0], two).is_finite() is f[name](open_[0], two).is_nan() is False
        assert f[name](open_[0], none[0]).is_nan()
    assert f["sqrt"](near).contains(2e-5) and f["asin"](ball_of(1, 1e-9)).contains(f["asin"](ball_of(1)).mid())
    assert f["select"](f["less"](near, ball_of(0)), two, -two).contains(2)
    assert balls(last=True).functions["less"](near, ball_of(0)).is_zero()


def test_a_root_of_a_root_of_nothing_is_nothing():
    """sqrt(x^2 - sqrt(x^4)) = 0, of 480 digits its two roots leave 120."""
    assert number_of(sqrt(X * X - sqrt(sqrt(X) ** 8)), {X: 0.3}) == 0
