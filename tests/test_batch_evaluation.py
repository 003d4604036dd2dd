"""Values at many states at once against one state after the other, in the arithmetic of Python's own floats."""

from __future__ import annotations

from math import isnan

import numpy as np
import pytest

from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.numeric.evaluation import FLOAT, Layers, evaluate


def formulas():
    """(unknowns, parameter, expressions of every depth and kind)."""
    graph = Graph()
    x, y, k = (graph.symbol(name) for name in "xyk")
    s = graph.call("sin", x) * y + k
    found = [s, s * s - graph.call("cos", y), graph.sqrt(x), k * k / 3, 7, x, graph.pi * y / s]
    chosen = graph.select(graph.call("less", x, y), s, -y)
    return (x, y), k, (*found, graph.call("atan2", s, y + 1), chosen, abs(y) * x**3)


def test_many_states_have_the_values_that_each_has_by_itself():
    """f(x_i) of n states at once is f(x_i) of each, operation by operation."""
    unknowns, k, scalars = formulas()
    states = np.random.default_rng(3).uniform(-2, 2, (50, 2))
    found = Layers(scalars, unknowns, {k: 1.25}).at(states)
    for state, row in zip(states, found, strict=True):
        alone = evaluate(scalars, {**dict(zip(unknowns, map(float, state), strict=True)), k: 1.25}, FLOAT)
        assert row == pytest.approx(alone, rel=1e-13, nan_ok=True)


def test_outside_its_domain_an_expression_has_no_number():
    """sqrt(-1) is nan in its own state, and does not reach the next: sqrt(4) = 2."""
    unknowns, k, scalars = formulas()
    found = Layers(scalars, unknowns, {k: 0.0}).at(np.array([[-1.0, 1.0], [4.0, 1.0]]))
    assert isnan(found[0, 2])
    assert found[1, 2] == 2.0


def test_no_state_and_no_unknown_are_no_exception():
    """0 states give 0 rows; expressions of parameters alone are the same in all states."""
    unknowns, k, scalars = formulas()
    assert Layers(scalars, unknowns, {k: 1.0}).at(np.zeros((0, 2))).shape == (0, len(scalars))
    assert Layers((k * k, 3), (), {k: 2.0}).at(np.zeros((2, 0))).tolist() == [[4.0, 3.0], [4.0, 3.0]]
