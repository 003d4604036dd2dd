"""Rolling, edges and friction in space on systems that nobody here had seen: what went wrong once, as laws."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from slow_run import sampled

import eomgen

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
BALL = """eomgen = 1
name = "ball"
space = "space"
[parameters]
m = 1
R = 0.1
mu = 0.2
g = 9.81
[coordinates]
x = { speed = 3 }
y = { speed = 1 }
z = { start = "R" }
e0 = 1
e1 = 0
e2 = 0
e3 = 0
[speeds]
w1 = { start = 20 }
w2 = { start = 5 }
w3 = { start = 7 }
[bodies.ball]
shape = { kind = "sphere", mass = "m", radius = "R" }
[bodies.ball.joint]
kind = "free"
position = ["x", "y", "z"]
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]
[constraints.floor]
kind = "rolling"
body = "ball"
plane = { at = [0, 0, 0], normal = [0, 0, 1] }
slip = true
friction = FRICTION
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""
# the bowling ball slips with (3 - 5 R, 1 + 20 R) = (2.5, 3)
SLIP = np.array([2.5, 3.0])


@sampled(2)
@pytest.mark.parametrize(
    ("friction", "force"),
    [
        ('"mu"', -0.2 * 9.81 * SLIP / np.hypot(*SLIP)),
        ("{ viscous = 0.2 }", -0.2 * 9.81 * SLIP),
    ],
)
def test_friction_on_a_surface_has_its_two_components_while_it_slides(friction, force):
    """T = -mu N v/|v|, -c N v along t and s: in runs, in answers, in the emitted code."""
    text = BALL.replace("FRICTION", friction) + '[outputs]\nT = "reaction_t(floor)"\nS = "reaction_s(floor)"\n'
    model = eomgen.loads(text)
    run = eomgen.simulate(model, time=0.01, samples=2)
    assert [run[f"reaction_{k}(floor)"][0] for k in "ts"] == pytest.approx(force)
    assert [answer.value for answer in eomgen.solve(model).values()] == pytest.approx(force)
    equations = eomgen.derive(model)
    reactions = equations.reaction_rhs("numpy")
    rhs = equations.rhs("numpy")
    found = dict(zip(reactions.names, reactions(0.0, rhs.x0, rhs.p0), strict=True))
    assert [found[f"reaction_{k}(floor)"] for k in "ts"] == pytest.approx(force)


def test_a_bowling_ball_comes_to_roll_along_a_line_that_was_fixed_at_the_start():
    """v = (5 v_0 + 2 R (w_y, -w_x))/7 when it no longer slips, whatever mu."""
    run = eomgen.simulate(eomgen.loads(BALL.replace("FRICTION", '"mu"')), time=1, samples=2)
    assert (run["x'"][-1], run["y'"][-1]) == pytest.approx(((15 + 2 * 0.1 * 5) / 7, (5 - 2 * 0.1 * 20) / 7), abs=1e-6)


COIN = """eomgen = 1
name = "coin"
space = "space"
[parameters]
m = 0.5
R = 0.2
g = 9.81
[coordinates]
x = 0
y = 0
z = "R*cos(0.1)"
psi = 0
phi = 0.1
theta = 0
[bodies.disc]
shape = { kind = "disc", mass = "m", radius = "R" }
joint = { kind = "free", position = ["x", "y", "z"], orientation = "zxz", angles = ["psi", "phi - pi/2", "theta"] }
[constraints.floor]
kind = "rolling"
body = "disc"
axis = [0, 0, 1]
plane = { at = [0, 0, 0], normal = [0, 0, 1] }
MORE
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""


@sampled(2)
@pytest.mark.parametrize(
    "more",
    [
        "",
        "slip = true",
        "slip = true\nunilateral = true",
        "slip = true\nunilateral = true\nfriction = 0.3",
    ],
)
def test_a_coin_that_falls_flat_ends_the_run_whatever_its_contact(more):
    """Its whole rim touches; a run through it would take the coin below the floor."""
    run = eomgen.simulate(eomgen.loads(COIN.replace("MORE", more)), time=2, samples=50)
    assert run.status == "singular" and "'disc' lies flat in 'floor'" in run.message
    assert run["z"].min() > 0 and run["phi"][-1] == pytest.approx(np.pi / 2, abs=1e-4)


def test_a_slip_that_turns_round_goes_on():
    """A coin falls in a plane: its slip passes 0, where friction cannot hold it, and turns its sense."""
    more = "slip = true\nunilateral = true\nfriction = 0.3"
    run = eomgen.simulate(eomgen.loads(COIN.replace("MORE", more)), time=2, samples=400)
    assert len(run.phases) == 3
    N, S = run["reaction_n(floor)"], run["reaction_s(floor)"]
    slides = run.t > run.phases[0].end
    assert np.abs(S[slides]) == pytest.approx(0.3 * N[slides], rel=1e-2)  # 1e-7 m/s is where it turns
    assert (np.sign(S[slides]) == -1).any() and (np.sign(S[slides]) == 1).any()


CONE = """eomgen = 1
name = "cone"
space = "space"
[parameters]
h = 0.3
alpha = 0.4
slope = 0.35
g = 9.81
[coordinates]
phi = 0.2
psi = { dependent = true, start = 0 }
[bodies.cone]
shape = { kind = "cone", mass = 2, radius = "h*tan(alpha)", height = "h" }
points = { apex = [0, 0, "3*h/4"], base = [0, 0, "-h/4"] }
[bodies.cone.joint]
kind = "spherical"
point = "apex"
turned = { axis = [0, 1, 0], angle = "slope" }
orientation = "zyz"
angles = ["phi + pi", "pi/2 + alpha", "psi"]
[constraints.plane]
kind = "rolling"
body = "cone"
center = "base"
axis = [0, 0, 1]
radius = "h*tan(alpha)"
plane = { at = [0, 0, 0], normal = ["sin(slope)", 0, "cos(slope)"] }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""


