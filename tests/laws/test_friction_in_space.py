"""Friction of bilateral contacts of a line in space, |N| = sqrt(N_1^2 + N_2^2), against textbooks."""

from __future__ import annotations

import math
from random import Random

import numpy as np
import pytest
from scipy.optimize import fsolve

import eomgen
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.free_bodies.friction import equations_of_motion
from eomgen.symbolic.exact.cramer import LARGEST_BLOCK
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = pytest.mark.slow

G = 9.81
HEAD = """
eomgen = 1
space = "space"
forces.weight = { kind = "gravity", acceleration = [0, 0, "-g"] }
"""
ROD = """
[parameters]
m = 0.5
mu = 0.3
g = 9.81
W = 3
[bodies.rod]
points = { A = [0, 0, 0], B = [1, 0, 0] }
line = ["A", "B"]
joint = { kind = "revolute", angle = "psi" }
[outputs]
N = "reaction_n(BEAD)"
F = "reaction_t(BEAD)"
D = "drive(psi)"
"""
RAIL = 'constraints.rail = { kind = "slider", point = "bead.center", on = "rod", LAW }\n'
BEADS = {
    "identical": (
        "rail",
        RAIL
        + """
        coordinates = { psi = { motion = "W*t" }, r = { start = 0.4, speed = 0.2 } }
        bodies.bead.shape = { kind = "particle", mass = "m" }
        bodies.bead.joint = { kind = "placed", at = ["r*cos(psi)", "r*sin(psi)", 0] }""",
    ),
    "closing": (
        "rail",
        RAIL
        + """
        coordinates = { psi = { motion = "W*t" }, x = { start = 0.4, speed = 0.2 }, y = { speed = 1.2 }, z = 0 }
        bodies.bead.shape = { kind = "particle", mass = "m" }
        bodies.bead.joint = { kind = "placed", at = ["x", "y", "z"] }""",
    ),
    "path": (
        "bead",
        """
        coordinates = { psi = { motion = "W*t" }, r = { start = 0.4, speed = 0.2 } }
        bodies.bead.shape = { kind = "particle", mass = "m" }
        bodies.bead.joint = { kind = "path", on = "rod", along = "r", pieces = [{ line = 9, LAW }] }""",
    ),
}


def bead(kind: str, law: str) -> eomgen.Model:
    owner, text = BEADS[kind]
    return eomgen.loads(HEAD + text.replace("LAW", law) + ROD.replace("BEAD", owner))


@pytest.mark.parametrize("kind", BEADS)
def test_the_friction_of_a_bead_is_by_the_resultant_of_its_two_normal_forces(kind):
    """On a rod that turns in a horizontal plane N = m sqrt(g^2 + (2 W r')^2), r'' = W^2 r - mu N/m."""
    m, mu, W, r, v = 0.5, 0.3, 3, 0.4, 0.2
    N = m * math.hypot(G, 2 * W * v)
    model = bead(kind, 'friction = "mu"')
    found = {name: answer.value for name, answer in eomgen.solve(model).items()}
    assert found == pytest.approx({"N": N, "F": -mu * N, "D": 2 * m * W * r * v}, rel=1e-9)
    equations = eomgen.derive(model)
    assert equations.certify().ok
    states = [equations.rhs(target) for target in ("numpy", "c")]
    dx = [rhs(0.0, rhs.x0, rhs.p0) for rhs in states]
    assert dx[0] == pytest.approx(dx[1], rel=1e-12)
    assert dx[0][len(equations.coordinates)] == pytest.approx(W**2 * r * (kind != "closing") - mu * N / m, rel=1e-9)


def test_viscous_friction_grows_with_the_resultant_too():
    """F = -c sqrt(N_1^2 + N_2^2) v."""
    model = bead("identical", "friction = { viscous = 0.7 }")
    found = eomgen.solve(model)
    assert found["F"].value == pytest.approx(-0.7 * found["N"].value * 0.2, rel=1e-12)


CIRCLE = (
    HEAD
    + """
parameters = { m = 0.2, mu = 0.15, g = 9.81, R = 0.7, v0 = 3 }
coordinates.s = { speed = "v0" }
bodies.bead.shape = { kind = "particle", mass = "m" }
[bodies.bead.joint]
kind = "path"
along = "s"
pieces = [{ arc = "R", turn = "ccw", angle = "6*pi", friction = "mu" }]
"""
)


