"""Systems of textbooks and test suites as model files, each beside its energies as a lecture writes them down."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy
from lagrange import Book, Frame, t
from sympy import Rational, cos, sin, sqrt

SYSTEMS: dict[str, tuple[str, dict[str, Any], Callable[[Frame], Book]]] = {}
"""name -> (model file, {driven coordinate: its rate}, what is known)"""

WEIGHT = '[forces.weight]\nkind = "gravity"\nacceleration = [0, "-g"]\n'
WEIGHT_IN_SPACE = '[forces.weight]\nkind = "gravity"\nacceleration = [0, 0, "-g"]\n'


def system(space: str, text: str, **given: Any) -> Callable:
    """Puts a system, with the rates of its driven coordinates, into SYSTEMS under the name of what knows it."""

    def known(function: Callable[[Frame], Book]) -> Callable[[Frame], Book]:
        head = f'eomgen = 1\nname = "{function.__name__}"\nspace = "{space}"\n'
        SYSTEMS[function.__name__] = (head + text, given, function)
        return function

    return known


def turned(angle, x, y):
    """A vector of a frame turned by an angle, in the plane."""
    return cos(angle) * x - sin(angle) * y, sin(angle) * x + cos(angle) * y


@system(
    "plane",
    """
[parameters]
M = 3
m = 1.5
g = 9.81
[coordinates]
r = 1
theta = 0.5
[bodies.swing]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["r*sin(theta)", "-r*cos(theta)"] }
[bodies.counterweight]
shape = { kind = "particle", mass = "M" }
joint = { kind = "placed", at = [-1, "r - 3"] }
[outputs]
v = "speed(swing.center)"
ay = "ay(swing.center)"
p = "momentum(theta)"
P = "power(weight)"
Q = "generalized_force(r)"
"""
    + WEIGHT,
)
def swinging_atwood(f: Frame) -> Book:
    """Tufillaro, Abbott & Griffiths, Am. J. Phys. 52 (1984) 895."""
    r, theta, (M, m, g) = f.q["r"], f.q["theta"], f.p.values()
    x, y = r * sin(theta), -r * cos(theta)
    T, V = m / 2 * f.square(x, y) + M / 2 * f.u["r"] ** 2, m * g * y + M * g * r
    outputs = {"v": sqrt(f.square(x, y)), "ay": f.rate(f.rate(y)), "p": T.diff(f.u["theta"]), "P": -f.rate(V)}
    return Book(T, V, outputs=outputs | {"Q": -V.diff(r)})


@system(
    "plane",
    """
[parameters]
m = 1
l = "1/2"
a = { value = 2, unit = "cm" }
Om = 60
g = 9.81
[coordinates]
phi = 3
[bodies.pivot]
joint = { kind = "placed", at = [0, "a*cos(Om*t)"] }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
points = { top = [0, "l"] }
joint = { kind = "revolute", on = "pivot", angle = "phi", point = "top" }
[outputs]
vy = "vy(bob.center)"
ay = "ay(bob.center)"
seen = "speed(bob.center, pivot)"
"""
    + WEIGHT,
)
def kapitza(f: Frame) -> Book:
    """The pendulum with a vibrated pivot: Landau & Lifshitz, Mechanics, sec. 5, problem 3c."""
    phi, (m, l, a, Om, g) = f.q["phi"], f.p.values()
    x, y = l * sin(phi), a * cos(Om * t) - l * cos(phi)
    outputs = {"vy": f.rate(y), "ay": f.rate(f.rate(y)), "seen": l * sympy.Abs(f.u["phi"])}
    return Book(m / 2 * f.square(x, y), m * g * y, outputs=outputs)


@system(
    "plane",
    """
