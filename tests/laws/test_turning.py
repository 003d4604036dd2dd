"""Bodies turned by quaternions and moved by declared speeds: rest, small motions, constants of motion, the report."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from each import each
from scipy.spatial.transform import Rotation
from slow_run import in_slow_run

import eomgen
from eomgen.documents import rendered
from eomgen.mechanics.integrals.first_integrals import (
    FirstIntegrals,
)
from eomgen.mechanics.linearization.linearization import SmallMotions

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
HEAD = 'eomgen = 1\nname = "turning"\nspace = "space"\n'
BY_QUATERNION = 'orientation = "quaternion", quaternion = ["e0", "e1", "e2", "e3"], omega = ["w1", "w2", "w3"]'
WEIGHT = '[forces.weight]\nkind = "gravity"\nacceleration = [0, 0, "-g"]\n'

TOP = (
    HEAD
    + """
[parameters]
m = 0.5
d = 0.06
A = 0.003
C = 0.0008
g = 9.81
W = 200
[coordinates]
e0 = %s
e1 = %s
e2 = %s
e3 = %s
[speeds]
w1 = {}
w2 = {}
w3 = { start = "%s" }
[bodies.top]
mass = "m"
center = [0, 0, "d"]
inertia = ["A - m*d^2", "A - m*d^2", "C"]
joint = { kind = "spherical", """
    + BY_QUATERNION
    + " }\n"
    + WEIGHT
)

SATELLITE = (
    HEAD
    + """
[parameters]
n = 0.001
A = 10
B = 12
C = %s
[coordinates]
u = { rate = "n" }
e0 = 1
e1 = 0
e2 = 0
e3 = 0
[speeds]
w1 = {}
w2 = {}
w3 = {}
[bodies.orbit]
joint = { kind = "revolute", axis = [0, 0, 1], angle = "u" }
[bodies.satellite]
mass = 100
inertia = ["A", "B", "C"]
joint = { kind = "spherical", on = "orbit", """
    + BY_QUATERNION
    + """ }
[forces.gradient]
kind = "potential"
energy = "3/2*n^2*(A*(e0^2+e1^2-e2^2-e3^2)^2 + 4*B*(e1*e2-e0*e3)^2 + 4*C*(e1*e3+e0*e2)^2)"
"""
)

FREE = (
    HEAD
    + """
[parameters]
m = 3
A = 1.1
B = 2.3
C = 3.1
[coordinates]
x = 0.3
y = { start = 0.1, speed = 2 }
z = 0
e0 = 1
e1 = 0.2
e2 = -0.3
e3 = 0.1
[speeds]
w1 = { start = 0.5 }
w2 = { start = -1 }
w3 = { start = 2 }
[bodies.body]
mass = "m"
center = [0.1, 0.2, -0.3]
inertia = ["A", "B", "C"]
joint = { kind = "free", position = ["x", "y", "z"], """
    + BY_QUATERNION
    + " }\n"
)


def small(text: str, about: str = "equilibrium"):
    return SmallMotions.of(eomgen.derive(eomgen.loads(text)).system, about)


def frequencies(found) -> list[float]:
    """Imaginary parts of the state matrix's eigenvalues that are positive."""
    return sorted(x.imag for x in np.linalg.eigvals(found.state_matrix) if x.imag > 1e-6)


# -- rest ----------------------------------------------------------------------------------------


@in_slow_run
def test_a_body_on_a_ball_joint_hangs_or_stands():
    """Two families of rest, V = -+m g d; below it swings with w^2 = m g d/A, twice."""
    resting = eomgen.statics(eomgen.loads(TOP % (0.1, 1, 0.1, 0, 0)))
    places = resting.as_dict()["equilibria"]
    signs = {"e0": 1, "e1": -1, "e2": -1, "e3": 1}
    ups = [sum(s * place["coordinates"][e]["value"] ** 2 for e, s in signs.items()) for place in places]
    assert ups == pytest.approx([-1, 1])
    assert places[1]["stability"]["kind"] == "unstable"
    assert resting.as_dict()["reactions"]["reaction_z(top)"]["value"] == pytest.approx(0.5 * 9.81)
    hanging = small(TOP % (0.1, 1, 0.1, 0, 0))
    assert frequencies(hanging) == pytest.approx([np.sqrt(0.5 * 9.81 * 0.06 / 0.003)] * 2)


@each("C", [16, 6])
def test_a_satellite_librates_in_the_gradient_of_gravity(C):
    """Pitch w^2 = 3 n^2 (B - A)/C; roll and yaw by C th1'' and so on, worked out by hand below."""
    n, A, B = 0.001, 10.0, 12.0
    found = small(SATELLITE % C)
    roll_yaw = np.array(
        [  # x = (th1, th2, th1', th2'), th1 about the radius, th2 about the orbit's tangent
            [0, 0, 1, 0],
            [0, 0, 0, 1],
            [-(n**2) * (C - B) / A, 0, 0, n * (A + B - C) / A],
            [0, -4 * n**2 * (C - A) / B, -n * (A + B - C) / B, 0],
        ]
    )
    expected = [*np.linalg.eigvals(roll_yaw), *(s * 1j * n * np.sqrt(3 * (B - A) / C) for s in (1, -1))]
    found = np.linalg.eigvals(found.state_matrix)
    ours, by_hand = (np.sort_complex(np.round(np.array(x) / n, 7)) for x in (found, expected))
    assert ours == pytest.approx(by_hand, abs=1e-6)


def test_a_sleeping_top_is_stable_above_its_critical_spin():
    """C^2 W^2 > 4 A m g d; in space A l^2 - C W l + m g d = 0, and in the body's axes l - W."""
    m, d, A, C, g = 0.5, 0.06, 0.003, 0.0008, 9.81
    for W, is_stable in ((200, True), (60, False)):
        found = small((TOP % (1, 0, 0, 0, "W")).replace("W = 200", f"W = {W}"), "start")
        roots = np.roots([A, -C * W, m * g * d])
        seen = np.linalg.eigvals(found.state_matrix)
        for root in 1j * (roots - W):
            assert np.min(abs(seen - root)) < 1e-6 * W
        assert bool(np.max(seen.real) < 1e-6 * W) is is_stable
        assert (C**2 * W**2 > 4 * A * m * g * d) is is_stable


def test_the_small_motions_of_a_quaternion_are_those_of_angles():
    """A hanging body whose tensor is no symmetric one, by quaternion in a turned start and by xyz angles."""
    tensor = 'inertia = ["A - m*d^2", "A - m*d^2", "C"]'
    other = "inertia = [0.002, 0.0035, 0.004, 0.0003, -0.0002, 0.0001]"
    by_four = (TOP % (0, 0.6, 0.8, 0, 0)).replace(tensor, other)
    angles = by_four[: by_four.index("[coordinates]")] + "[coordinates]\na = 3.0\nb = 0.1\nc = 0.4\n"
    angles += by_four[by_four.index("[bodies.top]") :]
    angles = angles.replace(BY_QUATERNION, 'orientation = "xyz", angles = ["a", "b", "c"]')
    assert frequencies(small(by_four)) == pytest.approx(frequencies(small(angles)), rel=1e-8)


def test_rest_and_reactions_do_not_ask_for_declared_speeds():
    """At theta = 0 the speed u2 = psi' sin(theta) gives no psi': rest is known there, small motions are not."""
    text = (
        HEAD
        + """
[parameters]
g = 9.81
[coordinates]
psi = 0
theta = 0.2
phi = 0
[speeds]
u1 = "theta'"
u2 = "psi'*sin(theta)"
u3 = "phi' + psi'*cos(theta)"
[bodies.top]
mass = 0.5
center = [0, 0, 0.06]
inertia = [0.003, 0.003, 0.0008]
joint = { kind = "spherical", orientation = "zxz", angles = ["psi", "theta", "phi"] }
"""
        + WEIGHT
    )
    model = eomgen.loads(text)
    assert eomgen.statics(model).as_dict()["reactions"]["reaction_z(top)"]["value"] == pytest.approx(0.5 * 9.81)
    with pytest.raises(eomgen.EomgenError, match="declared speeds do not determine"):
        small(text)


# -- constants of motion --------------------------------------------------------------------------


def constants(text: str) -> dict[str, object]:
    equations = eomgen.derive(eomgen.loads(text))
    found = FirstIntegrals(equations.graph).momenta_of_the_whole(())
    return {f"{each.letter}_{each.axis}".rstrip("_"): each.expression for each in found}


def test_a_free_body_keeps_momentum_and_angular_momentum():
    """P, and L about the mass centre, in axes of the ground; |L|^2."""
    assert set(constants(FREE)) == {"P_x", "P_y", "P_z", "L_x", "L_y", "L_z", "L"}


def test_weight_leaves_the_horizontal_momentum():
    """P_x and P_y stay, P_z does not; L about the mass centre does."""
    assert set(constants(FREE.replace("m = 3", "m = 3\ng = 9.81") + WEIGHT)) == {"P_x", "P_y", "L_x", "L_y", "L_z", "L"}


def test_a_heavy_body_keeps_what_is_about_the_vertical():
    """L_z about the ball joint; T + V."""
    text = TOP % (1, 0.2, 0.1, 0.3, 3)
    assert set(constants(text)) == {"L_z"}
    equations = eomgen.derive(eomgen.loads(text))
    assert [each.name for each in FirstIntegrals(equations.graph).of_energy] == ["energy"]


def test_a_torque_takes_the_constants_away():
    """Nothing stays of L where a torque turns with the body."""
    torque = '[forces.t]\nkind = "couple"\nbody = "body"\ncouple = [0.1, 0, 0]\naxes = "body"\n'
    assert set(constants(FREE + torque)) == {"P_x", "P_y", "P_z"}


def test_the_energy_of_a_gyrostat_is_jacobis():
    """sum u dT/du - T stays where the wheel is kept at its rate, and T does not; L of both together stays."""
    equations = eomgen.derive(eomgen.load(MODELS / "gyrostat.toml"))
    (energy,) = FirstIntegrals(equations.graph).of_energy
    assert energy.name == "jacobi"
    run = eomgen.simulate(eomgen.load(MODELS / "gyrostat.toml"), time=5)
    w = run.x[:, -3:]
    h = w**2 @ np.array([3.011, 4.011, 5.02]) / 2
    assert h == pytest.approx(np.full(len(h), h[0]), rel=1e-8)
    assert FirstIntegrals(equations.graph).stay_constant((energy.expression, equations.graph.T)) == (True, False)
    names = [each.letter + each.axis for each in FirstIntegrals(equations.graph).momenta_of_the_whole(())]
    assert {"Lx", "Ly", "Lz"} <= set(names)


# -- as it is read ---------------------------------------------------------------------------------


def printed(path: Path) -> str:
    return rendered(eomgen.derive(eomgen.load(path)).derivation, "text")


def test_eulers_equations_are_printed_as_in_a_textbook():
    """I1 w1' + (I3 - I2) w2 w3 = N1 and cyclically."""
    text = printed(MODELS / "seeds" / "s1_euler.toml")
    for line in ("I1*w1' + (I3 - I2)*w2*w3 = N1", "I2*w2' + (I1 - I3)*w1*w3 = N2", "I3*w3' + (I2 - I1)*w1*w2 = N3"):
        assert line in text


def test_the_energy_of_a_symmetric_top_is_printed_as_in_a_textbook():
    """T = I_t/2 (theta'^2 + phi'^2 sin^2) + I_3/2 (psi' + phi' cos)^2"""
    text = re.sub(r"\s+", " ", printed(MODELS / "seeds" / "s1_lagrange_top.toml"))
    assert "T = 1/2*I_t*(sin(theta)^2*phi'^2 + theta'^2) + 1/2*I_3*(cos(theta)*phi' + psi')^2" in text


def test_reactions_are_printed_in_the_declared_speeds():
    """No rate of a quaternion stands in them, nor in the equations of motion; e . e = 1 is used."""
    text = printed(MODELS / "gyrostat.toml")
    equations = text[text.index("Equations of motion") : text.index("First integrals")]
    reactions = text[text.index("\nFrom the balance of forces") :]
    assert "e0" not in equations
    assert not re.search(r"e\d'", reactions)
    assert re.search(r"D_wheel = .*w3'", reactions)


# -- against other descriptions and other programs ----------------------------------------------------


def test_a_body_on_a_wire_swings_the_same_by_a_quaternion_and_by_angles():
    """Where the wire passes through the mass centre its row has no part along any turn: none of these is solved for."""
    body = "[bodies.base]\nmass = 4\ninertia = [0.3, 0.4, 0.5]\npoints = { P = [0.1, 0.2, 0.1] }\n"
    wire = '[constraints.wire]\nkind = "link"\npoints = ["O", "base.P"]\nlength = 1.2\n'
    head = HEAD + "[parameters]\ng = 9.81\n[points]\nO = [0, 0, 1]\n[coordinates]\nx = 0\ny = 0\nz = -0.4\n"
    joint = 'joint = { kind = "free", position = ["x", "y", "z"], %s }\n'
    four = "e0 = 0.84\ne1 = 0.47\ne2 = -0.27\ne3 = 0\n[speeds]\nw1 = {}\nw2 = {}\nw3 = {}\n"
    angles = "a = 1\nb = -0.5\nc = 0\n"
    by_four = head + four + body + joint % BY_QUATERNION + wire + WEIGHT
    by_angles = head + angles + body + joint % 'orientation = "xyz", angles = ["a", "b", "c"]' + wire + WEIGHT
    assert frequencies(small(by_four)) == pytest.approx(frequencies(small(by_angles)), rel=1e-7)


SEQUENCES = [a + b + c for a in "xyz" for b in "xyz" for c in "xyz" if a != b and b != c]


@each("sequence", SEQUENCES)
def test_a_sequence_of_angles_is_scipys(sequence):
    """R = R1(a) R2(b) R3(c), child to parent: scipy's intrinsic rotations, in capital letters."""
    angles, place = (0.3, 0.7, -1.1), np.array([0.2, -0.5, 0.4])
    text = HEAD + "[parameters]\nm = 1\n[coordinates]\na = 0.3\nb = 0.7\nc = -1.1\n"
    text += '[bodies.body]\nmass = "m"\ninertia = [1, 2, 2.5]\npoints = { P = [0.2, -0.5, 0.4] }\n'
    text += f'joint = {{ kind = "spherical", orientation = "{sequence}", angles = ["a", "b", "c"] }}\n'
    text += '[outputs]\nx = "x(body.P)"\ny = "y(body.P)"\nz = "z(body.P)"\n'
    found = [answer.value for answer in eomgen.solve(eomgen.loads(text)).values()]
    assert found == pytest.approx(Rotation.from_euler(sequence.upper(), angles).apply(place))
