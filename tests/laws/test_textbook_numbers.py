"""Examples of other libraries' suites as strangers write them, against the textbook in plain numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from mpmath import mp
from scipy.integrate import solve_ivp
from slow_run import in_slow_run

import eomgen
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.start.assembly_modes import Branches

pytestmark = pytest.mark.slow

SPACE = 'eomgen = 1\nname = "peer"\nspace = "space"\n'
PLANE = 'eomgen = 1\nname = "peer"\nspace = "plane"\n'

# -- Modelica, Mechanics.MultiBody.Examples.Rotational3DEffects.GearConstraint ------------------------------

GEARBOX = (
    SPACE
    + """
[parameters]
J1 = 0.3
J2 = 4
n = 10
[coordinates]
a = { dependent = true }
b = 0
[inputs]
tau = "2*cos(t)"
[bodies.c1]
mass = 1
inertia = ["J1", 1, 1]
joint = { kind = "revolute", axis = [1, 0, 0], angle = "a", torque = "tau" }
[bodies.c2]
mass = 1
inertia = ["J2", 3, 3]
joint = { kind = "revolute", at = [1, 0, 0], axis = [1, 0, 0], angle = "b" }
[constraints.g]
kind = "gear"
bodies = ["c1", "c2"]
ratio = "n"
[outputs]
acc = "b''"
cut = "reaction_couple(g)"
other = "reaction_couple_x(g.c2)"
vague = "reaction_couple(c2)"
"""
)


def test_the_couple_of_a_gear_in_space_is_along_its_axle():
    """(J1 n^2 + J2) b'' = n tau;  lam = J1 a'' - tau = -J2 tau/(J1 n^2 + J2) on the first, -n lam on the second."""
    found = eomgen.solve(eomgen.loads(GEARBOX))
    assert found["acc"].value == pytest.approx(10 * 2 / 34)
    assert found["cut"].value == pytest.approx(-4 * 2 / 34)
    assert found["other"].value == pytest.approx(10 * 4 * 2 / 34)


def test_a_couple_in_space_is_asked_by_its_components():
    found = eomgen.solve(eomgen.loads(GEARBOX))["vague"]
    assert found.value is None
    assert "three components; ask reaction_couple_x(c2), reaction_couple_y(c2)" in str(found.message)


# -- Drake: the strandbeest ---------------------------------------------------------------------------------

LEG = (
    PLANE
    + """
[parameters]
al = "acos((41.5^2 + 40.1^2 - 55.8^2)/(2*41.5*40.1))"
be = "acos((36.7^2 + 49^2 - 65.7^2)/(2*36.7*49))"
[coordinates]
th = { motion = "2*pi*t" }
q1 = { dependent = true, near = 2.4 }
q2 = { dependent = true, near = 3.7 }
q3 = { dependent = true, near = 1.9 }
q4 = { dependent = true, near = 4.0 }
q5 = { dependent = true, near = 5.8 }
q6 = { dependent = true, near = 2 }
[bodies.crank]
points = { P = [15, 0] }
joint = { kind = "revolute", angle = "th" }
[bodies.J]
points = { end = [50, 0] }
joint = { kind = "revolute", on = "crank.P", angle = "q1 - th" }
[bodies.K]
points = { end = [61.9, 0] }
joint = { kind = "revolute", on = "crank.P", angle = "q2 - th" }
[bodies.B]
points = { top = [41.5, 0], side = ["40.1*cos(al)", "40.1*sin(al)"] }
joint = { kind = "revolute", at = [-38, -7.8], angle = "q3" }
[bodies.C]
points = { end = [39.3, 0] }
joint = { kind = "revolute", at = [-38, -7.8], angle = "q4" }
[bodies.F]
points = { end = [39.4, 0] }
joint = { kind = "revolute", on = "B.side", angle = "q5 - q3" }
[bodies.G]
points = { left = [36.7, 0], foot = ["49*cos(be)", "49*sin(be)"] }
joint = { kind = "revolute", on = "C.end", angle = "q6 - q4" }
[constraints]
top = { kind = "pin", points = ["J.end", "B.top"] }
low = { kind = "pin", points = ["K.end", "C.end"] }
knee = { kind = "pin", points = ["F.end", "G.left"] }
"""
)


def angles_of_leg(q: np.ndarray, th: float) -> np.ndarray:
    """Newton's method on the three loops, in complex numbers."""
    al = math.acos((41.5**2 + 40.1**2 - 55.8**2) / (2 * 41.5 * 40.1))
    lengths = np.array(
        [[50, 0, 0], [0, 61.9, 0], [-41.5, 0, 40.1 * np.exp(1j * al)], [0, -39.3, -39.3], [0, 0, 39.4], [0, 0, -36.7]]
    ).T
    offset = 15 * np.exp(1j * th) + 38 + 7.8j
    for _ in range(20):
        gaps, slopes = lengths @ np.exp(1j * q) + [offset, offset, 0], lengths * 1j * np.exp(1j * q)
        q = q - np.linalg.solve(np.vstack([slopes.real, slopes.imag]), np.concatenate([gaps.real, gaps.imag]))
    return q


