"""Constraints in space, equations between points, friction on surfaces, and rows of velocities that can be integrated.

Oracles: Newton's law and Lagrange's multipliers written here in numbers, closed forms of textbooks, the same system in
the plane or with a joint.
"""

from __future__ import annotations

import json
from math import cos, hypot, sin, sqrt

import numpy as np
import pytest
from each import each
from moving import solved, written

import eomgen
from eomgen.errors import EomgenError, ModelError
from eomgen.mechanics.constraints.rank import Freedom
from eomgen.mechanics.kinematics.symbols import primitive
from eomgen.symbolic.expression.derivatives import gradient
from eomgen.symbolic.expression.formula import function
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = pytest.mark.slow

G = 9.81


def model_of(text: str, space: str = "space") -> eomgen.Model:
    return eomgen.loads(f'eomgen = 1\nname = "test"\nspace = "{space}"\n{text}')


def values_of(text: str, space: str = "space") -> dict[str, float]:
    """The values of the outputs."""
    return {name: answer.value for name, answer in eomgen.solve(model_of(text, space)).items()}


WEIGHT = """
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""
BEAD = f"""
[parameters]
m = 1.5
g = {G}
k = 2
[coordinates]
x = {{ start = 0.3, speed = 0.4 }}
y = {{ start = 0.1, speed = -0.2 }}
z = {{ start = 0.2, speed = 0.4 }}
[bodies.bead]
shape = {{ kind = "particle", mass = "m" }}
joint = {{ kind = "placed", at = ["x", "y", "z"] }}
"""
BOWL = '[constraints.bowl]\nkind = "equation"\ngap = "z(bead.center) - k*(x(bead.center)^2 + y(bead.center)^2)"\n'
REQUESTED = """
[outputs]
x = { value = "reaction_x(bowl)", at = "t = 0" }
y = { value = "reaction_y(bowl)", at = "t = 0" }
z = { value = "reaction_z(bowl)", at = "t = 0" }
lam = { value = "multiplier(bowl)", at = "t = 0" }
"""


def multiplier_on_the_bowl(m: float, k: float, q: np.ndarray, v: np.ndarray) -> tuple[float, np.ndarray]:
    """lam and lam grad phi of phi = z - k (x^2 + y^2): grad phi . (lam grad phi/m - g e_z) = 2 k (x'^2 + y'^2)."""
    normal = np.array([-2 * k * q[0], -2 * k * q[1], 1.0])
    lam = m * (2 * k * (v[0] ** 2 + v[1] ** 2) + G) / (normal @ normal)
    return lam, lam * normal


def test_an_equation_between_points_pushes_along_its_gradient():
    """A bead on a paraboloid: R = lam grad phi, as Newton's law asks."""
    lam, R = multiplier_on_the_bowl(1.5, 2, np.array([0.3, 0.1]), np.array([0.4, -0.2]))
    found = values_of(BEAD + BOWL + WEIGHT + REQUESTED)
    assert [found["x"], found["y"], found["z"]] == pytest.approx(R)
    assert found["lam"] == pytest.approx(lam)


def test_an_equation_between_points_is_certified_by_every_method():
    """The reactions of the bodies in balance, and the energy theorem, hold with it."""
    model = model_of(BEAD + BOWL + WEIGHT)
    for method in ("lagrange", "projection", "kinetostatic"):
        assert eomgen.derive(model, method=method).certify().ok


def test_a_run_on_a_surface_keeps_energy_and_surface():
    """|phi| stays below 10 atol, T + V constant."""
    run = eomgen.simulate(model_of(BEAD + BOWL + WEIGHT), time=5)
    x, y, z = run.x[:, :3].T
    assert np.max(np.abs(z - 2 * (x**2 + y**2))) < 1e-8
    assert run.drift < 1e-7


