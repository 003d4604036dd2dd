"""Systems of textbooks, benchmarks and other programs: what eomgen says beside what was found without it.

The whole list, with what was compared and to how many digits: docs/published_systems.md.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import eomgen

pytestmark = pytest.mark.slow

PLANE = 'eomgen = 1\nspace = "plane"\n'
SPACE = 'eomgen = 1\nspace = "space"\n'
DOWN = '[forces.weight]\nkind = "gravity"\nacceleration = [0, "-g"]\n'
DOWN_Z = '[forces.weight]\nkind = "gravity"\nacceleration = [0, 0, "-g"]\n'
G = 9.81


def answers(text: str) -> dict[str, float]:
    found = eomgen.solve(eomgen.loads(text))
    return {name: found[name].value for name in found}


def end_of(rates, start, time: float) -> np.ndarray:
    """Of a motion x' = rates(t, x), by scipy."""
    return solve_ivp(rates, (0, time), start, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]


# -- small motions -----------------------------------------------------------------------------------

ZIEGLER = """
[parameters]
m = 1
l = 1
c = 1
P = LOAD
[coordinates]
a = 0
b = 0
[bodies.lower]
mass = "2*m"
center = ["l", 0]
inertia = 0
points = { tip = ["l", 0] }
joint = { kind = "revolute", angle = "a", stiffness = "c" }
[bodies.upper]
mass = "m"
center = ["l", 0]
inertia = 0
points = { tip = ["l", 0] }
joint = { kind = "revolute", on = "lower.tip", angle = "b - a", stiffness = "c" }
[forces.P]
kind = "force"
point = "upper.tip"
force = ["-P", 0]
axes = "upper"
"""


@pytest.mark.parametrize(("load", "flutters"), [(2.08, False), (2.09, True)])
def test_zieglers_column_flutters_under_a_load_that_follows_it(load, flutters):
    """P l/c = 7/2 - sqrt 2 = 2.0858 (Ziegler 1952; Bolotin, Nonconservative Problems, 1963)."""
    small = eomgen.linearize(eomgen.loads(PLANE + ZIEGLER.replace("LOAD", str(load))))
    assert bool(np.max(np.linalg.eigvals(small.A).real) > 1e-3) is flutters
    assert (small.spectrum.stability == "unstable") is flutters


def test_a_rotor_blade_flaps_and_lags_about_its_offset_hinge():
    """Lag Om sqrt(3 e/2 L), flap Om sqrt(1 + 3 e/2 L) of a uniform blade (Johnson, Helicopter Theory, 1980, 5.14)."""
    text = """
    parameters = { m = 40, e = 0.3, L = 5, Om = 30 }
    coordinates = { psi = { motion = "Om*t" }, lag = 0, flap = 0 }
    linearize.about = "start"
    outputs = { lagging = "frequency(1)", flapping = "frequency(2)", pull = "reaction_x(blade, hub)" }
    [bodies.hub]
    joint = { kind = "revolute", angle = "psi" }
    points = { hinge = ["e", 0, 0] }
    [bodies.blade]
    shape = { kind = "rod", mass = "m", length = "L" }
    joint = { kind = "universal", on = "hub.hinge", axes = [[0, 0, 1], [0, 1, 0]], angles = ["lag", "flap"] }
    """
    found = answers(SPACE + text)
    assert found["lagging"] == pytest.approx(30 * math.sqrt(0.09), rel=1e-12)
    assert found["flapping"] == pytest.approx(30 * math.sqrt(1.09), rel=1e-12)
    assert found["pull"] == pytest.approx(-40 * 900 * (0.3 + 2.5), rel=1e-12)


