"""Exact places of coordinates that several ties fix together: proven by substitution, never by their numbers alone."""

from __future__ import annotations

from math import pi

import pytest

import eomgen
from eomgen.mechanics.proven import proven_places
from eomgen.mechanics.system import system_of
from eomgen.symbolic.text import to_text

LOOP = """
eomgen = 1
space = "plane"
[parameters]
l = 0.7
[coordinates]
theta = 0
phi = { dependent = true, near = 0.1 }
psi = { dependent = true, near = 0 }
[bodies.OA]
shape = { kind = "rod", mass = 1, length = "2*l" }
joint = { kind = "revolute", angle = "theta" }
[bodies.CB]
shape = { kind = "rod", mass = 1, length = "2*l*LONGER" }
joint = { kind = "revolute", at = ["3*l", 0], angle = "phi" }
[bodies.AB]
shape = { kind = "rod", mass = 1, length = "3*l" }
joint = { kind = "revolute", on = "OA.end", angle = "psi - theta" }
[constraints.B]
kind = "pin"
points = ["AB.end", "CB.end"]
"""


def places(theta: float, phi: float, psi: float, longer: str = "1") -> dict[str, str]:
    """What is proven of phi and psi where they stand at these numbers, theta known."""
    system = system_of(eomgen.loads(LOOP.replace("LONGER", longer)))
    numbers = dict(zip(system.symbols.q, (theta, phi, psi), strict=True))
    exact = {system.symbols.q[0]: round(theta / pi * 12) * system.scope.graph.pi / 12}
    return {q.name: to_text(x) for q, x in proven_places(system, exact, numbers).items()}


@pytest.mark.parametrize(("theta", "text"), [(0.0, "0"), (pi / 2, "pi/2"), (-pi / 6, "-pi/6")])
def test_a_parallelogram_stays_one(theta, text):
    """phi = theta, psi = 0 closes the loop whatever l is."""
    assert places(theta, theta, 0.0) == {"phi": text, "psi": "0"}


def test_a_number_near_a_place_is_no_proof():
    """A crank longer by 1e-10 puts phi within 1e-9 of pi/2, where the loop does not close."""
    assert places(pi / 2, pi / 2 + 1e-10, 0.0, "(1 + 1e-10)") == {}


def test_a_place_without_a_closed_form_is_left_out():
    """The crossed branch of the loop at theta = pi/2 is no multiple of 15 degrees."""
    assert places(pi / 2, -0.9, 1.1) == {}
