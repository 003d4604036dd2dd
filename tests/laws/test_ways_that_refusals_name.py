"""Refusals that name the way, and the way they name: nodes without mass, ropes that are hauled in."""

from __future__ import annotations

import re

import pytest

import eomgen
from eomgen.errors import ModelError

NODE = """
eomgen = 1
space = "plane"
parameters = { m = 1, k1 = 100, k2 = 300, c = 7 }
coordinates = { n = START, x = 0.3 }
bodies.node.joint = { kind = "prismatic", axis = [1, 0], displacement = "n", HELD }
bodies.block.shape = { kind = "particle", mass = "m" }
bodies.block.joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
forces.s = { kind = "spring", points = ["node.origin", "block.origin"], stiffness = "k2", length = 0, along = [1, 0] }
"""
CRANE = """
eomgen = 1
space = "plane"
coordinates = { l = { motion = "2 - 0.3*t" }, phi = 0.2 }
points.O = [0, 0]
bodies.load.shape = { kind = "particle", mass = 1 }
bodies.load.joint = { kind = "placed", at = ["l*sin(phi)", "-l*cos(phi)"] }
constraints.rope = { kind = "link", points = ["O", "load.center"], length = "l" }
"""


@pytest.mark.parametrize(
    ("held", "roots"),
    [
        ('stiffness = "k1"', [1j * (300 / 4) ** 0.5, -1j * (300 / 4) ** 0.5]),
        ('damping = "c"', [0, *(-300 / 14 + s * ((300 / 14) ** 2 - 300) ** 0.5 for s in (1, -1))]),
    ],
)
def test_a_node_without_mass_follows_from_the_balance_that_is_told(held, roots):
    """k1 n = k2 (x - n), or c n' = k2 (x - n); m x'' = -k2 (x - n)"""
    text = NODE.replace("HELD", held)
    with pytest.raises(ModelError, match="moves no mass") as refused:
        eomgen.simulate(eomgen.loads(text.replace("START", "0")), time=1, target="numpy")
    told = re.search(r"\{ kind = .* \}", str(refused.value))
    way = text.replace("START", "{ dependent = true, start = 0 }") + f"constraints.balance = {told.group(0)}\n"
    values = eomgen.linearize(eomgen.loads(way)).modes.spectrum.eigenvalues
    assert sorted(values, key=lambda x: (x.real, x.imag)) == pytest.approx(
        sorted(map(complex, roots), key=lambda x: (x.real, x.imag)), abs=1e-9
    )


def test_a_rope_that_is_hauled_in_is_a_driven_joint():
    """the length of a link is no coordinate"""
    with pytest.raises(ModelError, match='driven joint: kind = "prismatic", displacement = "l"'):
        eomgen.loads(CRANE)
