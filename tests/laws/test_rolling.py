"""Rolling and knife edges in space: discs, tyres, balls and ellipsoids on planes, balls on what is curved."""

from __future__ import annotations

import math

import numpy as np
import pytest
from each import each
from rolling_bodies import RoundBody, rotation_of

import eomgen
from eomgen.errors import ModelError

pytestmark = pytest.mark.slow

MASS, COM = 1.5, np.array([0.02, -0.03, 0.01])
INERTIA = np.array([[0.11, 0.01, 0.005], [0.01, 0.13, 0], [0.005, 0, 0.17]])
FREE = """eomgen = 1
name = "round"
space = "space"
[parameters]
R = 0.4
W = 0.7
[coordinates]
x = 0
y = 0
z = 0.4
e0 = 0.8
e1 = 0.3
e2 = 0.2
e3 = 0.1
{more}
[speeds]
w1 = {{ start = 0 }}
w2 = {{ start = 0 }}
w3 = {{ start = 0 }}
[bodies.body]
{mass}
[bodies.body.joint]
kind = "free"
position = ["x", "y", "z"]
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]
[forces.weight]
kind = "gravity"
acceleration = [0, 0, -9.81]
[constraints.contact]
kind = "rolling"
body = "body"
{contact}
{last}
"""
UNEVEN = "mass = 1.5\ncenter = [0.02, -0.03, 0.01]\ninertia = [0.11, 0.13, 0.17, 0.01, 0, 0.005]"
AXIS = (1 / 3, 2 / 3, 2 / 3)
SURFACES = {
    "ball": ('radius = "R"', RoundBody(MASS, COM, INERTIA, "ball", (0.4,))),
    "disc": ('radius = "R"\naxis = [1, 2, 2]', RoundBody(MASS, COM, INERTIA, "wheel", (0.4,), AXIS)),
    "tyre": ('radius = "R"\naxis = [1, 2, 2]\ntube = 0.1', RoundBody(MASS, COM, INERTIA, "wheel", (0.4,), AXIS, 0.1)),
    "ellipsoid": ("ellipsoid = [0.4, 0.3, 0.2]", RoundBody(MASS, COM, INERTIA, "egg", (0.4, 0.3, 0.2))),
}
ON_TABLE = 'on = "table"\nplane = { at = [1, 0, 0.2], normal = [1, 2, 2] }'
TABLE = '[bodies.table]\njoint = { kind = "revolute", angle = "alpha" }'
PLANES = {  # (of the contact, coordinates, bodies), normal and place in the track's axes, its rate of turning
    "floor": (("plane = { at = [0, 0, 0], normal = [0, 0, 1] }", "", ""), ([0, 0, 1], [0, 0, 0]), 0.0),
    "slope": (("plane = { at = [1, 0, 0], normal = [1, 2, 2] }", "", ""), (AXIS, [1, 0, 0]), 0.0),
    "table": ((ON_TABLE, 'alpha = { motion = "W*t + 0.3" }', TABLE), (AXIS, [1, 0, 0.2]), 0.7),
}


def text(contact: str, more: str = "", last: str = "", mass: str = UNEVEN) -> str:
    return FREE.format(contact=contact, more=more, last=last, mass=mass)


@each("plane", PLANES)
@each("surface", SURFACES)
def test_a_round_body_rolls_as_newton_and_euler_say(surface, plane):
    """The contact force holds the material point in contact to the plane, and the point of contact wanders."""
    fields, body = SURFACES[surface]
    (contact, more, last), (normal, at), rate = PLANES[plane]
    rhs = eomgen.derive(eomgen.loads(text(f"{contact}\n{fields}", more, last))).rhs("numpy")
    rng, t = np.random.default_rng(5), 0.4
    for _ in range(3):
        alpha = (0.3 if rate else 0.0) + rate * t
        turned = rotation_of([np.cos(alpha / 2), 0, 0, np.sin(alpha / 2)])
        n, turning = turned @ np.asarray(normal), np.array([0, 0, rate])
        e, w_body = rng.normal(size=4), rng.normal(size=3)
        e /= np.linalg.norm(e)
        R = rotation_of(e)
        w = R @ w_body
        r, _ = body.reach(R, w, n, np.cross(turning, n))
        o = rng.normal(size=3)
        o -= n * (n @ (o + r - turned @ np.asarray(at)))
        v = np.cross(turning, o + r) - np.cross(w, r)
        q = [*o, *e, alpha][: len(rhs.coordinates)]
        found = rhs(t, np.array([*q, *v, *w_body]), rhs.p0)[len(q) :]
        a, w_rate, _ = body.accelerations(R, w, v, n, turning, np.array([0, 0, -9.81]))
        assert found == pytest.approx(np.concatenate([a, w_rate]), rel=1e-8, abs=1e-8)


