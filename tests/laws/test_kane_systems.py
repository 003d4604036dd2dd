"""Systems of sympy.physics.mechanics, PyDy and of Kane & Levinson: speeds, velocity constraints, what their forces
are."""

from __future__ import annotations

import math

import numpy as np
import pytest

import eomgen
from eomgen.errors import ModelError
from eomgen.results.declared import check_document

pytestmark = pytest.mark.slow

DISC = """eomgen = 1
name = "rolling disc"
space = "space"
[parameters]
g = 9.81
r = 0.26
m = 3.43
[coordinates]
q1 = 0.3
q2 = 0.1
q3 = 1.97
q4 = { dependent = true, start = -0.35 }
q5 = { dependent = true, start = 2.27 }
[speeds]
u1 = { rate = "-q1'*sin(q3)*cos(q2) + q2'*cos(q3)", start = -0.2 }
u2 = { rate = "q1'*sin(q2) + q3'", start = 1.3 }
u3 = { rate = "q1'*cos(q2)*cos(q3) + q2'*sin(q3)", start = 0.15 }
[bodies.disc]
mass = "m"
inertia = ["m*r^2/4", "m*r^2/2", "m*r^2/4"]
[bodies.disc.joint]
kind = "placed"
at = ["q4 + r*sin(q1)*sin(q2)", "q5 - r*cos(q1)*sin(q2)", "r*cos(q2)"]
orientation = "zxy"
angles = ["q1", "q2", "q3"]
[constraints.road]
kind = "rolling"
body = "disc"
axis = [0, 1, 0]
radius = "r"
plane = { at = [0, 0, 0], normal = [0, 0, 1] }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
[outputs]
q1 = "q1'"
q2 = "q2'"
q3 = "q3'"
q4 = "q4'"
q5 = "q5'"
u1 = "u1'"
u2 = "u2'"
u3 = "u3'"
u4 = "q4''"
u5 = "q5''"
"""


def test_a_disc_by_body_fixed_speeds_has_the_numbers_of_sympys_test():
    """Source: sympy 1.14, physics/mechanics/tests/test_kane5.py, first numeric test."""
    expected = (
        0.126603940595934,
        0.215942571601660,
        1.28736069604936,
        0.319764288376543,
        0.0989146857254898,
        -0.925848952664489,
        -0.0181350656532944,
        2.91695398184589,
        -0.00992793421754526,
        0.0412861634829171,
    )
    found = [answer.value for answer in eomgen.solve(eomgen.loads(DISC)).values()]
    assert found == pytest.approx(expected, rel=1e-12)


TRICYCLE = """eomgen = 1
name = "a frame on two wheels and a ball that slides, on a slope"
space = "space"
[parameters]
R = 0.3
g = 9.81
f = 0.6
theta = 0.4
a = 0.35
b = 0.4
mA = 5
mB = 1.2
IA = 0.6
J = 0.05
K = 0.03
mu = 0.2
[coordinates]
X = { start = "R" }
Y = {}
Z = {}
q1 = 0.7
p2 = 0
p3 = 0
q2 = 0.1
q3 = -0.2
[speeds]
u1 = { rate = "q1'", start = 0.3 }
u2 = { rate = "Y'*cos(q1) + Z'*sin(q1)", start = 1.1 }
u3 = { rate = "-Y'*sin(q1) + Z'*cos(q1)" }
[bodies.P]
joint = { kind = "fixed", axis = [0, 1, 0], angle = "-theta" }
[bodies.A]
mass = "mA"
center = [0, "a", 0]
inertia = ["IA", 0.4, 0.5]
points = { Q = ["-R", "f", 0], wB = [0, 0, "b"], wC = [0, 0, "-b"] }
joint = { kind = "free", on = "P", position = ["X", "Y", "Z"], orientation = "xyz", angles = ["q1", "p2", "p3"] }
[bodies.B]
mass = "mB"
inertia = ["K", "K", "J"]
joint = { kind = "revolute", on = "A.wB", angle = "q2" }
[bodies.C]
mass = "mB"
inertia = ["K", "K", "J"]
joint = { kind = "revolute", on = "A.wC", angle = "q3" }
[constraints]
wheelB = { kind = "rolling", body = "B", axis = [0, 0, 1], radius = "R", on = "P", PLANE }
wheelC = { kind = "rolling", body = "C", axis = [0, 0, 1], radius = "R", on = "P", PLANE }
skid = { kind = "support", point = "A.Q", normal = ["cos(theta)", 0, "sin(theta)"], at = [0, 0, 0], friction = "mu" }
[forces.weight]
kind = "gravity"
acceleration = ["-g", 0, 0]
""".replace("PLANE", "plane = { at = [0, 0, 0], normal = [1, 0, 0] }")


