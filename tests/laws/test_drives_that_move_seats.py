"""What drives a coordinate that moves the seat of another body too, or a place at which a constraint holds."""

from __future__ import annotations

import pytest

import eomgen

SEAT = """
eomgen = 1
name = "a slide on the ground whose seat moves with what drives another"
space = "plane"

[parameters]
m = 2
[coordinates]
b = { motion = "0.5*t^2" }
q = 0

[bodies.base]
mass = "m"
joint = { kind = "prismatic", axis = [1, 0], displacement = "b" }

[bodies.tool]
shape = { kind = "disc", mass = "m", radius = 0.2 }
joint = { kind = "revolute", at = ["3*b", 1], angle = "q" }

[outputs]
D = "drive(b)"
"""
SEAT_AND_TABLE = """
eomgen = 1
name = "seats"
space = "space"
[parameters]
m = 2
[coordinates]
b = { motion = "0.5*t^2 + 0.3*t + 0.2" }
q = { start = 0.3, speed = 0.7 }
x = 0
y = { start = 0.04, speed = 0.12 }
[bodies.base]
mass = "m"
center = [0.1, 0.2, 0]
inertia = [1, 1.2, 1.3]
joint = { kind = "revolute", axis = [0, 0, 1], angle = "b" }
[bodies.tool]
mass = "m"
center = [0.1, 0.3, 0.2]
inertia = [1, 1.2, 1.3]
joint = { kind = "revolute", on = "base", at = ["3*b", 1, "b/2"], angle = "q", axis = [1, 0, 2] }
[bodies.puck]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", 0, "y"], angle = 0 }
[constraints.table]
kind = "equation"
gap = "z(puck.center) - b^2"
[forces.weight]
kind = "gravity"
acceleration = [0, 0, -9.81]
[outputs]
D = "drive(b)"
"""


def test_a_drive_moves_what_it_seats():
    """F = m b'' (1 + 3^2): the slide, and a disc whose seat goes three times as far."""
    found = eomgen.reactions(eomgen.loads(SEAT))
    assert found["drive(b)"].value == pytest.approx(20)


def test_code_and_answers_name_one_drive():
    """F_k of the freed equations of motion is what all reactions do on the bodies per change of b, constraints left
    out."""
    model = eomgen.loads(SEAT_AND_TABLE)
    equations = eomgen.derive(model)
    rhs, function = equations.rhs("numpy"), equations.reaction_rhs("numpy")
    found = dict(zip(function.names, function(0.0, rhs.x0, rhs.p0), strict=True))
    assert found["drive(b)"] == pytest.approx(eomgen.solve(model)["D"].value, rel=1e-10)
