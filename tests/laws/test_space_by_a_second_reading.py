"""Bodies in space as strangers write them, against a second reading of their files; what once went wrong with them."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest
from model_by_hand import ByHand, mp
from slow_run import usual

import eomgen
from eomgen.errors import DerivationError, ModelError

pytestmark = pytest.mark.slow

HEAD = 'eomgen = 1\nname = "unseen"\nspace = "space"\n'
WEIGHT = '[forces.weight]\nkind = "gravity"\nacceleration = [0, 0, -9.81]\n'
QUATERNION = "[coordinates]\ne0 = 0.9\ne1 = 0.1\ne2 = 0.3\ne3 = -0.2\n"
BY_QUATERNION = 'orientation = "quaternion", quaternion = ["e0", "e1", "e2", "e3"], omega = ["w1", "w2", "w3"]'
SPINS = "[speeds]\nw1 = { start = 0.1 }\nw2 = { start = 0.02 }\nw3 = { start = -0.4 }\n"

SKEW_CHAIN = """
[parameters]
l = 0.8
k = 40
c = 0.6
[coordinates]
psi = { start = 0.4, speed = 1 }
s = { start = 0.2, speed = -0.3 }
b = { start = 0.5, speed = 2 }
d = { start = 0.1, speed = -1 }
e = 0.2
[bodies.post]
mass = 2
center = [0.1, -0.2, 0.3]
inertia = [0.3, 0.4, 0.5, 0.02, -0.03, 0.01]
[bodies.post.joint]
kind = "revolute"
at = [0.3, 0, 0]
turned = [{ axis = [1, 1, 0], angle = "pi/3" }, { axis = [0, 1, 2], angle = 0.4 }]
axis = [1, 2, -1]
angle = "2*psi - 0.1"
damping = "c"
[bodies.slide]
mass = 0.7
inertia = [0.1, 0.12, 0.07]
[bodies.slide.joint]
kind = "prismatic"
on = "post"
at = [0, 0, "l"]
turned = { axis = [0, 1, 0], angle = "pi/6" }
axis = [3, 0, 4]
displacement = "s^2 + s"
angle = 0.7
stiffness = "k"
rest = 0.1
damping = "c"
force = "2*cos(t) - s'"
[bodies.nut]
mass = 0.4
points = { seat = [0.02, 0.03, 0.04] }
inertia = [0.004, 0.004, 0.002]
[bodies.nut.joint]
kind = "screw"
on = "slide"
at = [0.1, 0.2, 0]
axis = [0, 1, 1]
angle = "b"
pitch = 0.05
stiffness = 3
damping = 0.1
torque = "sin(3*t)"
point = "seat"
[bodies.sleeve]
mass = 0.2
center = [0.1, 0, 0]
inertia = [0.001, 0.002, 0.002]
joint = { kind = "cylindrical", on = "nut", displacement = "d", angle = "e", force = "-d", torque = "-0.01*e'" }
"""

UNIVERSALS = """
[parameters]
m = 0.3
l = 0.5
[coordinates]
a1 = { start = 0.3 }
b1 = 0.3
a2 = { start = -0.5, speed = 1 }
b2 = 0.1
[bodies.upper]
mass = "m"
center = ["l/2", 0, 0]
points = { end = ["l", 0, 0] }
inertia = ["m*l^2/600", "m*l^2/12", "m*l^2/12"]
[bodies.upper.joint]
kind = "universal"
turned = { axis = [0, 1, 0], angle = "pi/2" }
axes = [[0, 1, 0], [0, 0, 1]]
angles = ["a1 + t/5", "b1"]
[bodies.lower]
mass = "m"
center = ["l/2", 0.1, 0]
inertia = ["m*l^2/600", "m*l^2/12", "m*l^2/12"]
joint = { kind = "universal", on = "upper.end", axes = [[1, 2, 0], [1, 0, 1]], angles = ["a2", "b2"] }
"""

CONTROL_MOMENT_GYROS = (
    QUATERNION
    + """