@in_slow_run
def test_bars_without_mass_are_kept_closed():
    """One turn of a strandbeest's crank in its own lengths; no body has mass, so that nothing measures a change."""
    run = eomgen.simulate(eomgen.loads(LEG), time=1)
    assert "could not" not in run.message
    assert run.gap < 1e-9
    q = run.x[0, 1:7]
    for t, x in zip(run.t, run.x, strict=True):
        q = angles_of_leg(q, 2 * math.pi * t)
        assert x[1:7] == pytest.approx(q, abs=1e-8)


# -- Modelica, Examples.Constraints.UniversalConstraint -----------------------------------------------------

PULLED = """
[points]
P = [0.8, 0, 0.3]
[forces.s]
kind = "spring"
points = ["P", "B.b"]
stiffness = 20
length = 0
[forces.w]
kind = "gravity"
acceleration = [0, -9.81, 0]
[bodies.B]
mass = 1
center = [0.2, 0, 0]
inertia = [0.4, 1, 1]
points = { b = [0.4, 0.1, 0] }
"""
BY_JOINT = (
    SPACE
    + PULLED
    + """
joint = { kind = "universal", axes = [[0, 0, 1], [1, 0, 0]], angles = ["c", "d"] }
[coordinates]
c = { start = 0, speed = 0.7 }
d = { start = 0, speed = 0.5 }
"""
)
BY_CROSS = (
    SPACE
    + PULLED
    + """
joint = { kind = "free", position = ["x", "y", "z"], orientation = "xyz", angles = ["d", "f", "h"] }
[coordinates]
c = { start = 0, speed = 0.7 }
d = { start = 0, speed = 0.5 }
x = {}
y = {}
z = {}
f = {}
h = {}
[bodies.cross]
joint = { kind = "revolute", angle = "c" }
[constraints.u]
kind = "pin"
points = ["B.origin", "cross.origin"]
axis = [1, 0, 0]
"""
)


def test_a_cross_without_mass_ties_as_a_universal_joint_holds():
    """The cross has no inertia, so that M is singular: the constraints say what its acceleration is."""
    assert eomgen.derive(eomgen.loads(BY_CROSS)).certify().ok
    requested = '[outputs]\na = "c\'\'"\nay = "ay(B.b)"\nR = "reaction_y({0})"\nM = "reaction_couple_z({0})"\n'
    one = eomgen.solve(eomgen.loads(BY_JOINT + requested.format("B")))
    other = eomgen.solve(eomgen.loads(BY_CROSS + requested.format("u")))
    for name, answer in one.items():
        assert other[name].value == pytest.approx(answer.value, rel=1e-9, abs=1e-12)
    ends = [eomgen.simulate(eomgen.loads(text), time=1)["c"][-1] for text in (BY_JOINT, BY_CROSS)]
    assert ends[0] == pytest.approx(ends[1], rel=1e-7)


# -- Modelica, Examples.Loops.EngineV6, in its own numbers --------------------------------------------------

INCLINED, OFFSET = (-30, 30, -30, 30, -30, 30), (-30, 90, 210, 210, 90, -30)
r, l = mp.mpf("0.05"), mp.mpf("0.175")


