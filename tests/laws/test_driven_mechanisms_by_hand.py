"""Driven mechanisms at nice angles, where formulas cancel: places differentiated, every body cut free by hand.

By default each second one; all by

    EOMGEN_ALL_MODELS=1 python -m pytest -q tests/laws/test_driven_mechanisms_by_hand.py
"""

from __future__ import annotations

import numpy as np
import pytest
from by_hand import Collection, Free, Known, agree, balance, differences, meeting
from mpmath import asin, atan2, cos, sin, sqrt
from slow_run import sampled, usual

pytestmark = pytest.mark.slow

SYSTEMS = Collection()
X, Y = (1.0, 0.0), (0.0, 1.0)
NICE = tuple({"alpha": angle} for angle in ("0", "pi/6", "pi/4", "pi/3", "pi/2", "2*pi/3"))


def free(m, J, path, **kw):
    """A body cut free, from its path t -> (x, y, angle)."""
    p, _, a = differences(path)
    return Free(m, J, (p[0], p[1]), tuple(a), **kw)


CRANK = """
[bodies.crank]
shape = { kind = "rod", mass = "m1", length = "r" }
joint = { kind = "revolute", angle = "theta" }
"""


@SYSTEMS.system(
    "plane",
    """
[coordinates]
theta = { motion = "alpha + n*t" }
beta = { dependent = true, near = 0 }
x = { dependent = true, near = "r + l" }
"""
    + CRANK
    + """
[bodies.rod]
shape = { kind = "rod", mass = "m2", length = "l" }
joint = { kind = "revolute", on = "crank.end", angle = "beta - theta" }
[bodies.piston]
shape = { kind = "particle", mass = "m3" }
joint = { kind = "prismatic", axis = [1, 0], at = [0, "e"], displacement = "x" }
[constraints.B]
kind = "pin"
points = ["rod.end", "piston.origin"]
[outputs]
a = "ax(piston.origin)"
epsilon = "epsilon(rod)"
M = "drive(theta)"
""",
    {"r": 0.1, "l": 0.25, "e": 0.05, "m1": 1.5, "m2": 2, "m3": 3, "n": 80, "g": 9.81},
    *NICE,
    *({**angle, "e": 0} for angle in NICE[1:4]),
)
def slider_crank(r, l, e, m1, m2, m3, n, g, alpha):
    """Crank, rod and piston on a line that misses the crank's axle by e."""

    def beta(t):
        return asin((e - r * sin(alpha + n * t)) / l)

    def B(t):
        return r * cos(alpha + n * t) + l * cos(beta(t)), e, 0

    def rod(t):
        th, be = alpha + n * t, beta(t)
        return r * cos(th) + l * cos(be) / 2, r * sin(th) + l * sin(be) / 2, be

    bodies = {
        "crank": free(m1, m1 * r**2 / 12, lambda t: (r / 2 * cos(alpha + n * t), r / 2 * sin(alpha + n * t), n * t)),
        "rod": free(m2, m2 * l**2 / 12, rod),
        "piston": free(m3, 0, B),
    }
    pin, A = bodies["piston"].G, (r * np.cos(alpha), r * np.sin(alpha))
    forces = balance(
        bodies,
        {
            "reaction_x(crank)": ("crank", None, (0, 0), X),
            "reaction_y(crank)": ("crank", None, (0, 0), Y),
            "drive(theta)": ("crank", None, None, None),
            "reaction_x(rod)": ("rod", "crank", A, X),
            "reaction_y(rod)": ("rod", "crank", A, Y),
            "reaction_x(B)": ("rod", "piston", pin, X),
            "reaction_y(B)": ("rod", "piston", pin, Y),
            "reaction_n(piston)": ("piston", None, pin, Y),
            "reaction_couple(piston)": ("piston", None, None, None),
        },
        g,
    )
    assert forces.pop("reaction_couple(piston)") == pytest.approx(0, abs=1e-9)  # a particle: no couple to ask for
    a, epsilon = bodies["piston"].a[0], bodies["rod"].a[2]
    return Known({"a": a, "epsilon": epsilon, "M": forces["drive(theta)"]}, forces)