def test_kanes_frame_on_wheels_slides_with_its_ball():
    """M_1 u1' = -m_A a u1 u2 + f Q3 + M g e sin(theta) cos(q1), M_2 u2' = m_A a u1^2 + Q2 + M g sin(theta) sin(q1),
    0 = M g e cos(theta) - f Q1 - R Q2: Kane & Levinson, exercises 8.12 and 8.17.
    """
    R, g, f, theta, a, b, mA, mB, IA, J, K, mu = 0.3, 9.81, 0.6, 0.4, 0.35, 0.4, 5, 1.2, 0.6, 0.05, 0.03, 0.2
    q1, u1, u2 = 0.7, 0.3, 1.1
    weight, lever, v = (mA + 2 * mB) * g, mA * a / (mA + 2 * mB), math.hypot(u2, f * u1)
    Q1 = lever * weight * math.cos(theta) / (f - mu * R * u2 / v)
    Q2, Q3 = -mu * Q1 * u2 / v, -mu * Q1 * f * u1 / v
    M1 = IA + 2 * J * b**2 / R**2 + 2 * K + mA * a**2 + 2 * mB * b**2
    u1d = (-mA * a * u1 * u2 + f * Q3 + weight * lever * math.sin(theta) * math.cos(q1)) / M1
    u2d = (mA * a * u1**2 + Q2 + weight * math.sin(theta) * math.sin(q1)) / (mA + 2 * mB + 2 * J / R**2)
    equations = eomgen.derive(eomgen.loads(TRICYCLE), method="projection")
    rhs, reactions = equations.rhs("numpy"), equations.reaction_rhs("numpy")
    rates = dict(zip((*rhs.coordinates, *rhs.speeds), rhs(0.0, rhs.x0, rhs.p0), strict=True))
    forces = dict(zip(reactions.names, reactions(0.0, rhs.x0, rhs.p0), strict=True))
    assert (rates["u1"], rates["u2"]) == pytest.approx((u1d, u2d), rel=1e-9)
    assert forces["reaction_n(skid)"] == pytest.approx(Q1, rel=1e-9)
    assert math.hypot(forces["reaction_t(skid)"], forces["reaction_s(skid)"]) == pytest.approx(math.hypot(Q2, Q3))


def test_brackets_that_vanish_reach_no_new_position():
    """Of (Y, Z, q1, q2, q3) the wheels reach four: 2 b q1' = R (q2' - q3') is the derivative of a position."""
    assert eomgen.freedom_of(eomgen.loads(TRICYCLE)).integrability.positions == 4


def test_check_counts_the_declared_speeds_too():
    """Two speeds for three rates are an error of `check`, not only of the verbs that need them."""
    text = "\n".join(line for line in TRICYCLE.splitlines() if not line.startswith("u3 ="))
    with pytest.raises(ModelError, match=r"2 speeds are declared for 3 rates \(Y', Z', q1'\)"):
        check_document(eomgen.loads(text))


SNAKEBOARD = """eomgen = 1
name = "snakeboard"
space = "plane"
[parameters]
l = 0.6
I = 0.7
m = 2.3
[coordinates]
q1 = { dependent = true, start = 0.1 }
q2 = { dependent = true, start = -0.2 }
q3 = { start = 0.3 }
q4 = { start = 0.5 }
q5 = { start = -0.4 }
[speeds]
u3 = { rate = "l*q3'/2", start = 0.9 }
u4 = { rate = "q4'", start = 0.3 }
u5 = { rate = "q5'", start = -0.7 }
[bodies.A]
mass = "m"
inertia = "I"
points = { B = ["l/2", 0], C = ["-l/2", 0] }
joint = { kind = "planar", x = "q1", y = "q2", angle = "q3" }
[bodies.B]
mass = "m"
inertia = "I"
joint = { kind = "revolute", on = "A.B", angle = "q4" }
[bodies.C]
mass = "m"
inertia = "I"
joint = { kind = "revolute", on = "A.C", angle = "q5" }
[constraints]
front = { kind = "skate", point = "B.origin", along = [1, 0] }
back = { kind = "skate", point = "C.origin", along = [1, 0] }
[outputs]
u1 = "q1'"
u2 = "q2'"
u3 = "u3'"
u4 = "u4'"
u5 = "u5'"
front = "reaction_n(front)"
back = "reaction_n(back)"
"""