@pytest.mark.parametrize(("surface", "plane"), [("disc", "table"), ("tyre", "slope"), ("ellipsoid", "table")])
def test_a_rolling_body_is_certified_by_independent_routes(surface, plane):
    """DESIGN 6 holds with multipliers, quaternions and a contact that wanders on a plane that moves."""
    contact, more, last = PLANES[plane][0]
    assert eomgen.derive(eomgen.loads(text(f"{contact}\n{SURFACES[surface][0]}", more, last))).certify().ok


DISC = """eomgen = 1
name = "disc"
space = "space"
[parameters]
m = 1.5
R = 0.4
g = 9.81
Omega = 4
[coordinates]
x = { dependent = true, start = 0 }
y = { dependent = true, start = 0 }
psi = { start = 0 }
phi = { start = 0 }
theta = { start = 0, speed = "Omega" }
SPEEDS
[bodies.disc]
shape = { kind = "disc", mass = "m", radius = "R" }
[bodies.disc.joint]
kind = "free"
position = ["x", "y", "R*cos(phi)"]
orientation = "zxz"
angles = ["psi", "phi + pi/2", "theta"]
[constraints.floor]
kind = "rolling"
body = "disc"
axis = [0, 0, 1]
plane = { at = [0, 0, 0], normal = [0, 0, 1] }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
[linearize]
about = "start"
"""
KANE = """[speeds]
u1 = { rate = "phi'" }
u2 = { rate = "theta' - psi'*sin(phi)", start = 4 }
u3 = { rate = "psi'*cos(phi)" }"""


def test_a_rolling_disc_by_independent_speeds_has_the_equations_of_the_textbooks():
    """Kane's disc, as in sympy's own test of the rolling disc (there with u2 of the other sense).

    u1' = (4 g sin q2 - 6 R u2 u3 - R u3^2 tan q2)/(5 R),  u2' = 2 u1 u3/3,  u3' = (2 u2 + u3 tan q2) u1
    """
    equations = eomgen.derive(eomgen.loads(DISC.replace("SPEEDS", KANE).replace(', speed = "Omega"', "")))
    rhs = equations.rhs("numpy")
    assert equations.certify().ok and rhs.speeds == ("u1", "u2", "u3")
    rng = np.random.default_rng(2)
    for _ in range(4):
        lean, (u1, u2, u3) = rng.uniform(-1, 1), rng.normal(size=3)
        x = np.array([0.3, -0.2, rng.normal(), lean, rng.normal(), u1, u2, u3])
        expected = [
            (4 * 9.81 * np.sin(lean) - 6 * 0.4 * u2 * u3 - 0.4 * u3**2 * np.tan(lean)) / (5 * 0.4),
            2 * u1 * u3 / 3,
            (2 * u2 + u3 * np.tan(lean)) * u1,
        ]
        assert rhs(0.0, x, rhs.p0)[-3:] == pytest.approx(expected, rel=1e-12)


