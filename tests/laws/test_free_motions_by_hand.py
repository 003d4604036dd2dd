"""Systems of the plane that move freely, slide, land and swing, beside laws written by hand and solved by scipy."""

from __future__ import annotations

import numpy as np
import pytest
from by_hand import Collection, Free, Known, agree, balance
from scipy.integrate import solve_ivp
from slow_run import sampled, usual

pytestmark = pytest.mark.slow

SYSTEMS = Collection()


def last(law, time, *start):
    """Where y' = law(t, y) is at a time, by scipy with hardly an error."""
    return solve_ivp(law, (0, time), start, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]


@SYSTEMS.system(
    "plane",
    """
[coordinates]
turn = { motion = "n*t" }
phi = { start = "p0", speed = 0.5 }
[bodies.arm]
points = { P = ["a", 0] }
joint = { kind = "revolute", angle = "turn" }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
points = { top = [0, "l"] }
joint = { kind = "revolute", on = "arm.P", point = "top", angle = "phi - turn" }
[outputs]
e = "phi''"
""",
    {"a": 0.2, "l": 0.9, "n": 5, "m": 2, "g": 9.81},
    {"p0": "pi/6"},
    {"p0": "pi/2"},
)
def pendulum_on_a_crank(a, l, n, m, g, p0):
    """l phi'' = (g - a_P) . e: the pivot runs evenly round a circle."""

    def law(t, y):
        phi, w = y
        return w, (-g * np.sin(phi) + a * n**2 * np.cos(phi - n * t)) / l

    e = law(0, (p0, 0.5))[1]
    ax = -a * n**2 + l * (e * np.cos(p0) - 0.25 * np.sin(p0))
    ay = l * (e * np.sin(p0) + 0.25 * np.cos(p0))
    R = {"reaction_x(bob)": m * ax, "reaction_y(bob)": m * (ay + g), "drive(turn)": a * m * (ay + g)}
    phi, w = last(law, 1.5, p0, 0.5)
    return Known({"e": e}, R, time=1.5, run={"phi": phi, "phi'": w})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
s = { start = 0, speed = 0.2 }
[bodies.block]
shape = { kind = "particle", mass = "m1" }
joint = { kind = "placed", at = ["s*cos(alpha)", "s*sin(alpha)"] }
[bodies.pulley]
shape = { kind = "disc", mass = "mp", radius = "R" }
joint = { kind = "revolute", at = ["3*cos(alpha) + R*sin(alpha)", "3*sin(alpha) - R*cos(alpha)"], angle = "-s/R" }
[bodies.load]
shape = { kind = "particle", mass = "m2" }
joint = { kind = "placed", at = ["3*cos(alpha) + R*sin(alpha) + R", "-1 - s"] }
[constraints.slope]
kind = "support"
point = "block.center"
normal = ["-sin(alpha)", "cos(alpha)"]
friction = "mu"
[constraints.rope]
kind = "string"
path = ["block.center", { body = "pulley", turn = "cw" }, "load.center"]
strands = [["cos(alpha)", "sin(alpha)"], "down"]
[outputs]
a = "s''"
T1 = "tension(rope, 1)"
T2 = "tension(rope, 2)"
N = "reaction_n(slope)"
F = "reaction_t(slope)"
""",
    {"m1": 2, "m2": 3, "mp": 1, "R": 0.1, "mu": 0.25, "g": 9.81},
    {"alpha": "pi/6"},
    {"alpha": "pi/3"},
)
def load_pulls_a_block_up(m1, m2, mp, R, mu, g, alpha):
    """Atwood's machine with one load on a rough slope, and a pulley with inertia."""
    s, c = np.sin(alpha), np.cos(alpha)
    a = g * (m2 - m1 * (s + mu * c)) / (m1 + m2 + mp / 2)
    T1, T2 = m1 * (a + g * (s + mu * c)), m2 * (g - a)
    assert R * (T2 - T1) == pytest.approx(mp * R**2 / 2 * a / R)
    v, time = 0.2, 0.5
    run = {"s": v * time + a * time**2 / 2, "s'": v + a * time}
    return Known({"a": a, "T1": T1, "T2": T2, "N": m1 * g * c, "F": -mu * m1 * g * c}, time=time, run=run)