def test_a_snakeboard_whose_board_follows_moves_as_by_lagrange_with_multipliers():
    """M q'' + c = J^T lam, J q'' + J' q' = 0 of the bodies at (q1, q2), (q1, q2) +- l/2 e(q3), in plain numbers.

    The system of the chapters on nonholonomic motion of J. K. Moore, Learn Multibody Dynamics.
    """
    length, inertia, mass, (q3, q4, q5) = 0.6, 0.7, 2.3, (0.3, 0.5, -0.4)
    M = np.diag([3 * mass, 3 * mass, mass * length**2 / 2 + 3 * inertia, inertia, inertia])
    M[2, 3:] = M[3:, 2] = inertia

    def constraints(q: np.ndarray) -> np.ndarray:
        left = [(-math.sin(q[2] + q[k]), math.cos(q[2] + q[k])) for k in (3, 4)]
        sides = (length / 2, -length / 2)
        return np.array(
            [
                [x, y, side * (y * math.cos(q[2]) - x * math.sin(q[2])), 0, 0]
                for (x, y), side in zip(left, sides, strict=True)
            ]
        )

    q = np.array([0.1, -0.2, q3, q4, q5])
    J, spins = constraints(q), np.array([2 * 0.9 / length, 0.3, -0.7])
    rates = np.concatenate([np.linalg.solve(J[:, :2], -J[:, 2] * spins[0]), spins])
    bent = (constraints(q + 1e-6 * rates) - constraints(q - 1e-6 * rates)) @ rates / 2e-6
    system = np.block([[M, -J.T], [J, np.zeros((2, 2))]])
    solved = np.linalg.solve(system, np.concatenate([np.zeros(5), -bent]))
    found = {name: answer.value for name, answer in eomgen.solve(eomgen.loads(SNAKEBOARD)).items()}
    expected = [*rates[:2], solved[2] * length / 2, solved[3], solved[4], solved[5], solved[6]]
    assert list(found.values()) == pytest.approx(expected, rel=1e-7)


SLEIGH = """eomgen = 1
name = "sleigh"
space = "plane"
[parameters]
m = 2
I = 0.5
a = 0.3
[coordinates]
x = 0
y = 0
th = 0.2
[speeds]
v = { rate = "x'*cos(th) + y'*sin(th)", start = 1 }
s = { rate = "-x'*sin(th) + y'*cos(th)" }
w = { rate = "th'", start = 0.4 }
[bodies.b]
mass = "m"
inertia = "I"
center = ["a", 0]
joint = { kind = "planar", x = "x", y = "y", angle = "th" }
[constraints.edge]
kind = "equation"
rate = "RATE"
[outputs]
v = "v'"
w = "w'"
lam = "multiplier(edge)"
"""


@pytest.mark.parametrize("rate", ["s - 0.1*t*w", "-x'*sin(th) + y'*cos(th) - 0.1*t*th'"])
def test_a_velocity_tie_may_be_written_in_the_declared_speeds(rate):
    """At t = 0: v' = a w^2, s' = w/10, m (s' + a w' + v w) = lam, I w' = -a lam."""
    m, inertia, a, v, w = 2, 0.5, 0.3, 1, 0.4
    spin = -m * a * (w / 10 + v * w) / (inertia + m * a * a)
    found = [answer.value for answer in eomgen.solve(eomgen.loads(SLEIGH.replace("RATE", rate))).values()]
    assert found == pytest.approx((a * w * w, spin, m * (w / 10 + a * spin + v * w)), rel=1e-12)


PLATES = """eomgen = 1
name = "a ball between two plates that turn"
space = "space"
[parameters]
r = 0.1
m = 1
W1 = 2
W2 = -1
[coordinates]
a1 = { motion = "W1*t" }
a2 = { motion = "W2*t" }
x = 0.3
y = 0
z = "r"
e0 = 1
e1 = 0
e2 = 0
e3 = 0
[speeds]
w1 = {}
w2 = {}
w3 = { start = 1 }
[bodies.lower]
joint = { kind = "revolute", angle = "a1" }
[bodies.upper]
joint = { kind = "revolute", at = [0.5, 0, "2*r"], angle = "a2" }
[bodies.ball]
shape = { kind = "sphere", mass = "m", radius = "r" }
[bodies.ball.joint]
kind = "free"
position = ["x", "y", "z"]
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]
[constraints]
low = { kind = "rolling", body = "ball", on = "lower", plane = { at = [0, 0, 0], normal = [0, 0, 1] } }
up = { kind = "rolling", body = "ball", on = "upper", plane = { at = [0, 0, 0], normal = [0, 0, -1] } }
[outputs]
X = "x''"
"""