CAM = f"""
[parameters]
m = 1.5
J = 0.2
a = 0.2
b = 0.1
e = 0.03
g = {G}
[coordinates]
phi = {{ start = 0.3, speed = 2 }}
h = {{ dependent = true, near = 0.2 }}
[bodies.cam]
mass = 1
inertia = "J"
joint = {{ kind = "revolute", angle = "phi" }}
[bodies.follower]
shape = {{ kind = "particle", mass = "m" }}
joint = {{ kind = "prismatic", at = ["e", 0], axis = [0, 1], displacement = "h" }}
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[constraints.contact]
kind = "equation"
"""
BY_POINTS = 'gap = "(x(follower.center, cam)/a)^2 + (y(follower.center, cam)/b)^2 - 1"\n'
BY_COORDINATES = 'gap = "((e*cos(phi) + h*sin(phi))/a)^2 + ((h*cos(phi) - e*sin(phi))/b)^2 - 1"\n'
CAM_REQUESTED = {
    "x": "reaction_x(contact)",
    "y": "reaction_y(contact)",
    "axle": "reaction_x(cam)",
    "guide": "reaction_n(follower)",
}


def test_a_cam_with_an_offset_follower_moves_as_its_equation_in_coordinates():
    """The same accelerations whether the profile is written in points or in coordinates."""
    one, other = (eomgen.simulate(model_of(CAM + gap, "plane"), time=1) for gap in (BY_POINTS, BY_COORDINATES))
    assert one.x[-1] == pytest.approx(other.x[-1], abs=1e-7)


def test_the_force_of_a_cam_is_normal_to_its_profile_and_borne_by_axle_and_guide():
    """F along grad of the profile in the cam's axes, no other force along x: axle = - F_x, guide = F_x (left is -x)."""
    run = eomgen.simulate(model_of(CAM + BY_POINTS, "plane"), time=0.01)
    found = {name: run.reactions[requested][0] for name, requested in CAM_REQUESTED.items()}
    h = found_height(0.3)
    c, s = cos(0.3), sin(0.3)
    u, v = 0.03 * c + h * s, h * c - 0.03 * s
    normal = np.array([u / 0.2**2, v / 0.1**2])
    F = np.array([found["x"], found["y"]])
    in_cam = np.array([[c, s], [-s, c]]) @ F
    assert in_cam == pytest.approx(normal * in_cam[1] / normal[1])
    assert found["axle"] == pytest.approx(found["x"]) and found["guide"] == pytest.approx(found["x"])


def found_height(phi: float) -> float:
    """The upper root h of the profile's equation."""
    c, s, e = cos(phi), sin(phi), 0.03
    A = s * s / 0.04 + c * c / 0.01
    B = 2 * e * s * c * (1 / 0.04 - 1 / 0.01)
    C = e * e * (c * c / 0.04 + s * s / 0.01) - 1
    return (-B + sqrt(B * B - 4 * A * C)) / (2 * A)


SLEIGH = """
[parameters]
m = 2
[coordinates]
x = { start = 0, speed = 1 }
y = { start = 0, speed = 0.5 }
psi = { start = 0.4636476090008061, speed = 0.7 }
[bodies.sleigh]
mass = "m"
inertia = 0.3
center = [0.2, 0]
points = { blade = [0, 0] }
joint = { kind = "planar", x = "x", y = "y", angle = "psi" }
[constraints.blade]
"""
BY_RATE = 'kind = "equation"\nrate = "cos(angle(sleigh))*vy(sleigh.blade) - sin(angle(sleigh))*vx(sleigh.blade)"\n'
BY_SKATE = 'kind = "skate"\npoint = "sleigh.blade"\nalong = [1, 0]\n'


def test_a_knife_edge_written_as_velocities_of_a_point_is_a_skate():
    """n . v = 0 with the force lam n: the same motion, and the same force on the blade."""
    requested = '[outputs]\nx = { value = "reaction_x(blade)", at = "t = 0" }\n'
    normal = '[outputs]\nn = { value = "reaction_n(blade)", at = "t = 0" }\n'
    one, other = (eomgen.simulate(model_of(SLEIGH + constraint, "plane"), time=2) for constraint in (BY_RATE, BY_SKATE))
    assert one.x[-1] == pytest.approx(other.x[-1], abs=1e-7)
    x, n = values_of(SLEIGH + BY_RATE + requested, "plane")["x"], values_of(SLEIGH + BY_SKATE + normal, "plane")["n"]
    assert x == pytest.approx(-n * sin(0.4636476090008061))