@each("shape, limit", [("disc", 1 / 3), ("ring", 1 / 4)])
def test_a_rolling_disc_stays_upright_above_its_critical_speed(shape, limit):
    """Omega^2 > g/(3 R) of a disc, g/(4 R) of a hoop: I_t m g R/(I_a (I_a + m R^2)) with its two moments of inertia.

    Source: O'Reilly, The dynamics of rolling disks and sliding disks, Nonlinear Dynamics 10 (1996).
    """
    for share, stable in ((0.98, False), (1.02, True)):
        written = DISC.replace("SPEEDS", "").replace('"disc", m', f'"{shape}", m')
        written = written.replace("Omega = 4", f"Omega = {np.sqrt(share * limit * 9.81 / 0.4):.6f}")
        fastest = max(x.real for x in eomgen.linearize(eomgen.loads(written)).spectrum.eigenvalues)
        assert fastest < 1e-3 if stable else fastest > 0.1


SPHERE = 'shape = { kind = "sphere", mass = 0.5, radius = "R" }'
ROUND_TABLE = '[bodies.table]\njoint = { kind = "revolute", angle = "alpha" }'


def test_a_ball_on_a_turntable_runs_round_a_circle_at_two_sevenths_of_its_rate():
    """v' = 2/7 Omega x v for a homogeneous ball, whatever its size, mass and spin.

    Source: Neimark & Fufaev, Dynamics of Nonholonomic Systems, chapter 1.
    """
    contact = 'on = "table"\nplane = { at = [0, 0, 0], normal = [0, 0, 1] }'
    written = text(contact, 'alpha = { motion = "3*t" }', ROUND_TABLE, SPHERE)
    written = written.replace("x = 0\n", "x = 1\n").replace("y = 0\n", "y = { start = 0, speed = 3 }\n")
    run = eomgen.simulate(eomgen.loads(written), time=2.0)
    rate = 2 / 7 * 3
    x, y = run.x[:, 0], run.x[:, 1]
    assert x == pytest.approx(1 + 3 / rate * (np.cos(rate * run.t) - 1), abs=1e-7)
    assert y == pytest.approx(3 / rate * np.sin(rate * run.t), abs=1e-7)


def test_a_ball_in_an_upright_pipe_swings_up_and_down():
    """The golfer's ball: it comes back up, z'' = -2/7 phi'^2 z + const with phi' its steady rate round the pipe.

    Source: Gualtieri et al., Golfer's dilemma, American Journal of Physics 74 (2006).
    """
    contact = "circle = { at = [0, 0, 0], radius = 1.4, inside = true, axis = [0, 0, 1] }"
    written = text(contact, mass=SPHERE).replace("x = 0\n", "x = 1\n").replace("z = 0.4", "z = 0")
    written = written.replace("y = 0\n", "y = { start = 0, speed = 2 }\n").replace("e0 = 0.8", "e0 = 1")
    written = written.replace("e1 = 0.3", "e1 = 0").replace("e2 = 0.2", "e2 = 0").replace("e3 = 0.1", "e3 = 0")
    written = written.replace("w3 = { start = 0 }", "w3 = { start = -5 }")
    run = eomgen.simulate(eomgen.loads(written), time=4.0)
    omega = np.sqrt(2 / 7) * 2
    depth = 5 / 7 * 9.81 / omega**2
    assert run.x[:, 2] == pytest.approx(-depth * (1 - np.cos(omega * run.t)), abs=1e-6)
    assert run.drift < 1e-7


def test_a_ball_in_a_bowl_swings_like_a_longer_pendulum():
    """Small oscillations at omega^2 = 5 g/(7 (D - R)), D the bowl's radius."""
    contact = "circle = { at = [0, 0, 0], radius = 1.4, inside = true }"
    written = text(contact, mass=SPHERE).replace("x = 0\n", "x = 0.001\n")
    written = written.replace("z = 0.4", 'z = { start = "-sqrt(1 - 0.001^2)" }')
    run = eomgen.simulate(eomgen.loads(written), time=3.0)
    omega = np.sqrt(5 * 9.81 / 7)
    assert run.x[:, 0] == pytest.approx(0.001 * np.cos(omega * run.t), abs=1e-8)