def test_an_overhung_rotor_has_the_four_whirls_of_stodola():
    """(k11 - m w^2)(k22 - Id w^2 + Ip Om w) = k12^2 (Gasch, Nordmann & Pfuetzner, Rotordynamik, 2006)."""
    m, Id, Ip, Om, k11, k12, k22 = 10, 0.2, 0.38, 300, 2e6, -6e5, 2.5e5
    text = f"""
    coordinates = {{ x = 0, y = 0, a = 0, b = 0, s = {{ motion = "{Om}*t" }} }}
    linearize.about = "start"
    outputs = {{ f1 = "frequency(1)", f2 = "frequency(2)", f3 = "frequency(3)", f4 = "frequency(4)" }}
    [bodies.disc]
    mass = {m}
    inertia = [{Id}, {Id}, {Ip}]
    joint = {{ kind = "free", position = ["x", "y", 0], orientation = "xyz", angles = ["a", "b", "s"] }}
    [forces.shaft]
    kind = "potential"
    energy = "{k11}*(x^2 + y^2)/2 + ({k12})*(x*b - y*a) + {k22}*(a^2 + b^2)/2"
    """
    whirls = np.roots(np.polysub(np.polymul([-m, 0, k11], [-Id, Ip * Om, k22]), [k12**2]))
    assert list(answers(SPACE + text).values()) == pytest.approx(sorted(abs(whirls)), rel=1e-10)


@pytest.mark.parametrize("damping", [0, 1e-9])
def test_a_pendulum_absorber_has_the_frequency_of_its_rotor_times_a_number(damping):
    """Om sqrt((J + m (R + r)^2) R/(r J)) (Den Hartog); a steady motion beside it counts as none, damped or not."""
    text = f"""
    parameters = {{ m = 0.3, R = 0.2, r = 0.05, J = 0.4, Om = 100 }}
    coordinates = {{ psi = {{ start = 0, speed = "Om" }}, th = 0 }}
    linearize.about = "start"
    outputs.tuned = "frequency(1)"
    [bodies.rotor]
    mass = 5
    inertia = "J"
    points = {{ P = ["R", 0] }}
    joint = {{ kind = "revolute", angle = "psi" }}
    [bodies.bob]
    shape = {{ kind = "particle", mass = "m" }}
    points = {{ hub = ["-r", 0] }}
    joint = {{ kind = "revolute", on = "rotor.P", point = "hub", angle = "th", damping = {damping!r} }}
    """
    tuned = 100 * math.sqrt((0.4 + 0.3 * 0.0625) * 0.2 / (0.05 * 0.4))
    assert answers(PLANE + text)["tuned"] == pytest.approx(tuned, rel=1e-9)


# -- rolling -----------------------------------------------------------------------------------------


def rotation(q: np.ndarray) -> np.ndarray:
    """Of a quaternion, scalar first, child to parent."""
    a, (b, c, d) = q[0], q[1:]
    cross = np.array([[0, -d, c], [d, 0, -b], [-c, b, 0]])
    return np.eye(3) + 2 * a * cross + 2 * cross @ cross


BALL = """
coordinates = { x = START, y = 0, e0 = 1, e1 = 0, e2 = 0, e3 = 0 }
[bodies.ball]
INERTIA
[bodies.ball.joint]
kind = "free"
position = ["x", "y", "R"]
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]
[constraints.floor]
kind = "rolling"
body = "ball"
radius = "R"
plane = { at = [0, 0, 0], normal = [0, 0, 1] }
"""


def test_chaplygins_ball_keeps_its_moment_about_the_contact():
    """K = (I + m R^2 (1 - z z)) w is constant in space; x' = w x R z (Chaplygin 1903)."""
    head = (
        "parameters = { R = 0.2, g = 9.81 }\nspeeds = { w1 = { start = 3 }, w2 = { start = -2 }, w3 = { start = 5 } }\n"
    )
    inertia = "mass = 1.3\ninertia = [0.01, 0.02, 0.025]"
    text = SPACE + head + BALL.replace("START", "0").replace("INERTIA", inertia) + DOWN_Z
    run = eomgen.simulate(eomgen.loads(text), time=2, rtol=1e-10)
    inertia, floor = np.diag([0.01, 0.02, 0.025]), 1.3 * 0.04 * np.diag([1, 1, 0])
    moment = (inertia + floor) @ [3, -2, 5]

    def rates(_, s):
        R = rotation(s[:4] / np.linalg.norm(s[:4]))
        w = np.linalg.solve(R @ inertia @ R.T + floor, moment)
        turning = np.append(-w @ s[1:4], s[0] * w + np.cross(w, s[1:4])) / 2
        return np.concatenate([turning, 0.2 * np.array([w[1], -w[0]])])

    names = ("e0", "e1", "e2", "e3", "x", "y")
    assert [run[name][-1] for name in names] == pytest.approx(end_of(rates, [1, 0, 0, 0, 0, 0], 2.0), abs=1e-8)