@SYSTEMS.system(
    "plane",
    """
[coordinates]
x = { start = 0, speed = 0.1 }
y = { dependent = true, near = 0 }
[bodies.lifted]
mass = "A"
joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
[bodies.wedge]
mass = "B"
points = { low = ["cos(beta)", "-sin(beta)"] }
line = ["origin", "low"]
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "F" }
[constraints.face]
kind = "slider"
point = "lifted.origin"
on = "wedge"
friction = "mu"
[outputs]
a = "x''"
N = "reaction_n(face)"
aside = "reaction_n(lifted)"
floor = "reaction_n(wedge)"
""",
    {"A": 3, "B": 2, "F": 60, "g": 9.81},
    *({"beta": beta, "mu": mu} for beta in ("pi/6", "pi/4") for mu in (0, 0.15)),
)
def wedge_lifts(A, B, F, g, beta, mu):
    """A wedge that is pushed in lifts a guided block over a rough face."""
    s, c, tan = np.sin(beta), np.cos(beta), np.tan(beta)
    a, N = np.linalg.solve([[A * tan, -(c - mu * s)], [B, s + mu * c]], [-A * g, F])
    aside = N * (s + mu * c)  # the guide of the block, along -x
    return Known({"a": a, "N": N, "aside": aside, "floor": B * g + N * (c - mu * s)})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
h = { motion = "a0*t^2/2" }
theta = 0
[bodies.hand]
joint = { kind = "prismatic", axis = [0, 1], at = ["r", 0], displacement = "h" }
[bodies.yoyo]
mass = "m"
inertia = "J"
joint = { kind = "placed", at = [0, "h - 1/2 - r*theta"], angle = "theta" }
[constraints.thread]
kind = "string"
path = ["hand.origin", { body = "yoyo", radius = "r", turn = "cw" }]
strands = ["down"]
[outputs]
e = "theta''"
T = "tension(thread)"
a = "ay(yoyo.center)"
""",
    {"m": 0.1, "J": 2e-4, "r": 0.008, "g": 9.81},
    {"a0": 0},
    {"a0": 4},
    {"a0": -9.81},
)
def yo_yo(m, J, r, g, a0):
    """Of a hand that pulls: J theta'' = T r, T - m g = m (a0 - r theta'')."""
    e = m * r * (g + a0) / (J + m * r**2)
    return Known({"e": e, "T": J * e / r, "a": a0 - r * e}, time=0.3, run={"theta": e * 0.045, "theta'": e * 0.3})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
q = { start = "q0", speed = 1 }
[points]
O = [0, 0]
[bodies.rod]
shape = { kind = "rod", mass = "m", length = "L" }
joint = { kind = "placed", point = "center", at = ["h*sin(q)", "-h*cos(q)"], angle = "q" }
[constraints.left]
kind = "link"
points = ["O", "rod.start"]
length = "sqrt(h^2 + L^2/4)"
[constraints.right]
kind = "link"
points = ["O", "rod.end"]
length = "sqrt(h^2 + L^2/4)"
[linearize]
about = "equilibrium"
""",
    {"m": 2, "L": 1.2, "h": 0.8, "g": 9.81},
    {"q0": "pi/6"},
    {"q0": "pi/4"},
)
def rod_in_a_bowl(m, L, h, g, q0):
    """Both ends slide in a round bowl, each pushed towards its centre; so does a rod on two threads."""
    I = m * (h**2 + L**2 / 12)

    def law(_, y):
        return y[1], -m * g * h / I * np.sin(y[0])

    e, s, c = law(0, (q0, 1))[1], np.sin(q0), np.cos(q0)
    G = (h * s, -h * c)
    ends = [(G[0] + k * L / 2 * c, G[1] + k * L / 2 * s) for k in (-1, 1)]
    size = np.hypot(h, L / 2)
    pulls = {name: ("rod", None, p, (-p[0] / size, -p[1] / size)) for name, p in zip("lr", ends, strict=True)}
    body = Free(m, m * L**2 / 12, G, (h * (e * c - s), h * (e * s + c), e))
    T = balance({"rod": body}, pulls | {"no couple": ("rod", None, None, None)}, g)
    assert T["no couple"] == pytest.approx(0, abs=1e-10)
    q, w = last(law, 2, q0, 1)
    R = {"tension(left)": T["l"], "tension(right)": T["r"]}
    return Known({}, R, (np.sqrt(m * g * h / I),), 2, {"q": q, "q'": w})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