WIRE = f"""
[parameters]
m = 0.4
g = {G}
w = 3
al = 0.6
[coordinates]
turn = {{ motion = "w*t" }}
x = 0.2
y = 0
z = "0.2*cos(al)/sin(al)"
[bodies.wire]
points = {{ A = [0, 0, 0], B = ["sin(al)", 0, "cos(al)"] }}
line = ["A", "B"]
joint = {{ kind = "revolute", angle = "turn" }}
[bodies.bead]
shape = {{ kind = "particle", mass = "m" }}
joint = {{ kind = "placed", at = ["x", "y", "z"] }}
[constraints.hole]
kind = "slider"
point = "bead.center"
on = "wire"
"""


def test_a_slider_in_space_holds_a_bead_on_a_turning_wire():
    """s'' = s w^2 sin(al)^2 - g cos(al); across the wire it pushes with m (2 w s' + ...) and the weight's share."""
    s0, al, w, m = 0.2 / sin(0.6), 0.6, 3.0, 0.4
    text = WIRE.replace("y = 0\n", 'y = { start = 0, speed = "0.2*w" }\n')
    found = values_of(
        text
        + WEIGHT
        + "".join(
            [
                "[outputs]\n",
                *(f'a{k} = {{ value = "a{k}(bead.center)", at = "t = 0" }}\n' for k in "xyz"),
                *(f'R{k} = {{ value = "reaction_{k}(hole)", at = "t = 0" }}\n' for k in "xyz"),
            ]
        )
    )
    along = s0 * w**2 * sin(al) ** 2 - G * cos(al)
    a = np.array([along * sin(al) - s0 * sin(al) * w**2, 0, along * cos(al)])
    assert [found["ax"], found["ay"], found["az"]] == pytest.approx(a, abs=1e-12)
    assert [found["Rx"], found["Ry"], found["Rz"]] == pytest.approx(m * (a + np.array([0, 0, G])), abs=1e-12)


BLOCK = f"""
[parameters]
m = 2
g = {G}
[coordinates]
COORDINATES
[bodies.block]
mass = "m"
inertia = [1, 2, 3]
points = {{ P = [0.1, 0.2, 0.3] }}
JOINT
[forces.push]
kind = "force"
point = "block.P"
force = [5, 1, 7]
"""


def test_a_guide_in_space_is_a_prismatic_joint():
    """Two forces and three couples: the same acceleration, and the same force and couple in space."""
    requested = "[outputs]\n" + "".join(
        f'{kind}{k} = {{ value = "reaction_{kind}{k}(NAME)", at = "t = 0" }}\n'
        for kind in ("", "couple_")
        for k in "xyz"
    )
    free = BLOCK.replace("COORDINATES", "x = 0\ny = 0\nz = 0\na = 0\nb = 0\nc = 0").replace(
        "JOINT",
        ('joint = { kind = "free", position = ["x", "y", "z"], orientation = "xyz", angles = ["a", "b", "c"] }'),
    )
    free += '[constraints.rail]\nkind = "guide"\npoint = "block.origin"\nalong = [1, 2, 2]\n'
    slide = BLOCK.replace("COORDINATES", "s = 0").replace(
        "JOINT", 'joint = { kind = "prismatic", axis = [1, 2, 2], displacement = "s" }'
    )
    one = values_of(free + WEIGHT + requested.replace("NAME", "rail"))
    other = values_of(slide + WEIGHT + requested.replace("NAME", "block"))
    assert one == pytest.approx(other, abs=1e-9)
    assert Freedom.of(model_of(free)).by_rank == 1