def test_a_billiard_ball_slides_along_a_parabola_and_then_rolls_straight():
    """Its contact slips by u for 2 u/7 mu g, the friction along it all the time (Coriolis 1835)."""
    head = "parameters = { R = 0.02862, mu = 0.2, g = 9.81 }\n"
    head += "speeds = { w1 = { start = 40 }, w2 = { start = -30 }, w3 = { start = 20 } }\n"
    text = (
        SPACE
        + head
        + BALL.replace("START", "{ speed = 2 }").replace(
            "INERTIA", 'shape = { kind = "sphere", mass = 0.17, radius = "R" }'
        )
    )
    run = eomgen.simulate(eomgen.loads(text + 'slip = true\nfriction = "mu"\n' + DOWN_Z), time=2)
    slip = np.array([2 + 0.02862 * 30, 0.02862 * 40])
    slides = 2 * np.hypot(*slip) / (7 * 0.2 * G)
    brake = 0.2 * G * slip / np.hypot(*slip)
    end = np.array([2, 0]) * slides - brake * slides**2 / 2 + (np.array([2, 0]) - brake * slides) * (2 - slides)
    assert run.phases[0].end == pytest.approx(slides, rel=1e-6)
    assert [run["x"][-1], run["y"][-1]] == pytest.approx(end, abs=1e-7)


def test_a_roller_of_two_discs_keeps_its_height():
    """Discs across one another, sqrt 2 R apart: the centre stays R/sqrt 2 high (Stewart, Am. J. Phys. 34, 1966)."""
    text = """
    parameters = { R = 0.1, c = "sqrt(2)*R", g = 9.81 }
    coordinates = { X = 0, Y = 0, Z = 0.0707, e0 = "cos(pi/8)", e1 = "sin(pi/8)", e2 = 0, e3 = 0 }
    speeds = { w1 = { start = 0.5 }, w2 = {}, w3 = {} }
    [bodies.roller]
    points = { A = ["-c/2", 0, 0], B = ["c/2", 0, 0] }
    parts = [
      { kind = "disc", mass = 0.2, radius = "R", at = ["-c/2", 0, 0] },
      { kind = "disc", mass = 0.2, radius = "R", at = ["c/2", 0, 0], axis = [1, 0, 0], angle = "pi/2" },
    ]
    [bodies.roller.joint]
    kind = "free"
    position = ["X", "Y", "Z"]
    orientation = "quaternion"
    quaternion = ["e0", "e1", "e2", "e3"]
    omega = ["w1", "w2", "w3"]
    """
    for point, axis in (("A", [0, 0, 1]), ("B", [0, 1, 0])):
        text += f"""
    [constraints.{point}]
    kind = "rolling"
    body = "roller"
    center = "{point}"
    axis = {axis}
    radius = "R"
    plane = {{ at = [0, 0, 0], normal = [0, 0, 1] }}
    """
    with pytest.warns(RuntimeWarning, match="indeterminate"):
        run = eomgen.simulate(eomgen.loads(SPACE + text + DOWN_Z), time=1)
    assert run.ok and run["Z"] == pytest.approx(0.1 / math.sqrt(2), abs=1e-9)
    assert np.ptp(run["X"]) + np.ptp(run["Y"]) > 0.01


# -- mechanisms, strings, robots ---------------------------------------------------------------------


