"""Dry friction of a slide by the forces at both ends of its guide: force and couple over its length."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
import scipy.optimize

import eomgen
from eomgen.errors import ModelError

G = 9.81
DRAWER = """
eomgen = 1
space = "plane"
parameters = { m = 2, J = 0.1, L = 0.5, e = 0.1, b = 0, h = 0, W = 0, mu = 0.3, P = 20 }
coordinates = { x = { start = 0, speed = 1 } }
outputs = { F = "friction(drawer)" }
forces.pull = { kind = "force", point = "drawer.knob", force = ["P", 0] }
forces.weight = { kind = "force", point = "drawer.center", force = [0, "-W"] }
[bodies.drawer]
mass = "m"
inertia = "J"
center = ["b", "h"]
points.knob = [0, "-e"]
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", friction = { coefficient = "mu", length = "L" } }
"""


PLAIN = re.sub("center = .*\n|forces.weight.*\n", "", DRAWER.replace("b = 0, h = 0, W = 0, ", ""))


def drawer(text: str = DRAWER, **values: float) -> str:
    for name, value in values.items():
        text = re.sub(rf"(?<= {name} = )[\d.]+", str(value), text, count=1)
    return text


def friction_of_drawer(s: float, *, m=2.0, L=0.5, e=0.1, b=0.0, h=0.0, W=0.0, mu=0.3, P=20.0) -> float:
    """F against a motion of the sense s, by Newton and Euler about the mass centre (b, h): N = W,
    0 = M - b N + h (-s F) + (e + h) P, F = mu (|N/2 + M/L| + |N/2 - M/L|): the largest of four linear equations."""
    found = []
    for one, two in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        # F = mu (one (W/2 + M/L) + two (W/2 - M/L)), M = b W + h s F - (e + h) P
        k = mu * (one - two) / L
        found.append((mu * (one + two) * W / 2 + k * (b * W - (e + h) * P)) / (1 - k * h * s))
    return max(found)


@pytest.mark.parametrize("s", [1, -1])
@pytest.mark.parametrize(
    "values", [{}, {"W": 30.0, "b": 0.2}, {"W": 90.0}, {"h": 0.2, "W": 5.0}, {"P": -20.0, "h": -0.3}]
)
def test_a_drawer_rubs_at_both_ends_of_its_guide(values, s):
    """F = mu (|N/2 + M/L| + |N/2 - M/L|): 2 mu |M|/L where both ends press on opposite sides, mu |N| where on one."""
    model = eomgen.loads(drawer(**values).replace("speed = 1", f"speed = {s}"))
    assert float(eomgen.solve(model)["F"].value) == pytest.approx(-s * friction_of_drawer(s, **values), rel=1e-12)
    assert eomgen.derive(model).certify().ok


def test_a_drawer_that_is_pulled_at_an_offset_moves_on_or_jams():
    """m x'' = P (1 - 2 mu e/L); for 2 mu e/L > 1 it stops at v^2/(2 |x''|), and friction holds the whole pull."""
    moved = eomgen.simulate(eomgen.loads(DRAWER), time=1, target="numpy")
    assert moved["x"][-1] == pytest.approx(1 + 20 * (1 - 2 * 0.3 * 0.1 / 0.5) / 2 / 2, rel=1e-9)
    assert moved.certify().ok
    jams = eomgen.simulate(eomgen.loads(drawer(mu=3)), time=1, target="numpy")
    slows = 20 * (2 * 3 * 0.1 / 0.5 - 1) / 2
    assert jams.phases[0].end == pytest.approx(1 / slows) and jams["x"][-1] == pytest.approx(1 / (2 * slows))
    assert jams["F"][-1] == pytest.approx(-20) and jams.certify().ok


def test_statics_says_when_a_drawer_jams():
    """It stays at rest however hard it is pulled if 2 mu e/L >= 1: L/(2 e) <= mu."""
    for mu in (2.4, 2.6):
        found = eomgen.statics(eomgen.loads(drawer(PLAIN, mu=mu).replace(", speed = 1", "")))
        (rest,) = found.entries()["rest_range"]
        assert rest["condition"] == "L/(2*e) <= mu" and bool(found.broken) == (mu < 2.5)


def test_the_growth_of_its_friction_stands_in_the_derivation():
    """The mass centre beside the guide by h: D = 2 mu h/L, and from 1 on there is no single value."""
    text = eomgen.derive(eomgen.loads(drawer(h=0.2))).render()
    assert "F_drawer = -mu*(abs(1/2*N_drawer + M_drawer/L) + abs(1/2*N_drawer - M_drawer/L))*sign(x')" in text
    assert "D_drawer = 2*mu*h/L" in text
    run = eomgen.simulate(eomgen.loads(drawer(h=0.2, mu=1.5)), time=1, target="numpy")
    assert "grows by 1.2 of itself" in run.message


CARRIAGE = """
eomgen = 1
space = "space"
parameters = { m = 2, g = 9.81, L = 0.5, mu = 0.15, P = 3 }
coordinates = { x = { start = 0, speed = 1 } }
outputs = { F = "friction(carriage)" }
forces.weight = { kind = "gravity", acceleration = [0, 0, "-g"] }
forces.pull = { kind = "force", point = "carriage.knob", force = ["P*cos(0.3)", "P*sin(0.3)", 0] }
[bodies.carriage]
mass = "m"
inertia = [0.1, 0.2, 0.3]
center = [0.05, 0.1, -0.08]
points.knob = [0, -0.1, 0.06]
[bodies.carriage.joint]
kind = "prismatic"
axis = [1, 0, 0]
turned = { axis = [0, 0, 1], angle = 0.3 }
displacement = "x"
friction = { coefficient = "mu", length = "L" }
"""


@pytest.mark.parametrize(("s", "P"), [(1, 3.0), (-1, 40.0)])
def test_a_carriage_in_space_rubs_by_two_forces_across_its_way(s, P):
    """Along its own axes R = m a - P + F - W, M = c x m a - c x W - k x P, F = mu sum |R/2 +- M x n/L|."""
    c, k, n = np.array([0.05, 0.1, -0.08]), np.array([0, -0.1, 0.06]), np.array([1.0, 0, 0])
    W, pull = np.array([0, 0, -2 * G]), np.array([P, 0, 0])

    def wrong(F: float) -> float:
        inertia = n * (P - s * F)
        R, M = inertia - W - pull + s * F * n, np.cross(c, inertia) - np.cross(c, W) - np.cross(k, pull)
        return F - 0.15 * sum(np.linalg.norm(R / 2 + sign * np.cross(M, n) / 0.5) for sign in (1, -1))

    due = scipy.optimize.brentq(wrong, 0, 1000, xtol=1e-14, rtol=1e-15)
    model = eomgen.loads(CARRIAGE.replace("speed = 1", f"speed = {s}").replace("P = 3", f"P = {P}"))
    assert float(eomgen.solve(model)["F"].value) == pytest.approx(-s * due, rel=1e-11)
    if s == 1:
        run = eomgen.simulate(model, time=2, target="numpy")
        assert run["x"][-1] == pytest.approx(2 + (P - due) if P > due else 1 / (due - P), rel=1e-9)
        assert run.certify().ok


def test_without_a_length_couples_do_not_count_and_a_length_needs_a_coefficient():
    text = DRAWER.replace(', length = "L"', "")
    assert float(eomgen.solve(eomgen.loads(text))["F"].value) == 0
    with pytest.raises(ModelError, match="friction of the joint of 'drawer' has a 'length' and no 'coefficient'"):
        eomgen.loads(DRAWER.replace('coefficient = "mu"', "force = 3"))


def test_a_friction_formula_of_a_guide_is_judged():
    model = eomgen.loads(PLAIN)
    assert eomgen.verify(model, "m*x'' = P - 2*mu*e*P/L")
    assert not eomgen.verify(model, "m*x'' = P - mu*e*P/L")
    assert eomgen.verify(model, "friction(drawer) = -2*mu*abs(reaction_couple(drawer))/L")


def test_an_impact_that_turns_a_guide_is_refused():
    """A stop along the way of a mass centre beside it: the joint takes an impulsive couple."""
    stop = drawer(h=0.1).replace("friction =", 'limits = ["-inf", 0.5], restitution = 0.5, friction =')
    assert "an impulse there would rub too" in eomgen.simulate(eomgen.loads(stop), time=1, target="numpy").message
    stop = DRAWER.replace("friction =", 'limits = ["-inf", 0.5], restitution = 0.5, friction =')
    assert eomgen.simulate(eomgen.loads(stop), time=0.4, target="numpy").impacts


@pytest.mark.slow
def test_a_guide_sticks_and_slips_in_compiled_phases_as_in_the_interpreted_ones():
    """The same instants and places, in C and in numpy."""
    text = drawer(h=0.1, W=40, P=0).replace('displacement = "x"', 'displacement = "x", stiffness = 200')
    model = eomgen.loads(text.replace("speed = 1", "speed = 3"))
    one, two = (eomgen.simulate(model, time=3, target=way, rtol=1e-11, atol=1e-11) for way in ("c", "numpy"))
    assert len(one.phases) == len(two.phases) > 3 and math.isfinite(one["x"][-1])
    assert [p.end for p in one.phases] == pytest.approx([p.end for p in two.phases], abs=1e-8)
    assert one["x"][-1] == pytest.approx(two["x"][-1], abs=1e-9)