def test_a_bead_on_a_level_circle_of_wire_comes_to_rest():
    """v v' = -mu sqrt(g^2 + v^4/R^2): asinh(v^2/(g R)) falls by 2 mu s/R, until it sticks."""
    R, mu, v0 = 0.7, 0.15, 3
    run = eomgen.simulate(eomgen.loads(CIRCLE), time=4, target="numpy")
    assert run.phases[0].ended_by.startswith("the body 'bead' sticks") and run.ok
    way = R / (2 * mu) * math.asinh(v0**2 / (G * R))
    assert run["s"][-1] == pytest.approx(way, rel=1e-7)
    moving = slice(*run.phases[0].rows)
    v, s = run["s'"][moving], run["s"][moving]
    assert np.arcsinh(v**2 / (G * R)) == pytest.approx(math.asinh(v0**2 / (G * R)) - 2 * mu * s / R, abs=1e-7)
    assert run["reaction_t(bead)"][moving][:-1] == pytest.approx(-mu * 0.2 * np.hypot(G, v**2 / R)[:-1], rel=1e-7)


SLOPE = (
    HEAD
    + """
parameters = { m = 0.2, mu = MU, g = 9.81, a = 0.4 }
coordinates = { x = { speed = "2*cos(a)" }, y = 0, z = { speed = "2*sin(a)" } }
points.O = [0, 0, 0]
bodies.wire = { points = { A = [0, 0, 0], B = ["cos(a)", 0, "sin(a)"] }, line = ["A", "B"], joint = { kind = "fixed" } }
bodies.bead.shape = { kind = "particle", mass = "m" }
bodies.bead.joint = { kind = "placed", at = ["x", "y", "z"] }
constraints.rail = { kind = "slider", point = "bead.center", on = "wire", friction = "mu" }
"""
)


@pytest.mark.parametrize("mu", [0.6, 0.2])
def test_a_bead_thrown_up_a_wire_stays_or_slides_back(mu):
    """It stops after v^2/(2 g (sin a + mu cos a)) and stays where mu > tan a."""
    run = eomgen.simulate(eomgen.loads(SLOPE.replace("MU", str(mu))), time=1.5, target="numpy")
    sin, cos = math.sin(0.4), math.cos(0.4)
    up, way = 2 / (G * (sin + mu * cos)), 4 / (2 * G * (sin + mu * cos))
    assert run.phases[0].end == pytest.approx(up, rel=1e-6)
    back = 0 if mu > math.tan(0.4) else G * (sin - mu * cos) * (1.5 - up) ** 2 / 2
    assert run["x"][-1] / cos == pytest.approx(way - back, abs=1e-6)
    if not back:
        assert run["reaction_t(rail)"][-1] == pytest.approx(0.2 * G * sin, rel=1e-8)  # what it takes, below mu N


# -- contacts that press one another ----------------------------------------------------------------

DRAWER = (
    HEAD
    + """
parameters = { m = 2, mu = 0.35, g = 9.81, b = 0.3, P = 60, c = 0.25, h = 0.1 }
bodies.bar = { points = { A = [0, 0, 0], B = [1, 0, 0] }, line = ["A", "B"], joint = { kind = "fixed" } }
constraints.one = { kind = "slider", point = "plate.one", on = "bar", friction = "mu" }
constraints.two = { kind = "slider", point = "plate.two", on = "bar", friction = "mu" }
forces.pull = { kind = "force", point = "plate.grip", force = ["P", 0, 0], axes = "plate" }
[bodies.plate]
mass = "m"
inertia = [0.02, 0.03, 0.04, 0.001, -0.002, 0.003]
points = { one = ["-b", 0.01, "h"], two = ["b", 0.01, "h"], grip = [0.1, "c", 0.02] }
joint = { kind = "free", position = ["x", "y", "z"], orientation = "xyz", angles = ["q", "e", "f"] }
[coordinates]
"""
)
FREE = "x = { speed = 0.5 }\nq = 0\n"
DRAWERS = {
    "closing": FREE + "y = -0.01\nz = -0.1\ne = 0\nf = 0",
    "dependent": FREE
    + "\n".join(
        f"{k} = {{ dependent = true, start = {v} }}" for k, v in {"y": -0.01, "z": -0.1, "e": 0, "f": 0}.items()
    ),
}