@SYSTEMS.system(
    "plane",
    """
[coordinates]
theta = { motion = "alpha + n*t" }
beta = { dependent = true, near = 0.5 }
gamma = { dependent = true, near = 1.6 }
"""
    + CRANK
    + """
[bodies.coupler]
shape = { kind = "rod", mass = "m2", length = "l" }
joint = { kind = "revolute", on = "crank.end", angle = "beta - theta" }
[bodies.rocker]
shape = { kind = "rod", mass = "m3", length = "c" }
joint = { kind = "revolute", at = ["d", 0], angle = "gamma" }
[constraints.B]
kind = "pin"
points = ["coupler.end", "rocker.end"]
[outputs]
w = "omega(rocker)"
epsilon = "epsilon(rocker)"
""",
    {"r": 0.2, "l": 0.5, "c": 0.4, "d": 0.5, "m1": 1, "m2": 2, "m3": 1.6, "n": 30, "g": 9.81},
    *NICE,
)
def four_bar(r, l, c, d, m1, m2, m3, n, g, alpha):
    """A crank that turns evenly rocks a bar through a coupler; all three are heavy."""

    def ends(t):
        A = r * cos(alpha + n * t), r * sin(alpha + n * t)
        return A, meeting(A, l, (d, 0), c, 1)

    def coupler(t):
        (ax, ay), (bx, by) = ends(t)
        return (ax + bx) / 2, (ay + by) / 2, atan2(by - ay, bx - ax)

    def rocker(t):
        _, (bx, by) = ends(t)
        return (d + bx) / 2, by / 2, atan2(by, bx - d)

    bodies = {
        "crank": free(m1, m1 * r**2 / 12, lambda t: (r / 2 * cos(alpha + n * t), r / 2 * sin(alpha + n * t), n * t)),
        "coupler": free(m2, m2 * l**2 / 12, coupler),
        "rocker": free(m3, m3 * c**2 / 12, rocker),
    }
    A, B = (tuple(float(value) for value in point) for point in ends(0))
    cuts = {"drive(theta)": ("crank", None, None, None)}
    for name, on, against, point in (
        ("crank", "crank", None, (0, 0)),
        ("coupler", "coupler", "crank", A),
        ("B", "coupler", "rocker", B),
        ("rocker", "rocker", None, (d, 0)),
    ):
        cuts[f"reaction_x({name})"] = (on, against, point, X)
        cuts[f"reaction_y({name})"] = (on, against, point, Y)
    w = differences(rocker)[1][2]
    return Known({"w": w, "epsilon": bodies["rocker"].a[2]}, balance(bodies, cuts, g))


LEVER = """
[coordinates]
theta = { motion = "alpha + n*t" }
phi = { dependent = true, near = "atan2(d + r*sin(alpha), r*cos(alpha))" }
[bodies.crank]
points = { P = ["r", 0] }
joint = { kind = "revolute", angle = "theta" }
[bodies.lever]
shape = { kind = "rod", mass = "m", length = "L" }
line = ["start", "end"]
joint = { kind = "revolute", at = [0, "-d"], angle = "phi", damping = "c" }
[constraints.block]
kind = "slider"
point = "crank.P"
on = "lever"
[outputs]
w = "omega(lever)"
epsilon = "epsilon(lever)"
v = "vx(crank.P, lever)"
a_C = "coriolis_acceleration(crank.P, lever)"
M = "drive(theta)"
"""


@SYSTEMS.system(
    "plane",
    LEVER,
    {"r": 0.2, "d": 0.1, "L": 0.5, "m": 4, "c": 0.3, "n": 12, "g": 9.81},
    *NICE,
    *({**angle, "d": 0.4} for angle in NICE[1:4]),
)
def quick_return(r, d, L, m, c, n, g, alpha):
    """The crank's pin in the slot of a heavy lever: Whitworth's with d < r, the crank-shaper's with d > r."""

    def P(t):
        return r * cos(alpha + n * t), d + r * sin(alpha + n * t)

    phi, w, epsilon = (row[0] for row in differences(lambda t: (atan2(*P(t)[::-1]),)))
    s, v, _ = (row[0] for row in differences(lambda t: (sqrt(P(t)[0] ** 2 + P(t)[1] ** 2),)))
    N = -(m * L**2 / 3 * epsilon + c * w + m * g * L / 2 * np.cos(phi)) / s  # on the pin, to the left of the lever
    M = -r * N * np.cos(phi - alpha)
    R = {"reaction_n(block)": N, "drive(theta)": M}
    R |= {"reaction_x(crank)": N * np.sin(phi), "reaction_y(crank)": -N * np.cos(phi)}
    return Known({"w": w, "epsilon": epsilon, "v": v, "a_C": 2 * abs(w * v), "M": M}, R)


