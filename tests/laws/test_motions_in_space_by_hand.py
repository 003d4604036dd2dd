"""Systems in space, turning frames and gyroscopes among them, beside laws written by hand and solved by scipy."""

from __future__ import annotations

import numpy as np
import pytest
from by_hand import Collection, Known, agree
from scipy.integrate import solve_ivp
from slow_run import sampled, usual

pytestmark = pytest.mark.slow

SYSTEMS = Collection()
FRAME = """
[bodies.frame]
joint = { kind = "revolute", angle = "psi" }
"""


def last(law, time, *start):
    """Where y' = law(t, y) is at a time, by scipy with hardly an error."""
    return solve_ivp(law, (0, time), start, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]


@SYSTEMS.system(
    "space",
    """
[coordinates]
psi = { motion = "n*t" }
r = { start = "r0" }
[bodies.bead]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", on = "frame", axis = [1, 0, 0], displacement = "r" }
[outputs]
side = { value = "reaction_y(bead, frame)", at = "t = 1/2" }
below = "reaction_z(bead)"
M = { value = "drive(psi)", at = "t = 1/2" }
"""
    + FRAME,
    {"m": 0.2, "n": 3, "r0": 0.1, "g": 9.81},
)
def bead_on_a_turning_rod(m, n, r0, g):
    """r = r0 cosh(n t); the rod pushes with 2 m n r'."""
    r, v = r0 * np.cosh(n / 2), r0 * n * np.sinh(n / 2)
    run = {"r": r0 * np.cosh(n), "r'": r0 * n * np.sinh(n)}
    return Known({"side": 2 * m * n * v, "below": m * g, "M": 2 * m * n * v * r}, time=1, run=run)


@SYSTEMS.system(
    "space",
    """
[coordinates]
psi = { motion = "n*t" }
x = { start = 0.3 }
[bodies.bead]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", on = "frame", at = ["x", 0, "a*x^2"] }
[linearize]
about = "equilibrium"
[outputs]
e = "x''"
"""
    + FRAME,
    {"m": 1, "a": 2, "g": 9.81},
    {"n": 3},
    {"n": 5},
)
def bead_on_a_turning_parabola(m, a, g, n):
    """(1 + 4 a^2 x^2) x'' + 4 a^2 x x'^2 = (n^2 - 2 g a) x"""

    def law(_, y):
        return y[1], ((n**2 - 2 * g * a) * y[0] - 4 * a**2 * y[0] * y[1] ** 2) / (1 + 4 * a**2 * y[0] ** 2)

    x, v = last(law, 1.5, 0.3, 0)
    return Known({"e": law(0, (0.3, 0))[1]}, {}, [np.sqrt(2 * g * a - n**2)], 1.5, {"x": x, "x'": v})


@SYSTEMS.system(
    "space",
    """
[coordinates]
psi = { motion = "n*t" }
q = { start = 1 }
[bodies.rod]
shape = { kind = "rod", mass = "m", length = "L" }
joint = { kind = "revolute", on = "frame", axis = [0, 1, 0], angle = "pi/2 - q" }
[linearize]
about = "equilibrium"
[outputs]
e = "q''"
M = "drive(psi)"
"""
    + FRAME,
    {"m": 1.5, "L": 0.9, "n": 6, "g": 9.81},
)
def rod_on_a_shaft(m, L, n, g):
    """Hinged to a turning shaft it rests at cos q = 3g/(2 L n^2), and swings about there with n sin q."""

    def law(_, y):
        return y[1], n**2 * np.sin(y[0]) * np.cos(y[0]) - 1.5 * g / L * np.sin(y[0])

    q0 = np.arccos(1.5 * g / (L * n**2))
    q, w = last(law, 1, 1, 0)
    return Known({"e": law(0, (1, 0))[1], "M": 0}, {}, [n * np.sin(q0)], 1, {"q": q, "q'": w})


@SYSTEMS.system(
    "space",
    """
[coordinates]
psi = { motion = "n*t" }
q = { start = 1 }
[bodies.left]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", on = "frame", at = ["-l*sin(q)", 0, "-l*cos(q)"] }
[bodies.right]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", on = "frame", at = ["l*sin(q)", 0, "-l*cos(q)"] }
[bodies.sleeve]
shape = { kind = "particle", mass = "M" }
joint = { kind = "prismatic", on = "frame", axis = [0, 0, 1], displacement = "-2*l*cos(q)" }
[linearize]
about = "equilibrium"
[outputs]
e = "q''"
"""
    + FRAME,
    {"m": 0.5, "M": 1, "l": 0.3, "n": 14, "g": 9.81},
)
def watt_governor(m, M, l, n, g):
    """cos q = (1 + M/m) g/(l n^2), omega^2 = n^2 sin^2 q/(1 + 2 (M/m) sin^2 q)"""

    def law(_, y):
        s, c = np.sin(y[0]), np.cos(y[0])
        force = 2 * m * l**2 * n**2 * s * c - 2 * (m + M) * g * l * s - 4 * M * l**2 * s * c * y[1] ** 2
        return y[1], force / (2 * m * l**2 + 4 * M * l**2 * s**2)

    q0 = np.arccos((1 + M / m) * g / (l * n**2))
    w = n * np.sin(q0) / np.sqrt(1 + 2 * M / m * np.sin(q0) ** 2)
    q, u = last(law, 1, 1, 0)
    return Known({"e": law(0, (1, 0))[1]}, {}, [w], 1, {"q": q, "q'": u})