def engine() -> str:
    """Six slider-cranks on one shaft; x is up, cylinder i leans by INCLINED, its pin is at OFFSET on the shaft."""
    text = [PLANE, "[coordinates]\nphi = { start = 0, speed = 10 }"]
    text += [f"{q}{i} = {{ dependent = true, near = {near} }}" for i in range(6) for q, near in (("b", 0), ("s", 0.2))]
    pins = (f'p{i} = ["0.05*cos({a}*pi/180)", "0.05*sin({a}*pi/180)"]' for i, a in enumerate(OFFSET))
    text += [
        f"[bodies.crank]\nmass = 1\ninertia = 1\npoints = {{ {', '.join(pins)} }}",
        'joint = { kind = "revolute", angle = "phi", torque = "-100*(phi\'/200)^2" }',
    ]
    for i, c in enumerate(INCLINED):
        text += [
            f"[bodies.rod{i}]\nmass = 1\ncenter = [0.0875, 0]\ninertia = 0.006\npoints = {{ end = [0.175, 0] }}",
            f'joint = {{ kind = "revolute", on = "crank.p{i}", angle = "b{i} + {c}*pi/180 - phi" }}',
            f"[bodies.piston{i}]\nmass = 6\ncenter = [0.05, 0]\ninertia = 0.0088\n[bodies.piston{i}.joint]",
            f'kind = "prismatic"\naxis = ["cos({c}*pi/180)", "sin({c}*pi/180)"]\ndisplacement = "s{i}"',
            f'force = "-4000*(s{i} - 0.1)"\n[constraints.pin{i}]\nkind = "pin"',
            f'points = ["rod{i}.end", "piston{i}.origin"]',
        ]
    return "\n".join([*text, '[forces.w]\nkind = "gravity"\nacceleration = [-9.81, 0]\n'])


def cylinders(phi: mp.mpf) -> list[tuple[mp.mpf, ...]]:
    """(s, b, place of the rod's middle, height of the piston) of each cylinder."""
    found = []
    for c, offset in zip(INCLINED, OFFSET, strict=True):
        a, c = phi + mp.radians(offset), mp.radians(c)
        s = r * mp.cos(a - c) + mp.sqrt(l**2 - (r * mp.sin(a - c)) ** 2)
        b = -mp.asin(r * mp.sin(a - c) / l)
        middle = r * mp.cos(a) + l / 2 * mp.cos(b + c), r * mp.sin(a) + l / 2 * mp.sin(b + c)
        found.append((s, b, *middle, (s + mp.mpf("0.05")) * mp.cos(c)))
    return found


def test_six_cylinders_turn_one_shaft_as_their_reduced_inertia_says():
    """I(phi) phi'' + I'(phi)/2 phi'^2 = Q with I from the closed form of each slider-crank."""
    phi, w, J, kg = mp.mpf(0), 10, mp.mpf("0.006"), mp.mpf("9.81")

    def inertia(at: mp.mpf) -> mp.mpf:
        rates = [[mp.diff(lambda x, i=i, k=k: cylinders(x)[i][k], at) for k in range(4)] for i in range(6)]
        return 1 + sum(6 * s**2 + J * b**2 + x**2 + y**2 for s, b, x, y in rates)

    def potential(at: mp.mpf) -> mp.mpf:
        return sum(kg * (x + 6 * h) + 2000 * (s - mp.mpf("0.1")) ** 2 for s, _, x, _, h in cylinders(at))

    Q = -100 * (mp.mpf(w) / 200) ** 2 - mp.diff(potential, phi)
    equations = eomgen.derive(eomgen.loads(engine()))
    rhs = equations.rhs("numpy")
    found = rhs(0.0, equations.start(), rhs.p0)[len(equations.coordinates)]
    assert found == pytest.approx(float((Q - mp.diff(inertia, phi) / 2 * w**2) / inertia(phi)), rel=1e-9)


# -- Simbody, ExampleScissorLift ----------------------------------------------------------------------------


def scissors(stages: int) -> str:
    """Crossed rods of length 1 on one another, pushed together by a roller; a table on top, all of it pinned."""
    text = [PLANE, "[coordinates]\ns = { start = 0.8 }\nh = { near = 1.5 }\ne = { near = 0.8 }"]
    text += [f"a{i} = {{ near = 0.6 }}\nb{i} = {{ near = 2.5 }}" for i in range(stages)]
    for name, mass, more in (
        ("roller", 0.1, 'axis = [1, 0]\ndisplacement = "s"'),
        ("table", 10, 'axis = [0, 1]\ndisplacement = "h"'),
        ("top", 0.1, 'on = "table"\naxis = [1, 0]\ndisplacement = "e"'),
    ):
        text += [f'[bodies.{name}]\nmass = {mass}\ninertia = 1\n[bodies.{name}.joint]\nkind = "prismatic"\n{more}']
    for i in range(stages):
        first = (f'on = "B{i - 1}.end", angle = "a{i} - b{i - 1}"', f'on = "A{i - 1}.end", angle = "b{i} - a{i - 1}"')
        seats = first if i else ('angle = "a0"', 'on = "roller.origin", angle = "b0"')
        for rod, seat in zip("AB", seats, strict=True):
            text += [
                f'[bodies.{rod}{i}]\nshape = {{ kind = "rod", mass = 2, length = 1 }}',
                f'joint = {{ kind = "revolute", {seat} }}',
            ]
    last = stages - 1
    text += [
        "[constraints]",
        f'l = {{ kind = "pin", points = ["B{last}.end", "table.origin"] }}',
        f'r = {{ kind = "pin", points = ["A{last}.end", "top.origin"] }}',
    ]
    text += [f'm{i} = {{ kind = "pin", points = ["A{i}.center", "B{i}.center"] }}' for i in range(stages)]
    text += [
        '[forces.w]\nkind = "gravity"\nacceleration = [0, -9.81]',
        '[forces.push]\nkind = "force"\npoint = "roller.origin"\nforce = [-200, 0]\n',
    ]
    return "\n".join(text)