@SYSTEMS.system(
    "plane",
    """
[coordinates]
theta = { motion = "alpha + n*t" }
psi = { dependent = true, near = "atan2(r*sin(alpha), r*cos(alpha) - sqrt(2)*r)" }
[bodies.crank]
points = { P = ["r", 0] }
joint = { kind = "revolute", angle = "theta" }
[bodies.wheel]
mass = 2
inertia = "J"
points = { slot = [1, 0] }
line = ["origin", "slot"]
joint = { kind = "revolute", at = ["sqrt(2)*r", 0], angle = "psi", damping = "c" }
[constraints.pin]
kind = "slider"
point = "crank.P"
on = "wheel"
[outputs]
w = "omega(wheel)"
epsilon = "epsilon(wheel)"
N = "reaction_n(pin)"
M = "drive(theta)"
""",
    {"r": 0.1, "J": 0.02, "c": 0.01, "n": 6},
    *({"alpha": angle} for angle in ("-pi/4", "-pi/6", "0", "pi/6", "pi/8")),
)
def geneva(r, J, c, n, alpha):
    """The wheel of a Geneva drive of four slots while the pin is in one: tan psi = sin/(cos - sqrt 2)."""
    k = float(sqrt(2))
    D = 1 + k * k - 2 * k * np.cos(alpha)
    w = n * (1 - k * np.cos(alpha)) / D
    epsilon = n**2 * k * np.sin(alpha) * (k * k - 1) / D**2
    lever = r * np.sqrt(D)
    N = -(J * epsilon + c * w) / lever
    return Known({"w": w, "epsilon": epsilon, "N": N, "M": (J * epsilon + c * w) * w / n})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
theta = { motion = "alpha + n*t" }
x = { dependent = true, near = "r*cos(alpha) - r*sin(alpha)/tan(beta)" }
[bodies.crank]
points = { P = ["r", 0] }
joint = { kind = "revolute", angle = "theta" }
[bodies.yoke]
mass = "m"
points = { S = ["cos(beta)", "sin(beta)"] }
line = ["origin", "S"]
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k" }
[constraints.slot]
kind = "slider"
point = "crank.P"
on = "yoke"
[outputs]
v = "x'"
a = "x''"
""",
    {"r": 0.3, "m": 5, "k": 200, "n": 7, "g": 9.81},
    *({"alpha": a, "beta": b} for a in ("pi/6", "pi/3", "pi/2") for b in ("pi/4", "pi/3")),
)
def inclined_yoke(r, m, k, n, g, alpha, beta):
    """A Scotch yoke whose slot leans by beta: x = r cos(theta) - r sin(theta) cot(beta)."""
    cot = 1 / np.tan(beta)
    x = r * np.cos(alpha) - r * np.sin(alpha) * cot
    v, a = n * (-r * np.sin(alpha) - r * np.cos(alpha) * cot), -(n**2) * x
    N = (m * a + k * x) / np.sin(beta)
    R = {"reaction_n(slot)": N, "reaction_n(yoke)": m * g + N * np.cos(beta)}
    R["drive(theta)"] = -N * r * np.cos(alpha - beta)
    return Known({"v": v, "a": a}, R)


@SYSTEMS.system(
    "plane",
    """
[coordinates]
theta = { motion = "alpha + n*t" }
y = { dependent = true, near = "R + e*sin(alpha)" }
[bodies.cam]
points = { axle = ["-e", 0] }
joint = { kind = "revolute", point = "axle", angle = "theta" }
[bodies.follower]
mass = "m"
joint = { kind = "prismatic", axis = [0, 1], displacement = "y", stiffness = "k", rest = "R - e" }
[constraints.face]
kind = "rolling"
body = "cam"
radius = "R"
on = "follower"
line = { at = [0, 0], normal = [0, -1] }
slip = true
[outputs]
v = "y'"
a = "y''"
""",
    {"R": 0.3, "e": 0.1, "m": 2, "k": 900, "n": 15, "g": 9.81},
    *NICE,
)
def flat_follower(R, e, m, k, n, g, alpha):
    """An eccentric disc lifts a flat face: y = R + e sin(theta), the contact e cos(theta) aside."""
    y, a = R + e * np.sin(alpha), -(n**2) * e * np.sin(alpha)
    N = m * (a + g) + k * (y - R + e)
    arm = e * np.cos(alpha)
    R_ = {"reaction_n(face)": N, "drive(theta)": N * arm, "reaction_couple(follower)": -N * arm}
    return Known({"v": n * arm, "a": a}, R_ | {"reaction_x(cam)": 0, "reaction_y(cam)": N})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
s = { motion = "s0 + v*t" }
y = { dependent = true, near = "a*s0^2" }
[bodies.cam]
mass = 1
joint = { kind = "prismatic", axis = [1, 0], displacement = "s" }
[bodies.follower]
mass = "m"
joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
[constraints.profile]
kind = "equation"
gap = "y(follower.origin, cam) - a*x(follower.origin, cam)^2"
[outputs]
lift = "y''"
lam = "multiplier(profile)"
push = "drive(s)"
aside = "reaction_n(follower)"
""",
    {"a": 1.5, "v": 2, "m": 0.8, "g": 9.81},
    {"s0": 0},
    {"s0": 0.25},
    {"s0": -0.5},
)
def parabolic_cam(a, v, m, g, s0):
    """A sliding cam y = a x^2 lifts a point with the constant acceleration 2 a v^2."""
    lam = m * (2 * a * v**2 + g)
    return Known({"lift": 2 * a * v**2, "lam": lam, "push": 2 * a * s0 * lam, "aside": 2 * a * s0 * lam})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