BEVEL = """
[coordinates]
p = 0
q = 0
[bodies.pinion]
mass = 1
inertia = [0.1, 0.1, 0.02]
joint = { kind = "revolute", axis = [1, 0, 0], angle = "p", torque = 3 }
[bodies.crown]
mass = 1
inertia = [0.3, 0.3, 0.5]
joint = { kind = "revolute", angle = "q" }
[constraints.teeth]
kind = "gear"
bodies = ["pinion", "crown"]
ratio = -4
"""


def test_bevel_gears_turn_in_their_ratio_about_axes_at_right_angles():
    """p' = -4 q': (J_p 16 + J_q) q'' = -4 M, the couple on the pinion lam = J_p p'' - M."""
    a, lam = solved(written(BEVEL, "space"), {})
    q = -4 * 3 / (16 * 0.1 + 0.5)
    assert a == pytest.approx([-4 * q, q]) and lam == pytest.approx([0.1 * -4 * q - 3])


DIFFERENTIAL = """
[parameters]
J = 0.3
[coordinates]
c = 0
left = 0
right = 0
s = 0
[bodies.cage]
mass = 1
inertia = [0.5, 0.5, 0.5]
joint = { kind = "revolute", angle = "c", torque = 6 }
[bodies.L]
mass = 0
inertia = ["J", "J", "J"]
joint = { kind = "revolute", on = "cage", angle = "left" }
[bodies.R]
mass = 0
inertia = ["J", "J", "J"]
joint = { kind = "revolute", on = "cage", angle = "right" }
[bodies.spider]
mass = 0
inertia = [0.01, 0.01, 0.01]
joint = { kind = "revolute", on = "cage", axis = [1, 0, 0], angle = "s" }
[constraints.one]
kind = "gear"
bodies = ["L", "spider"]
ratio = 2
[constraints.two]
kind = "gear"
bodies = ["R", "spider"]
ratio = -2
[forces.brake]
kind = "couple"
body = "L"
couple = [0, 0, -2]
"""


def test_a_differential_shares_the_torque_and_the_speeds_add_up():
    """left + right = 0 in the cage; all of it turns with what acts about z, the wheels with the brake alone."""
    a, _ = solved(written(DIFFERENTIAL, "space"), {"J": 0.3})
    c, left, right, s = a
    assert left + right == pytest.approx(0) and left == pytest.approx(2 * s)
    cage = 0.5 + 2 * 0.3 + 0.01  # about z, all of it
    assert c == pytest.approx((6 - 2) / cage)
    assert left * (2 * 0.3 + 0.01 / 4) == pytest.approx(-2)


TABLE = f"""
[parameters]
m = 0.5
M = 0.8
g = {G}
[coordinates]
r = {{ start = 0.4, speed = 0.1 }}
phi = {{ start = 0, speed = 5 }}
z = {{ start = -0.6, speed = 0.1 }}
[points]
hole = [0, 0, 0]
[bodies.puck]
shape = {{ kind = "particle", mass = "m" }}
joint = {{ kind = "placed", at = ["r*cos(phi)", "r*sin(phi)", 0] }}
[bodies.load]
shape = {{ kind = "particle", mass = "M" }}
joint = {{ kind = "placed", at = [0, 0, "z"] }}
[constraints.cord]
kind = "string"
path = ["puck.center", "hole", "load.center"]
[outputs]
T = {{ value = "tension(cord)", at = "t = 0" }}
"""


def test_a_string_through_a_hole_of_a_table_has_one_tension():
    """(m + M) r'' = m r phi'^2 - M g and T = M (g + r''): Goldstein's problem."""
    acceleration = (0.5 * 0.4 * 25 - 0.8 * G) / 1.3
    assert values_of(TABLE + WEIGHT)["T"] == pytest.approx(0.8 * (G + acceleration))
    run = eomgen.simulate(model_of(TABLE + WEIGHT), time=2)
    assert run.drift < 1e-7