a = 0
b = 0
[bodies.motor]
shape = { kind = "disc", mass = "m1", radius = "R1" }
joint = { kind = "revolute", angle = "a", torque = "M" }
[bodies.fan]
shape = { kind = "disc", mass = "m2", radius = "R2" }
joint = { kind = "revolute", at = [2, 0], angle = "b", damping = "c" }
[constraints.belt]
kind = "equation"
gap = "R1*a - R2*b"
[outputs]
e = "a''"
pull = "-multiplier(belt)"
""",
    {"m1": 2, "m2": 5, "R1": 0.1, "R2": 0.25, "M": 3, "c": 0.2},
)
def belt_drive(m1, m2, R1, R2, M, c):
    """(I1 + i^2 I2) a'' = M - i^2 c a' with i = R1/R2; the belt's two strands differ by the pull."""
    i = R1 / R2
    I, d = m1 * R1**2 / 2 + i**2 * m2 * R2**2 / 2, i**2 * c
    a, w = M / d * (2 - I / d * (1 - np.exp(-2 * d / I))), M / d * (1 - np.exp(-2 * d / I))
    pull = (M - m1 * R1**2 / 2 * M / I) / R1
    return Known({"e": M / I, "pull": pull}, time=2, run={"a": a, "a'": w, "b": i * a})


ROW = "".join(
    f"""
[bodies.bob{k}]
shape = {{ kind = "particle", mass = "m" }}
points = {{ top = [0, "l"] }}
joint = {{ kind = "revolute", at = [{k}, 0], point = "top", angle = "q{k}" }}
"""
    for k in range(3)
) + "".join(
    f"""
[forces.s{k}]
kind = "spring"
points = ["bob{k}.center", "bob{k + 1}.center"]
stiffness = "k"
length = 1
"""
    for k in range(2)
)


@SYSTEMS.system("plane", "[coordinates]\nq0 = 0.1\nq1 = 0\nq2 = 0\n" + ROW, {"m": 0.5, "l": 0.6, "k": 4, "g": 9.81})
def three_coupled_pendulums(m, l, k, g):
    """omega^2 = g/l + (k/m) (0, 1, 3)"""
    return Known(frequencies=[np.sqrt(g / l + k / m * i) for i in (0, 1, 3)])


SHAFT = "".join(
    f"""
[bodies.disc{k}]
mass = 1
inertia = "J{k}"
joint = {{ kind = "revolute", angle = "q{k}" }}
"""
    for k in range(3)
) + "".join(
    f"""
[forces.shaft{k}]
kind = "torsion_spring"
bodies = ["disc{k}", "disc{k + 1}"]
stiffness = "k{k}"
"""
    for k in range(2)
)


@SYSTEMS.system(
    "plane",
    "[coordinates]\nq0 = 0.1\nq1 = 0\nq2 = { start = 0, speed = 2 }\n" + SHAFT,
    {"J0": 0.5, "J1": 1.2, "J2": 0.3, "k0": 40, "k1": 90},
)
def three_discs_on_a_shaft(J0, J1, J2, k0, k1):
    """It turns as a whole, and twists in two ways: det(K - omega^2 J) = 0."""
    J = np.array([J0, J1, J2])
    K = np.array([[k0, -k0, 0], [-k0, k0 + k1, -k1], [0, -k1, k1]])
    squares, modes = np.linalg.eigh(K / np.sqrt(np.outer(J, J)))
    w = np.sqrt(np.abs(squares))
    u, du = modes.T @ (np.sqrt(J) * [0.1, 0, 0]), modes.T @ (np.sqrt(J) * [0, 0, 2])
    free = squares < 1e-6
    swing = u * np.cos(w) + du * np.where(free, 1, np.sin(w) / np.where(free, 1, w))
    q = modes @ swing / np.sqrt(J)
    return Known(frequencies=np.where(free, 0, w), time=1, run={"q0": q[0], "q1": q[1], "q2": q[2]})


SLED = """
[coordinates]
s = { start = 0, speed = "v" }
[bodies.sled]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["s*cos(beta)", "s*sin(beta)"] }
[constraints.ground]
kind = "support"
point = "sled.center"
normal = ["-sin(beta)", "cos(beta)"]
friction = "mu"
"""


@SYSTEMS.system(
    "plane",
    SLED.replace('["s*cos(beta)", "s*sin(beta)"]', '["s", 0]').replace('["-sin(beta)", "cos(beta)"]', "[0, 1]")
    + """
