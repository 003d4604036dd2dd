"""Rest where time stands in the model: surfaces and seats as they are at t = 0, declared speeds that are not 0."""

from __future__ import annotations

import math

import pytest

import eomgen
from eomgen.errors import DerivationError

SEA = """
eomgen = 1
space = "plane"
parameters = { m = 1, A = 0.2, k = 2, w = 4, g = 9.81 }
coordinates = { x = 0.5, z = { near = 0 } }
bodies.p.shape = { kind = "particle", mass = "m" }
bodies.p.joint = { kind = "planar", x = "x", y = "z", angle = 0 }
constraints.sea = { kind = "equation", gap = "y(p.center) - A*sin(k*x(p.center) - w*t)" }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
outputs.x0 = { value = "x", at = "equilibrium" }
"""
SPEED = """
eomgen = 1
space = "plane"
coordinates = { x = 0.3, y = 0.1 }
speeds = { U = "x' + 0.2*t + 0.7 + 0.1*y", W = "y' - x" }
bodies.a.shape = { kind = "particle", mass = 1 }
bodies.a.joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = 30, rest = 0.5, force = "-2*U" }
bodies.s.joint = { kind = "placed", at = [0, "SEAT"] }
bodies.b.shape = { kind = "particle", mass = 1 }
bodies.b.joint = { kind = "prismatic", on = "s", axis = [0, 1], displacement = "y", stiffness = 30 }
[outputs]
xe = { value = "x", at = "equilibrium" }
Ue = { value = "U", at = "equilibrium" }
"""
SKATE = """
eomgen = 1
space = "space"
coordinates = { theta = 0, phi = 0 }
bodies.a.joint = { kind = "revolute", angle = "theta", axis = [1, 0, 0], torque = 0.3 }
bodies.b.points = { P = [0.3, 0.1, 0.05] }
bodies.b.joint = { kind = "revolute", on = "a", angle = "phi", stiffness = 30 }
constraints.T = { kind = "skate", point = "b.P", along = [1, 0.5, 0] }
"""
OPEN = """
eomgen = 1
space = "plane"
parameters = { k = {} }
coordinates = { x = { start = 0, speed = 0 }, phi = { speed = 0.3 } }
bodies.a.joint = { kind = "planar", x = 0.3, y = "x", angle = "phi" }
bodies.a.points = { P = [0.3, 0.1] }
constraints.T = { kind = "support", point = "a.P", normal = [-1, 2] }
"""


@pytest.mark.slow
def test_a_moving_surface_stands_as_it_is_at_the_start():
    """V = m g A sin(k x) at t = 0: rest at k x = pi/2 + n pi"""
    model = eomgen.loads(SEA)
    found = eomgen.statics(model)
    assert found.certify().ok
    for place in found.places:
        (x,) = (value for q, value in place.numbers.items() if q.name == "x")
        assert math.cos(2 * x) == pytest.approx(0, abs=1e-9)
    assert float(eomgen.solve(model)["x0"].value) == pytest.approx(math.pi / 4)


@pytest.mark.parametrize("seat", ["0", "0.4*cos(3*t)"])
def test_at_rest_the_rates_vanish_and_declared_speeds_need_not(seat):
    """U = x' + 0.7 + 0.1 y, x' = 0:  U = 0.7;  30 (x - 1/2) + 2 U = 0"""
    model = eomgen.loads(SPEED.replace("SEAT", seat))
    solved = eomgen.solve(model)
    assert float(solved["Ue"].value) == pytest.approx(0.7)
    assert float(solved["xe"].value) == pytest.approx(0.5 - 1.4 / 30)
    assert eomgen.statics(model).certify().ok


