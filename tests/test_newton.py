"""One iteration for all roots nearby: its order, its digits, what it leaves, and how it fails."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from eomgen.symbolic.numeric.evaluation import NoValue, fifty_digits
from eomgen.symbolic.numeric.roots import Newton, least_left


@dataclass(frozen=True)
class Equations:
    """f and df/dx of plain functions; places are arrays, of floats or of numbers of 50 digits."""

    f: Any
    A: Any

    def left(self, x):
        return self.f(x)

    def slopes(self, x):
        return np.array(self.A(x), dtype=float)

    def moved(self, x, step):
        return [a + d for a, d in zip(x, step, strict=True)]


CIRCLE = Equations(lambda x: [x[0] ** 2 + x[1] ** 2 - 2, x[0] - x[1]], lambda x: [[2 * x[0], 2 * x[1]], [1, -1]])
TWICE = Equations(lambda x: [(x[0] - 1) ** 2], lambda x: [[2 * (x[0] - 1)]])
LOG = Equations(lambda x: [math.log(x[0])], lambda x: [[1 / x[0]]])


def digits(*x: float) -> list[Any]:
    return [fifty_digits().number(1) * v for v in x]


def test_the_digits_of_the_root_are_those_of_the_equations():
    """Slopes are floats, yet x = y = 1 comes out to 40 digits: each step adds its own to x."""
    root = Newton(enough=1e-40).root(CIRCLE, digits(1.2, 0.7))
    assert root.met and root.left <= 1e-40
    assert all(abs(x - 1) < 1e-39 for x in root.x)


def test_the_digits_double_in_every_step():
    """|e| <- |e|^2 / 2 of x^2 = 2: six steps from 1.5 leave less than rounding."""
    root = Equations(lambda x: [x[0] ** 2 - 2], lambda x: [[2 * x[0]]])
    errors = [abs(Newton(steps=k).root(root, [1.5]).x[0] - math.sqrt(2)) for k in range(1, 4)]
    assert all(after < before**2 for before, after in pairwise(errors))


def test_the_change_is_the_least_that_will_do():
    """x + y = 2 from (3, 1) leads to (2, 0), the foot of the perpendicular; the same equation twice changes nothing."""
    once = Equations(lambda x: [x[0] + x[1] - 2], lambda x: [[1, 1]])
    twice = Equations(lambda x: 2 * [x[0] + x[1] - 2], lambda x: [[1, 1], [1, 1]])
    for equations in (once, twice):
        root = Newton(enough=1e-12).root(equations, [3.0, 1.0])
        assert root.met and root.x == pytest.approx([2, 0])


def test_a_double_root_is_reached_by_doubled_steps():
    """(x - 1)^2 halves its error in a step; a step taken twice lands on the root."""
    plain = Newton(enough=1e-20, steps=12).root(TWICE, [2.0])
    doubled = Newton(enough=1e-20, steps=12, double=0.02).root(TWICE, [2.0])
    assert not plain.met and doubled.met and doubled.x[0] == pytest.approx(1, abs=1e-10)


def test_equations_that_differ_by_rounding_stall_at_their_root():
    """x = 1 and x = 1 + 1e-14 have no common root; where they come no nearer is one, with what is left."""
    equations = Equations(lambda x: [x[0] - 1, x[0] - 1 - 1e-14], lambda x: [[1], [1]])
    assert not Newton(enough=1e-20).root(equations, digits(3)).met
    root = Newton(enough=1e-20, stalls=1e-13).root(equations, digits(3))
    assert root.met and root.left == pytest.approx(5e-15, rel=1e-3)


def test_a_search_that_fails_is_a_value_with_what_is_left():
    """x^2 + 1 = 0 has no real root: not met, |f| at least 1; no exception."""
    equations = Equations(lambda x: [x[0] ** 2 + 1], lambda x: [[2 * x[0]]])
    root = Newton(enough=1e-12, steps=30).root(equations, [0.7])
    assert not root.met and root.left >= 1


def test_a_place_without_a_value_ends_the_search():
    """No slope, or no value of the function: not met, and what is left is not a number."""

    def refuse(x):
        raise NoValue("the logarithm of a negative number")

    for equations in (Equations(refuse, LOG.A), Equations(lambda x: [1.0], lambda x: [[math.inf]])):
        root = Newton(enough=1e-12).root(equations, [0.5])
        assert not root.met and math.isnan(root.left)


def test_a_flat_place_is_no_root():
    """f = 1 with slope 0: the step is nothing, and yet nothing was reached."""
    assert not Newton(enough=1e-12).root(Equations(lambda x: [1.0], lambda x: [[0.0]]), [0.5]).met


def test_damping_does_not_leap_along_what_hardly_resists():
    """x + 1e-6 y = 1 and x = 0.9: undamped y runs away to 1e5; damped the first step stays within reach."""
    equations = Equations(lambda x: [x[0] + 1e-6 * x[1] - 1, x[0] - 0.9], lambda x: [[1, 1e-6], [1, 0]])
    free, held = (Newton(steps=1, damped=damped).root(equations, [0.0, 0.0]).x for damped in (False, True))
    assert abs(free[1]) > 1e4 and abs(held[1]) < 1


def test_the_least_that_can_be_left_is_found_where_there_is_no_root():
    """|f|^2 of x - 1 and x + 1 is least at 0, where both are 1."""
    found = least_left(lambda x: np.array([x[0] - 1, x[0] + 1]), np.array([0.4]))
    assert found.x[0] == pytest.approx(0, abs=1e-8) and found.left == pytest.approx(1) and not found.met
