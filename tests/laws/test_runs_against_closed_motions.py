"""Runs, samples and inverse dynamics of systems from elsewhere, against motions that share nothing with eomgen.

The oracle of the plane holds every body in its own x, y, angle, its rows as velocities, J and gamma by complex steps:

    [M  -J^T] [a  ]   [F     ]
    [J    0 ] [lam] = [-gamma]
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

import eomgen
from eomgen.cli import main
from eomgen.errors import UsageError
from eomgen.symbolic.numeric import tolerances

pytestmark = pytest.mark.slow

G = 9.81
H = 1e-30  # of complex steps
FINE = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-12}

# -- the oracle of the plane ----------------------------------------------------------------------


def accelerations(masses, rows, force, t, q, v):
    """(a, lam) of bodies that are all free but for the rows, rows(q, v, t) = 0."""
    n, k = len(q), len(rows(q, v, t))
    turned = (v + 1j * H * np.eye(n)[j] for j in range(n))
    J = np.array([np.imag(rows(q + 0j, each, t)) / H for each in turned]).T
    gamma = np.imag(rows(q + 1j * H * v, v + 0j, t + 1j * H)) / H
    whole = np.block([[np.diag(masses), -J.T], [J, np.zeros((k, k))]])
    found = np.linalg.solve(whole, np.concatenate([force(q, v, t), -np.array(gamma)]))
    return found[:n], found[n:]


def moved(masses, rows, force, q, v, times):
    """(q, v, lam) at the times, one row each."""
    n = len(q)

    def rate(t, x):
        return np.concatenate([x[n:], accelerations(masses, rows, force, t, x[:n], x[n:])[0]])

    found = solve_ivp(rate, (0, times[-1]), np.concatenate([q, v]), t_eval=times, **FINE).y.T
    lam = [accelerations(masses, rows, force, t, x[:n], x[n:])[1] for t, x in zip(times, found, strict=True)]
    return found[:, :n], found[:, n:], np.array(lam)


def point_rate(q, v, body, s):
    """The velocity of the point s of a body."""
    angle, w = q[3 * body + 2], v[3 * body + 2]
    x, y = np.cos(angle) * s[0] - np.sin(angle) * s[1], np.sin(angle) * s[0] + np.cos(angle) * s[1]
    return v[3 * body] - w * y, v[3 * body + 1] + w * x


# -- models ---------------------------------------------------------------------------------------

WIRES = """
eomgen = 1
name = "Two particles on two wires"
space = "plane"
parameters = { m1 = 1, m2 = 0.5, l1 = 1, l2 = 0.7, g = 9.81 }
[coordinates]
x1 = "l1*sin(pi/3)"
y1 = "-l1*cos(pi/3)"
x2 = "l1*sin(pi/3) + l2"
y2 = "-l1*cos(pi/3)"
[points]
O = [0, 0]
[bodies]
A = { shape = { kind = "particle", mass = "m1" }, joint = { kind = "placed", at = ["x1", "y1"] } }
B = { shape = { kind = "particle", mass = "m2" }, joint = { kind = "placed", at = ["x2", "y2"] } }
[constraints]
w1 = { kind = "link", points = ["A.origin", "O"], length = "l1" }
w2 = { kind = "link", points = ["B.origin", "A.origin"], length = "l2" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
"""

TOP = """
eomgen = 1
name = "Heavy top, free, its tip tied to the ground"
space = "space"
parameters = { m = 2, h = 0.3, I1 = 0.05, I3 = 0.02, g = 9.81 }
[coordinates]
x = 0
y = "-h*sin(0.5)"
z = "h*cos(0.5)"
e0 = "cos(0.25)"
e1 = "sin(0.25)"
e2 = 0
e3 = 0
[speeds]
w1 = {}
w2 = {}
w3 = { start = 60 }
[points]
O = [0, 0, 0]
[bodies.top]
mass = "m"
inertia = ["I1", "I1", "I3"]
points = { tip = [0, 0, "-h"] }
[bodies.top.joint]
kind = "free"
position = ["x", "y", "z"]
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]
[constraints]
ball = { kind = "pin", points = ["top.tip", "O"] }
[forces]
weight = { kind = "gravity", acceleration = [0, 0, "-g"] }
"""

BEAD = """
eomgen = 1
name = "Bead on a wire that turns as measured"
space = "plane"
parameters = { m = 0.4, k = 30 }
[coordinates]
phi = { motion = { samples = [[0, 0], [0.3, 0.2], [0.8, 1.5], [1.4, 2.0], [2, 2.1]], ends = "rest" } }
s = { start = 0.5, speed = 0.2 }
[bodies.wire]
mass = 0.1
inertia = 0.02
joint = { kind = "revolute", angle = "phi" }
[bodies.bead]
shape = { kind = "particle", mass = "m" }
[bodies.bead.joint]
kind = "prismatic"
on = "wire"
axis = [1, 0]
displacement = "s"
stiffness = "k"
rest = 0.5
damping = 0.2
"""

RACER = """
eomgen = 1
name = "Roller racer, steered to and fro"
space = "plane"
parameters = { m = 3, J = 0.4, a = 0.3, b = 0.2, m2 = 1, J2 = 0.05 }
coordinates = { x = 0, y = 0, th = 0.2, psi = { motion = "0.6*sin(3*t)" } }
[bodies.front]
mass = "m"
inertia = "J"
joint = { kind = "planar", x = "x", y = "y", angle = "th" }
points = { hinge = ["a", 0] }
[bodies.back]
mass = "m2"
inertia = "J2"
points = { wheel = ["b", 0] }
joint = { kind = "revolute", on = "front.hinge", angle = "psi" }
[constraints]
front_wheels = { kind = "skate", point = "front.origin", along = [1, 0] }
back_wheels = { kind = "skate", point = "back.wheel", along = [1, 0] }
"""

PARABOLA = """
eomgen = 1
name = "Particle on a parabola that swings between up and down"
space = "plane"
parameters = { m = 1, A = 0.5, w = 3, g = 9.81 }
coordinates = { x = { start = 0.4, speed = 0.1 }, y = 0.08 }
bodies.b = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", "y"] } }
constraints.curve = { kind = "equation", gap = "y - A*cos(w*t)*x^2" }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
"""

PUSHED = """
eomgen = 1
name = "Block on a rough floor, pushed for half a second"
space = "plane"
parameters = { m = 2, mu = 0.3, g = 9.81 }
coordinates = { x = 0, y = HEIGHT }
[inputs]
F = { value = { samples = [[0, 0], [0.5, 20], [1, 0]], between = "steps" } }
[bodies.b]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", "y"] }
[constraints.floor]
kind = "support"
point = "b.origin"
normal = [0, 1]
at = [0, 0]
friction = "mu"
unilateral = true
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
push = { kind = "force", point = "b.origin", force = ["F", 0] }
"""

SWING = """
eomgen = 1
space = "plane"
parameters = { m = 1, l = 1, g = 9.81 }
coordinates.q = 1
[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "q - pi/2" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
"""


@cache
def ran(text: str, time: float = 2.0, **options) -> eomgen.Trajectory:
    return eomgen.simulate(eomgen.loads(text), time=time, **options)


# -- motions and forces ---------------------------------------------------------------------------


def test_particles_on_wires_move_as_free_bodies_with_tensions():
    run = ran(WIRES)

    def rows(q, v, t):
        apart, opening = q[3:5] - q[:2], v[3:5] - v[:2]
        return [q[:2] @ v[:2], apart @ opening, v[2], v[5]]

    start = run.x[0, :4]
    q = np.array([*start[:2], 0, *start[2:], 0])
    weights = np.array([0, -G, 0, 0, -0.5 * G, 0])
    q, _, lam = moved([1, 1, 1, 0.5, 0.5, 1], rows, lambda q, v, t: weights, q, np.zeros(6), run.t)
    assert run.x[:, :4] == pytest.approx(q[:, [0, 1, 3, 4]], abs=1e-8)
    assert run["tension(w2)"] == pytest.approx(-0.7 * lam[:, 1], abs=1e-6)
    assert run.gap <= 1e-9 and run.gap_rate <= 1e-9 and run.drift < 1e-8


def test_a_top_on_a_tie_moves_as_one_by_euler_angles():
    """A theta'' = A sin cos psi'^2 - p_phi psi' sin + m g h sin, psi' = (p_psi - p_phi cos)/(A sin^2)."""
    run, A, spin, weight = ran(TOP), 0.05 + 2 * 0.09, 0.02 * 60, 2 * G * 0.3
    p = spin * np.cos(0.5)

    def rate(t, x):
        theta, speed, _ = x
        turning = (p - spin * np.cos(theta)) / (A * np.sin(theta) ** 2)
        tilting = np.cos(theta) * turning**2 - spin * turning / A + weight / A
        return [speed, np.sin(theta) * tilting, turning]

    theta, _, psi = solve_ivp(rate, (0, 2), [0.5, 0, 0], t_eval=run.t, **FINE).y
    place = 0.3 * np.array([np.sin(psi) * np.sin(theta), -np.cos(psi) * np.sin(theta), np.cos(theta)])
    assert run.x[:, :3] == pytest.approx(place.T, abs=1e-8) and run.gap <= 1e-9


def test_a_bead_on_a_sampled_wire_and_the_couple_that_turns_it():
    """s'' = s phi'^2 - (k (s - 1/2) + c s')/m; M = (J + m s^2) phi'' + 2 m s s' phi', phi of scipy's clamped cubic."""
    run = ran(BEAD)
    phi = CubicSpline([0, 0.3, 0.8, 1.4, 2], [0, 0.2, 1.5, 2, 2.1], bc_type="clamped")

    def rate(t, x):
        return [x[1], x[0] * phi(t, 1) ** 2 - (30 * (x[0] - 0.5) + 0.2 * x[1]) / 0.4]

    s, speed = solve_ivp(rate, (0, 2), [0.5, 0.2], t_eval=run.t, max_step=0.01, **FINE).y
    assert run["s"] == pytest.approx(s, abs=1e-8) and run["phi"] == pytest.approx(phi(run.t), abs=1e-9)
    couple = (0.02 + 0.4 * s**2) * phi(run.t, 2) + 0.8 * s * speed * phi(run.t, 1)
    assert run["drive(phi)"] == pytest.approx(couple, abs=1e-7)


def test_a_roller_racer_is_driven_by_its_steering():
    """Where it goes, what the steering takes, and what the front axle carries."""
    run = ran(RACER)

    def rows(q, v, t):
        hinge, wheel = point_rate(q, v, 0, (0.3, 0)), point_rate(q, v, 1, (0.2, 0))
        return [
            hinge[0] - v[3],
            hinge[1] - v[4],
            np.cos(q[2]) * v[1] - np.sin(q[2]) * v[0],
            np.cos(q[5]) * wheel[1] - np.sin(q[5]) * wheel[0],
            v[5] - v[2] - 1.8 * np.cos(3 * t),
        ]

    turning = -1.8 * 0.2 / 0.5  # the back wheels do not slip while the front stands
    c, s = 0.3 * np.cos(0.2), 0.3 * np.sin(0.2)
    q, v = np.array([0, 0, 0.2, c, s, 0.2]), np.array([0, 0, turning, -s * turning, c * turning, turning + 1.8])
    q, v, lam = moved([3, 3, 0.4, 1, 1, 0.05], rows, lambda q, v, t: np.zeros(6), q, v, run.t)
    assert run.x[:, :3] == pytest.approx(q[:, :3], abs=1e-8) and run["th'"] == pytest.approx(v[:, 2], abs=1e-8)
    assert run["drive(psi)"] == pytest.approx(lam[:, 4], abs=1e-7)
    assert run["reaction_n(front_wheels)"] == pytest.approx(lam[:, 2], abs=1e-7)


@pytest.mark.parametrize("way", ["projection", "baumgarte", "none"])
@pytest.mark.parametrize("method", ["DOP853", "RK23", "Radau", "LSODA"])
def test_a_curve_that_moves_carries_its_particle(method, way):
    """(1 + 4 c^2 x^2) x'' = -2 c x (c'' x^2 + 4 c' x x' + 2 c x'^2 + g), c = A cos(w t)."""
    tolerance = 1e-9 if method == "DOP853" else 1e-7
    run = ran(PARABOLA, method=method, stabilization=way, rtol=tolerance, atol=tolerance)

    def rate(t, state):
        x, v = state
        c, first, second = 0.5 * np.cos(3 * t), -1.5 * np.sin(3 * t), -4.5 * np.cos(3 * t)
        along = second * x * x + 4 * first * x * v + 2 * c * v * v + G
        return [v, -2 * c * x * along / (1 + 4 * c * c * x * x)]

    x = solve_ivp(rate, (0, 2), [0.4, 0.1], t_eval=run.t, **FINE).y[0]
    assert run["x"] == pytest.approx(x, abs=1e3 * tolerance)
    assert run["y"] == pytest.approx(0.5 * np.cos(3 * run.t) * x**2, abs=1e3 * tolerance)


def test_accelerations_and_rates_by_steps_and_lines_add_up():
    text = """
        eomgen = 1
        space = "plane"
        parameters = { m = 2 }
        [coordinates]
        x = { acceleration = { samples = [[0, 1], [0.5, -1], [1.5, 0]], between = "steps" }, start = 0.3, speed = 0.2 }
        y = { rate = { samples = [[0, 1], [1, -1], [3, 2]], between = "linear" } }
        [bodies]
        c.shape = { kind = "particle", mass = "m" }
        c.joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
        d.shape = { kind = "particle", mass = "m" }
        d.joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
    """
    run = ran(text, samples=(0, 0.25, 0.5, 0.75, 1, 1.5, 1.75, 2))
    t = run.t
    x = np.where(t < 0.5, 0.3 + 0.2 * t + t**2 / 2, 0.525 + 0.7 * (t - 0.5) - (t - 0.5) ** 2 / 2)
    assert run["x"] == pytest.approx(np.where(t < 1.5, x, 0.725 - 0.3 * (t - 1.5)), abs=1e-12)
    assert run["y"] == pytest.approx(np.where(t < 1, t - t**2, 1 - t + 0.75 * (t - 1) ** 2), abs=1e-12)
    assert run["drive(x)"] == pytest.approx(2 * np.where(t < 0.5, 1, np.where(t < 1.5, -1, 0)), abs=1e-12)
    assert run["drive(y)"] == pytest.approx(2 * np.where(t < 1, -2, 1.5), abs=1e-12)


# -- inverse dynamics -----------------------------------------------------------------------------


def test_the_wheels_of_a_robot_share_what_its_path_takes():
    """m (v' - d w^2) = L + R, (J + m d^2) w' + m d v w = b (R - L); and the motion gives the accelerations back."""
    text = """
        eomgen = 1
        space = "plane"
        parameters = { m = 5, J = 0.3, d = 0.1, b = 0.2 }
        coordinates = { x = 0, y = 0, th = 0.3 }
        inputs = { FL = 1, FR = 2 }
        [bodies.car]
        mass = "m"
        inertia = "J"
        center = ["d", 0]
        points = { L = [0, "b"], R = [0, "-b"] }
        joint = { kind = "planar", x = "x", y = "y", angle = "th" }
        [constraints]
        axle = { kind = "skate", point = "car.origin", along = [1, 0] }
        [forces]
        left = { kind = "force", point = "car.L", axes = "car", force = ["FL", 0] }
        right = { kind = "force", point = "car.R", axes = "car", force = ["FR", 0] }
    """
    equations = eomgen.derive(eomgen.loads(text))
    rhs, inverse = equations.rhs("numpy"), equations.inverse_dynamics(actuated=["FL", "FR"])
    th, v, w, dv, dw = 0.7, 1.3, -0.8, 0.5, 2.1
    ahead, left = np.array([np.cos(th), np.sin(th)]), np.array([-np.sin(th), np.cos(th)])
    x, a = [0.1, 0.2, th, *(v * ahead), w], [*(dv * ahead + v * w * left), dw]
    total, difference = 5 * (dv - 0.1 * w**2), ((0.3 + 5 * 0.01) * dw + 5 * 0.1 * v * w) / 0.2
    tau = inverse.function("numpy")(0, x, a, rhs.p0)
    assert tau == pytest.approx([(total - difference) / 2, (total + difference) / 2], rel=1e-12)
    assert rhs(0, x, rhs.p0, tau)[3:] == pytest.approx(a, rel=1e-12)


def test_the_crank_of_an_engine_takes_the_power_of_its_parts():
    """tau = sum of m r_c' . r_c'' + J b' b'' - F . r_c', all derivatives by the crank's angle."""
    text = """
        eomgen = 1
        space = "plane"
        parameters = { r = 0.1, l = 0.35, m1 = 1, m2 = 0.7, m3 = 2, g = 9.81, k = 50, c = 3 }
        coordinates = { a = 0.7, b = { dependent = true, near = -0.2 }, x = { dependent = true, near = 0.4 } }
        [bodies.crank]
        shape = { kind = "rod", mass = "m1", length = "r" }
        joint = { kind = "revolute", angle = "a" }
        [bodies.rod]
        shape = { kind = "rod", mass = "m2", length = "l" }
        joint = { kind = "revolute", on = "crank.end", angle = "b - a" }
        [bodies.piston]
        mass = "m3"
        inertia = 1
        joint = { kind = "prismatic", axis = [1, 0], displacement = "x", damping = "c", stiffness = "k", rest = 0.3 }
        [constraints]
        pin = { kind = "pin", points = ["rod.end", "piston.origin"] }
        [forces]
        weight = { kind = "gravity", acceleration = [0, "-g"] }
    """
    model = eomgen.loads(text)
    function = eomgen.inverse_dynamics(model, actuated=["crank"]).function("numpy")
    masses = np.array([1, 1, 0.01 / 12, 0.7, 0.7, 0.7 * 0.35**2 / 12, 2])

    def places(a):
        b = -np.arcsin(0.1 * np.sin(a) / 0.35)
        middle = 0.1 * np.cos(a) + 0.175 * np.cos(b), 0.1 * np.sin(a) + 0.175 * np.sin(b)
        return np.array([0.05 * np.cos(a), 0.05 * np.sin(a), a, *middle, b, 0.1 * np.cos(a) + 0.35 * np.cos(b)])

    def slopes(a):
        return np.imag(places(a + 1j * H)) / H

    for a, w, dw in ((0.4, 5, -9), (-2, 3, 4), (3, -6, 1)):
        place, slope, h = places(a), slopes(a), 1e-5
        bend = (slopes(a + h) - slopes(a - h)) / (2 * h)
        forces = np.array([0, -G, 0, 0, -0.7 * G, 0, -50 * (place[6] - 0.3) - 3 * slope[6] * w])
        tau = slope @ (masses * (slope * dw + bend * w**2) - forces)
        found = function(0, [a, place[5], place[6], w], [dw], [0.1, 0.35, 1, 0.7, 2, G, 50, 3])
        assert found == pytest.approx([tau], rel=1e-7)


def test_a_body_that_floats_with_an_arm_by_newton_and_euler():
    text = """
        eomgen = 1
        space = "space"
        coordinates = { x = 0, y = 0, z = 0, e0 = 1, e1 = 0.2, e2 = -0.1, e3 = 0.3, q = 0.5 }
        speeds = { w1 = { start = 0.1 }, w2 = {}, w3 = {} }
        [bodies.base]
        mass = 10
        inertia = [1, 2, 2.5, 0.1, 0.05, -0.2]
        [bodies.base.joint]
        kind = "free"
        position = ["x", "y", "z"]
        orientation = "quaternion"
        quaternion = ["e0", "e1", "e2", "e3"]
        omega = ["w1", "w2", "w3"]
        [bodies.arm]
        mass = 4
        center = [0.4, 0, 0.1]
        inertia = [0.1, 0.3, 0.35]
        joint = { kind = "revolute", on = "base", at = [0.5, 0.1, 0], axis = [0, 1, 1], angle = "q" }
    """
    model = eomgen.loads(text)
    function = eomgen.inverse_dynamics(model).function("numpy")
    speeds = eomgen.derive(model).speeds
    random = np.random.default_rng(1)
    e, u, a = random.normal(size=4), random.normal(size=7), random.normal(size=7)
    e, cross = e / np.linalg.norm(e), np.cross
    U, A = (dict(zip(speeds, each, strict=True)) for each in (u, a))
    w, dw = (np.array([each[f"w{k}"] for k in (1, 2, 3)]) for each in (U, A))

    def skew(v):
        return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])

    ground = np.eye(3) + 2 * e[0] * skew(e[1:]) + 2 * skew(e[1:]) @ skew(e[1:])
    axis, angle = np.array([0, 1, 1]) / np.sqrt(2), 0.8
    turn = np.eye(3) + np.sin(angle) * skew(axis) + (1 - np.cos(angle)) * skew(axis) @ skew(axis)
    inertia = np.array([[1, 0.1, -0.2], [0.1, 2, 0.05], [-0.2, 0.05, 2.5]])
    first = ground.T @ [A["x'"], A["y'"], A["z'"]]  # all in the axes of the base
    W, dW = w + axis * U["q'"], dw + axis * A["q'"] + cross(w, axis) * U["q'"]
    hinge, s = np.array([0.5, 0.1, 0]), turn @ [0.4, 0, 0.1]
    second = first + cross(dw, hinge) + cross(w, cross(w, hinge)) + cross(dW, s) + cross(W, cross(W, s))
    own = turn @ np.diag([0.1, 0.3, 0.35]) @ turn.T
    couple = own @ dW + cross(W, own @ W)
    total = inertia @ dw + cross(w, inertia @ w) + couple + 4 * cross(hinge + s, second)
    x = [*random.normal(size=3), *e, angle, *u]
    tau = dict(zip(speeds, function(0, x, a, []), strict=True))
    assert [tau["x'"], tau["y'"], tau["z'"]] == pytest.approx(ground @ (10 * first + 4 * second), rel=1e-12)
    assert [tau["w1"], tau["w2"], tau["w3"]] == pytest.approx(total, rel=1e-12)
    assert tau["q'"] == pytest.approx(axis @ (couple + 4 * cross(s, second)), rel=1e-12)


