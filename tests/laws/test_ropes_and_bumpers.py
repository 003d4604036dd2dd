"""Elastic ropes, which only pull, over pulleys and drums; bumpers, which only push: against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import eomgen
from eomgen.errors import DerivationError, ModelError

pytestmark = pytest.mark.slow

HEAD = 'eomgen = 1\nspace = "plane"\n'
WEIGHT = 'forces.weight = { kind = "gravity", acceleration = [0, -9.81] }\n'
FALLING = """
coordinates.y = { start = -0.5 }
points.O = [0, 0]
[bodies.ball]
mass = 2
joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
[forces.cord]
kind = "rope"
path = ["O", "ball.origin"]
stiffness = 300
length = 1.5
"""


def run_of(text: str, time: float) -> object:
    run = eomgen.simulate(eomgen.loads(text), time=time, target="numpy", rtol=1e-11, atol=1e-11, samples=2001)
    assert run.ok
    return run


def test_a_jumper_falls_until_the_cord_has_taken_his_energy():
    """m g (h + s) = k s^2/2, h the way on which the cord is slack; T = k s there; energy comes back."""
    run = run_of(HEAD + WEIGHT + FALLING, 2.2)
    h, mg, k = 1.0, 2 * 9.81, 300
    s = (mg + math.sqrt(mg**2 + 2 * k * mg * h)) / k
    assert -np.min(run["y"]) == pytest.approx(1.5 + s, abs=1e-5)
    assert np.ptp(run["energy"]) == pytest.approx(0, abs=1e-7)
    found = eomgen.derive(eomgen.loads(HEAD + WEIGHT + FALLING))
    assert found.certify().ok


def test_a_slack_cord_with_damping_pulls_and_brakes_nothing():
    """Free fall while it is slack, and while it is stretched but closes faster than it pulls."""
    damped = HEAD + WEIGHT + FALLING.replace("length = 1.5", "length = 1.5\ndamping = 60")
    assert run_of(damped, 0.4)["y"][-1] == pytest.approx(-0.5 - 9.81 * 0.16 / 2, rel=1e-10)
    model = eomgen.loads(damped.replace("start = -0.5", "start = -1.6, speed = 9") + "[outputs]\nT = 'pull(cord)'\n")
    assert float(eomgen.solve(model)["T"].value) == 0


TOUCHING = """
coordinates.x = { start = 1, speed = SPEED }
points.O = [0, 0]
[bodies.ball]
mass = 2
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[forces.F]
kind = "KIND"
stiffness = 300
damping = 60
length = LENGTH
[outputs]
a = "x''"
"""


@pytest.mark.parametrize(
    ("kind", "way", "speed", "length"),
    [("rope", "path", 0.8, "1"), ("rope", "path", 0.8, '"start"'), ("bumper", "points", -0.8, "1")],
)
def test_what_only_touches_does_nothing(kind, way, speed, length):
    """Stretch or compression 0: neither above 0 nor half of it, at whatever speed, also where the motion starts so."""
    text = TOUCHING.replace("SPEED", str(speed)).replace("KIND", kind).replace("LENGTH", length)
    model = eomgen.loads(HEAD + text.replace("[outputs]", f'{way} = ["O", "ball.origin"]\n[outputs]'))
    assert float(eomgen.solve(model)["a"].value) == 0


HOIST = (
    HEAD
    + WEIGHT
    + """
parameters = { m = 40, J = 3, r = 0.25, k = 9000, M = 0 }
coordinates = { phi = 0, y = -2 }
bodies.drum = { mass = 0, inertia = "J", joint = { kind = "revolute", angle = "phi", torque = "M" } }
bodies.load = { mass = "m", joint = { kind = "placed", at = [2, "y"] } }
[forces.rope]
kind = "rope"
path = [{ body = "drum", radius = "r", turn = "cw" }, { at = ["2 - r", 0], radius = "r", turn = "cw", slip = true },
    "load.origin"]