[forces.pull]
kind = "force"
point = "sled.center"
force = ["F*cos(alpha)", "F*sin(alpha)"]
[outputs]
a = "s''"
N = "reaction_n(ground)"
""",
    {"m": 10, "F": 40, "v": 1, "g": 9.81},
    {"alpha": "pi/6", "mu": 0.3},
    {"alpha": "pi/3", "mu": 0.2},
)
def sled_on_a_rope(m, F, v, g, alpha, mu):
    """The rope's rise takes weight off the ground: m s'' = F cos - mu (m g - F sin)."""
    N = m * g - F * np.sin(alpha)
    a = (F * np.cos(alpha) - mu * N) / m
    return Known({"a": a, "N": N}, time=0.8, run={"s": v * 0.8 + a * 0.32, "s'": v + 0.8 * a})


@SYSTEMS.system("plane", SLED, {"m": 2, "v": 4, "g": 9.81}, {"beta": "pi/6", "mu": 0.2}, {"beta": "pi/4", "mu": 0.5})
def up_a_slope_and_back(m, v, g, beta, mu):
    """Friction turns round with the velocity; the way down is slower."""
    up, down = g * (np.sin(beta) + mu * np.cos(beta)), g * (np.sin(beta) - mu * np.cos(beta))
    rest = 2 - v / up
    return Known(time=2, run={"s": v**2 / (2 * up) - down * rest**2 / 2, "s'": -down * rest})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
x = { start = 0, speed = "v" }
y = { start = "h" }
[bodies.bag]
shape = { kind = "particle", mass = "m" }
joint = { kind = "planar", x = "x", y = "y", angle = 0 }
[constraints.floor]
kind = "support"
point = "bag.center"
normal = [0, 1]
at = [0, 0]
unilateral = true
friction = "mu"
""",
    {"m": 5, "v": 3, "h": 1.25, "mu": 0.4, "g": 10},
)
def thrown_bag(m, v, h, mu, g):
    """It falls for sqrt(2h/g), lands dead, slides v^2/(2 mu g) and lies."""
    x = v * np.sqrt(2 * h / g) + v**2 / (2 * mu * g)
    return Known(time=2, run={"x": x, "y": 0, "x'": 0, "reaction_n(floor)": m * g})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
q = { start = "q0", speed = 0.7 }
[bodies.half]
shape = { kind = "sector", mass = "m", radius = "R", opening = "pi" }
joint = { kind = "placed", at = ["-R*q", "R"], angle = "q - pi/2" }
[constraints.floor]
kind = "rolling"
body = "half"
radius = "R"
line = { at = [0, 0], normal = [0, 1] }
""",
    {"m": 3, "R": 0.4, "g": 9.81},
    {"q0": "pi/6"},
    {"q0": "pi/3"},
)
def rocking_half_disc(m, R, g, q0):
    """(I_G + m(R^2 + c^2 - 2 R c cos q)) q'' + m R c sin q q'^2 + m g c sin q = 0 with c = 4R/(3 pi)."""
    c = 4 * R / (3 * np.pi)
    I_G = m * R**2 / 2 - m * c**2

    def law(_, y):
        q, w = y
        I = I_G + m * (R**2 + c**2 - 2 * R * c * np.cos(q))
        return w, -m * c * np.sin(q) * (R * w**2 + g) / I

    w, e = law(0, (q0, 0.7))
    N = m * (g + c * np.sin(q0) * e + c * np.cos(q0) * w**2)
    F = m * ((c * np.cos(q0) - R) * e - c * np.sin(q0) * w**2)
    q, u = last(law, 2, q0, 0.7)
    small = np.sqrt(m * g * c / (I_G + m * (R - c) ** 2))
    return Known({}, {"reaction_n(floor)": N, "reaction_t(floor)": F}, (small,), 2, {"q": q, "q'": u})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