# -- where a run ends -----------------------------------------------------------------------------


def period() -> float:
    """Of the rod that swings to 1 rad, by the complete elliptic integral."""
    from scipy.special import ellipk

    return 4 * ellipk(np.sin(0.5) ** 2) / np.sqrt(1.5 * G)


@pytest.mark.parametrize(
    ("until", "part"),
    [
        ("speed(arm.end) = 0", 1 / 2),
        ("kinetic_energy() = 0", 1 / 2),
        ("q' = 0", 1 / 2),
        ("q = 0", 1 / 4),
        ("y(arm.end) = -1", 1 / 4),
        ("abs(q) = 0", 1 / 4),
        ("q = 1", 1),
        ("q'' = 0", 1 / 4),
    ],
)
def test_a_run_ends_where_the_condition_holds_though_it_may_only_touch(until, part):
    """Speeds, squares and turning points touch zero and turn back."""
    run = ran(SWING, 10, until=until)
    assert run.status == "event" and run.t[-1] == pytest.approx(part * period(), abs=2e-4 if until == "q = 1" else 1e-6)


def test_what_is_only_nearly_reached_is_not_reached():
    assert ran(SWING, 5, until="q = 1.00001").status == "finished"
    with pytest.raises(UsageError, match="it holds always or never"):
        ran(SWING, 5, until="q = q")


