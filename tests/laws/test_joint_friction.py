"""Dry friction in joints: it slips against the motion, sticks within its bound, and takes energy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import eomgen
from eomgen.errors import ModelError

G = 9.81
HINGE = """
eomgen = 1
space = "plane"
parameters = { m = 1, g = 9.81, l = 1, T_c = 1 }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
coordinates = { q = { start = 1 } }
outputs = { holds = "friction(rod)" }
[bodies.rod]
shape = { kind = "rod", mass = "m", length = "l" }
[bodies.rod.joint]
kind = "revolute"
angle = "q"
point = "start"
turned = { angle = "-pi/2" }
friction = { torque = "T_c" }
"""


def run(text: str, time: float, **options):
    return eomgen.simulate(eomgen.loads(text), time=time, target="numpy", rtol=1e-12, atol=1e-12, **options)


def senses(result, joint: str) -> list[int | None]:
    return [phase.model.configuration.modes[joint].sense for phase in result.phases]


def test_a_pendulum_with_friction_comes_to_rest_where_its_weight_no_longer_moves_it():
    """m l^2/3 q'' = -m g (l/2) sin q - T_c sign q'; it rests at m g (l/2) sin q < T_c (two programs, 5e-16 apart)."""
    result = run(HINGE, 3)
    assert [phase.end for phase in result.phases[:2]] == pytest.approx([0.86240531174, 1.69641458195], abs=1e-10)
    assert senses(result, "rod") == [-1, 1, 0]
    turned, rests = (phase.last["q"] for phase in result.phases[:2])
    assert turned == pytest.approx(-0.5447788352200158, abs=1e-11)
    assert rests == pytest.approx(0.1262319872529, abs=1e-11)
    assert result["holds"][0] == pytest.approx(1) and result["holds"][-1] == pytest.approx(G / 2 * math.sin(rests))
    assert result.certify().ok


def test_friction_takes_as_much_energy_as_the_way_times_its_torque():
    """E(0) - E(t) = T_c sum |dq|."""
    result = run(HINGE, 3)
    way = np.sum(np.abs(np.diff([1, *(phase.last["q"] for phase in result.phases)])))
    assert result["energy"][0] - result["energy"][-1] == pytest.approx(way, rel=1e-9)


def test_at_rest_it_is_what_holds():
    """q = 0.1, where m g (l/2) sin q < T_c."""
    result = run(HINGE.replace("start = 1 ", "start = 0.1 "), 1)
    assert senses(result, "rod") == [0]
    assert result["q"] == pytest.approx(np.full(len(result.t), 0.1))
    answers = eomgen.solve(eomgen.loads(HINGE.replace("start = 1 ", "start = 0.1 ")))
    assert float(answers["holds"].value) == pytest.approx(G / 2 * math.sin(0.1))


SLIDE = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 50, F = 4 }
coordinates = { x = { start = START } }
[bodies.block]
mass = "m"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k", friction = { force = "F" STATIC } }
"""


def test_a_block_on_a_spring_turns_nearer_by_twice_what_friction_holds():
    """Each half swing ends 2 F/k nearer, until k |x| <= F: 0.5, -0.34, 0.18, -0.02; a half swing takes pi sqrt(m/k)."""
    result = run(SLIDE.replace("START", "0.5").replace("STATIC", ""), 2.5)
    assert [phase.last["x"] for phase in result.phases] == pytest.approx([-0.34, 0.18, -0.02, -0.02], abs=1e-10)
    half = math.pi * math.sqrt(2 / 50)
    assert [phase.end for phase in result.phases[:3]] == pytest.approx([half, 2 * half, 3 * half], abs=1e-9)
    assert result.certify().ok


def test_static_friction_above_kinetic_holds_earlier():
    """With F_s = 10 the block already stays at -0.18 = 0.5 - 2 F/k ... where k |x| <= F_s."""
    result = run(SLIDE.replace("START", "0.5").replace("STATIC", ", static = 10"), 2.5)
    assert [phase.last["x"] for phase in result.phases] == pytest.approx([-0.34, 0.18, 0.18], abs=1e-10)
    assert senses(result, "block") == [-1, 1, 0]
    assert result.certify().ok


def test_a_driven_belt_lets_its_block_stick_and_slip():
    """A block on a spring, its slide carried by a belt at v: it sticks till k x = F_s, slips back, sticks again."""
    text = """
eomgen = 1
space = "plane"
parameters = { m = 1, k = 100, F = 2, F_s = 3, v = 0.1 }
coordinates = { b = { motion = "v*t" }, s = { start = 0 } }
forces.pull = { kind = "potential", energy = "k*(b + s)^2/2" }
[bodies.belt]
joint = { kind = "prismatic", axis = [1, 0], displacement = "b" }
[bodies.block]
mass = "m"
joint = { kind = "prismatic", on = "belt", axis = [1, 0], displacement = "s", friction = FRICTION }
"""
    result = run(text.replace("FRICTION", '{ force = "F", static = "F_s" }'), 1)
    stick, slip = result.phases[0], result.phases[1]
    assert stick.end == pytest.approx(0.03 / 0.1, rel=1e-9)

    def back(t, x):
        return [x[1], -100 * x[0] + 2]

    def together(t, x):
        return x[1] - 0.1

    together.terminal, together.direction = True, 1
    found = solve_ivp(back, (0, 1), [0.03, 0.1 - 1e-12], events=together, rtol=1e-12, atol=1e-13)
    assert slip.end - slip.start == pytest.approx(found.t[-1], abs=1e-7)
    assert senses(result, "block")[:3] == [0, -1, 0]


def test_smooth_friction_is_a_hyperbolic_tangent():
    """- T tanh(q'/v): at q' = v 76 % of T; the line in the equations shows v."""
    text = HINGE.replace('torque = "T_c"', 'torque = "T_c", smooth = "v"').replace("T_c = 1", "T_c = 1, v = 1e-4")
    equations = eomgen.derive(eomgen.loads(text))
    assert "T_c*tanh(q'/v)" in str(equations)
    result = run(text, 10, method="Radau")
    assert result["q"][-1] == pytest.approx(0.1256, abs=5e-5)
    assert len(result.phases) == 1


def test_friction_without_a_size_and_a_static_one_below_are_refused():
    with pytest.raises(ModelError, match="friction of the joint of 'rod' needs 'torque'"):
        eomgen.loads(HINGE.replace('{ torque = "T_c" }', "{ static = 1 }"))
    with pytest.raises(ModelError, match="'static' is 1, below 2"):
        eomgen.loads(HINGE.replace('{ torque = "T_c" }', "{ torque = 2, static = 1 }"))
    with pytest.raises(ModelError, match="smooth friction has no 'static'"):
        eomgen.loads(HINGE.replace('{ torque = "T_c" }', "{ torque = 2, static = 3, smooth = 1 }"))