def drawer_by_newton() -> dict[str, float]:
    """Newton and Euler for the plate, solved by MINPACK: (a_x, alpha_x, N_1y, N_1z, N_2y, N_2z)."""
    m, mu, b, P, c, h = 2, 0.35, 0.3, 60, 0.25, 0.1
    inertia = np.array([[0.02, 0.001, 0.003], [0.001, 0.03, -0.002], [0.003, -0.002, 0.04]])
    arms = [np.array([s * b, 0.01, h]) for s in (-1, 1)]
    grip = np.array([0.1, c, 0.02])

    def left(v: np.ndarray) -> np.ndarray:
        a_x, alpha, *N = v
        forces = [np.array([-mu * math.hypot(y, z), y, z]) for y, z in (N[:2], N[2:])]
        turning = np.array([alpha, 0, 0])
        a = np.array([a_x, 0, 0]) + np.cross(turning, -arms[0]) * np.array([0, 1, 1])
        total = sum(forces) + np.array([P, 0, -m * G]) - m * a
        moment = np.cross(grip, [P, 0, 0]) + sum(np.cross(r, f) for r, f in zip(arms, forces, strict=True))
        return np.array([*total, *(moment - inertia @ turning)])

    v, _, ok, _ = fsolve(left, [10, 0, 5, 5, 5, 5], full_output=True, xtol=1e-13)
    assert ok == 1
    return {"a": v[0], "F_1": -mu * math.hypot(v[2], v[3]), "F_2": -mu * math.hypot(v[4], v[5])}


@pytest.mark.parametrize("kind", DRAWERS)
def test_two_eyes_on_one_bar_press_each_other(kind):
    """Friction in one eye turns the plate against the other: |N| of both from one system of equations."""
    model = eomgen.loads(DRAWER + DRAWERS[kind])
    equations = eomgen.derive(model)
    rhs, reactions = equations.rhs("numpy"), equations.reaction_rhs("numpy")
    dx = rhs(0.0, rhs.x0, rhs.p0)
    found = dict(zip(reactions.names, reactions(0.0, rhs.x0, rhs.p0), strict=True))
    wanted = drawer_by_newton()
    assert dx[len(equations.coordinates)] == pytest.approx(wanted["a"], rel=1e-8)
    for eye, F in (("one", "F_1"), ("two", "F_2")):
        assert found[f"reaction_t({eye})"] == pytest.approx(wanted[F], rel=1e-8)


def test_eyes_that_jam_have_no_acceleration():
    """With so much friction that |G| >= 1 no single |N| is: nan in the code, never a wrong number."""
    model = eomgen.loads(DRAWER.replace("mu = 0.35", "mu = 9") + DRAWERS["dependent"])
    rhs = eomgen.derive(model).rhs("numpy")
    assert np.isnan(rhs(0.0, rhs.x0, rhs.p0)[6])


# -- on surfaces ------------------------------------------------------------------------------------

PUCK = (
    HEAD
    + """
parameters = { m = 2, mu = MU, g = 9.81, a = 0.3 }
coordinates = { s = SPEED, y = 0 }
bodies.puck.shape = { kind = "particle", mass = "m" }
bodies.puck.joint = { kind = "placed", at = ["s*cos(a)", "y", "s*sin(a)"] }
outputs.stop = { value = "s", at = "s' = 0" }
outputs.a_s = "s''"
constraints.slope = { kind = "support", point = "puck.center", normal = ["-sin(a)", 0, "cos(a)"], friction = "mu" }
"""
)


@pytest.mark.parametrize("mu", [0.5, 0.1])
def test_a_puck_thrown_up_a_slope_stops_at_an_instant_that_can_be_asked(mu):
    """s = v^2/(2 g (sin a + mu cos a)) where s' = 0, whether it sticks there or slides back."""
    answer = eomgen.solve(eomgen.loads(PUCK.replace("MU", str(mu)).replace("SPEED", "{ speed = 1 }")))["stop"]
    assert answer.value == pytest.approx(1 / (2 * G * (math.sin(0.3) + mu * math.cos(0.3))), rel=1e-6)