def test_a_cone_rolls_on_a_slope_that_its_normal_gives():
    """phi'' = -5 g cos(alpha) sin(slope) sin(phi)/(h (1 + 5 cos^2 alpha)); phi = 0 is no singular place."""
    model = eomgen.loads(CONE)
    rhs = eomgen.derive(model).rhs("numpy")
    alpha, slope = 0.4, 0.35
    pull = 5 * 9.81 * np.cos(alpha) * np.sin(slope) / (0.3 * (1 + 5 * np.cos(alpha) ** 2))
    assert rhs.speeds == ("phi'",)
    assert rhs(0.0, np.array([0.7, 0.1, 1.3]), rhs.p0)[2] == pytest.approx(-pull * np.sin(0.7))


SLEIGH = """eomgen = 1
name = "sleigh"
space = "plane"
[parameters]
m = 2
J = 0.3
a = 0.4
[coordinates]
x = 0
y = { dependent = true, start = 0 }
theta = 1
[speeds]
v = { rate = "x'*cos(theta) + y'*sin(theta)", start = 0.5 }
omega = { rate = "theta'", start = 1.5 }
[bodies.sleigh]
mass = "m"
inertia = "J"
center = ["a", 0]
joint = { kind = "planar", x = "x", y = "y", angle = "theta" }
[constraints.edge]
kind = "skate"
point = "sleigh.origin"
along = [1, 0]
"""


def test_a_dependent_rate_that_declared_speeds_make_regular_is_not_called_singular():
    """y' = tan(theta) x' has no value where the sleigh stands across, y' = v sin(theta) has."""
    run = eomgen.simulate(eomgen.loads(SLEIGH), time=3, samples=20)
    assert run["theta"].min() < np.pi / 2 < run["theta"].max() and not run.carried and run.ok


def test_an_equation_of_rounding_alone_says_nothing_of_a_reaction():
    """A force along the edge of a skate on a slope is 0 but for rounding: N is that of the bodies' balance."""
    text = SLEIGH.replace('"plane"', '"space"').replace('inertia = "J"', 'inertia = ["J", "J", "J"]')
    text = text.replace('center = ["a", 0]', 'center = ["a", 0, 0]').replace("along = [1, 0]", "along = [1, 0, 0]")
    text = text.replace('kind = "planar", x', 'kind = "planar", on = "slope", x')
    text = text.replace("y = { dependent = true, start = 0 }", "y = 0")
    text = text[: text.index("[speeds]")] + text[text.index("[bodies") :]
    text = text.replace("theta = 1", "theta = { start = 1, speed = 1.5 }")
    text += 'normal = ["sin(0.3)", 0, "cos(0.3)"]\n'
    text += '[bodies.slope]\njoint = { kind = "fixed", axis = [0, 1, 0], angle = 0.3 }\n'
    text += '[forces.weight]\nkind = "gravity"\nacceleration = [0, 0, -9.81]\n'
    run = eomgen.simulate(eomgen.loads(text), time=1, samples=20)
    theta, omega = run["theta"], run["theta'"]
    v = run["x'"] * np.cos(theta) + run["y'"] * np.sin(theta)
    m, J, a, pull = 2, 0.3, 0.4, 9.81 * np.sin(0.3)
    turning = -(m * a * v * omega + m * a * pull * np.sin(theta)) / (m * a**2 + J)  # about the edge; N from across it
    N = m * (v * omega + a * turning) + m * pull * np.sin(theta)
    assert run["reaction_n(edge)"] == pytest.approx(N, rel=1e-7, abs=1e-8)


def test_what_steers_two_joints_at_once_is_one_generalized_force():
    """phi turns the front wheels and -phi the back ones: drive(phi) = 2 J_w phi'', whatever the board does."""
    run = eomgen.simulate(eomgen.load(MODELS / "snakeboard.toml"), time=2, samples=9)
    assert run["drive(phi)"] == pytest.approx(-2 * 0.0013 * 2.7 * np.sin(3 * run.t), abs=1e-9)
