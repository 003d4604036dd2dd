"""Reactions as code where a body stands straight, a base is not turned, a loop lies along an axis."""

from __future__ import annotations

import numpy as np
import pytest

import eomgen
from eomgen.mechanics.free_bodies.names_of_reactions import NamedReaction
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

BICYCLE = """
[parameters]
g = 9.81
[coordinates]
x = { speed = 2 }
y = 0
z = -0.3
psi = 0
phi = 0
theta = 0
front = { speed = -5 }
rear = { speed = -5 }
delta = 0
[bodies.frame]
mass = 20
center = [0.5, 0, -0.4]
inertia = [1, 2, 1.5, 0, 0, 0.1]
joint = { kind = "free", position = ["x", "y", "z"], orientation = "zxy", angles = ["psi", "phi", "theta"] }
[bodies.rear_wheel]
mass = 2
inertia = [0.1, 0.2, 0.1]
joint = { kind = "revolute", on = "frame", axis = [0, 1, 0], angle = "rear" }
[bodies.fork]
mass = 1
center = [0, 0, -0.2]
inertia = [0.1, 0.1, 0.05]
joint = { kind = "revolute", on = "frame", at = [1, 0, 0], axis = [0.3, 0, 1], angle = "delta" }
[bodies.front_wheel]
mass = 2
inertia = [0.1, 0.2, 0.1]
joint = { kind = "revolute", on = "fork", axis = [0, 1, 0], angle = "front" }
[constraints.at_rear]
kind = "rolling"
body = "rear_wheel"
radius = 0.3
axis = [0, 1, 0]
plane = { at = [0, 0, 0], normal = [0, 0, -1] }
[constraints.at_front]
kind = "rolling"
body = "front_wheel"
radius = 0.3
axis = [0, 1, 0]
plane = { at = [0, 0, 0], normal = [0, 0, -1] }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "g"]
"""
SLIDER_ON_A_TURNING_BASE = """
[parameters]
m = 1.2
w = 1.5
[coordinates]
b = { motion = "sin(w*t)" }
cr = { start = 0.7, speed = -0.3 }
ro = { dependent = true, near = -0.2 }
pi1 = { dependent = true, near = 1.3 }
[bodies.base]
mass = "m"
center = [0.3, 0.1, -0.1]
inertia = [1, 1.2, 1.1]
joint = { kind = "revolute", angle = "b", axis = [1, 0, 0] }
[bodies.crank]
mass = "m"
center = [0.2, 0, 0]
inertia = [0.1, 0.8, 0.8]
points = { end = [0.4, 0, 0] }
joint = { kind = "revolute", on = "base", angle = "cr", turned = UPRIGHT }
[bodies.rod]
mass = "m"
center = [0.5, 0, 0]
inertia = [0.1, 0.8, 0.8]
points = { end = [1.1, 0, 0] }
joint = { kind = "revolute", on = "crank.end", angle = "ro - cr" }
[bodies.piston]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", on = "base", axis = [1, 0, 0], displacement = "pi1" }
[constraints.wrist]
kind = "pin"
points = ["rod.end", "piston.center"]
[forces.weight]
kind = "gravity"
acceleration = [0, 0, -9.81]
"""
FOUR_BAR_ON_A_DRIVEN_BASE = """
[parameters]
m = 1.1
[coordinates]
b = { motion = "t^2/2 + t/3" }
al = { start = 1.1, speed = -0.8 }
be = { dependent = true, near = 0.53 }
ga = { dependent = true, near = 1.68 }
[bodies.base]
mass = "m"
center = [0.2, 0.1, -0.1]
inertia = [1.3, 1.5, 1.2, 0.1, -0.1, 0.05]
joint = { kind = "revolute", at = [0.1, 0.2, 0], angle = "b", axis = [1, 2, 2] }
[bodies.crank]
mass = "m"
center = [0.2, 0, 0]
inertia = [0.2, 1, 1]
points = { end = [0.4, 0, 0] }
joint = { kind = "revolute", on = "base", at = [0.2, 0.1, 0], angle = "al", turned = UPRIGHT }
[bodies.coupler]
mass = "m"
center = [0.5, 0, 0]
inertia = [0.2, 1, 1]
points = { end = [1.1, 0, 0] }
joint = { kind = "revolute", on = "crank.end", angle = "be - al" }
[bodies.rocker]
mass = "m"
center = [0.4, 0, 0]
inertia = [0.2, 1, 1]
points = { end = [0.9, 0, 0] }
joint = { kind = "revolute", on = "base", at = [1.4, 0.1, 0], angle = "ga", turned = UPRIGHT }
[constraints.B]
kind = "pin"
points = ["coupler.end", "rocker.end"]
[forces.weight]
kind = "gravity"
acceleration = [0, 0, -9.81]
"""
UPRIGHT = '{ axis = [1, 0, 0], angle = "pi/2" }'


@pytest.mark.parametrize("text", [BICYCLE, SLIDER_ON_A_TURNING_BASE, FOUR_BAR_ON_A_DRIVEN_BASE])
def test_reactions_as_code_are_those_of_the_balance_where_its_coefficients_vanish(text):
    """A rho = b of all bodies has one K rho of each K that A determines at the state: code gives it, and never 0/0."""
    equations = eomgen.derive(
        eomgen.loads(f'eomgen = 1\nname = "straight"\nspace = "space"\n{text.replace("UPRIGHT", UPRIGHT)}')
    )
    rhs, function = equations.rhs("numpy"), equations.reaction_rhs("numpy")
    found = dict(zip(function.names, function(0.0, rhs.x0, rhs.p0), strict=True))
    symbols, balance = equations.graph.symbols, equations.reactions.balance
    du = rhs(0.0, rhs.x0, rhs.p0)[len(symbols.q) :]
    places = (symbols.t, *symbols.x, *symbols.a, *symbols.parameters.values())
    state = dict(zip(places, (0.0, *rhs.x0, *du, *rhs.p0), strict=True))
    A = np.zeros((len(balance.equations), len(balance.components)))
    for row, equation in zip(A, balance.equations, strict=True):
        row[list(equation.coefficients)] = evaluate(tuple(equation.coefficients.values()), state, FLOAT)
    b = np.array(evaluate(tuple(e.needed for e in balance.equations), state, FLOAT), dtype=float)
    rho = np.linalg.lstsq(A, b, rcond=1e-10)[0]
    assert pytest.approx(b, abs=1e-9) == A @ rho
    for named in NamedReaction.all_of(balance):
        K = np.zeros(len(rho))
        K[list(named.combination)] = evaluate(tuple(named.combination.values()), state, FLOAT)
        if named.name in found:
            assert found[named.name] == pytest.approx(K @ rho + evaluate((named.given,), state, FLOAT)[0], abs=1e-9)
    assert len(found) >= 6