def test_a_condition_that_holds_as_phases_change_ends_the_run():
    """Pushed by F = 20 N for half a second, the block rests again after v/(mu g); thrown down, it stops as it lands."""
    v = (10 - 0.3 * G) / 2
    rest = 1 + v / (0.3 * G)
    for until in ("x' = 0", "speed(b.origin) = 0"):
        run = ran(PUSHED.replace("HEIGHT", "0"), 5, until=until)
        assert run.status == "event" and run.t[-1] == pytest.approx(rest, abs=1e-6) and len(run.phases) == 2
        assert run["x"][-1] == pytest.approx(v / 4 + v**2 / (0.6 * G), abs=1e-6)
    run = ran(PUSHED.replace("HEIGHT", "2"), 5, until="y' = 0")
    assert (
        run.status == "event"
        and run.t[-1] == pytest.approx(np.sqrt(4 / G), abs=1e-6)
        and abs(run["y'"][-1]) < tolerances.COMPUTED
    )
    assert "closes" in run.phases[0].ended_by


# -- what is refused ------------------------------------------------------------------------------


def test_what_is_driven_starts_where_its_motion_says():
    with pytest.raises(UsageError, match="'phi' starts where its `motion` says"):
        ran(BEAD, start=_Once(phi=5))


class _Once(dict):
    """A mapping that may stand among the arguments of a cached function."""

    def __hash__(self) -> int:
        return id(self)


@pytest.mark.parametrize(
    ("words", "reported"),
    [
        (("simulate", "--project-every", "5", "--stabilize", "none"), "--project-every goes with"),
        (("simulate", "--baumgarte", "5", "5"), "--baumgarte goes with --stabilize baumgarte"),
        (("simulate", "--follow", "e0=FILE"), "'e0' is driven, but it is part of the quaternion"),
    ],
)
def test_options_that_would_be_ignored_are_refused(tmp_path, words, reported):
    model, file = tmp_path / "top.toml", tmp_path / "e0.csv"
    model.write_text(TOP)
    file.write_text("t,e0\n0,1\n1,0.9\n")
    verb, *options = (word.replace("FILE", str(file)) for word in words)
    done = CliRunner().invoke(main, [verb, str(model), *options])
    assert done.exit_code == 2 and reported in done.output + (done.stderr or "")