def test_peaucelliers_cell_draws_a_straight_line():
    """x = (a^2 - b^2)/2 c and y = x tan(th/2) for a crank c about (c, 0) (Peaucellier 1864)."""
    text = """
    parameters = { a = 0.3, b = 0.25, c = 0.1 }
    outputs = { x = "x(C.end)", y = "y(C.end)" }
    [coordinates]
    th = { motion = "0.5*sin(1.3*t)" }
    p1 = { dependent = true, near = 0.6 }
    p2 = { dependent = true, near = -0.6 }
    p3 = { dependent = true, near = -2.15 }
    p4 = { dependent = true, near = 2.15 }
    p5 = { dependent = true, near = 1.3 }
    p6 = { dependent = true, near = -1.3 }
    [constraints]
    P = { kind = "pin", points = ["C.end", "D.end"] }
    Q = { kind = "pin", points = ["A.end", "E.end"] }
    S = { kind = "pin", points = ["B.end", "H.end"] }
    """
    rods = (
        ("crank", 'at = ["c", 0]', "c", "th"),
        ("A", "at = [0, 0]", "a", "p1"),
        ("B", "at = [0, 0]", "a", "p2"),
        ("C", 'on = "A.end"', "b", "p3 - p1"),
        ("D", 'on = "B.end"', "b", "p4 - p2"),
        ("E", 'on = "crank.end"', "b", "p5 - th"),
        ("H", 'on = "crank.end"', "b", "p6 - th"),
    )
    for name, seat, length, angle in rods:
        text += f"""
    [bodies.{name}]
    shape = {{ kind = "rod", mass = 0.2, length = "{length}" }}
    joint = {{ kind = "revolute", {seat}, angle = "{angle}" }}
    """
    run = eomgen.simulate(eomgen.loads(PLANE + text), time=2, samples=41)
    assert run["x"] == pytest.approx(0.1375, abs=1e-9)
    assert run["y"] == pytest.approx(0.1375 * np.tan(np.sin(1.3 * run.t) / 4), abs=1e-9)


def test_a_thread_winds_round_a_peg_as_its_free_length_says():
    """l th'' + R th'^2 + g sin th = 0, l = l0 + R th: the free end of a thread is perpendicular to its course."""
    text = """
    parameters = { l0 = 1.2, R = 0.15, g = 9.81 }
    coordinates = { x = { start = 0.15, speed = 1.5 }, y = { start = -1.2 } }
    bodies.bob = { shape = { kind = "particle", mass = 0.4 }, joint = { kind = "placed", at = ["x", "y"] } }
    constraints.thread = { kind = "string", path = [{ at = [0, 0], radius = "R", turn = "cw" }, "bob.center"] }
    """
    run = eomgen.simulate(eomgen.loads(PLANE + text + DOWN), time=2)

    def rates(_, s):
        return [s[1], -(G * math.sin(s[0]) + 0.15 * s[1] ** 2) / (1.2 + 0.15 * s[0])]

    a, _ = end_of(rates, [0, 1.5 / 1.2], 2.0)
    free = 1.2 + 0.15 * a
    assert run["x"][-1] == pytest.approx(0.15 * math.cos(a) + free * math.sin(a), abs=1e-8)
    assert run["y"][-1] == pytest.approx(0.15 * math.sin(a) - free * math.cos(a), abs=1e-8)


def test_a_swash_plate_drives_its_piston():
    """z = R tan al cos p; J p'' = -z_p (m z'' + k z); the multiplier is the force along the normal of the plate."""
    text = """
    parameters = { R = 0.06, al = 0.35, m = 0.3, k = 800, J = 0.02 }
    coordinates = { p = { start = 0.4, speed = 20 }, z = { dependent = true, near = 0.02 } }
    outputs = { p2 = "p''", push = "multiplier(face)", side = "reaction_x(piston)" }
    [bodies.plate]
    mass = 2
    inertia = ["J", "J", "J"]
    joint = { kind = "revolute", axis = [0, 0, 1], angle = "p" }
    [bodies.piston]
    shape = { kind = "particle", mass = "m" }
    joint = { kind = "prismatic", at = ["R", 0, 0], axis = [0, 0, 1], displacement = "z", stiffness = "k" }
    [constraints.face]
    kind = "equation"
    gap = "-sin(al)*x(piston.center, plate) + cos(al)*z(piston.center, plate)"
    """
    lift, p = 0.06 * math.tan(0.35), 0.4
    z, slope, curve = lift * math.cos(p), -lift * math.sin(p), -lift * math.cos(p)
    p2 = -slope * (0.3 * curve * 400 + 800 * z) / (0.02 + 0.3 * slope**2)
    push = (0.3 * (slope * p2 + curve * 400) + 800 * z) / math.cos(0.35)
    side = push * math.sin(0.35) * math.cos(p)
    assert list(answers(SPACE + text).values()) == pytest.approx([p2, push, side], rel=1e-10)


# -- friction ----------------------------------------------------------------------------------------


