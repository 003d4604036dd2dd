"""Rest with constraints of velocities that have a constant part: integrators, lags, belts that run."""

from __future__ import annotations

import math

import numpy as np
import pytest

import eomgen
from eomgen.errors import DerivationError

LAG = """
eomgen = 1
space = "plane"
parameters = { m = 1 }
coordinates = { x = 0.3, z = { start = 0, dependent = true } }
bodies.b.shape = { kind = "particle", mass = "m" }
bodies.b.joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "-4*x" }
constraints.lag = { kind = "equation", rate = "z' - (x - z)/2 - 1" }
outputs.z0 = { value = "z", at = "equilibrium" }
"""
ARM = """
eomgen = 1
space = "plane"
parameters = { m = 1, l = 1, g = 9.81, kp = 40, ki = 30, kd = 8, ref = 0.7 }
coordinates = { q = 0, z = { start = 0, FREE } }
bodies.arm.shape = { kind = "rod", mass = "m", length = "l" }
bodies.arm.joint = { kind = "revolute", angle = "q", torque = "kp*(ref - q) + ki*z - kd*q'" }
constraints.integrator = { kind = "equation", rate = "z' - (ref - q)" }
forces.w = { kind = "gravity", acceleration = [0, "-g"] }
[outputs]
qe = { value = "q", at = "equilibrium" }
ze = { value = "z", at = "equilibrium" }
F = { value = "reaction_y(arm)", at = "equilibrium" }
"""
DOUBLE = """
eomgen = 1
space = "plane"
parameters = { m = 2, a = 0.4, k1 = 3, k2 = 0.5, d = 5 }
coordinates = { x = 0.1, z = { start = 0, dependent = true }, w = { start = 0, dependent = true } }
bodies.b.shape = { kind = "particle", mass = "m" }
bodies.b.joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "7 + k1*z + k2*w - d*x'" }
constraints.first = { kind = "equation", rate = "z' - (a - x)" }
constraints.second = { kind = "equation", rate = "w' - z + 2*z'" }
"""
BELT = """
eomgen = 1
space = "plane"
parameters = { m = 2, r = 0.3, v = 0.8 }
coordinates = { x = 0.1, phi = 0 }
bodies.disc.shape = { kind = "disc", mass = "m", radius = "r" }
bodies.disc.joint = { kind = "planar", x = "x", y = "r", angle = "phi" }
forces.s = { kind = "generalized", coordinate = "x", value = "-40*x - 1.5*x'" }
constraints.belt = { kind = "equation", rate = "x' + r*phi' - v" }
"""


def places(model):
    return [{node.name: place.numbers[node] for node in place.statics.system.symbols.q} for place in rest(model)]


def rest(model):
    return eomgen.statics(model).places


def eigenvalues(model):
    return np.sort_complex(np.linalg.eigvals(np.array(eomgen.linearize(model).state_space().A, dtype=float)))


def test_at_rest_a_whole_velocity_row_vanishes():
    """z' = (x - z)/2 + 1 = 0 with x = 0 gives z = 2, in statics as in solve"""
    model = eomgen.loads(LAG)
    assert places(model) == [{"x": 0.0, "z": 2.0}]
    assert float(eomgen.solve(model)["z0"].value) == 2
    assert eomgen.statics(model).certify().ok


@pytest.mark.parametrize("free", ["dependent = true", "speed = 0"])
def test_an_integrator_rests_where_its_error_vanishes(free):
    """q = ref,  ki z = m g l cos(ref)/2;  m l^2/3 s^3 + kd s^2 + (kp - m g l sin(ref)/2) s + ki = 0"""
    model = eomgen.loads(ARM.replace("FREE", free))
    (place,) = places(model)
    assert place["q"] == pytest.approx(0.7) and place["z"] == pytest.approx(9.81 * math.cos(0.7) / 60)
    solved = eomgen.solve(model)
    assert [float(solved[n].value) for n in ("qe", "ze", "F")] == pytest.approx([0.7, place["z"], 9.81])
    cubic = np.roots([1 / 3, 8, 40 - 9.81 * math.sin(0.7) / 2, 30])
    assert eigenvalues(model) == pytest.approx(np.sort_complex(cubic))
    assert [x.real for x in eigenvalues(model)] == pytest.approx([-18.199, -4.763, -1.038], abs=1e-3)
    assert eomgen.linearize(model).certify().ok


def test_an_integrator_carries_no_reaction():
    """lam = 0 of z' = r - q, where z moves no body:  F_y = m y_C'' + m g at q = 0, q'' = 3 (kp r - m g l/2)"""
    found = eomgen.reactions(eomgen.loads(ARM.replace("FREE", "dependent = true")))["reaction_y(arm)"]
    assert float(found.value) == pytest.approx(9.81 + 3 * (40 * 0.7 - 9.81 / 2) / 2)


def test_integrators_behind_one_another_rest_together():
    """x = a, z = 0, 7 + k2 w = 0;  m s^4 + d s^3 + (k1 - 2 k2) s + k2 = 0 of z = (a - x)/s, w = (1 - 2 s) z/s"""
    model = eomgen.loads(DOUBLE)
    (place,) = places(model)
    assert place == pytest.approx({"x": 0.4, "z": 0, "w": -14})
    expected = np.roots([2, 5, 0, 3 - 2 * 0.5, 0.5])
    assert eigenvalues(model) == pytest.approx(np.sort_complex(expected))


def test_stability_beside_integrators_is_not_told_by_the_potential_energy():
    """kd (kp - ...) < ki m l^2/3: it grows, though V has a minimum there"""
    model = eomgen.loads(ARM.replace("FREE", "dependent = true").replace("ki = 30", "ki = 3000"))
    assert eigenvalues(model).real.max() > 0
    (place,) = rest(model)
    assert place.stability.kind == "undecided"


def test_nothing_rests_on_a_belt_that_runs():
    """x' + r phi' = v is no rest for any place; the steady motion is x = 0, phi' = v/r"""
    model = eomgen.loads(BELT)
    with pytest.raises(DerivationError, match="'belt' demands a velocity at every place"):
        eomgen.statics(model)
    assert eomgen.linearize(model, about="steady").certify().ok