def test_a_scissor_lift_moves_as_one_freedom_with_two_redundant_rows():
    """T = I(s)/2 s'^2 with cos(al) = s and the height sin(al) of a stage."""
    stages = 3
    model = eomgen.loads(scissors(stages))
    freedom = eomgen.freedom_of(model)
    assert (freedom.by_rank, len(freedom.redundant)) == (1, 2)

    def height(s: mp.mpf) -> mp.mpf:
        return mp.sqrt(1 - s**2)

    def inertia(s: mp.mpf) -> mp.mpf:
        rise, turning = mp.diff(height, s), mp.diff(mp.acos, s)
        rods = sum(1 + 4 * ((i + mp.mpf("0.5")) * rise) ** 2 + turning**2 / 3 for i in range(stages))
        return mp.mpf("0.2") + mp.mpf("10.1") * (stages * rise) ** 2 + rods

    def potential(s: mp.mpf) -> mp.mpf:
        return mp.mpf("9.81") * height(s) * (sum(4 * i + 2 for i in range(stages)) + mp.mpf("10.1") * stages) + 200 * s

    equations = eomgen.derive(model)
    rhs = equations.rhs("numpy")
    s = mp.mpf("0.8")
    found = rhs(0.0, equations.start(), rhs.p0)[len(equations.coordinates)]
    assert found == pytest.approx(float(-mp.diff(potential, s) / inertia(s)), rel=1e-9)


# -- Modelica, Examples.Elementary.RollingWheelSetDriving ---------------------------------------------------

WHEEL = """
[bodies.{0}]
mass = 0.5
inertia = [0.02, 0.01, 0.02]
joint = {{ kind = "revolute", on = "axle", at = [0, {1}, 0], axis = [0, 1, 0], angle = "{0}_turn", torque = "{2}" }}
[constraints.{0}_road]
kind = "rolling"
body = "{0}"
axis = [0, 1, 0]
radius = 0.1
plane = {{ at = [0, 0, 0], normal = [0, 0, 1] }}
"""
WHEEL_SET = (
    SPACE
    + """
[coordinates]
x = 0.1
y = 0.1
z = { near = 0.1 }
yaw = 0
tilt = 0
left_turn = 0
right_turn = 0
[bodies.axle]
mass = 0.01
center = [0.2, 0, 0]
inertia = [0, 0, 0]
joint = { kind = "free", position = ["x", "y", "z"], orientation = "zxy", angles = ["yaw", "tilt", 0] }
[forces.w]
kind = "gravity"
acceleration = [0, 0, -9.81]
"""
    + WHEEL.format("left", 0.25, "2*sin(2*pi*t)")
    + WHEEL.format("right", -0.25, "2*cos(2*pi*t)")
)


def wheel_set(t: float, state: np.ndarray) -> list[float]:
    """(m) v' - m_b d w^2 = (t1 + t2)/R,  (J) w' + m_b d v w = (t2 - t1) b/R;  x' = v cos(yaw), y' = v sin(yaw)."""
    _, _, yaw, v, w = state
    R, b, d, m_b = 0.1, 0.25, 0.2, 0.01
    left, right = 2 * math.sin(2 * math.pi * t), 2 * math.cos(2 * math.pi * t)
    m = 1 + m_b + 2 * 0.01 / R**2
    J = b**2 + 2 * 0.02 + m_b * d**2 + 2 * 0.01 * (b / R) ** 2
    rates = ((left + right) / R + m_b * d * w**2) / m, ((right - left) * b / R - m_b * d * v * w) / J
    return [v * math.cos(yaw), v * math.sin(yaw), w, *rates]