theta = { motion = "alpha + n*t" }
s = { dependent = true, near = "e*cos(alpha)" }
psi = { dependent = true, near = "alpha" }
[bodies.shaft]
joint = { kind = "revolute", angle = "theta" }
[bodies.disc]
shape = { kind = "disc", mass = "m", radius = "e" }
joint = { kind = "prismatic", on = "shaft", axis = [1, 0], displacement = "s" }
[bodies.driven]
mass = 1
inertia = 0.1
joint = { kind = "revolute", at = ["e", 0], angle = "psi", damping = "c" }
[constraints.key]
kind = "equation"
gap = "x(driven.origin, disc)"
[constraints.turn]
kind = "equation"
gap = "angle(driven) - angle(disc)"
[outputs]
w = "psi'"
a = "acceleration(disc.center)"
M = "drive(theta)"
n1 = "reaction_n(disc)"
""",
    {"e": 0.02, "m": 3, "c": 0.4, "n": 50},
    *NICE[:5],
)
def oldham(e, m, c, n, alpha):
    """The floating disc between two parallel shafts runs round a circle of the diameter e, at 2 n."""
    a = 2 * n**2 * e * np.array([-np.cos(2 * alpha), -np.sin(2 * alpha)])
    left = np.array([-np.sin(alpha), np.cos(alpha)])
    return Known({"w": n, "a": 2 * n**2 * e, "M": c * n, "n1": m * float(a @ left)})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
theta = { motion = "alpha + n*t" }
beta = { dependent = true, near = "atan2(-r*sin(alpha), d - r*cos(alpha))" }
"""
    + CRANK
    + """
[points]
D = ["d", 0]
[bodies.rod]
shape = { kind = "rod", mass = "m2", length = "L" }
line = ["start", "end"]
joint = { kind = "revolute", on = "crank.end", angle = "beta - theta" }
[constraints.block]
kind = "slider"
point = "D"
on = "rod"
[outputs]
w = "omega(rod)"
epsilon = "epsilon(rod)"
""",
    {"r": 0.1, "d": 0.3, "L": 0.5, "m1": 0.5, "m2": 1.2, "n": 25, "g": 9.81},
    *NICE,
)
def oscillating_cylinder(r, d, L, m1, m2, n, g, alpha):
    """The rod of a crank slides through a block that turns about a fixed point."""

    def rod(t):
        x, y = r * cos(alpha + n * t), r * sin(alpha + n * t)
        beta = atan2(-y, d - x)
        return x + L / 2 * cos(beta), y + L / 2 * sin(beta), beta

    bodies = {
        "crank": free(m1, m1 * r**2 / 12, lambda t: (r / 2 * cos(alpha + n * t), r / 2 * sin(alpha + n * t), n * t)),
        "rod": free(m2, m2 * L**2 / 12, rod),
    }
    p, v, a = differences(rod)
    A = (r * np.cos(alpha), r * np.sin(alpha))
    cuts = {
        "reaction_x(crank)": ("crank", None, (0, 0), X),
        "reaction_y(crank)": ("crank", None, (0, 0), Y),
        "drive(theta)": ("crank", None, None, None),
        "reaction_x(rod)": ("rod", "crank", A, X),
        "reaction_y(rod)": ("rod", "crank", A, Y),
        "reaction_n(block)": ("rod", None, (d, 0), (-np.sin(p[2]), np.cos(p[2]))),
    }
    return Known({"w": v[2], "epsilon": a[2]}, balance(bodies, cuts, g))


