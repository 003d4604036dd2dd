"""Equations that are pickled mean the same in another process, whatever that process has derived before."""

from __future__ import annotations

import multiprocessing
import pickle

import pytest

import eomgen
from eomgen.symbolic.expression.formula import cos, sqrt
from eomgen.symbolic.expression.graph import CONSTANTS, Graph

CART = """
eomgen = 1
space = "plane"
[coordinates]
x = { motion = { samples = [[0, 0], [1, SAMPLE], [2, 0], [3, 0]] } }
theta = 0.3
[bodies.cart]
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[bodies.rod]
shape = { kind = "rod", mass = 2, length = 1 }
joint = { kind = "revolute", on = "cart", angle = "theta" }
[forces.w]
kind = "gravity"
acceleration = [0, -9.81]
"""


def derived(sample):
    return eomgen.derive(eomgen.loads(CART.replace("SAMPLE", str(sample))))


def rates(equations):
    rhs = equations.rhs("numpy")
    return list(rhs(1.5, rhs.x0, rhs.p0))


def rates_elsewhere(path, pickled):
    """What a process that derived another model first makes of the equations, and of what it derives itself."""
    import sys

    sys.path[:] = path
    own = rates(derived(70))
    return rates(pickle.loads(pickled)), own


@pytest.mark.slow
def test_samples_go_with_the_equations_into_a_spawned_process():
    """Between 0 and 3 s the cart follows its own samples: x'(1.5) = -4.5 for x(1) = 4, -78.75 for x(1) = 70."""
    import sys

    here = rates(derived(4))
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        there, own = pool.apply(rates_elsewhere, (list(sys.path), pickle.dumps(derived(4))))
    assert there == here == pytest.approx([-4.5, 0.0, -14.94433706])
    assert own[0] == pytest.approx(-78.75)


def test_a_pickled_graph_holds_each_expression_once_again():
    """What was one node is one node, sharing included; new expressions meet the old ones."""
    graph = Graph()
    x = graph.symbol("x")
    y = cos(x) * cos(x) + sqrt(1 + cos(x))
    x_, y_ = pickle.loads(pickle.dumps((x, y)))
    assert x_.graph is y_.graph is not graph and len(x_.graph) == len(graph)
    assert cos(x_) * cos(x_) + sqrt(1 + cos(x_)) is y_


@pytest.mark.slow
def test_a_deep_expression_is_pickled_without_recursion():
    """sqrt(1 + x sqrt(1 + x ...)), ten thousand deep."""
    graph = Graph()
    x = y = graph.symbol("x")
    for _ in range(10_000):
        y = sqrt(1 + x * y)
    assert len(pickle.loads(pickle.dumps(y)).graph) == len(graph)


def test_a_pickled_constant_is_the_constant_of_the_process_that_reads_it():
    """sqrt(2) of no graph can be combined with the expressions of any."""
    two = pickle.loads(pickle.dumps(sqrt(2)))
    assert two.graph is CONSTANTS and two is sqrt(2)
    x = Graph().symbol("x")
    assert two * x is sqrt(2) * x