[parameters]
m = 1
l = 1
h = 0.4
b = 0.7
k = 5
c = 0.3
g = 9.81
[coordinates]
alpha = 0.1
beta = 0
[bodies.left]
shape = { kind = "rod", mass = "m", length = "l" }
points = { hook = ["h", 0] }
joint = { kind = "revolute", angle = "alpha - pi/2" }
[bodies.right]
shape = { kind = "rod", mass = "2*m", length = "l" }
points = { hook = ["h", 0] }
joint = { kind = "revolute", at = ["b", 0], angle = "beta - pi/2" }
[forces.spring]
kind = "spring"
points = ["left.hook", "right.hook"]
stiffness = "k"
length = "b"
[forces.damper]
kind = "damper"
points = ["left.hook", "right.hook"]
damping = "c"
"""
    + WEIGHT,
)
def coupled_pendulums(f: Frame) -> Book:
    """Two rods, a spring and a damper between them, at large angles."""
    alpha, beta, (m, l, h, b, k, c, g) = f.q["alpha"], f.q["beta"], f.p.values()
    stretch = sqrt((b + h * sin(beta) - h * sin(alpha)) ** 2 + (h * cos(alpha) - h * cos(beta)) ** 2)
    T = m * l**2 / 6 * f.u["alpha"] ** 2 + m * l**2 / 3 * f.u["beta"] ** 2
    V = -m * g * l / 2 * cos(alpha) - m * g * l * cos(beta) + k / 2 * (stretch - b) ** 2
    return Book(T, V, c / 2 * f.rate(stretch) ** 2)


@system(
    "plane",
    """
[parameters]
r = 0.3
l = 1
g = 9.81
[coordinates]
theta = 0.4
psi = -0.1
x = 1.2
[inputs]
F = -10
[bodies.crank]
shape = { kind = "rod", mass = 2, length = "r" }
joint = { kind = "revolute", angle = "theta" }
[bodies.rod]
shape = { kind = "rod", mass = 3, length = "l" }
joint = { kind = "revolute", on = "crank.end", angle = "psi - theta" }
[bodies.piston]
shape = { kind = "particle", mass = 1 }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "F" }
[constraints.wrist]
kind = "pin"
points = ["rod.end", "piston.center"]
"""
    + WEIGHT,
)
def slider_crank(f: Frame) -> Book:
    """Three coordinates and one loop."""
    theta, psi, x, (r, l, g, F) = *f.q.values(), f.p.values()
    middle = r * cos(theta) + l / 2 * cos(psi), r * sin(theta) + l / 2 * sin(psi)
    T = r**2 / 3 * f.u["theta"] ** 2 + Rational(3, 2) * f.square(*middle) + l**2 / 8 * f.u["psi"] ** 2
    V = g * (r * sin(theta) + 3 * middle[1])
    phi = r * cos(theta) + l * cos(psi) - x, r * sin(theta) + l * sin(psi)
    return Book(T + f.u["x"] ** 2 / 2, V, Q={"x": F}, phi=phi)


@system(
    "plane",
    """
