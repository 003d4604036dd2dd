"""A reaction by the balance of one side of its joint is the one that all bodies in balance give."""

from __future__ import annotations

import pytest

from eomgen.documents.reaction_values import readings_of
from eomgen.documents.reading import Reader
from eomgen.symbolic.exact.normal_forms import equal
from eomgen.symbolic.expression.derivatives import substituted
from tests.helpers.derivations import equations

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", ["block_on_wedge", "elastic_pendulum", "ch22_p2", "cart_pole"])
def test_one_side_of_a_joint_gives_the_reaction_of_all_bodies(name: str):
    """n = sum(d/dt (I w) - n_applied + (C - P) x (m a_C - f_applied)), the same along every motion"""
    readings = readings_of(equations(name).graph, Reader())
    assert readings.sides and readings.accelerations
    for j, by_side in readings.sides.items():
        solved = readings.ways[0].combined({j: 1}, "")
        a, b = substituted((by_side, solved), readings.accelerations)
        assert equal(a, b), readings.ways[0].components[j].name