def test_two_wheels_on_an_axle_are_driven_by_their_torques():
    run = eomgen.simulate(eomgen.loads(WHEEL_SET), time=1)
    known = solve_ivp(wheel_set, (0, 1), [0.1, 0.1, 0, 0, 0], rtol=1e-11, atol=1e-12).y[:3, -1]
    assert [run[q][-1] for q in ("x", "y", "yaw")] == pytest.approx(known, abs=1e-7)


# -- Modelica, Examples.Elementary.LineForceWithTwoMasses ---------------------------------------------------

BOX = (
    SPACE
    + """
[coordinates]
phi = 0
[points]
A = [0, -0.9, 0]
[bodies.box]
mass = 5
center = [0.35, 0, 0]
inertia = [0.1, 0.3, 0.4]
points = { end = [0.7, 0, 0] }
joint = { kind = "revolute", at = [0, 0.3, 0], angle = "phi" }
[forces.w]
kind = "gravity"
acceleration = [0, -9.81, 0]
"""
)
STRUT = (
    BOX.replace("phi = 0", "phi = 0\na = { near = -1.1 }\nb = { near = 0 }\ns = { near = 1.3 }")
    + """
[bodies.lower]
mass = 1
center = [0.2, 0, 0]
inertia = [0, 0, 0]
joint = { kind = "universal", at = "A", axes = [[0, 0, 1], [0, 1, 0]], angles = ["a", "b"] }
[bodies.upper]
mass = 1
center = [-0.2, 0, 0]
inertia = [0, 0, 0]
joint = { kind = "prismatic", on = "lower", axis = [1, 0, 0], displacement = "s", damping = 3 }
[constraints.ball]
kind = "pin"
points = ["upper.origin", "box.end"]
"""
)
LENGTH = "sqrt((0.7*cos(phi))^2 + (1.2 + 0.7*sin(phi))^2)"
PARTICLES = (
    BOX
    + f"""
[bodies.m1]
shape = {{ kind = "particle", mass = 1 }}
[bodies.m1.joint]
kind = "placed"
at = ["0.14*cos(phi)/{LENGTH}", "-0.9 + 0.2*(1.2 + 0.7*sin(phi))/{LENGTH}", 0]
[bodies.m2]
shape = {{ kind = "particle", mass = 1 }}
[bodies.m2.joint]
kind = "placed"
at = ["0.7*cos(phi)*(1 - 0.2/{LENGTH})", "-0.9 + (1.2 + 0.7*sin(phi))*(1 - 0.2/{LENGTH})", 0]
[forces.damper]
kind = "damper"
points = ["A", "box.end"]
damping = 3
"""
)


def test_a_strut_with_two_masses_is_one_of_joints_or_of_places():
    """Universal, prismatic and ball joint in a loop; or the masses where the geometry has them."""
    runs = [eomgen.simulate(eomgen.loads(text), time=1) for text in (STRUT, PARTICLES)]
    assert runs[0]["phi"][-1] == pytest.approx(runs[1]["phi"][-1], abs=1e-7)


def test_no_angle_of_another_way_to_close_is_rounding():
    """What stays 0 while another loop turns over is said to be 0."""
    text = (
        PLANE
        + """
[coordinates]
a1 = { dependent = true }
b1 = { dependent = true }
a2 = { dependent = true }
b2 = { dependent = true }
q = { motion = "0.7*sin(t)" }
[bodies.rod]
points = { end = [0, 0.5] }
joint = { kind = "revolute", angle = "q" }
[bodies.c1]
mass = 1
inertia = 0
points = { end = [0.6, 0] }
joint = { kind = "revolute", on = "rod.end", angle = "a1 - q" }
[bodies.r1]
points = { end = [0.1, 0.5] }
joint = { kind = "revolute", at = [0.5, 0], angle = "b1" }
[bodies.c2]
mass = 1
inertia = 0
points = { end = [0.5, 0.1] }
joint = { kind = "revolute", on = "r1.end", angle = "a2 - b1" }
[bodies.r2]
points = { end = [0.1, 0.6] }
joint = { kind = "revolute", at = [1, 0], angle = "b2" }
[constraints]
P1 = { kind = "pin", points = ["c1.end", "r1.end"] }
P2 = { kind = "pin", points = ["c2.end", "r2.end"] }
"""
    )
    branches = Branches.of(System.of(eomgen.loads(text)), {"q": 0, "a1": 0, "b1": 0, "a2": 0, "b2": 0})
    assert branches is not None
    small = [x for way in branches.others for x in way.values.values() if abs(x) < 1e-6]
    assert small
    assert set(small) == {0.0}