[parameters]
a = 1
L = 3
b = 1.2
g = 9.81
[coordinates]
phi = 0.3
x2 = 2
y2 = 1.5
x3 = 2
y3 = -1.2
x4 = 3
y4 = 0.5
[bodies.crank]
shape = { kind = "rod", mass = 2, length = "a" }
joint = { kind = "revolute", at = ["a", 0], angle = "phi" }
"""
    + "".join(
        f'[bodies.P{k}]\nshape = {{ kind = "particle", mass = 1 }}\n'
        f'joint = {{ kind = "placed", at = ["x{k}", "y{k}"] }}\n'
        for k in (2, 3, 4)
    )
    + "".join(
        f'[constraints.rod{k}]\nkind = "equation"\ngap = "{gap}"\n'
        for k, gap in enumerate(
            (
                "x2^2 + y2^2 - L^2",
                "x3^2 + y3^2 - L^2",
                "(x2 - a - a*cos(phi))^2 + (y2 - a*sin(phi))^2 - b^2",
                "(x3 - a - a*cos(phi))^2 + (y3 - a*sin(phi))^2 - b^2",
                "(x4 - x2)^2 + (y4 - y2)^2 - b^2",
                "(x4 - x3)^2 + (y4 - y3)^2 - b^2",
            )
        )
    )
    + WEIGHT,
)
def peaucellier(f: Frame) -> Book:
    """Peaucellier's straight-line linkage: a crank, three joints, six rods."""
    phi, (a, L, b, g) = f.q["phi"], f.p.values()
    P = {k: (f.q[f"x{k}"], f.q[f"y{k}"]) for k in (2, 3, 4)}
    P |= {0: (0, 0), 1: (a + a * cos(phi), a * sin(phi))}
    rods = ((2, 0, L), (3, 0, L), (2, 1, b), (3, 1, b), (4, 2, b), (4, 3, b))
    gaps = [(P[i][0] - P[j][0]) ** 2 + (P[i][1] - P[j][1]) ** 2 - length**2 for i, j, length in rods]
    T = a**2 / 3 * f.u["phi"] ** 2 + sum(f.square(*P[k]) for k in (2, 3, 4)) / 2
    return Book(T, g * (a * sin(phi) + P[2][1] + P[3][1] + P[4][1]), phi=gaps)


@system(
    "plane",
    """
[parameters]
G = 1
[coordinates]
x1 = 1
y1 = 0
x2 = -1
y2 = 0
x3 = 0
y3 = 2
"""
    + "".join(
        f'[bodies.P{k}]\nshape = {{ kind = "particle", mass = {k} }}\n'
        f'joint = {{ kind = "placed", at = ["x{k}", "y{k}"] }}\n'
        for k in (1, 2, 3)
    )
    + "".join(
        f'[forces.pull{i}{j}]\nkind = "between"\n'
        f'points = ["P{i}.center", "P{j}.center"]\npull = "{i * j}*G/r^2 + r\'/10"\n'
        for i, j in ((1, 2), (2, 3), (3, 1))
    ),
)
def three_bodies(f: Frame) -> Book:
    """Newton's attraction between three bodies, and a drag on the rates of their distances."""
    P = {k: (f.q[f"x{k}"], f.q[f"y{k}"]) for k in (1, 2, 3)}
    V, D = 0, 0
    for i, j in ((1, 2), (2, 3), (3, 1)):
        distance = sqrt((P[i][0] - P[j][0]) ** 2 + (P[i][1] - P[j][1]) ** 2)
        V, D = V - i * j * f.p["G"] / distance, D + f.rate(distance) ** 2 / 20
    return Book(sum(Rational(k, 2) * f.square(*P[k]) for k in P), V, D)


@system(
    "plane",
    """
[parameters]
m = 1
e = 0.2
[coordinates]
s = { start = 0.1, speed = 0.5 }
phi = { acceleration = "2*t + cos(t)", start = 0.3, speed = 1 }
[bodies.table]
joint = { kind = "revolute", angle = "phi" }
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", on = "table", at = [0, "e"], axis = [1, 0], displacement = "s" }
[outputs]
seen = "vx(block.center, table)"
aseen = "ax(block.center, table)"
v = "speed(block.center)"
ay = "ay(block.center)"
w = "omega(table)"
epsilon = "epsilon(table)"
""",
    phi=1 + t**2 + sin(t),
)
def groove_in_a_turning_table(f: Frame) -> Book:
    """Relative motion on a table whose angular acceleration is given: Euler's, Coriolis' and centrifugal terms."""
    s, phi, (m, e) = f.q["s"], f.q["phi"], f.p.values()
    x, y = turned(phi, s, e)
    outputs = {"seen": f.u["s"], "aseen": f.a["s"], "v": sqrt(f.square(x, y)), "ay": f.rate(f.rate(y))}
    return Book(m / 2 * f.square(x, y), outputs=outputs | {"w": 1 + t**2 + sin(t), "epsilon": 2 * t + cos(t)})