q = { start = "q0", speed = 1.5 }
[bodies.roller]
shape = { kind = "disc", mass = "m", radius = "r" }
joint = { kind = "placed", at = ["(R - r)*sin(q)", "-(R - r)*cos(q)"], angle = "-(R - r)*q/r" }
[constraints.gutter]
kind = "rolling"
body = "roller"
circle = { at = [0, 0], radius = "R", inside = true }
""",
    {"m": 2, "r": 0.1, "R": 0.5, "g": 9.81},
    {"q0": "pi/6"},
    {"q0": "pi/3"},
)
def roller_in_a_gutter(m, r, R, g, q0):
    """(3/2)(R - r) q'' = -g sin q; N = m g cos q + m (R - r) q'^2, friction (m/3) g sin q."""

    def law(_, y):
        return y[1], -2 * g / (3 * (R - r)) * np.sin(y[0])

    N = m * g * np.cos(q0) + m * (R - r) * 1.5**2
    F = m * g * np.sin(q0) / 3  # along the normal turned clockwise: at the bottom +x, so forward in q
    q, w = last(law, 1, q0, 1.5)
    run = {"q": q, "q'": w, "reaction_n(gutter)": m * g * np.cos(q) + m * (R - r) * w**2}
    small = np.sqrt(2 * g / (3 * (R - r)))
    return Known({}, {"reaction_n(gutter)": N, "reaction_t(gutter)": F}, (small,), 1, run)


@SYSTEMS.system(
    "plane",
    """
[coordinates]
q = 0.6
[bodies.plank]
shape = { kind = "rod", mass = "m", length = "L" }
joint = { kind = "placed", point = "center", at = ["r*sin(q) - r*q*cos(q)", "r*cos(q) + r*q*sin(q)"], angle = "-q" }
[outputs]
e = "q''"
""",
    {"m": 4, "L": 2, "r": 0.5, "g": 9.81},
)
def plank_on_a_log(m, L, r, g):
    """(L^2/12 + r^2 q^2) q'' + r^2 q q'^2 + g r q cos q = 0"""

    def law(_, y):
        return y[1], -(r**2 * y[0] * y[1] ** 2 + g * r * y[0] * np.cos(y[0])) / (L**2 / 12 + r**2 * y[0] ** 2)

    q, w = last(law, 2, 0.6, 0)
    e = law(0, (0.6, 0))[1]
    return Known({"e": e}, {}, (np.sqrt(12 * g * r) / L,), 2, {"q": q, "q'": w})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
q = "q0"
[bodies.chimney]
shape = { kind = "rod", mass = "m", length = "L" }
joint = { kind = "revolute", angle = "pi/2 - q" }
[outputs]
e = "q''"
M_third = "bending_moment(chimney, L/3)"
M_half = "bending_moment(chimney, L/2)"
V_third = "shear_force(chimney, L/3)"
""",
    {"m": 12, "L": 9, "g": 9.81},
    {"q0": "pi/6"},
    {"q0": "pi/4"},
    {"q0": "pi/2"},
)
def falling_chimney(m, L, g, q0):
    """It breaks where M = m g sin q x (L - x)^2/(4 L^2) is largest, at L/3: there the shear is nothing."""
    moment = [m * g * np.sin(q0) * x * (L - x) ** 2 / (4 * L**2) for x in (L / 3, L / 2)]
    return Known({"e": 1.5 * g / L * np.sin(q0), "M_third": moment[0], "M_half": moment[1], "V_third": 0})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
x = { start = 0, speed = 20 }
[bodies.car]
mass = "m"
inertia = 900
points = { rear = ["-b", "-h"], front = ["a", "-h"] }
joint = { kind = "placed", at = ["x", "h"] }
[constraints.rear]
kind = "support"
point = "car.rear"
normal = [0, 1]
friction = "mu"
[constraints.front]
kind = "support"
point = "car.front"
normal = [0, 1]
friction = "mu"
[outputs]
a = "x''"
N_r = "reaction_n(rear)"
N_f = "reaction_n(front)"
""",
    {"m": 1200, "a": 1.2, "b": 1.4, "h": 0.5, "mu": 0.7, "g": 9.81},
)
def braking_car(m, a, b, h, mu, g):
    """With all wheels locked: the front takes m g (b + mu h)/(a + b)."""
    front = m * g * (b + mu * h) / (a + b)
    return Known({"a": -mu * g, "N_r": m * g - front, "N_f": front}, time=4, run={"x": 400 / (2 * mu * g), "x'": 0})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