def test_a_rod_that_rubs_jams_where_painleve_says():
    """N = m g/(1 + 3 c (c - s mu sgn)): m g/N < 0 pushed ahead of its foot at mu = 1.5, 60 degrees; else a number."""
    text = """
    parameters = { m = 1, l = 1, mu = 1.5, g = 9.81 }
    coordinates = { x = { speed = SPEED }, y = 0, p = { start = "pi/3" } }
    bodies.rod.shape = { kind = "rod", mass = "m", length = "2*l" }
    bodies.rod.joint = { kind = "planar", x = "x", y = "y", angle = "p" }
    outputs.N = "reaction_n(floor)"
    [constraints.floor]
    kind = "support"
    point = "rod.start"
    normal = [0, 1]
    at = [0, 0]
    friction = "mu"
    unilateral = true
    """
    c, s = 0.5, math.sqrt(3) / 2
    drawn = PLANE + text.replace("SPEED", "1") + DOWN
    assert answers(drawn)["N"] == pytest.approx(G / (1 + 3 * c * (c + 1.5 * s)), rel=1e-12)
    pushed = eomgen.simulate(eomgen.loads(PLANE + text.replace("SPEED", "-1") + DOWN), time=0.1)
    assert 1 + 3 * c * (c - 1.5 * s) < 0 and not pushed.ok and "jam" in pushed.message


def test_a_tray_that_shakes_carries_what_lies_on_it_along():
    """|x''| <= mu g: it sticks while |s''| <= mu g and slides at mu g until the speeds agree; sums of parabolas."""
    text = """
    parameters = { mu = 0.2, A = 0.05, w = 12, g = 9.81 }
    coordinates = { s = { motion = "A*sin(w*t)" }, x = 0 }
    bodies.tray.points = { u = [-1, 0], v = [1, 0] }
    bodies.tray.line = ["u", "v"]
    bodies.tray.joint = { kind = "prismatic", axis = [1, 0], displacement = "s" }
    bodies.block = { shape = { kind = "particle", mass = 1 }, joint = { kind = "placed", at = ["x", 0] } }
    [constraints.face]
    kind = "slider"
    point = "block.center"
    on = "tray"
    friction = "mu"
    unilateral = true
    """
    run = eomgen.simulate(eomgen.loads(PLANE + text + DOWN), time=1.5, samples=1501)
    v, shaken, limit = run["x'"], 0.6 * np.cos(12 * run.t), 0.2 * G
    found = np.gradient(v, run.t)[1:-1]
    slides = np.abs(v - shaken)[1:-1] > 0.01
    calm = np.min(np.abs(run.t[1:-1, None] - [phase.end for phase in run.phases]), axis=1) > 0.002
    assert len(run.phases) > 5 and slides[calm].any() and not slides.all()
    assert found[slides & calm] == pytest.approx(-limit * np.sign(v - shaken)[1:-1][slides & calm], abs=1e-6)
    assert np.max(np.abs(found[calm])) <= limit + 1e-3


def test_the_multiplier_of_a_rough_guide_is_held_by_the_free_bodies():
    """N = m (r p'' + 2 r' p' + g cos p) and J p'' = tau - N r of a block on a bar that turns; all is proven."""
    text = """
    parameters = { m = 2, J = 0.5, mu = 0.25, g = 9.81 }
    coordinates = { x = { start = 0.3, speed = 0.6 }, y = { near = 0.1 }, p = { start = 0.3, speed = -0.4 } }
    outputs.N = "multiplier(guide)"
    constraints.guide = { kind = "slider", point = "block.center", on = "bar", friction = "mu" }
    bodies.block = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", "y"] } }
    [bodies.bar]
    mass = 1
    inertia = "J"
    points = { u = [-2, 0], v = [2, 0] }
    line = ["u", "v"]
    joint = { kind = "revolute", angle = "p", torque = 1.5 }
    """
    answer = eomgen.solve(eomgen.loads(PLANE + text + DOWN))
    r, rate = 0.3 / math.cos(0.3), -0.4
    out = (0.6 + r * math.sin(0.3) * rate) / math.cos(0.3)
    free = 2 * (2 * out * rate + G * math.cos(0.3))
    turn = (1.5 - r * free) / (0.5 + 2 * r * r)
    assert answer["N"].value == pytest.approx(2 * r * turn + free, rel=1e-9)
    assert {check.status for check in answer.certify().checks} == {"holds"}