d1 = { start = 0.1, speed = 0.3 }
d2 = { start = -0.4, speed = 0.1 }
s1 = { motion = "30*t" }
s2 = { motion = "0.3 + 30*t + sin(t)" }
"""
    + SPINS
    + """
[bodies.bus]
mass = 100
center = [0.1, 0, 0.02]
inertia = [10, 12, 14, 0.1, 0, -0.2]
joint = { kind = "spherical", """
    + BY_QUATERNION
    + """ }
[bodies.gimbal]
inertia = [0.1, 0.1, 0.1]
mass = 0
[bodies.gimbal.joint]
kind = "revolute"
on = "bus"
turned = { axis = [1, 0, 0], angle = 0.955 }
angle = "d1"
torque = "0.2*cos(t)"
[bodies.rotor]
mass = 1
inertia = [0.2, 0.1, 0.1]
joint = { kind = "revolute", on = "gimbal", axis = [1, 0, 0], angle = "s1" }
[bodies.other_gimbal]
mass = 0
inertia = [0.1, 0.1, 0.1]
[bodies.other_gimbal.joint]
kind = "revolute"
on = "bus"
turned = [{ axis = [0, 0, 1], angle = "pi/2" }, { axis = [1, 0, 0], angle = 0.955 }]
angle = "d2"
torque = "-0.3*d2'"
[bodies.other_rotor]
mass = 1
inertia = [0.2, 0.1, 0.1]
joint = { kind = "revolute", on = "other_gimbal", axis = [1, 0, 0], angle = "s2" }
[forces.jet]
kind = "couple"
body = "bus"
couple = [0.1, "-0.2*w2", 0]
axes = "bus"
"""
)

CAMERA = """
[coordinates]
yaw = { motion = "0.4*sin(3*t)" }
pitch = { motion = "0.1*sin(t)" }
roll = { motion = "0.2" }
x = { motion = "0.1*cos(3*t)" }
y = { motion = "0" }
z = { motion = "0.05*sin(6*t)" }
pan = { start = 0.3, speed = 0.5 }
tilt = { start = -0.5, speed = 0.5 }
[bodies.ship]
joint = { kind = "free", position = ["x", "y", "z"], orientation = "zyx", angles = ["yaw", "pitch", "roll"] }
[bodies.fork]
mass = 0.5
inertia = [0.01, 0.012, 0.014]
center = [0, 0, 0.05]
joint = { kind = "revolute", on = "ship", at = [0, 0, 0.1], angle = "pan", damping = 0.02, stiffness = 0.1 }
[bodies.camera]
mass = 1.5
center = [0.02, 0.01, 0]
inertia = [0.004, 0.005, 0.006, 0.0005, -0.0002, 0.0003]
joint = { kind = "revolute", on = "fork", axis = [0, 1, 0], angle = "tilt", damping = 0.01 }
"""

PUCK = """
[coordinates]
psi = { motion = "1.5*t + 0.2*sin(t)" }
x = { start = 0.3, speed = 0.5 }
y = { start = -0.1 }
f = { start = 0.4, speed = 2 }
[bodies.table]
joint = { kind = "revolute", turned = { axis = [0, 1, 0], angle = 0.436 }, axis = [0, 1, 3], angle = "psi" }
[bodies.puck]
mass = 0.7
center = [0.05, 0, 0]
inertia = [0.01, 0.02, 0.025, 0.001, 0, 0]
[bodies.puck.joint]
kind = "planar"
on = "table"
at = [0, 0, 0.1]
turned = { axis = [1, 0, 0], angle = 0.3 }
x = "x"
y = "y"
angle = "f"
[forces.drag]
kind = "couple"
body = "puck"
couple = [0, 0, "-0.01*f'"]
axes = "puck"
"""

SYSTEMS = {
    "skew chain": SKEW_CHAIN,
    "universals": UNIVERSALS,
    "gyros": CONTROL_MOMENT_GYROS,
    "camera": CAMERA,
    "puck": PUCK,
}


@pytest.mark.parametrize("name", usual([*SYSTEMS], 2, 1))
def test_a_tree_moves_and_reacts_as_a_second_reading_of_its_file_says(name):
    """u' and the force and couple in every joint, at random states."""
    text = HEAD + SYSTEMS[name] + WEIGHT
    by_hand, equations = ByHand(text), eomgen.derive(eomgen.loads(text))
    rhs, reactions = equations.rhs("numpy"), equations.reaction_rhs("numpy")
    random = Random(name)
    q = {k: mp.mpf(random.uniform(-0.8, 0.8)) for k in by_hand.q}
    for quaternion, _ in by_hand.turns:
        size = mp.sqrt(sum(q[e] ** 2 for e in quaternion))
        q |= {e: q[e] / size for e in quaternion}
    u, t = {k: mp.mpf(random.uniform(-2, 2)) for k in by_hand.u}, mp.mpf("0.3")
    speeds = [u[k.removesuffix("'")] for k in equations.speeds]
    names = by_hand.names(q, t)
    state = np.array([float(x) for x in (*(names[k] for k in equations.coordinates), *speeds)])
    expected = by_hand.accelerations(q, u, t)
    found = rhs(0.3, state, rhs.p0)[-len(speeds) :]
    assert found == pytest.approx([float(expected[k.removesuffix("'")]) for k in equations.speeds], rel=1e-9, abs=1e-9)
    held = dict(zip(reactions.names, reactions(0.3, state, rhs.p0), strict=True))
    compared = 0
    for body, (force, couple) in by_hand.reactions(q, u, t).items():
        for k, axis in enumerate("xyz"):
            for requested, known in ((f"reaction_{axis}", force[k]), (f"reaction_couple_{axis}", couple[k])):
                if f"{requested}({body})" in held:
                    compared += 1
                    assert held[f"{requested}({body})"] == pytest.approx(float(known), rel=1e-8, abs=1e-8), requested
    assert compared >= 3