x = 0
z = 0
[inputs]
F = "F0*cos(n*t)"
[bodies.machine]
mass = "M"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "K", force = "F" }
[bodies.absorber]
mass = "m"
joint = { kind = "prismatic", on = "machine", axis = [1, 0], displacement = "z", stiffness = "k" }
""",
    {"M": 10, "m": 1, "K": 4000, "k": 400, "F0": 50, "n": 20},
)
def tuned_absorber(M, m, K, k, F0, n):
    """Driven at sqrt(k/m): the frequencies are split about it, and the motion is that of the two equations."""
    A = np.linalg.solve([[M, 0], [m, m]], np.array([[-K, k], [0, -k]]))
    b = np.linalg.solve([[M, 0], [m, m]], [F0, 0])

    def law(t, y):
        return np.concatenate([y[2:], A @ y[:2] + b * np.cos(n * t)])

    x, z, *_ = last(law, 2, 0, 0, 0, 0)
    return Known(frequencies=np.sqrt(-np.linalg.eigvals(A)), time=2, run={"x": x, "z": z})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
x = { start = "a" }
y = { start = 0, speed = "v" }
[points]
O = [0, 0]
[bodies.P]
shape = { kind = "particle", mass = "m" }
joint = { kind = "planar", x = "x", y = "y", angle = 0 }
[forces.pull]
kind = "between"
points = ["O", "P.center"]
pull = "k*r"
[outputs]
rho = "curvature_radius(P.center)"
""",
    {"a": 0.5, "v": 3, "m": 2, "k": 32},
)
def elliptic_orbit(a, v, m, k):
    """A pull in the ratio of the distance leads round an ellipse about its centre: a cos, (v/w) sin."""
    w = np.sqrt(k / m)
    x, y = a * np.cos(5 * w), v / w * np.sin(5 * w)
    return Known({"rho": v**2 / (a * w**2)}, time=5, run={"x": x, "y": y})


@SYSTEMS.system(
    "plane",
    """
[coordinates]
q = "q0"
[bodies.bead]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["a*(q + sin(q))", "-a*(1 + cos(q))"] }
[outputs]
down = { value = "t", at = "q = 0" }
fast = { value = "speed(bead.center)", at = "q = 0" }
""",
    {"a": 0.3, "m": 1, "g": 9.81},
    {"q0": "pi/3"},
    {"q0": "pi/6"},
)
def huygens_pendulum(a, m, g, q0):
    """On a cycloid s = 4 a sin(q/2) swings with sqrt(g/(4a)), however far."""
    w, s = np.sqrt(g / (4 * a)), np.sin(q0 / 2)
    run = {"q": 2 * np.arcsin(s * np.cos(3 * w))}
    return Known({"down": np.pi / (2 * w), "fast": 4 * a * s * w}, {}, (w,), 3, run)


@sampled(3)
@pytest.mark.parametrize("name", usual([*SYSTEMS], 2))
def test_a_free_motion_is_the_one_by_hand(name):
    """Accelerations, reactions, frequencies and the place at the end of a run, each by its own law."""
    agree(SYSTEMS[name])
