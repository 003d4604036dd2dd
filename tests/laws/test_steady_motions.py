"""Steady motions are found from near the start: precession, conical motion, turns of rolling bodies."""

from pathlib import Path

import numpy as np
import pytest

import eomgen

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"


def found(text: str) -> dict[str, float]:
    small = eomgen.linearize(eomgen.loads(text), about="steady")
    return {name: entry["value"] for name, entry in small.as_dict()["state"].items()}


@pytest.mark.parametrize(("guess", "which"), [("start = 0,", 0), ("near = 0, speed = 200,", 1)])
def test_a_heavy_top_has_a_slow_and_a_fast_precession(guess, which):
    """I_t cos(theta) phi'^2 - I_3 w_3 phi' + m g d = 0,  w_3 = psi' + phi' cos(theta)"""
    text = (MODELS / "heavy_top.toml").read_text().replace("phi = { start = 0,", f"phi = {{ {guess}")
    state = found(text)
    m, d, I_t, I_3, g, theta, psi_d = 0.1, 0.04, 2.5e-4, 5e-5, 9.81, np.pi / 6, 250
    rates = np.roots([(I_t - I_3) * np.cos(theta), -I_3 * psi_d, m * g * d])
    assert state["theta"] == pytest.approx(theta) and state["psi'"] == psi_d
    assert state["phi'"] == pytest.approx(sorted(rates)[which], rel=1e-12)


DISC = """eomgen = 1
name = "disc"
space = "space"
[parameters]
m = 2
r = 0.3
[coordinates]
x = {}
y = {}
z = { near = "r" }
psi = { speed = 2 }
theta = 1.3
phi = { near = 0, speed = -4 }
[bodies.disc]
shape = { kind = "disc", mass = "m", radius = "r" }
joint = { kind = "free", position = ["x", "y", "z"], orientation = "zxz", angles = ["psi", "theta", "phi"] }
[constraints.floor]
kind = "rolling"
body = "disc"
axis = [0, 0, 1]
plane = { at = [0, 0, 0], normal = [0, 0, 1] }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, -9.81]
"""


def test_a_disc_rolls_in_a_circle():
    """g cos(theta) + r W sin(theta) (5/4 W cos(theta) + 3/2 w) = 0, W of the heading, w about its axis

    Source: O'Reilly, The dynamics of rolling disks and sliding disks, Nonlinear Dynamics 10 (1996) 287-305.
    """
    state = found(DISC)
    W, w, theta = state["psi'"], state["phi'"], state["theta"]
    assert (theta, W) == pytest.approx((1.3, 2))
    couple = 0.3 * W * np.sin(theta) * (1.25 * W * np.cos(theta) + 1.5 * w)
    assert 9.81 * np.cos(theta) + couple == pytest.approx(0, abs=1e-9)


def test_a_bicycle_turns_hands_free():
    """What is found stays so along the run: lean, steer and the rates of wheels and yaw"""
    text = (MODELS / "whipple_bicycle.toml").read_text()
    for old, new in (
        ('x = { unit = "m", about = "of the centre of the rear wheel", speed = "v" }', 'x = { unit = "m" }'),
        ('z = { start = "-r_R",', 'z = { near = "-r_R",'),
        ("phi = { about", "phi = { start = 0.1, about"),
        ("delta = { about", "delta = { near = 0.1, about"),
        ("theta_R = { speed", "theta_R = { near = 0, speed"),
        ('theta_F = { speed = "-v/r_F", ', "theta_F = { "),
    ):
        assert old in text
        text = text.replace(old, new)
    state = found(text)
    assert state["phi"] == pytest.approx(0.1) and state["psi'"] > 0.1 and state["delta"] > 0.01
    model = eomgen.loads(text)
    run = eomgen.simulate(model, time=1, start=state)
    names = [*run.coordinates, *run.speeds]
    for name in ("phi", "delta", "theta", "z", "psi'", "theta_R'", "theta_F'"):
        assert np.allclose(run.x[:, names.index(name)], state[name], atol=1e-7), name


def test_a_motion_that_cannot_be_steady_is_said_to_be_none():
    """a block that slides down an incline goes faster and faster"""
    model = eomgen.loads("""eomgen = 1
name = "block"
space = "plane"
[coordinates]
x = { speed = 1 }
[bodies.block]
mass = 1
inertia = 1
joint = { kind = "prismatic", axis = [1, -1], displacement = "x" }
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
""")
    with pytest.raises(eomgen.DerivationError, match="no steady motion was found near the start"):
        eomgen.linearize(model, about="steady")