def test_code_has_a_value_where_nothing_slides_yet_on_a_surface():
    """v/|v| is 0 there, as sign(v) along a line; an output says that friction has no direction."""
    model = eomgen.loads(PUCK.replace("MU", "0.1").replace("SPEED", "0"))
    equations = eomgen.derive(model)
    for target in ("numpy", "c"):
        rhs = equations.rhs(target)
        assert rhs(0.0, rhs.x0, rhs.p0) == pytest.approx([0, 0, -G * math.sin(0.3), 0], rel=1e-12)
    assert "friction has no direction there" in eomgen.solve(model)["a_s"].message


REST = (
    HEAD
    + """
parameters = { m = 2, mu = MU, g = 9.81, a = 0.3, P = 3 }
outputs.N = "reaction_n(hold)"
forces.side = { kind = "force", point = "block.center", force = [0, "P", 0] }
[bodies.wire]
points = { A = [0, 0, 0], B = ["cos(a)", 0, "sin(a)"] }
line = ["A", "B"]
joint = { kind = "fixed" }
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["cos(a)", 0, "sin(a)"] }
[constraints.hold]
friction = "mu"
point = "block.center"
"""
)
SIN, COS = 2 * G * math.sin(0.3), 2 * G * math.cos(0.3)
HOLDS = {
    "surface": ('kind = "support"\nnormal = ["-sin(a)", 0, "cos(a)"]\n', COS, math.hypot(SIN, 3) / COS),
    "line": ('kind = "slider"\non = "wire"\n', math.hypot(COS, 3), SIN / math.hypot(COS, 3)),
}


@pytest.mark.parametrize("kind", HOLDS)
def test_a_block_rests_as_long_as_the_resultants_allow(kind):
    """On a surface sqrt(F_t^2 + F_s^2) <= mu N, on a line |F| <= mu sqrt(N_1^2 + N_2^2)."""
    contact, N, needed = HOLDS[kind]
    rests, slides = (
        eomgen.solve(eomgen.loads(REST.replace("MU", str(mu)) + contact))["N"]
        for mu in (1.001 * needed, 0.999 * needed)
    )
    assert rests.value == pytest.approx(N, rel=1e-12)
    assert slides.value is None and "would need more friction" in slides.message


WELDED = """
eomgen = 1
space = "space"
parameters = { m = 0.6, I = 0.5, l = 0.6, h = 0.2, mu = 0.3 }
[coordinates]
b = {}
s = {}
x = {}
y = {}
z = {}
f = {}
g = {}
e = {}
p1 = { speed = 1 }
p2 = {}
p3 = {}
[bodies.base]
mass = "m"
inertia = ["I", "I", "2*I"]
joint = { kind = "prismatic", axis = [2, 1, 2], displacement = "b" }
[bodies.leg]
mass = "m"
inertia = ["I", "I", "I"]
points = { end = ["l", 0, 0] }
joint = { kind = "revolute", on = "base", at = [-0.5, 0, 0], angle = "s" }
[bodies.block]
mass = "m"
inertia = ["I", "I", "2*I"]
points = { P = ["h", 0, 0] }
joint = { kind = "free", on = "base", position = ["x", "y", "z"], orientation = "xyz", angles = ["g", "e", "f"] }
[bodies.puck]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["p1", "p3", "p2"], angle = 0 }
[constraints.weld]
kind = "clamp"
points = ["leg.end", "block.P"]
[constraints.floor]
kind = "support"
point = "puck.center"
normal = [0, 0, 1]
friction = "mu"
"""


def test_accelerations_of_many_unknowns_have_values_wherever_the_constraints_are_regular():
    """J a + gamma = 0 where one angle after the other is 0: nothing is divided by an entry that vanishes there."""
    system = System.free_of(eomgen.loads(WELDED))
    equations, rng = equations_of_motion(system), Random(1)
    symbols = system.symbols
    assert len(symbols.u) + len(equations.J) > LARGEST_BLOCK
    usual = system.scope.values_of_parameters(rng) | {x: rng.uniform(0.2, 1) for x in symbols.x}
    for zero in (None, *symbols.q):
        state = {**usual, symbols.t: 0.0} | ({} if zero is None else {zero: 0.0})
        a = evaluate(equations.accelerations, state, FLOAT)
        for row, bias in zip(equations.J, equations.gamma, strict=True):
            entries = evaluate((*row, bias), state, FLOAT)
            left = sum(x * y for x, y in zip(entries, (*a, 1.0), strict=True))
            assert abs(left) < 1e-9, zero