def test_formulas_of_accelerations_have_a_value_at_the_start():
    """The ball moves with the mean of the plates: x'' = -(W1 + W2)/2 y'; no form of it is 0/0 at e = (1, 0, 0, 0)."""
    answer = eomgen.solve(eomgen.loads(PLATES))["X"]
    assert answer.value == pytest.approx(-0.2, rel=1e-9)
    assert "/(" not in answer.exact


DRIVE = """eomgen = 1
name = "a cart on two driven wheels"
space = "plane"
[parameters]
m = 4
I = 0.08
b = 0.2
r = 0.05
J = 0.002
[coordinates]
x = { dependent = true, start = 0 }
y = { dependent = true, start = 0 }
th = { dependent = true, start = 0.3 }
left = { speed = 2 }
right = { speed = 3 }
[bodies.base]
mass = "m"
inertia = "I"
points = { l = [0, "b"], r = [0, "-b"] }
joint = { kind = "planar", x = "x", y = "y", angle = "th" }
[bodies.wheel_l]
inertia = "J"
mass = 0
joint = { kind = "placed", at = [0, 0], angle = "left" }
[bodies.wheel_r]
inertia = "J"
mass = 0
joint = { kind = "placed", at = [0, 0], angle = "right" }
[constraints]
side = { kind = "skate", point = "base.origin", along = [1, 0] }
l = { kind = "equation", rate = "vx(base.l)*cos(th) + vy(base.l)*sin(th) - r*left'" }
r = { kind = "equation", rate = "vx(base.r)*cos(th) + vy(base.r)*sin(th) - r*right'" }
[forces]
motor_l = { kind = "couple", body = "wheel_l", couple = 0.1 }
motor_r = { kind = "couple", body = "wheel_r", couple = 0.3 }
[outputs]
left = "left''"
right = "right''"
lam_l = "multiplier(l)"
lam_r = "multiplier(r)"
N = "reaction_n(side)"
"""


def test_ties_that_are_eliminated_together_have_their_multipliers():
    """(J + p) l'' + q r'' = T_l, q l'' + (J + p) r'' = T_r, p, q = m r^2/4 +- I r^2/(4 b^2); lam = (T - J l'')/r."""
    m, inertia, b, r, J, T = 4, 0.08, 0.2, 0.05, 0.002, np.array([0.1, 0.3])
    p, q = (m * r * r / 4 + sign * inertia * r * r / (4 * b * b) for sign in (1, -1))
    spins = np.linalg.solve([[J + p, q], [q, J + p]], T)
    answers = eomgen.solve(eomgen.loads(DRIVE))
    found = [answers[name].value for name in ("left", "right", "lam_l", "lam_r")]
    assert found == pytest.approx([*spins, *((T - J * spins) / r)], rel=1e-12)
    assert "the constraint 'l' acts on coordinates and at no place" in answers["N"].message


def test_the_centre_of_a_body_is_not_drawn_from_ties_in_which_other_rates_stand():
    """The wheels' rows allow any motion of the cart: their lines of force say nothing of its centre of rotation."""
    assert "DISAGREE" not in eomgen.kinematics(eomgen.loads(DRIVE)).render("text")


def test_ties_that_follow_from_one_another_have_no_multipliers_of_their_own():
    """lam_a + 2 lam_b = 0 says nothing of lam_a; x' = 3 is kept by lam_c = -k."""
    text = """eomgen = 1
space = "plane"
parameters = { m = 2, k = 3 }
coordinates = { x = {}, y = {} }
bodies.p = { shape = { kind = "particle", mass = "m" }, joint = { kind = "planar", x = "x", y = "y", angle = 0 } }
constraints.a = { kind = "equation", gap = "x - y" }
constraints.b = { kind = "equation", gap = "2*x - 2*y" }
constraints.c = { kind = "equation", rate = "x' - 3" }
forces.f = { kind = "force", point = "p.center", force = ["k", 0] }
outputs = { a = "multiplier(a)", b = "multiplier(b)", c = "multiplier(c)" }
"""
    answers = eomgen.solve(eomgen.loads(text))
    assert [answers[name].value for name in "abc"] == [None, None, -3]
    assert answers["a"].message.startswith("statically indeterminate: multiplier(a) shares its force with 'b'")