PULLEY = f"""
[parameters]
R = 0.2
g = {G}
[coordinates]
a = 0
b = 0
phi = 0
[bodies.wheel]
mass = 3
inertia = INERTIA
joint = {{ kind = "revolute", AXLE angle = "phi" }}
[bodies.left]
shape = {{ kind = "particle", mass = 2 }}
joint = {{ kind = "placed", at = LEFT }}
[bodies.right]
shape = {{ kind = "particle", mass = 1 }}
joint = {{ kind = "placed", at = RIGHT }}
[constraints.rope]
kind = "string"
path = ["left.center", {{ body = "wheel", radius = "R", turn = "cw" AXIS }}, "right.center"]
[forces.weight]
kind = "gravity"
acceleration = DOWN
"""
IN_PLANE = {
    "INERTIA": "0.05",
    "AXLE": "",
    "LEFT": '["-R", "a - 1"]',
    "RIGHT": '["R", "b - 1"]',
    "AXIS": "",
    "DOWN": '[0, "-g"]',
}
IN_SPACE = {
    "INERTIA": "[1, 0.05, 1]",
    "AXLE": "axis = [0, -1, 0],",
    "LEFT": '["-R", 0, "a - 1"]',
    "RIGHT": '["R", 0, "b - 1"]',
    "AXIS": ", axis = [0, -1, 0]",
    "DOWN": '[0, 0, "-g"]',
}


def test_a_rope_over_a_pulley_in_space_moves_as_in_the_plane():
    """Atwood's machine with a heavy pulley, two tensions: (m1 + m2 + J/R^2) a = (m1 - m2) g."""
    found = []
    for space, words in (("plane", IN_PLANE), ("space", IN_SPACE)):
        text = PULLEY
        for word, value in words.items():
            text = text.replace(word, value)
        found.append(solved(written(text, space), {"R": 0.2, "g": G}))
    (a, lam), (other, tensions) = found
    fall = (2 - 1) * G / (3 + 0.05 / 0.2**2)
    assert a == pytest.approx([-fall, fall, fall / 0.2]) and other == pytest.approx(a)
    assert tensions == pytest.approx(lam) and lam == pytest.approx([2 * (G - fall), G + fall])


def test_a_path_in_space_lies_in_the_plane_of_its_seat():
    """A loop that stands upright: N = m v^2/R + m g at its foot, one way across the plane and one in it."""
    text = f"""
[parameters]
g = {G}
[coordinates]
s = {{ start = 0, speed = 5 }}
[bodies.car]
shape = {{ kind = "particle", mass = 2 }}
[bodies.car.joint]
kind = "path"
turned = {{ axis = [1, 0, 0], angle = "pi/2" }}
along = "s"
pieces = [{{ arc = 0.7, turn = "ccw", angle = "pi" }}]
[outputs]
z = {{ value = "reaction_z(car)", at = "t = 0" }}
y = {{ value = "reaction_y(car)", at = "t = 0" }}
top = {{ value = "z(car.center)", at = "s = 0.7*pi/2" }}
"""
    found = values_of(text + WEIGHT)
    assert found["z"] == pytest.approx(2 * (25 / 0.7 + G)) and found["y"] == pytest.approx(0, abs=1e-12)
    assert found["top"] == pytest.approx(0.7)


# -- friction on surfaces --------------------------------------------------------------------------

PUCK = f"""
[parameters]
g = {G}
mu = 0.3
[coordinates]
x = {{ start = 0, speed = VX }}
y = {{ start = 0, speed = VY }}
z = 0
[bodies.puck]
shape = {{ kind = "particle", mass = 1.5 }}
joint = {{ kind = "placed", at = ["x", "y", "z"] }}
[constraints.floor]
kind = "support"
point = "puck.center"
normal = [0, 0, 1]
friction = FRICTION
[forces.field]
kind = "gravity"
acceleration = [AX, AY, "-g"]
"""


def puck(v: tuple[float, float], a: tuple[float, float] = (0, 0), friction: str = '"mu"') -> eomgen.Model:
    text = PUCK.replace("FRICTION", friction)
    for word, value in zip(("VX", "VY", "AX", "AY"), (*v, *a), strict=True):
        text = text.replace(word, str(value))
    return model_of(text)