@system(
    "space",
    """
[parameters]
m = 2
l = 10
Om = 0.05
lat = { value = 48.8, unit = "deg" }
Re = 50
g = 9.81
[coordinates]
day = { rate = "Om", start = 0 }
x = 0.5
y = 0.1
[bodies.earth]
joint = { kind = "revolute", axis = [0, 0, 1], angle = "day" }
[bodies.laboratory]
[bodies.laboratory.joint]
kind = "fixed"
on = "earth"
at = ["Re*cos(lat)", 0, "Re*sin(lat)"]
turned = { axis = [0, 1, 0], angle = "pi/2 - lat" }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", on = "laboratory", at = ["x", "y", "-sqrt(l^2 - x^2 - y^2)"] }
[forces.weight]
kind = "force"
point = "bob.center"
force = [0, 0, "-m*g"]
axes = "laboratory"
[outputs]
seen = "speed(bob.center, laboratory)"
v = "speed(bob.center)"
""",
    day=sympy.Symbol("p_Om"),
)
def foucault(f: Frame) -> Book:
    """Foucault's pendulum: the laboratory turns with the earth, the weight with the laboratory."""
    x, y, day, (m, l, _, lat, Re, g) = f.q["x"], f.q["y"], f.q["day"], f.p.values()
    z = -sqrt(l**2 - x**2 - y**2)
    outward, up = Re * cos(lat) + sin(lat) * x + cos(lat) * z, Re * sin(lat) - cos(lat) * x + sin(lat) * z
    place = (*turned(day, outward, y), up)
    Q = {"x": -m * g * z.diff(x), "y": -m * g * z.diff(y)}
    outputs = {"seen": sqrt(f.square(x, y, z)), "v": sqrt(f.square(*place))}
    return Book(m / 2 * f.square(*place), Q=Q, outputs=outputs)


@system(
    "space",
    """
[parameters]
m = 2
l = 1.5
g = 9.81
k = 0.2
[coordinates]
theta = 0.5
phi = { start = 0, speed = 1 }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["l*sin(theta)*cos(phi)", "l*sin(theta)*sin(phi)", "-l*cos(theta)"] }
[forces.wind]
kind = "force"
point = "bob.center"
force = ["-k*l*(theta'*cos(theta)*cos(phi) - phi'*sin(theta)*sin(phi))", 0, 0]
[outputs]
taken = "power(wind)"
Q = "generalized_force(phi)"
P = "power()"
"""
    + WEIGHT_IN_SPACE,
)
def spherical_pendulum_in_wind(f: Frame) -> Book:
    """A drag along x on a spherical pendulum: its power, and what it does to each coordinate."""
    theta, phi, (m, l, g, k) = f.q["theta"], f.q["phi"], f.p.values()
    x, y, z = l * sin(theta) * cos(phi), l * sin(theta) * sin(phi), -l * cos(theta)
    F = -k * f.rate(x)
    Q = {"theta": F * x.diff(theta), "phi": F * x.diff(phi)}
    outputs = {"taken": F * f.rate(x), "Q": Q["phi"], "P": F * f.rate(x) - m * g * f.rate(z)}
    return Book(m / 2 * f.square(x, y, z), m * g * z, Q=Q, outputs=outputs)