def test_a_bowled_ball_slides_on_a_parabola_until_it_rolls():
    """mu g against the velocity of the contact, whose direction stays; it rolls from 2 |v_c|/(7 mu g) on.

    Then v = (5 v_0 + 2 R w_0 x n)/7.
    Source: Hopkins & Patterson, Bowling frames, American Journal of Physics 45 (1977).
    """
    contact = "plane = { at = [0, 0, 0], normal = [0, 0, 1] }\nslip = true\nfriction = 0.12"
    written = text(contact, mass=SPHERE).replace("x = 0\n", "x = { start = 0, speed = 7 }\n")
    for e in ("e1 = 0.3", "e2 = 0.2", "e3 = 0.1"):
        written = written.replace(e, f"{e[:2]} = 0")
    written = written.replace("e0 = 0.8", "e0 = 1").replace("w1 = { start = 0 }", "w1 = { start = -10 }")
    run = eomgen.simulate(eomgen.loads(written), time=3.0)
    sliding = np.array([7, -10 * 0.4])
    assert run.phases[0].end == pytest.approx(2 * np.hypot(*sliding) / (7 * 0.12 * 9.81), rel=1e-6)
    assert run.x[-1, 7:9] == pytest.approx([5, 2 * 0.4 * 10 / 7], rel=1e-7)


def test_a_rattleback_keeps_its_energy_and_its_contact():
    """An ellipsoid whose principal axes are not those of its surface: nothing is lost where nothing slips."""
    run = eomgen.simulate(eomgen.load("models/rattleback.toml"), time=2.0)
    assert run.ok and run.drift < 1e-6 and run.gap < 1e-9


def test_a_skate_in_space_cuts_as_it_does_in_the_plane():
    """Chaplygin's sleigh: m a^2 theta'' + J theta'' = -m a v theta', v' = a theta'^2."""
    written = """eomgen = 1
name = "sleigh"
space = "space"
[coordinates]
x = 0
y = 0
theta = 0
[bodies.sleigh]
mass = 2
center = [0.3, 0, 0.1]
inertia = [0.4, 0.5, 0.2]
joint = { kind = "placed", at = ["x", "y", 0], angle = "theta" }
[constraints.edge]
kind = "skate"
point = "sleigh.origin"
along = [2, 0, 1]
"""
    rhs = eomgen.derive(eomgen.loads(written)).rhs("numpy")
    turn, v, rate = 0.7, 1.3, 0.6
    x = np.array([0, 0, turn, v * np.cos(turn), v * np.sin(turn), rate])
    ax, ay, turning = rhs(0.0, x, rhs.p0)[3:]
    assert turning == pytest.approx(-2 * 0.3 * v * rate / (2 * 0.3**2 + 0.2))
    assert ax * np.cos(turn) + ay * np.sin(turn) == pytest.approx(0.3 * rate**2)
    assert ay * np.cos(turn) - ax * np.sin(turn) == pytest.approx(v * rate)


def test_a_coin_that_falls_flat_ends_the_run():
    """Where the whole rim touches nobody can say how it goes on: a message, and no motion through the floor."""
    written = DISC.replace("SPEEDS", "").replace("phi = { start = 0 }", "phi = { start = 0.5 }")
    written = written.replace("Omega = 4", "Omega = 0")
    run = eomgen.simulate(eomgen.loads(written), time=2.0)
    assert run.status == "singular" and "'disc' lies flat in 'floor'" in run.message
    assert abs(run.x[-1, 3] - np.pi / 2) < 1e-4
    with pytest.raises(ModelError, match="'disc' lies flat at the start"):
        eomgen.derive(eomgen.loads(written.replace("start = 0.5", 'start = "pi/2"')))