def test_coulombs_friction_in_space_is_along_the_sliding_and_ends_with_it():
    """It goes straight, |v| falls with mu g, and stops after v^2/(2 mu g); then it sticks."""
    run = eomgen.simulate(puck((1, 2)), time=2)
    way = 5 / (2 * 0.3 * G)
    assert run.x[-1, :2] == pytest.approx(np.array([1, 2]) / sqrt(5) * way, abs=1e-7)
    assert run.x[-1, 3:5] == pytest.approx([0, 0], abs=1e-9)
    assert run.phases[0].end == pytest.approx(sqrt(5) / (0.3 * G), abs=1e-6) and len(run.phases) == 2


def test_a_puck_at_rest_sticks_below_the_limit_and_slides_off_above_it():
    """|F| <= mu N decides; above it a = |f| - mu g along the pull."""
    still, off = (eomgen.simulate(puck((0, 0), pull), time=2) for pull in ((2, 1), (3, 1)))
    assert still.x[-1] == pytest.approx(np.zeros(6), abs=1e-12)
    a = (sqrt(10) - 0.3 * G) * np.array([3, 1]) / sqrt(10)
    assert off.x[-1, 3:5] == pytest.approx(2 * a, abs=1e-6)


def test_friction_turns_a_motion_that_a_field_pulls_aside():
    """v' = f - mu g v/|v|, against the same law integrated here by Runge and Kutta's method."""
    run = eomgen.simulate(puck((1, 0), (0, 4)), time=1)
    state = np.array([0.0, 0.0, 1.0, 0.0])

    def rate(s: np.ndarray) -> np.ndarray:
        v = s[2:]
        return np.concatenate([v, np.array([0, 4]) - 0.3 * G * v / hypot(*v)])

    for _ in range(2000):
        k1 = rate(state)
        k2 = rate(state + k1 / 4000)
        k3 = rate(state + k2 / 4000)
        state = state + (k1 + 2 * k2 + 2 * k3 + rate(state + k3 / 2000)) / 12000
    assert np.concatenate([run.x[-1, :2], run.x[-1, 3:5]]) == pytest.approx(state, abs=1e-7)


def test_viscous_friction_in_space_is_along_the_velocity():
    """m v' = - c N v: v = v_0 e^(- c g t)."""
    run = eomgen.simulate(puck((1, 2), friction="{ viscous = 0.2 }"), time=1)
    assert run.x[-1, 3:5] == pytest.approx(np.exp(-0.2 * G) * np.array([1, 2]), abs=1e-8)


BALL = f"""
[parameters]
m = 1.5
g = {G}
mu = 0.3
R = 0.1
[coordinates]
x = {{ start = 0, speed = 1 }}
y = 0
z = 0.1
e0 = 1
e1 = 0
e2 = 0
e3 = 0
[speeds]
w1 = {{ start = 3 }}
w2 = {{ start = 0 }}
w3 = {{ start = 0.5 }}
[bodies.ball]
shape = {{ kind = "sphere", mass = "m", radius = "R" }}
[bodies.ball.joint]
kind = "free"
position = ["x", "y", "z"]
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]
[constraints.floor]
kind = "rolling"
body = "ball"
plane = {{ at = [0, 0, 0], normal = [0, 0, 1] }}
slip = true
friction = "mu"
"""


def test_a_ball_that_slides_begins_to_roll():
    """It rolls with v = (5 v_0 + 2 R w_0 x e_z)/7 after t = 2 |slip_0|/(7 mu g): Euler, and every book on billiards."""
    run = eomgen.simulate(model_of(BALL + WEIGHT), time=0.5)
    slip = hypot(1, 0.3)
    assert run.phases[0].end == pytest.approx(2 * slip / (7 * 0.3 * G), abs=1e-6)
    velocity = run.x[-1, 7:9]
    assert velocity == pytest.approx([5 / 7, -2 * 0.3 / 7], abs=1e-6)


# -- rows of velocities alone ----------------------------------------------------------------------