@pytest.mark.parametrize(
    ("space", "joint", "count", "formula"),
    [
        ("plane", 'kind = "planar", x = "x", y = "y", angle = 0', 2, "2*1 (particles)"),
        (
            "space",
            'kind = "free", position = ["x", "y", 0], orientation = "xyz", angles = [0, 0, 0]',
            2,
            "3*1 (particles) - 1 (joints)",
        ),
    ],
)
def test_constants_in_a_joint_are_no_freedoms_of_the_count(space, joint, count, formula):
    """A point that its joint cannot turn is a particle; z = 0 takes one component."""
    text = f"""eomgen = 1
space = "{space}"
coordinates = {{ x = 0, y = 0 }}
bodies.p = {{ shape = {{ kind = "particle", mass = 1 }}, joint = {{ {joint} }} }}
"""
    freedom = eomgen.freedom_of(eomgen.loads(text))
    assert (freedom.by_rank, freedom.by_formula, freedom.formula) == (2, count, formula)


MUSCLE = """eomgen = 1
name = "a forearm on a muscle that runs over the elbow"
space = "plane"
[parameters]
upper = 0.3
l = 0.35
m = 1.5
r = 0.03
k = 900
g = 9.81
[coordinates]
q = 0.6
s = { dependent = true, near = 0.05 }
[bodies.forearm]
shape = { kind = "rod", mass = "m", length = "l" }
points = { insertion = [0.08, 0] }
joint = { kind = "revolute", angle = "q - pi/2" }
[bodies.belly]
mass = 0
joint = { kind = "prismatic", at = [0, "upper"], axis = [0, 1], displacement = "s", stiffness = "k" }
[constraints.tendon]
kind = "string"
path = ["belly.origin", { at = [0, 0], radius = "r", turn = "cw", slip = true }, "forearm.insertion"]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
q = "q''"
T = "tension(tendon)"
"""


def test_a_tendon_runs_over_a_radius_that_is_less_than_a_length_in_numbers():
    """m l^2/3 q'' = -m g l/2 sin(q) + r T, T cos(a) = -k s with sin(a) = r/(upper + s) where the tendon leaves."""
    upper, length, m, r, k, g, q, s = 0.3, 0.35, 1.5, 0.03, 900, 9.81, 0.6, 0.05
    T = -k * s / math.sqrt(1 - (r / (upper + s)) ** 2)
    spin = (-m * g * length / 2 * math.sin(q) + r * T) / (m * length**2 / 3)
    found = eomgen.solve(eomgen.loads(MUSCLE))
    assert (found["q"].value, found["T"].value) == pytest.approx((spin, T), rel=1e-12)


def test_accelerations_do_not_stand_in_a_velocity_tie():
    """A constraint of velocities is linear in rates and speeds; their derivatives are named for what they are."""
    with pytest.raises(ModelError, match=r"\"?'v'' \(an acceleration\) cannot stand in the rate of constraint 'edge'"):
        eomgen.loads(SLEIGH.replace("RATE", "v' - 1"))


SLIDING = """eomgen = 1
space = "plane"
parameters = { m = 1, g = 9.81 }
coordinates = { x = { start = 0.5 SPEED }, phi = { dependent = true, near = 0.5 } }
SPEEDS
[bodies.slider]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[bodies.rod]
shape = { kind = "rod", mass = "m", length = 1 }
joint = { kind = "revolute", on = "slider", angle = "phi" }
[constraints.wall]
kind = "support"
point = "rod.end"
normal = [1, 0]
at = [0, 0]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
fast = "phi'"
"""


def test_declared_speeds_beside_dependent_coordinates_move_as_rates_do():
    """u = 2 x' and phi by a constraint, through two dead centres: the motion of x' alone."""
    speeds = eomgen.loads(SLIDING.replace("SPEEDS", """speeds.u = { rate = "2*x'", start = 3 }""").replace("SPEED", ""))
    rates = eomgen.loads(SLIDING.replace("SPEEDS", "").replace("SPEED", ", speed = 1.5"))
    one, other = (eomgen.simulate(model, time=1.5) for model in (speeds, rates))
    assert one.status == other.status == "finished" and "2 singular positions" in repr(one)
    assert np.allclose(one["x"], other["x"], atol=1e-7) and np.allclose(one["u"], 2 * other["x'"], atol=1e-6)
    assert np.allclose(one.outputs["fast"], other.outputs["fast"], atol=1e-6)