def test_small_motions_beside_rest_are_those_of_the_rates():
    """x'' + 2 x' + 30 x + 0.2 y = 0, y'' + 30 y = 0:  s = -1 +- i sqrt(29), +- i sqrt(30)"""
    found = eomgen.linearize(eomgen.loads(SPEED.replace("SEAT", "0").replace("0.2*t + ", "")))
    assert sorted(x.imag for x in found.modes.spectrum.eigenvalues if x.imag > 0) == pytest.approx([29**0.5, 30**0.5])
    assert found.certify().ok
    with pytest.raises(DerivationError, match="explicit time accelerates"):
        eomgen.linearize(eomgen.loads(SPEED.replace("SEAT", "0.4*cos(3*t)")))


def test_multipliers_are_proven_where_what_may_be_chosen_stands():
    """Q + J^T lam = 0 at theta = 0.4, which no force holds"""
    found = eomgen.statics(eomgen.loads(SKATE), start={"theta": 0.4})
    checks = {check.name: check.status for check in found.certify().checks}
    assert checks["the multipliers at every equilibrium hold the free bodies"] == "holds"


def test_velocities_are_put_together_where_a_parameter_without_a_value_does_not_matter():
    """n . v_P = 0, v_P = (-y_P, x_P - 3/10) omega + (0, x') nearest to what was given: omega = 0.15, x' = -0.0525"""
    found = eomgen.kinematics(eomgen.loads(OPEN))
    assert found.certify().ok
    assert eomgen.kinematics(eomgen.loads(OPEN.replace("k = {}", "k = 1"))).certify().ok


BARS = """
eomgen = 1
space = "plane"
parameters = { m = 1, l = 1 }
coordinates = { a = 0.2, b = 0.5 }
bodies.r.shape = { kind = "rod", mass = "m", length = "l" }
bodies.r.joint = { kind = "revolute", angle = "a", stiffness = 4 }
bodies.s.shape = { kind = "rod", mass = "m", length = "l" }
bodies.s.joint = { kind = "revolute", on = "r.end", angle = "b" }
"""


@pytest.mark.parametrize(("b", "exact"), [(0.5, True), (0.023907852651880116, False)])
def test_a_start_with_all_the_digits_of_a_double_stands_in_no_formula(b, exact):
    """M_aa = m l^2 (5/3 + cos b): cos(1/2) is a formula, cos(5976963162970029/250000000000000000) is a number"""
    found = eomgen.linearize(eomgen.loads(BARS), start={"b": b})
    assert ("cos(" in str(found)) == exact and "5976963162970029" not in str(found)
    assert float(found.modes.small.numbers.M[0][0]) == pytest.approx(5 / 3 + math.cos(b))


SHAKEN = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 50, c = 3, B = 0.1, w = 4, l0 = 0.5 }
coordinates = { x = { start = 0.4 }, y = { start = 0.3 } }

[bodies.mass]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }

[bodies.wagon]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", at = ["B*sin(w*t)", 1], axis = [1, 0], displacement = "y" }

[points]
O = [0, 0]
P = [0, 1]

[forces.spring]
kind = "spring"
points = ["O", "mass.origin"]
stiffness = "k"
length = "l0"

[forces.second]
kind = "spring"
points = ["P", "wagon.origin"]
stiffness = "k"
length = "l0"

[forces.damper]
kind = "damper"
points = ["mass.origin", "wagon.origin"]
damping = "c"
"""


BESIDE = """
[bodies.slave]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", at = [0, 2], axis = [1, 0], displacement = "z" }

[constraints.gear]
kind = "equation"
gap = "z - 2*x"
"""


@pytest.mark.parametrize("beside", ["", BESIDE])
def test_a_damper_at_a_seat_that_moves_by_an_explicit_time_does_not_pull_at_rest(beside):
    """The seat stands where it is at t = 0: both springs have their own length, beside a dependent coordinate too."""
    more = ", z = { dependent = true, start = 0.8 } }" if beside else " }"
    text = SHAKEN.replace("y = { start = 0.3 } }", f"y = {{ start = 0.3 }}{more}") + beside
    found = eomgen.statics(eomgen.loads(text))
    places = [{q.name: x for q, x in place.numbers.items()} for place in found.places]
    assert any(place["x"] == pytest.approx(0.5) and place["y"] == pytest.approx(0.5) for place in places)
    assert found.certify().ok