DISC = """
[parameters]
R = 0.3
[coordinates]
x = 0.1
y = 0.2
psi = 0.3
theta = 0.4
[bodies.body]
mass = 1
inertia = 1
joint = { kind = "planar", x = "x", y = "y", angle = "psi" }
[bodies.wheel]
mass = 1
inertia = 2
joint = { kind = "revolute", angle = "theta" }
"""


def rates(*laws: str) -> str:
    return DISC + "".join(f'[constraints.c{k}]\nkind = "equation"\nrate = "{law}"\n' for k, law in enumerate(laws))


CASES = {
    "an upright disc reaches every place": (["x' - R*cos(psi)*theta'", "y' - R*sin(psi)*theta'"], [False, False], 2, 4),
    "a wheel on a straight rail is holonomic": (["x' - R*theta'"], [True], 3, 3),
    "a factor makes x psi' - psi x' exact": (["x*psi' - psi*x'"], [True], 3, 3),
    "y' = 2 x theta' only with x' = R theta'": (["x' - R*theta'", "y' - 2*x*theta'"], [True, True], 2, 2),
    "y' = psi x' cannot": (["y' - psi*x'"], [False], 3, 4),
    "two rows of which one reaches on": (["y' - psi*x'", "theta' - 2*psi'"], [False, True], 2, 3),
    "Engel's rows: brackets of brackets": (["y' - psi*x'", "psi' - theta*x'"], [False, False], 2, 4),
    "a belt that moves": (["x' - R*theta' - t"], [True], 3, 3),
}


@each("name", CASES)
def test_frobenius_and_chow_tell_what_a_row_of_velocities_is(name):
    """dw(X, Y) = 0 on what is allowed; the fields and their brackets span the positions that are reached."""
    laws, integrable, in_velocity, in_position = CASES[name]
    freedom = Freedom.of(model_of(rates(*laws), "plane"))
    assert freedom.integrability is not None
    assert [row.integrable for row in freedom.integrability.rows] == integrable
    assert (freedom.by_rank, freedom.integrability.positions) == (in_velocity, in_position)


def test_an_integral_is_given_with_the_constant_of_the_start(tmp_path):
    """x' = R theta': x - R theta - (0.1 - 0.4 R) = 0, from `check` in both forms."""
    from eomgen.results.declared import check_document

    found = check_document(model_of(rates("x' - R*theta'"), "plane")).entries()
    (row,) = found["velocity_rows"]
    expression = eomgen.symbolic.expression.text.parse(row["integral"])
    for x, theta, R in ((0.1, 0.4, 0.3), (1.7, 0.4 + 1.6 / 0.5, 0.5)):
        assert expression.evaluate({"x": x, "theta": theta, "R": R}) == pytest.approx(0, abs=1e-12)
    assert abs(expression.evaluate({"x": 1, "theta": 0, "R": 1})) > 0.1
    assert json.dumps(found["position_freedoms"]) == "3"


WAVY = """
[parameters]
m = { value = 1, unit = "kg", positive = true }
r = { value = 0.2, unit = "m", positive = true }
A = { value = 0.3, unit = "m", positive = true }
k = { value = 1.2, unit = "1/m", positive = true }
[coordinates]
s = { start = 0.2, speed = 1.5, unit = "m" }
phi = { start = 0, dependent = true, unit = "rad" }
[bodies.disc]
shape = { kind = "disc", mass = "m", radius = "r" }
[bodies.disc.joint]
kind = "placed"
at = ["s - r*A*k*cos(k*s)/sqrt(1 + (A*k*cos(k*s))^2)", "A*sin(k*s) + r/sqrt(1 + (A*k*cos(k*s))^2)"]
angle = "phi"
[constraints.roll]
kind = "equation"
rate = "(vx(disc.center) + vy(disc.center)*A*k*cos(k*s))/sqrt(1 + (A*k*cos(k*s))^2) + r*omega(disc)"
"""


