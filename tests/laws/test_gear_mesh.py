"""Gear wheels whose teeth yield, with play and losses: against closed forms of a hoist and of two inertias."""

from __future__ import annotations

import math

import numpy as np
import pytest

import eomgen
from eomgen.errors import DerivationError, ModelError

pytestmark = pytest.mark.slow

HOIST = """
eomgen = 1
space = "plane"
parameters = { J = 0.05, m = 60, r = 0.1, i = 5, k = 900, c = 40, b = 0.02, eta = 0.8, g = 9.81 }
coordinates = { alpha = { motion = "W*t" }, beta = { start = 0, speed = "W/i" } }
bodies.pinion = { mass = 0, inertia = "J", joint = { kind = "revolute", angle = "alpha" } }
bodies.drum = { mass = 0, inertia = "2*m*r^2", joint = { kind = "revolute", at = [1, 0], angle = "-beta" } }
forces.weight = { kind = "couple", body = "drum", couple = "m*g*r" }
[forces.teeth]
kind = "gear_mesh"
bodies = ["pinion", "drum"]
ratio = "-i"
stiffness = "k"
damping = "c"
backlash = "b"
efficiency = "eta"
"""


def end_of(text: str, time: float, *names: str) -> list[float]:
    run = eomgen.simulate(eomgen.loads(text), time=time, target="numpy", rtol=1e-11, atol=1e-11)
    assert run.ok
    return [float(run[name][-1]) for name in names]


@pytest.mark.parametrize(("W", "share"), [(3, 1 / 0.8), (-3, 0.8)])
def test_a_hoist_takes_more_to_raise_and_gives_less_in_lowering(W, share):
    """M = m g r/(i eta) up, M = m g r eta/i down, once the teeth are at rest against one another."""
    text = HOIST.replace("W", str(W)) + "[outputs]\nM = 'drive(alpha)'\nx = \"alpha - i*beta\"\n"
    M, x = end_of(text, 6, "M", "x")
    due = 60 * 9.81 * 0.1 / 5
    assert M == pytest.approx(due * share, rel=1e-6)
    tooth = due / 0.8 if W > 0 else due
    assert x == pytest.approx(0.01 + tooth / 900, rel=1e-6)


IDLE = HOIST.replace("W", "0.5").replace("g = 9.81", "g = 0").replace('speed = "0.5/i"', "speed = 0")


def test_the_drum_stands_until_the_play_is_taken_up():
    """alpha = b/2 at t = 0.02: nothing moves before; after that it follows."""
    assert end_of(IDLE, 0.0199, "beta")[0] == 0
    assert end_of(IDLE, 3, "beta'")[0] == pytest.approx(0.1, rel=1e-3)


TWO = """
eomgen = 1
space = "plane"
coordinates = { a = { start = 0, speed = 2 }, d = { start = 0, speed = 0 } }
bodies.one = { mass = 0, inertia = 0.2, joint = { kind = "revolute", angle = "a" } }
bodies.two = { mass = 0, inertia = 3, joint = { kind = "revolute", at = [1, 0], angle = "d" } }
forces.mesh = { kind = "gear_mesh", bodies = ["one", "two"], ratio = -4, stiffness = 70 }
"""


def test_two_wheels_on_soft_teeth_swing_against_one_another():
    """sqrt(k (1/J_1 + ratio^2/J_2)); with play the energy stays, and 4 J_1 a' - J_2 d' does."""
    A = eomgen.linearize(eomgen.loads(TWO)).A
    assert np.max(np.abs(np.linalg.eigvals(A))) == pytest.approx(math.sqrt(70 * (5 + 16 / 3)), rel=1e-9)
    played = TWO.replace("stiffness = 70", "stiffness = 70, backlash = 0.1")
    run = eomgen.simulate(eomgen.loads(played), time=2, target="numpy", rtol=1e-11, atol=1e-11)
    assert run.ok and np.ptp(run["energy"]) < 1e-8
    assert 4 * 0.2 * run["a'"] - 3 * run["d'"] == pytest.approx(4 * 0.2 * 2, rel=1e-8)
    assert eomgen.derive(eomgen.loads(played)).certify().ok


def test_the_efficiency_is_the_share_of_the_power_that_arrives():
    """ratio M omega_2 eta = what the drum gets of M omega_1, both ways; smooth where it says so."""
    for W, name in ((3, "up"), (-3, "down")):
        text = HOIST.replace("W", str(W)) + "[outputs]\nP = 'drive(alpha)*alpha\\''\nQ = \"m*g*r*beta'\"\n".replace(
            "'drive(alpha)*alpha\\''", '"drive(alpha)*alpha\'"'
        )
        P, Q = end_of(text, 6, "P", "Q")
        assert (Q / P if name == "up" else P / Q) == pytest.approx(0.8, rel=1e-6)
    smooth = HOIST.replace("W", "3").replace('efficiency = "eta"', 'efficiency = "eta"\nsmooth = 0.1')
    assert eomgen.derive(eomgen.loads(smooth)).certify().ok


def test_what_no_gear_can_do_is_refused_by_name():
    whole = HOIST.replace("W", "3")
    with pytest.raises(ModelError, match="the efficiency of 'teeth' is"):
        eomgen.loads(whole.replace('efficiency = "eta"', "efficiency = 1.2").replace("eta = 0.8", "q = 1"))
    with pytest.raises(ModelError, match="no efficiency that 'smooth' could smooth"):
        eomgen.loads(TWO.replace("stiffness = 70", "stiffness = 70, smooth = 1"))
    with pytest.raises(DerivationError, match="turn in one plane"):
        text = TWO.replace('"plane"', '"space"').replace("at = [1, 0]", "at = [1, 0, 0]")
        text = text.replace("inertia = 0.2", "inertia = [1, 1, 0.2]").replace("inertia = 3", "inertia = [1, 1, 3]")
        eomgen.derive(eomgen.loads(text))