stiffness = "k"
length = "4 - r"
"""
)


def test_a_drum_winds_the_rope_and_the_load_hangs_at_its_weight_over_k():
    """Held by M = m g r: T = m g, the stretch m g/k; the one frequency is sqrt(k (1/m + r^2/J))."""
    held = HOIST.replace("M = 0", 'M = "9.81*m*r"').replace("y = -2 }", "y = -2.0436 }")
    A = eomgen.linearize(eomgen.loads(held)).A
    assert np.max(np.abs(np.linalg.eigvals(A))) == pytest.approx(math.sqrt(9000 * (1 / 40 + 0.25**2 / 3)), rel=1e-9)


def test_what_the_drum_winds_the_load_rises():
    """Energy: M phi = m g (y - y_0) + T + the rope's k s^2/2; a rope that starts with the load's stretch keeps it."""
    s = 40 * 9.81 / 9000
    text = HOIST.replace("M = 0", 'M = "9.81*m*r + 5"').replace("y = -2 }", f"y = {-2 - s} }}")
    run = run_of(text, 1.5)
    work = (40 * 9.81 * 0.25 + 5) * run["phi"]
    gained = 40 * 9.81 * (run["y"] + 2 + s) + 3 * run["phi'"] ** 2 / 2 + 40 * run["y'"] ** 2 / 2
    stretch = 0.25 * run["phi"] - run["y"] - 2
    assert work == pytest.approx(gained + 9000 * (stretch**2 - s**2) / 2, abs=1e-6)
    assert run["y"][-1] > -2


def test_a_rope_that_is_paid_out_lowers_the_load_steadily():
    """l_0 = 2 + v t: y = - l_0 - m g/k at the speed v, T = m g."""
    s = 2 * 9.81 / 300
    text = HEAD + WEIGHT + FALLING.replace("length = 1.5", 'length = "2 + 0.3*t"\ndamping = 7')
    text = text.replace("start = -0.5", f"start = {-2 - s}, speed = -0.3")
    assert run_of(text, 2)["y"][-1] == pytest.approx(-2 - 0.6 - s, rel=1e-9)


REFUSED = {
    "it slips on what it passes": HOIST.replace(", slip = true", ""),
    "nothing on it that it could pull": HEAD + FALLING.replace('"ball.origin"', '"O"'),
    "turns about is not known": HOIST.replace('"2 - r", 0]', '"1 - r", 0.2]'),
}


@pytest.mark.parametrize("what", REFUSED)
def test_a_rope_that_cannot_be_is_refused_by_name(what):
    with pytest.raises((ModelError, DerivationError), match=what):
        eomgen.derive(eomgen.loads(REFUSED[what]))


WAGON = (
    HEAD
    + """
parameters = { m = 3, k = 500 }
coordinates.x = { speed = 2 }
points.wall = [1, 0]
bodies.wagon = { mass = "m", joint = { kind = "prismatic", axis = [1, 0], displacement = "x" } }
[forces.buffer]
kind = "bumper"
points = ["wagon.origin", "wall"]
along = [1, 0]
stiffness = "k"
length = 0.4
"""
)


@pytest.mark.parametrize("n", ["1", "3/2", "2"])
def test_a_bumper_without_losses_gives_the_speed_back(n):
    """The deepest compression (m v^2 (n + 1)/(2 k))^(1/(n + 1)); the way back at the same speed."""
    run = run_of(WAGON + f'exponent = "{n}"\n', 1.6)
    p = float(eval(n)) + 1
    assert np.max(run["x"]) - 0.6 == pytest.approx((3 * 4 * p / 2 / 500) ** (1 / p), abs=1e-5)
    assert run["x'"][-1] == pytest.approx(-2, rel=1e-7)


@pytest.mark.parametrize("n", [1, 1.5])
def test_hunt_and_crossley_lose_the_same_speed_whatever_the_stiffness(n):
    """v dv/(1 + a v) = - k x^n dx/m: v/a - log(1 + a v)/a^2 is the same at both ends of the contact."""
    a = 0.35
    left = lambda v: v / a - math.log(1 + a * v) / a**2  # noqa: E731
    out = brentq(lambda v: left(-v) - left(2), 1e-6, 1 / a - 1e-9)
    run = run_of(WAGON + f"exponent = {n}\ndissipation = {a}\n", 1.8)
    assert run["x'"][-1] == pytest.approx(-out, rel=1e-6)


def test_a_damped_bumper_lets_go_where_its_force_ends():
    """k x + d x' = 0 while it opens: x(t) of the damped oscillator up to there, then no force."""
    d, m, k, v = 30.0, 3.0, 500.0, 2.0
    delta, w = d / (2 * m), math.sqrt(k / m - (d / (2 * m)) ** 2)
    x = lambda t: v / w * math.exp(-delta * t) * math.sin(w * t)  # noqa: E731
    rate = lambda t: v / w * math.exp(-delta * t) * (w * math.cos(w * t) - delta * math.sin(w * t))  # noqa: E731
    ends = brentq(lambda t: k * x(t) + d * rate(t), 0.6 * math.pi / w, math.pi / w)
    run = run_of(WAGON + "damping = 30\n", 1.5)
    assert run["x'"][-1] == pytest.approx(rate(ends), rel=1e-6)


def test_a_damping_and_a_dissipation_are_one_too_many():
    with pytest.raises(ModelError, match="a damping and a dissipation"):
        eomgen.loads(WAGON + "damping = 1\ndissipation = 1\n")