def test_no_rules_are_sought_for_an_elliptic_integral(monkeypatch):
    """phi' = f(s) s' is holonomic; f(s) ds with roots of cos(k s) has no closed form: no rule of sympy's is tried"""
    tried = []
    monkeypatch.setattr("sympy.integrals.manualintegrate.manualintegrate", lambda *given: tried.append(given))
    (row,) = Freedom.of(model_of(WAVY, "plane")).integrability.rows
    assert row.integrable and row.integral is None and not tried


def test_short_integrals_of_roots_of_sines_are_given():
    """d/dx of the integral of sin(x) sqrt(1 + cos(x)) is it, at random x"""
    graph = Graph()
    x = graph.symbol("x")
    f = function("sin", x) * function("sqrt", 1 + function("cos", x))
    F = primitive(f, x)
    (slope,) = gradient(F, (x,))
    for at in (0.3, 1.1):
        value, due = evaluate((slope, f), {x: at}, FLOAT)
        assert value == pytest.approx(due, rel=1e-12)


def test_a_ball_that_rolls_reaches_all_five_freedoms():
    """Two rows of no slip on a plane, with a unit quaternion: 3 degrees of freedom in velocity, 5 in position."""
    text = BALL.replace("slip = true\n", "").replace('friction = "mu"\n', "")
    freedom = Freedom.of(model_of(text))
    assert freedom.integrability is not None
    assert (freedom.by_rank, freedom.integrability.positions) == (3, 5)


# -- errors ----------------------------------------------------------------------------------------

WRONG = [
    (BEAD + '[constraints.c]\nkind = "equation"\ngap = "speed(bead.center)"\n', "'speed(bead.center)' cannot stand in"),
    (BEAD + '[constraints.c]\nkind = "equation"\ngap = "vx(bead.center)"\n', "only x, y, z, angle"),
    (BEAD + '[constraints.c]\nkind = "equation"\ngap = "x(bead.rim)"\n', "has no point 'rim'"),
    (BEAD + '[constraints.c]\nkind = "equation"\ngap = "x(bead.center, bead, bead)"\n', "name one body"),
    (WIRE + "unilateral = true\n", "it cannot end"),
    (TABLE.replace('"load.center"]\n', '"load.center"]\nstrands = ["up", [0, 0, -1]]\n'), "says no direction in space"),
]


@each("text, message", WRONG)
def test_what_an_equation_or_a_tie_cannot_say_in_space_is_an_error_of_the_model(text, message):
    """The culprit and the fix, from reading the model."""
    with pytest.raises(ModelError) as caught:
        model_of(text)
    assert message in str(caught.value)


NOT_DERIVED = [
    (BEAD + '[constraints.c]\nkind = "equation"\nrate = "vx(bead.center)^2 - 1"\n', "not linear in the velocities"),
    (BEAD + '[constraints.c]\nkind = "equation"\nrate = "x\'*vx(bead.center)"\n', "not linear in the rates"),
    (BEAD + '[constraints.c]\nkind = "equation"\ngap = "angle(bead) - 1"\n', "no single angle in space"),
    (
        BEVEL.replace(
            'kind = "revolute", axis = [1, 0, 0], angle = "p"',
            'kind = "universal", axes = [[1, 0, 0], [0, 1, 0]], angles = ["p", "q"]',
        ).replace(", torque = 3", ""),
        "the joint of body 'pinion' has no single angle",
    ),
    (
        PULLEY.replace("INERTIA", "[1, 1, 1]")
        .replace("AXLE", "")
        .replace("LEFT", '[0, 0.2, "a"]')
        .replace("AXIS", "")
        .replace("RIGHT", '[1, 1, "b"]')
        .replace("DOWN", "[0, 0, -1]"),
        "is not in the plane of the wrap",
    ),
]


@each("text, message", NOT_DERIVED)
def test_what_cannot_be_derived_in_space_says_why(text, message):
    """One clear error, never a traceback or a wrong answer."""
    with pytest.raises(EomgenError) as caught:
        written(text, "space")
    assert message in str(caught.value)