@SYSTEMS.system(
    "space",
    """
[coordinates]
psi = { motion = "n*t" }
tilt = { dependent = true, near = 0 }
spin = { motion = "-b*n*t/R" }
[bodies.arm]
joint = { kind = "revolute", on = "frame", axis = [0, 1, 0], angle = "tilt" }
[bodies.stone]
shape = { kind = "disc", mass = "m", radius = "R" }
[bodies.stone.joint]
kind = "revolute"
on = "arm"
at = ["b", 0, 0]
turned = { axis = [0, 1, 0], angle = "pi/2" }
angle = "spin"
[constraints.pan]
kind = "rolling"
body = "stone"
axis = [0, 0, 1]
plane = { at = [0, 0, "-R"], normal = [0, 0, 1] }
slip = true
[outputs]
N = "reaction_n(pan)"
M = "drive(psi)"
"""
    + FRAME,
    {"m": 80, "R": 0.5, "b": 0.7, "g": 9.81},
    {"n": 2},
    {"n": 6},
)
def edge_mill(m, R, b, g, n):
    """A millstone on a turning axle presses with more than its weight: N = m g + m R n^2/2."""
    return Known({"N": m * g + m * R * n**2 / 2, "M": 0})


@SYSTEMS.system(
    "space",
    """
[coordinates]
psi = { motion = "n*t" }
[bodies.disc]
shape = { kind = "disc", mass = "m", radius = "R" }
joint = { kind = "fixed", on = "frame", axis = [1, 0, 0], angle = "delta" }
[outputs]
couple = "reaction_couple_x(frame, frame)"
other = "reaction_couple_y(frame, frame)"
L_z = "angular_momentum_z(disc.center)"
"""
    + FRAME,
    {"m": 3, "R": 0.2, "n": 100},
    *({"delta": angle} for angle in ("pi/6", "pi/4", "pi/3", "pi/2")),
)
def skew_disc(m, R, n, delta):
    """A disc askew on its shaft shakes the bearings: (C - A) n^2 sin cos."""
    A, s, c = m * R**2 / 4, np.sin(delta), np.cos(delta)
    return Known({"couple": A * n**2 * s * c, "other": 0, "L_z": A * n * (1 + c**2)})


@SYSTEMS.system(
    "space",
    """
[coordinates]
psi = { motion = "alpha + n*t" }
spin = { motion = "w*t" }
[bodies.rotor]
shape = { kind = "cylinder", mass = "m", radius = "R", length = "R" }
joint = { kind = "revolute", on = "frame", turned = { axis = [0, 1, 0], angle = "pi/2" }, angle = "spin" }
[outputs]
M_y = "reaction_couple_y(rotor, frame)"
M_x = "drive(spin)"
M_z = "drive(psi)"
in_ground_x = "reaction_couple_x(rotor)"
"""
    + FRAME,
    {"m": 10, "R": 0.15, "n": 2, "w": 300, "g": 9.81},
    {"alpha": "pi/6"},
    {"alpha": "pi/3"},
)
def forced_precession(m, R, n, w, g, alpha):
    """A rotor that is led round pushes with C w n across both axes."""
    C = m * R**2 / 2
    return Known({"M_y": C * w * n, "M_x": 0, "M_z": 0, "in_ground_x": -C * w * n * np.sin(alpha)})


@SYSTEMS.system(
    "space",
    """
[coordinates]
s = { start = "s0" }
psi = { start = 0, speed = "sqrt(g*cos(al)/s0)/sin(al)" }
[bodies.P]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["s*sin(al)*cos(psi)", "s*sin(al)*sin(psi)", "s*cos(al)"] }
[linearize]
about = "start"
coordinates = ["s"]
[outputs]
e = "s''"
a = "acceleration(P.center)"
""",
    {"m": 1, "s0": 0.5, "g": 9.81},
    {"al": "pi/6"},
    {"al": "pi/4"},
)
def ball_in_a_funnel(m, s0, g, al):
    """It goes round at one height, and about that with sqrt(3) sin(al) psi' up and down."""
    rate = np.sqrt(g * np.cos(al) / s0) / np.sin(al)
    a = s0 * np.sin(al) * rate**2
    run = {"s": s0, "psi": rate * 1.5}
    return Known({"e": 0, "a": a}, {}, [np.sqrt(3) * np.sin(al) * rate], 1.5, run)