@pytest.mark.parametrize("sequence", "xyz xzy yxz yzx zxy zyx xyx xzx yxy yzy zxz zyz".split())
def test_every_sequence_of_angles_is_three_turns_about_the_bodys_own_axes(sequence):
    """R = R_1(a) R_2(b) R_3(c): a top whose mass centre, inertia and point lie anywhere."""
    text = (
        HEAD
        + f"""
[coordinates]
a = {{ start = 0.4, speed = 1 }}
b = {{ start = 0.7, speed = -1 }}
c = {{ start = 0.2, speed = 2 }}
[bodies.top]
mass = 1.3
center = [0.1, 0.05, 0.2]
points = {{ tip = [0.01, 0.02, -0.03] }}
inertia = [0.3, 0.35, 0.42, 0.02, -0.01, 0.03]
[bodies.top.joint]
kind = "spherical"
turned = {{ axis = [1, 1, 1], angle = 0.3 }}
point = "tip"
orientation = "{sequence}"
angles = ["a", "b", "c"]
"""
        + WEIGHT
    )
    rhs = eomgen.derive(eomgen.loads(text)).rhs("numpy")
    q, u = ({k: mp.mpf(str(x)) for k, x in zip("abc", row, strict=True)} for row in ((0.4, 0.7, 0.2), (1, -1, 2)))
    expected = ByHand(text).accelerations(q, u, mp.mpf(0))
    assert rhs(0.0, rhs.x0, rhs.p0)[3:] == pytest.approx([float(expected[k]) for k in "abc"], rel=1e-10)


# -- what drives, where joints share it ------------------------------------------------------------

TWO_RODS = """eomgen = 1
space = "plane"
[coordinates]
q = {{ start = 0.3, speed = 1 }}
psi = {{ motion = "sin(2*t)" }}
[bodies.a]
shape = {{ kind = "rod", mass = 1, length = 1 }}
joint = {{ kind = "revolute", angle = "{first}" }}
[bodies.b]
shape = {{ kind = "rod", mass = 1, length = 1 }}
joint = {{ kind = "revolute", on = "a.end", angle = "{second}" }}
[outputs]
d = "drive(psi)"
"""


