"""Intervals hold what they say they hold, and no root is missed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from each import each

from eomgen.symbolic.expression.formula import NAMES
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.numeric.arithmetic import INTERVALS
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate, fifty_digits
from eomgen.symbolic.numeric.roots import Descent, can_isolate, isolated

graph = Graph()
x, y = graph.symbol("x"), graph.symbol("y")
ONE = [name for name, n in NAMES.items() if n == 1]


@each("name", ONE)
@each("seed", range(3))
def test_a_function_stays_in_its_interval(name, seed):
    """f([a, b]) holds f at every point of [a, b] at which it has a value."""
    rng = np.random.default_rng(seed)
    low = rng.uniform(-3, 3, 40)
    high = low + rng.exponential(1, 40)
    f = graph.call(name, x)
    with np.errstate(all="ignore"):
        (found,) = evaluate((f,), {x: np.array([low, high])}, INTERVALS)
    for s in np.linspace(0, 1, 9):
        for k, point in enumerate(low + s * (high - low)):
            (value,) = evaluate((f,), {x: float(point)}, FLOAT)
            assert math.isnan(value) or found[0][k] <= value <= found[1][k]


@each(
    "make",
    [
        lambda: x + y,
        lambda: x - 2 * y,
        lambda: x * y,
        lambda: x / y,
        lambda: x * x - y,
        lambda: graph.pow(x, 3),
        lambda: graph.pow(x, -2),
        lambda: graph.call("min", x, y),
        lambda: graph.call("atan2", x, y),
        lambda: graph.select(graph.call("less", x, y), x * y, x + y),
    ],
)
def test_operations_stay_in_their_intervals(make):
    rng = np.random.default_rng(7)
    f = make()
    low = rng.uniform(-2, 2, (2, 60))
    high = low + rng.exponential(0.7, (2, 60))
    with np.errstate(all="ignore"):
        (found,) = evaluate((f,), {x: np.array([low[0], high[0]]), y: np.array([low[1], high[1]])}, INTERVALS)
    for _ in range(30):
        at = low + rng.uniform(0, 1, low.shape) * (high - low)
        for k in range(60):
            (value,) = evaluate((f,), {x: at[0, k], y: at[1, k]}, FLOAT)
            assert math.isnan(value) or found[0][k] <= value <= found[1][k]


def test_all_roots_of_two_equations_are_isolated():
    """A circle and a wave: as many roots as a fine grid shows, each in a box of its own."""
    equations = (x * x + y * y - 4, y - graph.call("sin", 3 * x))
    found = isolated(equations, (x, y), {}, np.array([-5.0, -5.1]), np.array([5.2, 5.0]))
    s = np.linspace(-2, 2, 400_001)
    crossings = np.count_nonzero(np.diff(np.sign(s**2 + np.sin(3 * s) ** 2 - 4)))
    assert found.finished and len(found.undecided) == 0 and len(found.roots) == crossings
    roots = Descent(equations, (x, y), {}).roots_near(found.roots)
    assert len(roots) == crossings
    for a, b in roots:
        assert abs(a * a + b * b - 4) < 1e-14 and abs(b - math.sin(3 * a)) < 1e-14


def test_a_multiple_root_stays_undecided_and_is_not_lost():
    """x = sin(x) has a triple root at 0, which Newton's method alone finds slowly."""
    equations = (x - graph.call("sin", x),)
    found = isolated(equations, (x,), {}, np.array([-3.1]), np.array([3.3]))
    assert found.finished and len(found.roots) == 0 and len(found.undecided) > 0
    assert np.max(np.abs(found.undecided)) < 1e-3
    for (root,) in Descent(equations, (x,), {}).roots_near(found.undecided):
        assert abs(root) < 1e-12


def test_a_parameter_has_a_value_and_jumps_are_not_isolated():
    """x^2 = p: the values of other symbols are given."""
    p = graph.symbol("p")
    found = isolated((x * x - p,), (x,), {p: fifty_digits().number(2)}, np.array([-3.0]), np.array([3.1]))
    assert sorted(np.round(found.roots[:, 0], 3)) == pytest.approx([-1.414, 1.414], abs=0.7)
    assert len(found.roots) == 2 and not can_isolate((graph.call("sign", x),))