@each(
    "contact, what",
    [
        ("line = { at = [0, 0, 0], normal = [0, 0, 1] }\nradius = 1", "'line' of 'contact' is for the plane"),
        ("plane = { at = [0, 0, 0], normal = [0, 0, 1] }", "the radius of 'body', which rolls, is not known"),
        ("plane = { at = [0, 0, 0], normal = [0, 0, 1] }\nradius = 1\ntube = 0.1", "the tyre of 'body' has no 'axis'"),
        ("plane = { at = [0, 0, 0], normal = [0, 0, 1] }\nradius = 1\nellipsoid = [1, 1, 2]", "it is one or the other"),
        (
            "circle = { at = [0, 0, 0], radius = 3, axis = [1, 0, 0]}\nradius = 1\naxis = [0, 0, 1]",
            "rolls in or on a pipe",
        ),
    ],
)
def test_a_rolling_contact_that_makes_no_sense_is_named(contact, what):
    """One error, at the constraint."""
    with pytest.raises(ModelError, match=what):
        eomgen.loads(text(contact))


# -- wheels on balls ---------------------------------------------------------------------------------

DISC_ON = """
eomgen = 1
space = "space"
parameters = { m = 2, R = 0.3, S = SIZE, g = 9.81 }
forces.weight = { kind = "gravity", acceleration = [0, 0, "-g"] }
constraints.c = { kind = "rolling", body = "disc", axis = [0, 0, 1], TRACK }
[coordinates]
x = START
y = {}
z = { dependent = true, near = NEAR }
yaw = { start = YAW, speed = 0.3 }
lean = { start = LEAN, speed = 0.1 }
spin = { speed = 4 }
[bodies.disc]
shape = { kind = "disc", mass = "m", radius = "R" }
joint = { kind = "free", position = ["x", "y", "z"], orientation = "zxz", angles = ["yaw", "lean", "spin"] }
"""
LEVEL = "plane = { at = [0, 0, 0], normal = [0, 0, 1] }"


def disc_on(track: str, size: float, near: float, start: float = 0, yaw: float = 0.2, lean: float = 1.3) -> str:
    text = DISC_ON.replace("TRACK", track).replace("SIZE", f"{size:.0f}").replace("NEAR", str(near))
    return text.replace("START", str(start)).replace("YAW", str(yaw)).replace("LEAN", str(lean))


@each("inside", [False, True])
def test_a_disc_rolls_on_a_very_large_ball_as_on_a_plane(inside):
    """Outside and inside: all accelerations, to the curvature R/S = 3e-8."""
    track = f'circle = {{ at = [0, 0, "{"" if inside else "-"}S"], radius = "S", inside = {str(inside).lower()} }}'
    found = []
    for text in (disc_on(track, 1e7, 0.3), disc_on(LEVEL, 1, 0.3)):
        rhs = eomgen.derive(eomgen.loads(text)).rhs("numpy")
        found.append(rhs(0.0, rhs.x0, rhs.p0)[6:])
    assert found[0] == pytest.approx(found[1], rel=1e-6)


def test_a_disc_in_the_vertical_circle_of_a_bowl_rolls_as_in_a_hoop():
    """Upright through the lowest place: 3/2 (S - R) phi'' = -g sin(phi), phi of its centre from the vertical."""
    S, R, phi = 2, 0.3, 0.4
    start, near = (S - R) * math.sin(phi), -(S - R) * math.cos(phi)
    text = disc_on('circle = { at = [0, 0, 0], radius = "S", inside = true }', S, near, start, 0, math.pi / 2)
    text = text.replace(", speed = 0.3", "").replace(", speed = 0.1", "").replace("{ speed = 4 }", "0")
    rhs = eomgen.derive(eomgen.loads(text)).rhs("numpy")
    x = rhs(0.0, rhs.x0, rhs.p0)[6]
    assert x == pytest.approx(-2 / 3 * 9.81 * math.sin(phi) * math.cos(phi), rel=1e-9)


def test_a_disc_that_rolls_in_a_bowl_keeps_its_energy():
    """The certificate holds, and T + V stays."""
    text = disc_on('circle = { at = [0, 0, 0], radius = "S", inside = true }', 2, -1.7)
    assert eomgen.derive(eomgen.loads(text)).certify().ok
    run = eomgen.simulate(eomgen.loads(text), time=0.5, target="numpy")
    assert run.ok and run.drift < 1e-8