@SYSTEMS.system(
    "space",
    """
[coordinates]
q = 0
[bodies.nut]
shape = { kind = "disc", mass = "m", radius = "R" }
joint = { kind = "screw", axis = [0, 0, 1], angle = "q", pitch = "p" }
[outputs]
e = "q''"
down = { value = "t", at = "q = -4*pi" }
""",
    {"m": 0.3, "R": 0.04, "p": 0.01, "g": 9.81},
)
def nut_on_a_screw(m, R, p, g):
    """(R^2/2 + p^2) q'' = -g p"""
    e = -g * p / (R**2 / 2 + p**2)
    return Known({"e": e, "down": np.sqrt(8 * np.pi / -e)}, {}, (), 0.5, {"q": e / 8, "q'": e / 2})


@SYSTEMS.system(
    "space",
    """
[coordinates]
x = 0
y = 0
z = 0
[bodies.ion]
shape = { kind = "particle", mass = "m" }
joint = { kind = "free", position = ["x", "y", "z"], orientation = "xyz", angles = [0, 0, 0] }
[forces.lorentz]
kind = "force"
point = "ion.center"
force = ["B*y'", "E - B*x'", "F"]
""",
    {"m": 2, "B": 6, "E": 3, "F": 1},
)
def ion_in_crossed_fields(m, B, E, F):
    """From rest it drifts across both fields on a cycloid: x = (E/B)(t - sin(w t)/w)."""
    w, d, t = B / m, E / B, 2.0
    run = {"x": d * (t - np.sin(w * t) / w), "y": d / w * (1 - np.cos(w * t)), "z": F / m * t**2 / 2}
    return Known(time=t, run=run)


@SYSTEMS.system(
    "space",
    """
[coordinates]
x = { speed = "v" }
y = 0
z = { start = "R" }
e0 = 1
e1 = 0
e2 = 0
e3 = 0
[speeds]
w1 = {}
w2 = { start = "v/R" }
w3 = { start = 5 }
[bodies.ball]
shape = { kind = "sphere", mass = "m", radius = "R" }
[bodies.ball.joint]
kind = "free"
position = ["x", "y", "z"]
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]
[constraints.slope]
kind = "rolling"
body = "ball"
plane = { at = [0, 0, 0], normal = [0, 0, 1] }
[forces.pull]
kind = "gravity"
acceleration = [0, "-G*sin(alpha)", "-G*cos(alpha)"]
[outputs]
a = "ay(ball.center)"
N = "reaction_n(slope)"
F = "reaction_s(slope)"
""",
    {"m": 2, "R": 0.1, "v": 1, "G": 9.81},
    {"alpha": "pi/6"},
    {"alpha": "pi/4"},
)
def ball_across_a_slope(m, R, v, G, alpha):
    """A rolling ball falls aside on a parabola, with 5/7 of g sin(alpha), whatever its spin."""
    a = -5 / 7 * G * np.sin(alpha)
    F = m * (a + G * np.sin(alpha))
    run = {"x": v * 0.8, "y": a * 0.32}
    return Known({"a": a, "N": m * G * np.cos(alpha), "F": F}, time=0.8, run=run)


@SYSTEMS.system(
    "space",
    """
[coordinates]
a = 0.3
b = { start = 0.2, speed = 1 }
[bodies.yoke]
joint = { kind = "revolute", axis = [1, 0, 0], angle = "a" }
[bodies.plate]
mass = "m"
inertia = ["A", "B", "C"]
points = { hook = [0, 0, "l"] }
joint = { kind = "revolute", on = "yoke", point = "hook", axis = [0, 1, 0], angle = "b" }
[linearize]
about = "equilibrium"
""",
    {"m": 2, "A": 0.1, "B": 0.25, "C": 0.3, "l": 0.4, "g": 9.81},
)
def plate_on_a_universal_joint(m, A, B, C, l, g):
    """T of w = (a' cos b, b', a' sin b): it swings with m g l/(A + m l^2) and m g l/(B + m l^2) about the two axes."""
    A, B = A + m * l**2, B + m * l**2

    def law(_, y):
        a, b, u, w = y
        s, c = np.sin(b), np.cos(b)
        I = A * c**2 + C * s**2
        du = (2 * (A - C) * s * c * u * w - m * g * l * np.sin(a) * c) / I
        dw = ((C - A) * s * c * u**2 - m * g * l * np.cos(a) * s) / B
        return u, w, du, dw

    a, b, u, w = last(law, 1, 0.3, 0.2, 0, 1)
    run = {"a": a, "b": b, "a'": u, "b'": w}
    return Known({}, {}, [np.sqrt(m * g * l / A), np.sqrt(m * g * l / B)], 1, run)


@sampled(2)
@pytest.mark.parametrize("name", usual([*SYSTEMS], 3, 2))
def test_a_motion_in_space_is_the_one_by_hand(name):
    """Accelerations, couples, frequencies and the place at the end of a run, each by its own law."""
    agree(SYSTEMS[name])
