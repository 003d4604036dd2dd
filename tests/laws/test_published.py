"""Numbers and equations that others have published."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from slow_run import in_slow_run

import eomgen

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"

TEST_SET = "Mazzia & Magherini, Test Set for Initial Value Problem Solvers, release 2.4 (University of Bari, 2008)"

ANGLES = ("beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon")
ANDREWS = (  # t = 0.03 s: angles, their rates, accelerations; of TEST_SET, problem andrews, by PSIDE at 1e-14
    (
        15.81077119629904,
        -15.75637105984298,
        0.04082224013073101,
        -0.5347301163226948,
        0.5244099658805304,
        0.5347301163226948,
        1.048080741042263,
    ),
    (
        1139.920302151208,
        -1424.379294994111,
        11.03291221937134,
        19.29337464421385,
        0.5735699284790808,
        -19.29337464421385,
        0.3231791658026955,
    ),
    (
        -24631.76316945196,
        51850.37701610329,
        324102.5686413781,
        566749.3645176213,
        16743.62929479361,
        -566749.3645176222,
        9826.520791458422,
    ),
)
HINGE_E = {  # its forces, of the multipliers there, on the bodies 3, 4 and 6
    "K3": (199.1753333731910, -29.75531228015052),
    "K4": (23.06654119098399, 31.45271365475927),
    "K6": (22.64249232082739, 11.61740700019673),
}


def test_andrews_squeezer_ends_where_the_test_set_says():
    """Seven bodies, three loops, a spring and a motor: angles, rates and accelerations.

    To the accuracy of the reference: runs at 1e-10 to 1e-13, by explicit and implicit methods, differ by 1e-12 from one
    another and by 1.1e-9 from it, a shift of 1e-12 s.
    """
    model = eomgen.load(MODELS / "andrews_squeezer.toml")
    run = eomgen.simulate(model, time=0.03, rtol=1e-11, atol=1e-12)
    assert run.ok, run.message
    rhs, x = eomgen.derive(model).rhs("numpy"), dict(zip((*run.coordinates, *run.speeds), run.x[-1], strict=True))
    dx = dict(zip(x, rhs(0.03, run.x[-1], rhs.p0), strict=True))
    q, u, a = ANDREWS
    assert [x[name] for name in ANGLES] == pytest.approx(q, abs=2e-9)
    assert [x[f"{name}'"] for name in ANGLES] == pytest.approx(u, rel=1e-7)
    assert [dx[f"{name}'"] for name in ANGLES] == pytest.approx(a, rel=2e-6)
    assert run.gap is not None and run.gap < 1e-10


def test_the_hinge_of_andrews_squeezer_carries_what_the_test_set_says():
    """Its multipliers are forces of the hinge at E, whatever the rows that close the loops."""
    sides = [(body, axis) for body in HINGE_E for axis in "xy"]
    lines = (f'{body}_{axis} = {{ value = "reaction_{axis}(E.{body})", at = "t = 0.03" }}\n' for body, axis in sides)
    requested = "".join(lines)
    found = eomgen.solve(eomgen.loads((MODELS / "andrews_squeezer.toml").read_text() + "[outputs]\n" + requested))
    for body, force in HINGE_E.items():
        assert [found[f"{body}_{axis}"].value for axis in "xy"] == pytest.approx(force, abs=3e-5), body


def test_the_car_axis_ends_where_the_test_set_says():
    """Stiff springs, a road that moves one end; its multipliers are those of the gaps, by eps^2. t = 3 s."""
    model = eomgen.load(MODELS / "car_axis.toml")
    run = eomgen.simulate(model, time=3, rtol=1e-11, atol=1e-12)
    names = ("x_l", "y_l", "x_r", "y_r")
    assert [run[name][-1] for name in (*names, *(f"{name}'" for name in names))] == pytest.approx(
        (
            0.0493455784275402809,
            0.496989460230171153,
            1.04174252488542151,
            0.373911027265361256,
            -0.0770583684040972357,
            0.00744686658723778553,
            0.0175568157537232222,
            0.770341043779251976,
        ),
        abs=1e-8,
    )
    found = eomgen.solve(model)
    assert found["lam1"].value == pytest.approx(-0.00473688659084893324, rel=1e-7)
    assert found["lam2"].value == pytest.approx(-0.00110468033125734368, rel=1e-7)


def fekete() -> list[tuple[float, float, float]]:
    """The places of twenty particles on the unit sphere at the start."""
    rings = (
        (3, np.pi / 13, 3 * np.pi / 8),
        (7, np.pi / 29, np.pi / 8),
        (6, np.pi / 7, -2 * np.pi / 15),
        (4, np.pi / 17, -3 * np.pi / 10),
    )
    angles = [(2 * np.pi * (k - (n == 4)) / n + turned, up) for n, turned, up in rings for k in range(1, n + 1)]
    return [(np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)) for a, b in angles]


def repelling(places: list[tuple[float, float, float]]) -> str:
    """Particles on rods of length 1 about a point, that repel one another by 1/r in a viscous fluid."""
    text = 'eomgen = 1\nspace = "space"\npoints = { O = [0, 0, 0] }\n[coordinates]\n'
    for k, place in enumerate(places):
        text += "".join(f"{axis}{k} = {float(x)!r}\n" for axis, x in zip("xyz", place, strict=True))
    for k in range(len(places)):
        at, drag = (str([f"{sign}{axis}{k}{dot}" for axis in "xyz"]) for sign, dot in (("", ""), ("-0.5*", "'")))
        text += f"""[bodies.p{k}]