@pytest.mark.parametrize("angles", [("q", "psi - q"), ("q + psi", "q")], ids=["absolute angle", "shared angle"])
def test_a_drive_that_moves_joints_together_with_a_freedom_has_no_one_place(angles):
    """The generalized force follows; reactions are refused by name, and never wrong."""
    model = eomgen.loads(TWO_RODS.format(first=angles[0], second=angles[1]))
    equations = eomgen.derive(model)
    assert equations.certify().ok
    with pytest.raises(DerivationError, match="what drives 'psi' has no one place: with 'q' it moves the joints of"):
        equations.reaction_rhs("numpy")
    inverse = eomgen.solve(model)["d"]
    assert inverse.value is not None


def test_a_freedom_that_two_joints_share_is_named_where_nothing_holds_it():
    """angle = q and angle = 2 q: a gear would; no reaction does."""
    model = eomgen.loads(TWO_RODS.format(first="q", second="2*q + psi"))
    with pytest.raises(DerivationError) as refused:
        eomgen.derive(model).reaction_rhs("numpy")
    assert "'a' and 'b'" in str(refused.value)


# -- constants -------------------------------------------------------------------------------------


def test_a_constant_of_motion_keeps_the_value_of_the_start_exactly():
    """L, |L|^2, the energy of a free body at t = 5 as formulas of the parameters; w1 by integration."""
    text = (
        HEAD
        + "[parameters]\nA = 1\nB = 2\nC = 2.5\nW = 3\n"
        + QUATERNION.replace("0.9", "1").replace("0.1", "0").replace("0.3", "0").replace("-0.2", "0")
        + """
[speeds]
w1 = { start = "W" }
w2 = { start = 0.1 }
w3 = { start = "W/2" }
[points]
O = [0, 0, 0]
[bodies.body]
mass = 1
inertia = ["A", "B", "C"]
joint = { kind = "spherical", """
        + BY_QUATERNION
        + """ }
[outputs]
L_x = { value = "angular_momentum_x(O)", at = "t = 5" }
T = { value = "kinetic_energy()", at = "t = 5", unit = "J" }
w = { value = "w1", at = "t = 5" }
"""
    )
    answers = eomgen.solve(eomgen.loads(text))
    assert answers["L_x"].exact == "A*W"
    assert answers["T"].method == "constant of motion"
    assert answers["T"].value == pytest.approx((9 + 2 * 0.01 + 2.5 * 2.25) / 2, abs=1e-12)
    assert answers["w"].method == "integration in time"


# -- words and prints ------------------------------------------------------------------------------


def test_masses_in_line_have_no_moment_about_it():
    """det I = 0: the smallest principal moment and its radius of gyration are 0, and no number near it."""
    text = (
        HEAD
        + """
[parameters]
m = 2
[coordinates]
a = 0.3
b = 0.7
[bodies.one]
shape = { kind = "particle", mass = 1 }
joint = { kind = "placed", at = ["cos(a)*cos(b)", "sin(a)*cos(b)", "sin(b)"] }
[bodies.two]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["2*cos(a)*cos(b)", "2*sin(a)*cos(b)", "2*sin(b)"] }
"""
    )
    found = eomgen.inertia(eomgen.loads(text))
    assert (found["I_1"].value, found["k_1"].value) == (0, 0)
    assert found["I_2"].value == pytest.approx(2 / 3)  # m1 m2/(m1 + m2) d^2, d = 1


def test_a_bare_start_beside_omega_is_told_how_to_be_written():
    text = (
        HEAD
        + QUATERNION
        + "[speeds]\nw1 = 0.4\nw2 = {}\nw3 = {}\n"
        + """
[bodies.body]
mass = 1
inertia = [1, 1, 1]
joint = { kind = "spherical", """
        + BY_QUATERNION
        + " }\n"
    )
    with pytest.raises(ModelError, match=r"a start is w1 = \{ start = 0.4 \}"):
        eomgen.loads(text)


def test_options_in_a_typeset_sentence_keep_both_hyphens():
    """T1 fonts make a dash of two hyphens, which no shell knows."""
    latex = eomgen.derive(eomgen.loads(HEAD + CONTROL_MOMENT_GYROS)).latex()
    assert "-{}-full" in latex and "--full" not in latex