@system(
    "plane",
    """
[parameters]
g = 9.81
k = 3
[coordinates]
s = { rate = "2*t/5 + cos(t)", start = 0 }
x = 0.1
y = 0.2
f = 0.3
[bodies.cart]
mass = 1
joint = { kind = "prismatic", axis = [3, 4], displacement = "s", angle = 0.5 }
[bodies.plate]
mass = 2
center = [0.1, 0.2]
inertia = 0.3
points = { A = [1, 0], B = [0, 1] }
joint = { kind = "planar", on = "cart", at = [0.1, 0], x = "x", y = "y", angle = "f", point = "A" }
[forces.spring]
kind = "spring"
points = ["cart.origin", "plate.B"]
stiffness = "k"
length = "start"
[forces.one]
kind = "force"
point = "plate.B"
force = ["x'", "t"]
axes = "cart"
[forces.two]
kind = "force"
point = "plate.A"
force = [1, "-2*f'"]
axes = "plate"
[forces.couple]
kind = "couple"
body = "plate"
couple = "x*t - 0.1*f'"
"""
    + WEIGHT,
    s=2 * t / 5 + cos(t),
)
def plate_on_a_driven_cart(f: Frame) -> Book:
    """A free plate on a slanted cart that is driven, with forces in the axes of either and a spring from its start."""
    s, x, y, angle, (g, k) = f.q["s"], f.q["x"], f.q["y"], f.q["f"], f.p.values()
    half, cart = Rational(1, 2), (Rational(3, 5) * s, Rational(4, 5) * s)

    def added(p, q):
        return p[0] + q[0], p[1] + q[1]

    def on_plate(px, py):
        return turned(half + angle, px, py)

    A = added(cart, turned(half, Rational(1, 10) + x, y))
    B, center = added(A, on_plate(-1, 1)), added(A, on_plate(Rational(-9, 10), Rational(1, 5)))
    length = sqrt((B[0] - cart[0]) ** 2 + (B[1] - cart[1]) ** 2)
    start = length.subs({s: 0, x: Rational(1, 10), y: Rational(1, 5), angle: Rational(3, 10)})
    V = g * (2 * center[1] + cart[1]) + k / 2 * (length - start) ** 2
    one, two, couple = turned(half, f.u["x"], t), on_plate(1, -2 * f.u["f"]), x * t - f.u["f"] / 10
    Q = {
        n: sum(F * p.diff(f.q[n]) for F, p in zip((*one, *two), (*B, *A), strict=True)) + (couple if n == "f" else 0)
        for n in ("x", "y", "f")
    }
    T = f.square(*cart) / 2 + f.square(*center) + Rational(3, 20) * f.u["f"] ** 2
    return Book(T, V, Q=Q)


@system(
    "space",
    """
[parameters]
A = 0.5
C = 0.9
J = 0.3
[coordinates]
psi = 0
theta = 0.5
phi = 0
[inputs]
tau = 0
[bodies.outer]
mass = 1
inertia = [1, 1, "J"]
joint = { kind = "revolute", axis = [0, 0, 1], angle = "psi" }
[bodies.inner]
mass = 1
inertia = ["J", "J", "J"]
joint = { kind = "revolute", on = "outer", axis = [1, 0, 0], angle = "theta", torque = "tau" }
[bodies.rotor]
mass = 1
inertia = ["A", "A", "C"]
joint = { kind = "revolute", on = "inner", axis = [0, 0, 1], angle = "phi" }
[outputs]
spin = "momentum(phi)"
wx = "omega_x(rotor)"
ez = "epsilon_z(rotor)"
seen = "omega_z(rotor, inner)"
""",
)
def gyroscope_in_gimbals(f: Frame) -> Book:
    """T by Euler's angles zxz; C (phi' + psi' cos theta) is the spin that stays."""
    psi, theta = f.q["psi"], f.q["theta"]
    dpsi, dtheta, dphi, (A, C, J, tau) = f.u["psi"], f.u["theta"], f.u["phi"], f.p.values()
    w = dphi + dpsi * cos(theta)
    T = (J * dpsi**2 + J * (dtheta**2 + dpsi**2) + A * (dtheta**2 + dpsi**2 * sin(theta) ** 2) + C * w**2) / 2
    outputs = {"spin": C * w, "wx": dtheta * cos(psi) + dphi * sin(theta) * sin(psi)}
    return Book(T, Q={"theta": tau}, outputs=outputs | {"ez": f.rate(dpsi + dphi * cos(theta)), "seen": dphi})