SPINNING_BALL = """
eomgen = 1
name = "ball"
space = "space"
[parameters]
m = 0.05
R = 0.03
g = 9.81
mu = 0.2
[coordinates]
x = 0
y = 0
z = { dependent = true, near = "R" }
e0 = 1
e1 = 0
e2 = 0
e3 = 0
[speeds]
w1 = {}
w2 = {}
w3 = { start = 40 }
[bodies.ball]
mass = "m"
inertia = [1.7e-5, 1.7e-5, 1.9e-5]
[bodies.ball.joint]
kind = "free"
position = ["x", "y", "z"]
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]
[constraints.table]
kind = "rolling"
body = "ball"
radius = "R"
plane = { at = [0, 0, 0], normal = [0, 0, 1] }
slip = true
friction = { viscous = "mu" }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
[linearize]
about = "start"
"""


def test_a_ball_that_spins_on_a_rough_table_has_small_motions_about_axes_that_stand_still():
    """I_1 m s^2 + (I_1 c - i I_3 w m + R^2 c m) s - i w c (I_3 + R^2 m) = 0, c = mu m g, by hand in complex numbers."""
    m, R, c, w, I_1, I_3 = 0.05, 0.03, 0.2 * 0.05 * 9.81, 40, 1.7e-5, 1.9e-5
    by_hand = np.roots([I_1 * m, I_1 * c - 1j * I_3 * w * m + R * R * c * m, -1j * w * c * (I_3 + R * R * m)])
    found = eomgen.linearize(eomgen.loads(SPINNING_BALL))
    oscillating = [mode.eigenvalue for mode in found.spectrum.oscillating]
    expected = sorted((complex(s.real, abs(s.imag)) for s in by_hand), key=lambda s: s.imag)
    assert oscillating == pytest.approx(expected, rel=1e-9)
    assert found.coordinates[2:] == ("turn_x_ball", "turn_y_ball", "turn_z_ball")
    assert found.certify()


def test_a_steady_motion_is_sought_along_what_velocity_ties_integrate_to():
    """phi = phi_0 + theta_0 - theta + 3 (sin theta_0 - sin theta) as the disc rolls; upright 1/5 + 3 sin 1/5."""
    found = eomgen.linearize(MODELS / "rolling_disc_and_bar.toml", about="steady", coordinates=["phi"])
    assert found.as_dict()["state"]["phi"]["value"] == pytest.approx(0.2 + 3 * np.sin(0.2), rel=1e-12)
    assert found.certify().ok


BESIDE = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 500, g = 9.81, l = 0.8 }
coordinates = { y = { start = -0.05, unit = "m" }, q = { start = START } }
bodies.seat.joint = { kind = "prismatic", axis = [0, 1], displacement = "y", stiffness = "k" }
bodies.seat.shape = { kind = "particle", mass = "m" }
bodies.rod.joint = { kind = "revolute", on = "seat", angle = "q - pi/2" }
bodies.rod.shape = { kind = "rod", mass = "m", length = "l" }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
linearize.about = "start"
"""


def test_about_a_start_that_is_no_rest_it_is_about_the_rest_near_it_and_says_so():
    """2 m g = -k y: 0.02848 m below -0.05 m;  K = (k, m g l/2)."""
    found = eomgen.linearize(eomgen.loads(BESIDE.replace("START", "0.2")))
    sag = -2 * 2 * 9.81 / 500
    assert found.entries()["beside_start"]["y"] == {"start": -0.05, "away": pytest.approx(sag + 0.05)}
    assert found.entries()["beside_start"]["q"]["away"] == pytest.approx(-0.2)
    assert np.diag(found.K) == pytest.approx([500, 2 * 9.81 * 0.4])
    text = found.render("text")
    assert "The start is accelerated. The equilibrium near it" in text and "-0.2" in text
    assert found.certify().ok and "y = -0.07848 for -0.05 at the start" in found.derivation.notes[0]


def test_about_a_start_far_from_rest_the_refusal_names_what_is_nearest():
    """Nearest to q = 0.9 is q = 0, farther than NEARBY."""
    with pytest.raises(eomgen.DerivationError, match=r"the equilibrium nearest to it is not near: .*q = 0 \(-0.9\)"):
        eomgen.linearize(eomgen.loads(BESIDE.replace("START", "0.9")))