shape = {{ kind = "particle", mass = 1 }}
joint = {{ kind = "placed", at = {at} }}
[constraints.rod{k}]
kind = "link"
points = ["O", "p{k}.center"]
length = 1
[forces.drag{k}]
kind = "force"
point = "p{k}.center"
force = {drag}
"""
    for i in range(len(places)):
        for k in range(i):
            text += f'[forces.f{i}_{k}]\nkind = "between"\npoints = ["p{i}.center", "p{k}.center"]\npull = "-1/r"\n'
    return text


@in_slow_run
def test_particles_on_a_sphere_come_to_rest_where_the_test_set_says():
    """Problem fekete after 1000 s: places of four of the twenty, and the tension -2 lambda = 9.5 of every rod."""
    run = eomgen.simulate(eomgen.loads(repelling(fekete())), time=1000, samples=2)
    assert run.ok, run.message
    published = {
        0: (-0.4070263380333202, 0.3463758772791802, 0.8451942450030429),
        4: (-0.4341114738782885, 0.8785430442262876, 0.1992720444237660),
        9: (0.9843259538440293, -0.1696995357819996, -0.04800504290609090),
        19: (0.2414481766969039, -0.3416456818373135, -0.9082846503446250),
    }
    for k, place in published.items():
        assert [run[f"{axis}{k}"][-1] for axis in "xyz"] == pytest.approx(place, abs=1e-9)
    assert [run[f"tension(rod{k})"][-1] for k in range(20)] == pytest.approx([9.5] * 20, abs=1e-9)


def test_seven_stars_are_where_the_test_set_says():
    """Problem pleiades: masses 1 to 7, attraction m_i m_k/r^2, after 3 s and several near encounters."""
    x0, y0, vx, vy = (
        (3, 3, -1, -3, 2, -2, 2),
        (3, -3, 2, 0, 0, -4, 4),
        (0, 0, 0, 0, 0, 1.75, -1.5),
        (0, 0, 0, -1.25, 1, 0, 0),
    )
    text = 'eomgen = 1\nspace = "plane"\n[coordinates]\n'
    for k in range(7):
        text += f"x{k} = {{ start = {x0[k]}, speed = {vx[k]} }}\ny{k} = {{ start = {y0[k]}, speed = {vy[k]} }}\n"
    for k in range(7):
        text += f'[bodies.s{k}]\nshape = {{ kind = "particle", mass = {k + 1} }}\n'
        text += f'joint = {{ kind = "placed", at = ["x{k}", "y{k}"] }}\n'
        for i in range(k):
            text += f'[forces.f{i}{k}]\nkind = "between"\npoints = ["s{i}.center", "s{k}.center"]\n'
            text += f'pull = "{(i + 1) * (k + 1)}/r^2"\n'
    run = eomgen.simulate(eomgen.loads(text), time=3, rtol=1e-12, atol=1e-12, samples=2)
    assert [run[f"x{k}"][-1] for k in range(7)] == pytest.approx(
        (
            0.3706139143970502,
            3.237284092057233,
            -3.222559032418324,
            0.6597091455775310,
            0.3425581707156584,
            1.562172101400631,
            -0.7003092922212495,
        ),
        abs=1e-9,
    )
    assert [run[f"y{k}"][-1] for k in range(7)] == pytest.approx(
        (
            -3.943437585517392,
            -3.271380973972550,
            5.225081843456543,
            -2.590612434977470,
            1.198213693392275,
            -0.2429682344935824,
            1.091449240428980,
        ),
        abs=1e-9,
    )


def test_the_spatial_slider_crank_moves_as_others_have_found():
    """Slider and crank by F. Gonzalez and by P. Masarati, handed in to the IFToMM library (in Exudyn's docs)."""
    run = eomgen.simulate(eomgen.load(MODELS / "spatial_slider_crank.toml"), time=5, samples=501)
    assert run.drift < 1e-7
    gonzalez = {
        10: 0.226785384,
        50: 0.184952803,
        100: 0.211754668,
        200: 0.289063554,
        300: 0.228450093,
        400: 0.188208161,
        500: 0.240761815,
    }
    assert run["s"][list(gonzalez)] == pytest.approx(list(gonzalez.values()), abs=5e-5)
    masarati = {10: 0.5600213536265, 20: 1.287191842519}  # of the crank's angle
    assert run["theta"][list(masarati)] == pytest.approx(list(masarati.values()), abs=2e-4)


DIAGONAL = """
eomgen = 1
name = "Four-bar linkage with a diagonal spring"
space = "plane"
[parameters]
k = 25
c = 1
g = 9.81
[coordinates]
a = { dependent = true, near = 2.2 }
b = { dependent = true, near = 0 }
phi = { near = 2.2 }
[points]
O = [0, 0]
[bodies]
one = { shape = { kind = "rod", mass = 1, length = 1 }, joint = { kind = "revolute", angle = "a" } }
two = { shape = { kind = "rod", mass = 1, length = 1 }, joint = { kind = "revolute", on = "one.end", angle = "b - a" } }
three = { shape = { kind = "rod", mass = 1, length = 1 }, joint = { kind = "revolute", at = [1, 0], angle = "phi" } }
[constraints]
D = { kind = "pin", points = ["two.end", "three.end"] }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
spring = { kind = "spring", points = ["O", "three.end"], stiffness = "k", length = "sqrt(2)" }
damper = { kind = "damper", points = ["O", "three.end"], damping = "c" }
"""


@in_slow_run
def test_the_four_bar_with_a_diagonal_spring_rests_where_the_benchmark_says():
    """phi = 2.23433101898: the IFToMM library's problem of this name, as B. Minaker's EoM has it; M, C, K by hand.

    A rhombus: 2 T = 5/3 phi'^2, V = 2 g sin(phi) + k (2 cos(phi/2) - sqrt(2))^2/2, the damper's rate -sin(phi/2) phi'.
    """
    model = eomgen.loads(DIAGONAL + '[outputs]\nrest = { value = "phi", at = "equilibrium" }\n')
    phi = 2.23433101898
    assert eomgen.solve(model)["rest"].value == pytest.approx(phi, abs=5e-11)  # the root is 2.234331019018
    small = eomgen.linearize(model)
    K = -2 * 9.81 * np.sin(phi) + 25 * (np.cos(phi / 2) / np.sqrt(2) - np.cos(phi))
    assert [small.M[0, 0], small.C[0, 0], small.K[0, 0]] == pytest.approx([5 / 3, np.sin(phi / 2) ** 2, K], rel=1e-9)


HEAVY_TOP = """
eomgen = 1
name = "Heavy top of Bruels and Cardona"
space = "space"
[coordinates]
e0 = 1
e1 = 0
e2 = 0
e3 = 0
[speeds]
w1 = {}
w2 = { start = 150 }
w3 = { start = -4.61538 }
[bodies.top]
mass = 15
center = [0, 1, 0]
inertia = [0.234375, 0.46875, 0.234375]
joint.kind = "spherical"
joint.orientation = "quaternion"
joint.quaternion = ["e0", "e1", "e2", "e3"]
joint.omega = ["w1", "w2", "w3"]
[forces.weight]
kind = "gravity"
acceleration = [0, 0, -9.81]
"""


def test_the_heavy_top_of_lie_group_integrators_turns_as_published():
    """Body rates by Runge-Kutta with steps of 1e-4 s, to their five digits: Exudyn's docs, HeavyTopSolution."""
    run = eomgen.simulate(eomgen.loads(HEAVY_TOP), time=0.06, samples=4)
    rates = np.column_stack([run["w1"], run["w2"], run["w3"]])[1:]
    assert rates == pytest.approx(
        np.array([[1.2594, 150, 4.4536], [-2.4401, 150, -3.9779], [3.4673, 150, 3.2160]]), abs=6e-5
    )


LIGHT_CART = """
eomgen = 1
name = "Cart-pole with a light cart"
space = "plane"
[parameters]
M = 1e-6
g = 9.81
[coordinates]
x = 0
theta = "pi/2"
[bodies.cart]
mass = "M"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[bodies.bob]
shape = { kind = "particle", mass = 1 }
joint = { kind = "placed", at = ["x + sin(theta)", "-cos(theta)"] }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def test_a_light_cart_flings_its_pole_round_and_loses_nothing():
    """|theta'| = sqrt(2 g (1 + 1/M)) = 4429 rad/s at each of 11 crossings in 10 s, a swing lasts 1.8 s.

    N. Parsons, light-cartpole-benchmark (2026), proposed for the IFToMM library. Period: by energy, momentum 0,
    theta'^2 = 2 g cos(theta)/(1 - cos(theta)^2/(1 + M)), T = 4 int_0^{pi/2} d theta/theta'.
    """
    run = eomgen.simulate(eomgen.loads(LIGHT_CART), time=10)
    assert run.ok and run.drift < 1e-8
    theta = np.linspace(0, np.pi / 2, 200_001) ** 2 / (np.pi / 2)  # finer where it is fast
    middle, steps = (theta[1:] + theta[:-1]) / 2, np.diff(theta)
    quarter = np.sum(steps * np.sqrt((1 - np.cos(middle) ** 2 / (1 + 1e-6)) / (2 * 9.81 * np.cos(middle))))
    crossings = np.flatnonzero(run["theta"][:-1] * run["theta"][1:] < 0)
    assert len(crossings) == 11
    assert run.t[crossings] == pytest.approx(quarter * (2 * np.arange(11) + 1), abs=0.012)
    peak = eomgen.solve(eomgen.loads(LIGHT_CART + '[outputs]\npeak = { value = "abs(theta\')", at = "theta = 0" }'))
    assert peak["peak"].value == pytest.approx(4429.449, abs=5e-4)


# Corke, Robotics Toolbox for Python, model DH/Puma560 (after Corke & Armstrong-Helouvry, A search for consensus among
# model parameters reported for the PUMA 560 robot, ICRA 1994) and tests/test_DHRobot.py: (d, a, alpha/(pi/2)), mass,
# centre, inertia, motor inertia, gear, viscous and Coulomb friction of each motor
PUMA = (
    ((0.67183, 0, 1), 0, (0, 0, 0), (0, 0.35, 0), 200e-6, 62.6111, 1.48e-3, 0.395),
    ((0, 0.4318, 0), 17.4, (-0.3638, 0.006, 0.2275), (0.13, 0.524, 0.539), 200e-6, 107.815, 0.817e-3, 0.126),
    ((0.15005, 0.0203, -1), 4.8, (-0.0203, -0.0141, 0.070), (0.066, 0.086, 0.0125), 200e-6, 53.7063, 1.38e-3, 0.132),
    ((0.4318, 0, 1), 0.82, (0, 0.019, 0), (1.8e-3, 1.3e-3, 1.8e-3), 33e-6, 76.0364, 71.2e-6, 11.2e-3),
    ((0, 0, -1), 0.34, (0, 0, 0), (0.3e-3, 0.4e-3, 0.3e-3), 33e-6, 71.923, 82.6e-6, 9.26e-3),
    ((0, 0, 0), 0.09, (0, 0, 0.032), (0.15e-3, 0.15e-3, 0.04e-3), 33e-6, 76.686, 36.7e-6, 3.96e-3),
)
AT_QN = [0, np.pi / 4, np.pi, 0, np.pi / 4, 0]
INERTIA_AT_QN = [
    [3.6594, -0.4044, 0.1006, -0.0025, 0.0000, 0.0000],
    [-0.4044, 4.4137, 0.3509, 0.0000, 0.0024, 0.0000],
    [0.1006, 0.3509, 0.9378, 0.0000, 0.0015, 0.0000],
    [-0.0025, 0.0000, 0.0000, 0.1925, 0.0000, 0.0000],
    [0.0000, 0.0024, 0.0015, 0.0000, 0.1713, 0.0000],
    [0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.1941],
]
TORQUES_AT_QN = {  # rates, accelerations: torques
    (0, 0): (0, 31.6399, 6.0351, 0, 0.0283, 0),
    (0, 1): (3.35311, 36.0025, 7.42596, 0.190043, 0.203441, 0.194133),
    (1, 1): (32.4952, 60.867, 17.7436, 1.45452, 1.29911, 0.713781),
}


def puma() -> str:
    text = 'eomgen = 1\nspace = "space"\n[coordinates]\n' + "".join(f"q{k} = 0\n" for k in range(1, 7))
    text += "[inputs]\n" + "".join(f"tau{k} = 0\n" for k in range(1, 7))
    for k, ((d, a, alpha), m, center, inertia, rotor, gear, viscous, _) in enumerate(PUMA, start=1):
        on = f'joint.on = "link{k - 1}"' if k > 1 else ""
        text += f'''[bodies.axis{k}]
joint.kind = "revolute"
{on}
joint.angle = "q{k}"
joint.torque = "tau{k}"
joint.damping = "{viscous}*{gear}^2"
joint.armature = "{rotor}*{gear}^2"
[bodies.link{k}]
mass = {m}
center = {list(center)}
inertia = {list(inertia)}
measured = true
joint = {{ kind = "fixed", on = "axis{k}", at = [{a}, 0, {d}], axis = [1, 0, 0], angle = "{alpha}*pi/2" }}
'''
    return text + '[forces.weight]\nkind = "gravity"\nacceleration = [0, 0, -9.81]\n'


def test_the_puma_of_the_robotics_toolbox_has_its_inertias_and_torques():
    """M, and tau by recursive Newton-Euler with motors, gears and friction, to the digits of its tests."""
    rhs = eomgen.derive(eomgen.loads(puma())).rhs("numpy")

    def accelerations(u: np.ndarray, tau: np.ndarray) -> np.ndarray:
        return rhs(0.0, [*AT_QN, *u], rhs.p0, tau)[6:]

    still, none = np.zeros(6), np.zeros(6)
    M = np.linalg.inv(np.array([accelerations(still, e) - accelerations(still, none) for e in np.eye(6)]).T)
    assert M == pytest.approx(np.array(INERTIA_AT_QN), abs=6e-5)
    coulomb = np.array([link[5] * link[7] for link in PUMA])
    for (rate, acceleration), torques in TORQUES_AT_QN.items():
        u = np.full(6, float(rate))
        tau = M @ (np.full(6, float(acceleration)) - accelerations(u, none)) + rate * coulomb
        assert tau == pytest.approx(np.array(torques), abs=6e-5)


CHAOTIC = """
eomgen = 1
name = "Chaotic pendulum: a plate that turns on a rod about the rod's own direction"
space = "space"
[parameters]
mA = 0.01
mB = 0.1
LA = 0.075
LB = 0.2
IAx = 5e-5
IBx = 2.5e-4
IBy = 5e-5
IBz = 2e-4
g = 9.81
[coordinates]
qA = "pi/2"
qB = { start = 0.5, unit = "deg" }
[bodies.rod]
mass = "mA"
center = [0, 0, "-LA"]
inertia = ["IAx", "IAx", 0]
joint = { kind = "revolute", axis = [1, 0, 0], angle = "qA" }
[bodies.plate]
mass = "mB"
inertia = ["IBx", "IBy", "IBz"]
joint = { kind = "revolute", on = "rod", at = [0, 0, "-LB"], axis = [0, 0, 1], angle = "qB" }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""


def test_the_chaotic_pendulum_has_the_equations_of_kane():
    """The 'babyboot' of Autolev and of PyDy: Kane & Levinson's equations, at random states.

    qA'' = (2 qA' qB' sin cos (IBx - IBy) - (mA LA + mB LB) g sin qA)
           / (IAx + mA LA^2 + mB LB^2 + IBx cos^2 + IBy sin^2)
    qB'' = - qA'^2 sin qB cos qB (IBx - IBy) / IBz
    """
    model = eomgen.loads(CHAOTIC)
    rhs = eomgen.derive(model).rhs("numpy")
    mA, mB, LA, LB, IAx, IBx, IBy, IBz, g = rhs.p0
    for qA, qB, wA, wB in np.random.default_rng(1).uniform(-3, 3, (20, 4)):
        s, c = np.sin(qB), np.cos(qB)
        inertia = IAx + mA * LA**2 + mB * LB**2 + IBx * c**2 + IBy * s**2
        aA = (2 * wA * wB * s * c * (IBx - IBy) - (mA * LA + mB * LB) * g * np.sin(qA)) / inertia
        aB = -(wA**2) * s * c * (IBx - IBy) / IBz
        assert rhs(0.0, [qA, qB, wA, wB], rhs.p0) == pytest.approx([wA, wB, aA, aB], rel=1e-12, abs=1e-12)


FURUTA = """
eomgen = 1
name = "Furuta pendulum"
space = "space"
[parameters]
m = 0.3
L1 = 0.25
l2 = 0.2
J1 = 0.01
J2 = 0.004
g = 9.81
[coordinates]
t1 = 0.1
t2 = 0.3
[inputs]
tau = 0
[bodies.arm]
mass = 1
center = [0, 0, 0]
inertia = [0, "J1", "J1"]
points = { tip = ["L1", 0, 0] }
joint = { kind = "revolute", axis = [0, 0, 1], angle = "t1", torque = "tau" }
[bodies.pendulum]
mass = "m"
center = [0, 0, "-l2"]
inertia = ["J2", "J2", 0]
joint = { kind = "revolute", on = "arm.tip", axis = [1, 0, 0], angle = "t2" }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""


def test_the_furuta_pendulum_has_the_published_equations():
    """Cazzolato & Prime, J. Control Science and Engineering 2011, eqs. 33-34, without damping.

    a1 (J1 + m L1^2 + J sin^2 t2) + a2 m L1 l2 cos t2 - m L1 l2 w2^2 sin t2 + w1 w2 J sin 2 t2 = tau
    a1 m L1 l2 cos t2 + a2 J - w1^2 J sin(2 t2) / 2 + m g l2 sin t2 = 0,  J = J2 + m l2^2
    """
    rhs = eomgen.derive(eomgen.loads(FURUTA)).rhs("numpy")
    m, L1, l2, J1, J2, g = rhs.p0
    Jp = J2 + m * l2**2
    for t1, t2, w1, w2, tau in np.random.default_rng(2).uniform(-3, 3, (20, 5)):
        _, _, a1, a2 = rhs(0.0, [t1, t2, w1, w2], rhs.p0, [tau])
        s, c = np.sin(t2), np.cos(t2)
        first = a1 * (J1 + m * L1**2 + Jp * s**2) + m * L1 * l2 * (a2 * c - w2**2 * s) + w1 * w2 * Jp * 2 * s * c
        second = a1 * m * L1 * l2 * c + a2 * Jp - w1**2 * Jp * s * c + m * g * l2 * s
        assert first == pytest.approx(tau, rel=1e-9, abs=1e-9)
        assert second == pytest.approx(0, abs=1e-9)