@SYSTEMS.system(
    "plane",
    """
[coordinates]
phi = { start = "alpha", speed = "n" }
[bodies.A]
mass = "mA"
joint = { kind = "prismatic", axis = [1, 0], displacement = "L*cos(phi)", stiffness = "k" }
[bodies.B]
mass = "mB"
joint = { kind = "prismatic", axis = [0, 1], displacement = "L*sin(phi)" }
[bodies.rod]
shape = { kind = "rod", mass = "m", length = "L" }
joint = { kind = "revolute", on = "A", angle = "pi - phi" }
[constraints.pin]
kind = "pin"
points = ["rod.end", "B.origin"]
[outputs]
epsilon = "phi''"
T = "kinetic_energy()"
""",
    {"L": 0.8, "mA": 1, "mB": 2, "m": 3, "k": 40, "n": 3, "g": 9.81},
    *NICE[1:4],
)
def elliptic_trammel(L, mA, mB, m, k, n, g, alpha):
    """A rod between collars on two rails that cross: T = (m/6 + (mA sin^2 + mB cos^2)/2) L^2 phi'^2."""
    s, c = np.sin(alpha), np.cos(alpha)
    I = (m / 3 + mA * s**2 + mB * c**2) * L**2
    force = k * L**2 * c * s - (mB + m / 2) * g * L * c  # -dV/dphi
    epsilon = (force - (mA - mB) * s * c * L**2 * n**2) / I

    def angle(t):
        return alpha + n * t + epsilon * t**2 / 2

    def rod(t):
        return L / 2 * cos(angle(t)), L / 2 * sin(angle(t)), -angle(t)

    bodies = {
        "A": free(mA, 0, lambda t: (L * cos(angle(t)), 0, 0), load=(-k * L * c, 0, 0)),
        "B": free(mB, 0, lambda t: (0, L * sin(angle(t)), 0)),
        "rod": free(m, m * L**2 / 12, rod),
    }
    at_A, at_B = (L * c, 0), (0, L * s)
    cuts = {
        "reaction_n(A)": ("A", None, at_A, Y),
        "reaction_n(B)": ("B", None, at_B, (-1, 0)),
        "reaction_x(rod)": ("rod", "A", at_A, X),
        "reaction_y(rod)": ("rod", "A", at_A, Y),
        "reaction_x(pin)": ("rod", "B", at_B, X),
        "reaction_y(pin)": ("rod", "B", at_B, Y),
        "reaction_couple(A)": ("A", None, None, None),
        "reaction_couple(B)": ("B", None, None, None),
    }
    full = balance(bodies, cuts | {"free": ("rod", None, None, None)}, g)
    assert full.pop("free") == pytest.approx(0, abs=1e-9)  # phi'' is that of the balance too
    return Known({"epsilon": epsilon, "T": I * n**2 / 2}, full)


@SYSTEMS.system(
    "plane",
    """
[coordinates]
theta = { motion = "alpha + n*t" }
beta = { dependent = true, near = "b0" }
gamma = { dependent = true, near = "c0" }
[bodies.crank]
points = { A = [5, 0] }
joint = { kind = "revolute", angle = "theta" }
[bodies.coupler]
points = { P = [1, 0], B = [2, 0] }
joint = { kind = "revolute", on = "crank.A", angle = "beta - theta" }
[bodies.rocker]
points = { B = [5, 0] }
joint = { kind = "revolute", at = [4, 0], angle = "gamma" }
[constraints.B]
kind = "pin"
points = ["coupler.B", "rocker.B"]
[outputs]
x = "x(coupler.P)"
y = "y(coupler.P)"
vx = "vx(coupler.P)"
vy = "vy(coupler.P)"
ax = "ax(coupler.P)"
ay = "ay(coupler.P)"
rho = "curvature_radius(coupler.P)"
""",
    {"n": 2},
    {"alpha": "pi/4", "b0": -2.5, "c0": 1.97},
    {"alpha": "pi/3", "b0": -3.0, "c0": 2.3},
)
def chebyshev_line(n, alpha, b0, c0):
    """Crossed cranks 5 on a base 4 lead the middle of a coupler 2 along a line, almost."""

    def P(t):
        A = 5 * cos(alpha + n * t), 5 * sin(alpha + n * t)
        B = meeting(A, 2, (4, 0), 5, -1)
        return (A[0] + B[0]) / 2, (A[1] + B[1]) / 2

    p, v, a = differences(P)
    rho = np.hypot(*v) ** 3 / abs(v[0] * a[1] - v[1] * a[0])
    return Known({"x": p[0], "y": p[1], "vx": v[0], "vy": v[1], "ax": a[0], "ay": a[1], "rho": rho})


@sampled(3)
@pytest.mark.parametrize("name", usual(list(SYSTEMS), 4))
def test_a_driven_mechanism_moves_and_pushes_as_by_hand(name):
    """Velocities and accelerations by differences of places in 40 digits, forces by the balance of every body."""
    agree(SYSTEMS[name])
