"""Dry friction in joints: it slips against the motion, sticks within its bound, and takes energy."""

from __future__ import annotations

import itertools
import math
import textwrap

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import eomgen
from eomgen.errors import ModelError
from eomgen.simulation.phase_change import senses_from_rest

G = 9.81
HINGE = """
eomgen = 1
space = "plane"
parameters = { m = 1, g = 9.81, l = 1, T_c = 1 }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
coordinates = { q = { start = 1 } }
outputs = { holds = "friction(rod)" }
[bodies.rod]
shape = { kind = "rod", mass = "m", length = "l" }
[bodies.rod.joint]
kind = "revolute"
angle = "q"
point = "start"
turned = { angle = "-pi/2" }
friction = { torque = "T_c" }
"""


def run(text: str, time: float, **options):
    return eomgen.simulate(eomgen.loads(text), time=time, target="numpy", rtol=1e-12, atol=1e-12, **options)


def senses(result, joint: str) -> list[int | None]:
    return [phase.model.configuration.modes[joint].sense for phase in result.phases]


def test_a_pendulum_with_friction_comes_to_rest_where_its_weight_no_longer_moves_it():
    """m l^2/3 q'' = -m g (l/2) sin q - T_c sign q'; it rests at m g (l/2) sin q < T_c (two programs, 5e-16 apart)."""
    result = run(HINGE, 3)
    assert [phase.end for phase in result.phases[:2]] == pytest.approx([0.86240531174, 1.69641458195], abs=1e-10)
    assert senses(result, "rod") == [-1, 1, 0]
    turned, rests = (phase.last["q"] for phase in result.phases[:2])
    assert turned == pytest.approx(-0.5447788352200158, abs=1e-11)
    assert rests == pytest.approx(0.1262319872529, abs=1e-11)
    assert result["holds"][0] == pytest.approx(1) and result["holds"][-1] == pytest.approx(G / 2 * math.sin(rests))
    assert result.certify().ok


def test_friction_takes_as_much_energy_as_the_way_times_its_torque():
    """E(0) - E(t) = T_c sum |dq|."""
    result = run(HINGE, 3)
    way = np.sum(np.abs(np.diff([1, *(phase.last["q"] for phase in result.phases)])))
    assert result["energy"][0] - result["energy"][-1] == pytest.approx(way, rel=1e-9)


def test_at_rest_it_is_what_holds():
    """q = 0.1, where m g (l/2) sin q < T_c."""
    result = run(HINGE.replace("start = 1 ", "start = 0.1 "), 1)
    assert senses(result, "rod") == [0]
    assert result["q"] == pytest.approx(np.full(len(result.t), 0.1))
    answers = eomgen.solve(eomgen.loads(HINGE.replace("start = 1 ", "start = 0.1 ")))
    assert float(answers["holds"].value) == pytest.approx(G / 2 * math.sin(0.1))


SLIDE = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 50, F = 4 }
coordinates = { x = { start = START } }
[bodies.block]
mass = "m"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k", friction = { force = "F" STATIC } }
"""


def test_a_block_on_a_spring_turns_nearer_by_twice_what_friction_holds():
    """Each half swing ends 2 F/k nearer, until k |x| <= F: 0.5, -0.34, 0.18, -0.02; a half swing takes pi sqrt(m/k)."""
    result = run(SLIDE.replace("START", "0.5").replace("STATIC", ""), 2.5)
    assert [phase.last["x"] for phase in result.phases] == pytest.approx([-0.34, 0.18, -0.02, -0.02], abs=1e-10)
    half = math.pi * math.sqrt(2 / 50)
    assert [phase.end for phase in result.phases[:3]] == pytest.approx([half, 2 * half, 3 * half], abs=1e-9)
    assert result.certify().ok


def test_static_friction_above_kinetic_holds_earlier():
    """With F_s = 10 the block already stays at -0.18 = 0.5 - 2 F/k ... where k |x| <= F_s."""
    result = run(SLIDE.replace("START", "0.5").replace("STATIC", ", static = 10"), 2.5)
    assert [phase.last["x"] for phase in result.phases] == pytest.approx([-0.34, 0.18, 0.18], abs=1e-10)
    assert senses(result, "block") == [-1, 1, 0]
    assert result.certify().ok


def test_a_driven_belt_lets_its_block_stick_and_slip():
    """A block on a spring, its slide carried by a belt at v: it sticks till k x = F_s, slips back, sticks again."""
    text = """
eomgen = 1
space = "plane"
parameters = { m = 1, k = 100, F = 2, F_s = 3, v = 0.1 }
coordinates = { b = { motion = "v*t" }, s = { start = 0 } }
forces.pull = { kind = "potential", energy = "k*(b + s)^2/2" }
[bodies.belt]
joint = { kind = "prismatic", axis = [1, 0], displacement = "b" }
[bodies.block]
mass = "m"
joint = { kind = "prismatic", on = "belt", axis = [1, 0], displacement = "s", friction = FRICTION }
"""
    result = run(text.replace("FRICTION", '{ force = "F", static = "F_s" }'), 1)
    stick, slip = result.phases[0], result.phases[1]
    assert stick.end == pytest.approx(0.03 / 0.1, rel=1e-9)

    def back(t, x):
        return [x[1], -100 * x[0] + 2]

    def together(t, x):
        return x[1] - 0.1

    together.terminal, together.direction = True, 1
    found = solve_ivp(back, (0, 1), [0.03, 0.1 - 1e-12], events=together, rtol=1e-12, atol=1e-13)
    assert slip.end - slip.start == pytest.approx(found.t[-1], abs=1e-7)
    assert senses(result, "block")[:3] == [0, -1, 0]


def test_smooth_friction_is_a_hyperbolic_tangent():
    """- T tanh(q'/v): at q' = v 76 % of T; the line in the equations shows v."""
    text = HINGE.replace('torque = "T_c"', 'torque = "T_c", smooth = "v"').replace("T_c = 1", "T_c = 1, v = 1e-4")
    equations = eomgen.derive(eomgen.loads(text))
    assert "T_c*tanh(q'/v)" in str(equations)
    result = run(text, 10, method="Radau")
    assert result["q"][-1] == pytest.approx(0.1256, abs=5e-5)
    assert len(result.phases) == 1


def test_friction_without_a_size_and_a_static_one_below_are_refused():
    with pytest.raises(ModelError, match="friction of the joint of 'rod' needs one of 'torque' and 'coefficient'"):
        eomgen.loads(HINGE.replace('{ torque = "T_c" }', "{ static = 1 }"))
    with pytest.raises(ModelError, match="'static' is 1, below 2"):
        eomgen.loads(HINGE.replace('{ torque = "T_c" }', "{ torque = 2, static = 1 }"))
    with pytest.raises(ModelError, match="smooth friction has no 'static'"):
        eomgen.loads(HINGE.replace('{ torque = "T_c" }', "{ torque = 2, static = 3, smooth = 1 }"))


LOADED = HINGE.replace("T_c = 1", "mu = 0.3, r = 0.1").replace('torque = "T_c"', 'coefficient = "mu", radius = "r"')


@pytest.mark.slow
def test_the_friction_of_a_hinge_by_the_force_that_it_carries():
    """I A + m g a sin q + s rho m sqrt((a A + g sin q)^2 + (a w^2 + g cos q)^2) = 0; at rest |sin q| <= rho/a."""
    result = run(LOADED, 8)
    turned = [phase.last["q"] for phase in result.phases]
    due = [
        -0.82581234790,
        0.67012396706,
        -0.52753830625,
        0.39426004143,
        -0.26742912718,
        0.14474581430,
        -0.0242358020494,
    ]
    assert turned == pytest.approx([*due, due[-1]], abs=2e-11)
    assert abs(math.sin(turned[-1])) < 0.03 / 0.5
    assert result.certify().ok


def test_friction_by_the_force_is_the_root_of_its_equation_at_any_state():
    """The same equation, solved for A by bisection."""
    import scipy.optimize

    for q, w in ((0.4, 2.0), (2.5, -3.0), (1.5, -0.1)):
        text = LOADED.replace("start = 1 ", f"start = {q}, speed = {w} ")
        equations = eomgen.derive(eomgen.loads(text))
        friction = float(eomgen.solve(eomgen.loads(text))["holds"].value)

        def balance(A, q=q, w=w):
            R = math.hypot(A / 2 + G * math.sin(q), w * w / 2 + G * math.cos(q))
            return A / 3 + G / 2 * math.sin(q) + math.copysign(0.03, w) * R

        A = scipy.optimize.brentq(balance, -100, 100, xtol=1e-14, rtol=1e-15)
        assert friction == pytest.approx(A / 3 + G / 2 * math.sin(q), rel=1e-10)
        assert equations.certify().ok


def test_where_friction_feeds_on_itself_it_has_no_single_value():
    """Not unique from mu r = I/(m a) = 2 l/3 on: the condition stands in the derivation, and a run names it."""
    result = run(LOADED.replace("mu = 0.3", "mu = 7").replace("start = 1 ", "start = 1, speed = 1 "), 1)
    assert "the friction of the joint 'rod' has no single value: it grows by 1.05 of itself" in result.message
    text = eomgen.derive(eomgen.loads(LOADED)).render()
    assert "spectral radius of D is below 1" in text and "D_rod = 3*mu*r/(2*l)" in text


RAMP = """
eomgen = 1
space = "plane"
parameters = { m = 2, g = 9.81, alpha = 0.5, mu = 0.2, mu_s = 0.6 }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
coordinates = { s = { start = 0, speed = -1 } }
outputs = { F = "friction(block)" }
[bodies.block]
shape = { kind = "rectangle", mass = "m", width = 0.4, height = 0.2 }
[bodies.block.joint]
kind = "prismatic"
displacement = "s"
axis = ["cos(alpha)", "-sin(alpha)"]
friction = { coefficient = "mu", static = "mu_s" }
"""


def test_a_slide_on_a_slope_stops_and_holds_itself():
    """It slows by g (sin a + mu cos a), stops at v^2 over twice that, and stays, as tan a <= mu_s."""
    slows = G * (math.sin(0.5) + 0.2 * math.cos(0.5))
    result = run(RAMP, 1)
    assert result.phases[0].end == pytest.approx(1 / slows)
    assert result["s"][-1] == pytest.approx(-1 / (2 * slows))
    assert (result["F"][0], result["F"][-1]) == pytest.approx((0.4 * G * math.cos(0.5), -2 * G * math.sin(0.5)))
    assert senses(run(RAMP.replace("mu_s = 0.6", "mu_s = 0.5"), 0.5), "block") == [-1, 1]


def test_a_hinge_in_space_rubs_by_the_whole_force_that_it_carries():
    """A wheel with its axis along z carries m g alone: J w' = - mu r m g, and the plane's pendulum is the same."""
    text = """
eomgen = 1
space = "space"
parameters = { m = 2, g = 9.81, J = 0.05, mu = 0.1, r = 0.02 }
forces.weight = { kind = "gravity", acceleration = [0, 0, "-g"] }
coordinates = { q = { speed = 3 } }
[bodies.wheel]
mass = "m"
inertia = [0.03, 0.03, "J"]
joint = { kind = "revolute", angle = "q", friction = { coefficient = "mu", radius = "r" } }
"""
    result = run(text, 5)
    slows = 0.002 * 2 * G / 0.05
    assert result.phases[0].end == pytest.approx(3 / slows)
    assert result["q"][-1] == pytest.approx(9 / (2 * slows))
    assert result.certify().ok


TWO = """
eomgen = 1
space = "plane"
parameters = { m = 1, g = 9.81, l = 1 }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
coordinates = { q1 = { start = Q1 }, q2 = { start = Q2 } }
[bodies.upper]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "q1", point = "start", turned = { angle = "-pi/2" }, friction = { ONE } }
[bodies.lower]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", on = "upper.end", angle = "q2", point = "start", friction = { OTHER } }
"""


def two(q1: float, q2: float, one: str, other: str) -> str:
    return TWO.replace("Q1", str(q1)).replace("Q2", str(q2)).replace("ONE", one).replace("OTHER", other)


def consistent(M, f, kinetic, static) -> list[tuple[int, ...]]:
    """Every combination of slip and stick that agrees with M a = f + tau, |tau| <= T_s, tau = - s T_k, s a >= 0."""
    found = []
    for senses in itertools.product((0, 1, -1), repeat=len(f)):
        s = np.array(senses)
        free = s != 0
        a = np.zeros(len(f))
        a[free] = np.linalg.solve(M[np.ix_(free, free)], (f - s * kinetic)[free])
        tau = M @ a - f
        if np.all(np.abs(tau[~free]) <= static[~free]) and np.all(s[free] * a[free] >= 0):
            found.append(senses)
    return found


def test_joints_at_rest_move_as_the_one_combination_that_agrees():
    """Gauss's principle against 3^n combinations: with static = kinetic friction exactly one agrees."""
    rng = np.random.default_rng(3)
    for n in (2, 3, 4):
        for _ in range(60):
            A = rng.normal(size=(n, n))
            M, f = A @ A.T + 0.1 * np.eye(n), rng.normal(size=n)
            T = rng.uniform(0.05, 1, n)
            G = np.linalg.inv(M)
            assert consistent(M, f, T, T) == [tuple(senses_from_rest(G, G @ f, T, T))]


def test_two_joints_stick_and_slip_as_their_equations_say():
    """T = (3, 0.5): between events M a + c = Q - T sign; each phase as its modes, to the last rest; proven."""
    result = run(two(1, -0.5, "torque = 3", "torque = 0.5"), 6)
    assert [phase.model.configuration.modes["upper"].sense for phase in result.phases][-1] == 0
    assert [phase.model.configuration.modes["lower"].sense for phase in result.phases][-1] == 0
    q1, q2 = result["q1"][-1], result["q2"][-1]
    outer = G / 2 * math.sin(q1 + q2)
    assert abs(outer) <= 0.5 and abs(outer + 1.5 * G * math.sin(q1)) <= 3
    assert result.certify().ok


def test_several_ways_to_go_on_from_rest_are_named():
    """T_k = (5.663, 0.849), T_s = (14.375, 2.154) at (2.073, -1.407): (stick, slip) agrees, and (slip, stick)."""
    result = run(two(2.073, -1.407, "torque = 5.663, static = 14.375", "torque = 0.849, static = 2.154"), 1)
    assert "leaves 2 ways to go on from rest: 'upper' sticks, 'lower' slips back; or" in result.message
    one = run(two(-1.488, -0.563, "torque = 4.245, static = 8.614", "torque = 0.333, static = 0.675"), 0.01)
    assert (senses(one, "upper")[0], senses(one, "lower")[0]) == (1, 0)


def ranges(text: str) -> list[dict]:
    return eomgen.statics(eomgen.loads(text)).entries()["rest_range"]


def test_statics_gives_the_range_of_rest():
    """|sin q| <= mu_s r/a, m g (l/2) |sin q| <= T_s; on a slope tan(alpha) <= mu_s holds anywhere."""
    (found,) = ranges(LOADED.replace("start = 1 ", "start = 0.02 "))
    assert found["name"] == "q" and found["condition"] == "abs(1/2*l*sin(q)) <= mu*r"
    assert (found["low"], found["high"]) == pytest.approx((-0.060036058, 0.060036058), abs=1e-9)
    (found,) = ranges(HINGE.replace("start = 1 ", "start = 0.1 ").replace("T_c = 1", "T_c = 2"))
    assert found["high"] == pytest.approx(math.asin(4 / G), abs=1e-12)
    assert ranges(RAMP.replace("speed = -1", "speed = 0")) == [
        {"name": "s", "low": None, "high": None, "condition": "tan(alpha) <= mu_s", "extent": "anywhere"}
    ]


def test_statics_names_a_joint_that_cannot_hold():
    found = eomgen.statics(eomgen.loads(HINGE))
    assert found.broken == ("the joint 'rod' slides: it would need more friction than it can have",)
    assert ranges(HINGE)[0]["high"] == pytest.approx(math.asin(2 / G), abs=1e-12)


SPRING = """
eomgen = 1
space = "plane"
parameters = { m = 10, k = 500, mu = 0.25, al = { value = 20, unit = "deg" }, g = 9.81 }
coordinates = { s = { start = 0, unit = "cm" } }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
[bodies.block]
mass = "m"
[bodies.block.joint]
kind = "prismatic"
axis = ["cos(al)", "sin(al)"]
displacement = "s"
stiffness = "k"
friction = { coefficient = "mu" }
"""


def test_the_range_of_rest_beside_a_start_that_slides():
    """-m g (sin al + mu cos al) <= k s <= -m g (sin al - mu cos al); without a spring it rests nowhere."""
    al, W = math.radians(20), 10 * G
    (found,) = ranges(SPRING)
    ends = [-W * (math.sin(al) + sign * 0.25 * math.cos(al)) / 500 for sign in (1, -1)]
    assert (found["low"], found["high"]) == pytest.approx(tuple(ends), abs=1e-12)
    printed = str(eomgen.statics(eomgen.loads(SPRING)).render("text"))
    assert f"{100 * ends[0]:.10g} cm" in printed and f"{100 * ends[1]:.10g} cm" in printed
    (found,) = ranges(SPRING.replace('"k"', "0").replace(" k = 500,", ""))
    assert (found["low"], found["high"], found["extent"]) == (None, None, "nowhere")


TOGGLE = """
eomgen = 1
space = "plane"
parameters = { l = 0.3, F = 100, W = 800, mu = 0.15 }
coordinates = { q = { start = 10, unit = "deg" }, y = { dependent = true, near = 0.59 } }
bodies.low = { points = { knee = ["l", 0] }, joint = { kind = "revolute", angle = "pi/2 - q" } }
bodies.high = { points = { top = ["l", 0] }, joint = { kind = "revolute", on = "low.knee", angle = "2*q" } }
forces.push = { kind = "force", point = "low.knee", force = ["-F", 0] }
constraints.head = { kind = "pin", points = ["high.top", "press.origin"] }
[bodies.press]
mass = 5
joint = { kind = "prismatic", axis = [0, 1], displacement = "y", force = "-W", friction = { coefficient = "mu" } }
"""


def test_a_narrow_range_of_rest_of_a_toggle_is_found():
    """F/(2 tan q) = W -+ mu F/2, a range of 0.07 deg, which the head follows."""
    (found,) = ranges(TOGGLE)
    assert (found["name"], found["extent"]) == ("q", "between")
    ends = [math.atan(50 / (800 + sign * 7.5)) for sign in (1, -1)]
    assert (found["low"], found["high"]) == pytest.approx(tuple(ends), rel=1e-9)


def test_each_variable_of_a_sleeve_sticks_by_itself():
    """A spinning sleeve slows by T/J and slides by F/m, each on its own."""
    text = """
eomgen = 1
space = "space"
parameters = { m = 2, J = 0.03 }
coordinates = { d = { speed = 1 }, a = { speed = -3 } }
outputs = { F = "friction(sleeve_displacement)", T = "friction(sleeve_angle)" }
[bodies.sleeve]
mass = "m"
inertia = ["J", 0.02, 0.02]
[bodies.sleeve.joint]
kind = "cylindrical"
axis = [1, 0, 0]
displacement = "d"
angle = "a"
friction = { displacement = { force = 3 }, angle = { torque = 0.05 } }
"""
    result = run(text, 3)
    assert [phase.end for phase in result.phases[:2]] == pytest.approx([2 / 3, 9 / 5])
    assert (result["d"][-1], result["a"][-1]) == pytest.approx((1 / 3, -2.7))
    assert (result["F"][0], result["T"][0]) == pytest.approx((-3, 0.05))
    assert result.certify().ok


def test_friction_of_a_driven_joint_is_a_part_of_its_drive():
    """q = t: the drive is m g (l/2) sin q + T_c."""
    text = HINGE.replace("{ start = 1 }", '{ motion = "t" }').replace(
        'holds = "friction(rod)"', 'holds = "friction(rod)", D = "drive(q)"'
    )
    result = run(text, 1)
    assert result["holds"] == pytest.approx(np.full(len(result.t), -1.0))
    assert result["D"] == pytest.approx(G / 2 * np.sin(result.t) + 1)


def test_friction_in_a_loop_holds_where_virtual_work_says():
    """A parallelogram of two cranks l with a bar M: it rests while (m + M) g l |sin a| <= T, the coupler follows."""
    text = """
eomgen = 1
space = "plane"
parameters = { m = 1, M = 2, l = 0.5, d = 1, g = 9.81, T = 3 }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
coordinates = { a = { start = 0.1 }, b = { dependent = true, near = 0.1 }, c = { dependent = true, near = 0 } }
outputs = { holds = "friction(left)" }
points = { P = ["d", 0] }
constraints.pin = { kind = "pin", points = ["bar.end", "right.end"] }
[bodies.left]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "a - pi/2", point = "start", friction = { torque = "T" } }
[bodies.bar]
shape = { kind = "rod", mass = "M", length = "d" }
joint = { kind = "revolute", on = "left.end", angle = "c - a + pi/2", point = "start" }
[bodies.right]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", at = "P", angle = "b - pi/2", point = "start" }
"""
    result = run(text, 0.5)
    assert senses(result, "left") == [0]
    assert result["holds"][-1] == pytest.approx(3 * G * 0.5 * math.sin(0.1), rel=1e-9)
    moved = run(text.replace("start = 0.1", "start = 0.4"), 3)
    rests = moved["a"][-1]
    assert senses(moved, "left")[-1] == 0 and 3 * G * 0.5 * abs(math.sin(rests)) <= 3
    assert moved.certify().ok


def test_statics_gives_the_condition_of_contacts_that_hold_themselves():
    """A block on a slope: tan(alpha) <= mu; a ladder on a rough floor: 1/(2 tan(alpha)) <= mu."""
    head = 'eomgen = 1\nspace = "plane"\nforces.weight = { kind = "gravity", acceleration = [0, "-g"] }\n'
    slope = """
parameters = { m = 2, g = 9.81, alpha = 0.3, mu = 0.4 }
coordinates = { s = { start = 0 } }
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["s*cos(alpha)", "-s*sin(alpha)"] }
[constraints.slope]
kind = "support"
point = "block.origin"
normal = ["sin(alpha)", "cos(alpha)"]
friction = "mu"
"""
    assert [found["condition"] for found in ranges(head + slope)] == ["tan(alpha) <= mu"]
    ladder = """
parameters = { m = 10, g = 9.81, l = 4, alpha = 1.1, mu = 0.4 }
[bodies.ladder]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "free", x = "l*cos(alpha)/2", y = "l*sin(alpha)/2", angle = "pi - alpha" }
[constraints]
floor = { kind = "support", point = "ladder.start", normal = [0, 1], friction = "mu" }
wall = { kind = "support", point = "ladder.end", normal = [1, 0] }
"""
    (found,) = ranges(head + ladder)
    assert (found["name"], found["condition"]) == ("floor", "1/(2*tan(alpha)) <= mu")
    assert found["high"] == pytest.approx(0.4 * 10 * G) and found["low"] == -found["high"]


def test_many_runs_stick_and_slip_as_each_alone():
    model = eomgen.loads(HINGE)
    many = eomgen.simulate_many(model, time=3, start={"q": [1, 0.5, 0.1]}, target="numpy", rtol=1e-11, atol=1e-11)
    alone = [
        eomgen.simulate(model, time=3, start={"q": q}, target="numpy", rtol=1e-11, atol=1e-11) for q in (1, 0.5, 0.1)
    ]
    assert many.x[:, -1, 0] == pytest.approx([each["q"][-1] for each in alone], abs=1e-10)


def test_a_regressor_has_friction_as_a_parameter_and_an_impact_with_a_rubbing_hinge_is_refused():
    """tau = ... + sign(q') T_c; the impulse of an impact would rub in a hinge with mu r |R|."""
    found = eomgen.regressor(eomgen.loads(HINGE))
    assert "friction(rod)" in found.parameters and found.certify().ok
    text = LOADED.replace("friction =", "limits = [-0.3, 2]\nrestitution = 0.5\nfriction =")
    assert "an impulse there would rub too" in run(text, 1).message
    assert run(text.replace('coefficient = "mu", radius = "r"', "torque = 0.3"), 1).impacts


CRANK = """
eomgen = 1
space = "plane"
parameters = { J = 0.2, r = 0.1, l = 0.3 }
coordinates.al = { start = 0.5, speed = 20 }
coordinates.be = { near = -0.2, dependent = true }
coordinates.x = { near = 0.37, dependent = true }
bodies.crank = { mass = 1, inertia = "J", points = { pin = ["r", 0] }, joint = { kind = "revolute", angle = "al" } }
bodies.rod = { points = { end = ["l", 0] }, joint = { kind = "revolute", on = "crank.pin", angle = "be - al" } }
bodies.slide.joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "P", friction = FRICTION }
inputs.P = 0
constraints.wrist = { kind = "pin", points = ["rod.end", "slide.origin"] }
"""


def place(al: float) -> float:
    """Of the slide: r cos al + sqrt(l^2 - r^2 sin^2 al)."""
    return 0.1 * math.cos(al) + math.sqrt(0.09 - 0.01 * math.sin(al) ** 2)


@pytest.mark.slow
def test_a_slide_in_a_loop_passes_its_dead_centres():
    """J (w^2 - w0^2)/2 = -F times the way; in a dead centre x' = 0, and nothing holds what is moved on by x''."""
    result = run(CRANK.replace("FRICTION", "{ force = 30, static = 90 }"), 0.4)
    assert senses(result, "slide") == [-1, 1, -1]
    way = place(0.5) - 0.2 + 0.2 + 0.4 - place(1)
    last = result.ask("al' at al = 2*pi + 1").value
    assert last == pytest.approx(math.sqrt(20**2 - 2 * 30 / 0.2 * way), rel=1e-9)
    assert result.certify().ok


def run_of(model, P: float) -> float:
    """N at the start."""
    return float(eomgen.simulate(model, time=0.001, inputs={"P": P}, target="numpy")["N"][0])


def test_the_normal_force_of_a_rough_slide_keeps_its_sign():
    """Along the rod N = -(P + F) tan be, be the angle by which it falls, F = mu |N| against x' < 0."""
    model = eomgen.loads(CRANK.replace("FRICTION", "{ coefficient = 0.1 }") + 'outputs.N = "reaction_n(slide)"')
    tan = math.tan(math.asin(math.sin(0.5) / 3))
    for P, N in ((50, -50 * tan / (1 - 0.1 * tan)), (-50, 50 * tan / (1 + 0.1 * tan))):
        assert run_of(model, P) == pytest.approx(N), P


HOIST = """
parameters = { M = 30, J = 0.8, r = 0.2, k = 40000, T_c = 4, h = 3, g = 9.81 }
coordinates = { phi = 0, y = -2 }
bodies.drum = { inertia = "J", joint = { kind = "revolute", angle = "phi", friction = { torque = "T_c" } } }
[bodies.load]
shape = { kind = "particle", mass = "M" }
joint = { kind = "prismatic", at = ["r", 0], axis = [0, 1], displacement = "y", limits = ["-h", "inf"] }
[forces.cable]
kind = "rope"
path = [{ body = "drum", radius = "r", turn = "cw" }, "load.center"]
stiffness = "k"
length = "start"
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def test_a_stop_that_is_open_at_the_start_holds_nothing():
    """The load hangs 1 m above its stop: nothing carries it there, though brake and stop together would hold all."""
    model = eomgen.loads('eomgen = 1\nspace = "plane"\n' + HOIST)
    with pytest.raises(eomgen.EomgenError, match=r"'load_low'.* open by 1"):
        eomgen.statics(model)
    assert eomgen.statics(model, start={"y": -3, "phi": -5}).certify().ok


STOPPED = """
parameters = { m = 2, l = 0.8, g = 9.81, T = 0.5 }
coordinates = { q = START }
inputs = { M = "MOMENT" }
[bodies.bob]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "q", friction = { torque = "T" }, limits = [-1, 2], torque = "M" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def stopped(start: float, moment: str) -> eomgen.Model:
    text = STOPPED.replace("START", repr(start)).replace("MOMENT", moment)
    return eomgen.loads('eomgen = 1\nspace = "plane"\n' + text)


def test_what_friction_holds_between_its_stops_rests_there_with_an_input_and_a_state_as_they_begin():
    """|m g l cos(q)/2 - M| <= T: q between acos(2 (M + T)/(m g l)) and acos(2 (M - T)/(m g l)), the stops open."""
    (rest,) = eomgen.statics(stopped(1.55, "0.1")).found.ranges
    assert [rest.low, rest.high] == pytest.approx([math.acos(2 * (0.1 + s * 0.5) / (2 * 9.81 * 0.8)) for s in (1, -1)])
    text = STOPPED.replace("START", "1.55").replace("MOMENT", "0").replace('"T" }', '"T*k" }')
    text += '[states.k]\nstart = 0.5\nrate = "1 - k"\n'
    (rest,) = eomgen.statics(eomgen.loads('eomgen = 1\nspace = "plane"\n' + text)).found.ranges
    assert rest.high == pytest.approx(math.acos(-2 * 0.25 / (2 * 9.81 * 0.8)))


def test_a_joint_with_friction_rests_on_its_stop_until_its_drive_beats_weight_and_friction():
    """It leaves the stop at 6 t = m g l cos(1)/2 + T, and what stop and friction share before is in no column."""
    run = eomgen.simulate(stopped(-1, "6*t"), time=0.9, target="numpy")
    assert run.status == "finished"
    assert run.phases[-1].start == pytest.approx((2 * 9.81 * 0.4 * math.cos(1) + 0.5) / 6, rel=1e-9)
    assert np.isnan(run["friction(bob)"][1]) and np.isnan(run["reaction_couple(bob_low)"][1])
    assert run["friction(bob)"][-1] == pytest.approx(-0.5) and run["q"][-1] > -1


def test_the_reactions_of_a_hinge_that_rubs_by_its_own_force_follow_where_it_begins_to_slide():
    """Let go at q: I q'' = -m g l sin(q)/2 + mu r |R|, R = m (l/2 q'' t - g)."""
    text = STOPPED.replace("START", "1.2").replace("MOMENT", "0").replace("limits = [-1, 2], ", "")
    text = text.replace('torque = "T" }', "coefficient = 0.3, radius = 0.02 }").replace(", T = 0.5", "")
    model = eomgen.loads('eomgen = 1\nspace = "plane"\n' + text)
    m, l, q = 2, 0.8, 1.2
    F = 0.0
    for _ in range(50):
        a = (F - m * 9.81 * l / 2 * math.cos(q)) / (m * l * l / 3)
        F = 0.3 * 0.02 * m * math.hypot(l / 2 * a * math.sin(q), l / 2 * a * math.cos(q) + 9.81)
    assert eomgen.reactions(model)["friction(bob)"].value == pytest.approx(F, rel=1e-9)


SCREW = """
eomgen = 1
space = "space"
parameters = { W = 500, J = 0.02, h = 0.001, r = 0.008, mu = 0.15, M = MOMENT }
coordinates.q = { start = 0SPEED }
forces.load = { kind = "force", point = "nut.origin", force = [0, 0, "-W"] }
outputs = { T = "friction(nut)" }
[bodies.nut]
mass = 50
inertia = ["J", "J", "J"]
joint = { kind = "screw", angle = "q", pitch = "h", torque = "M", friction = { coefficient = "mu", radius = "r" } }
"""


def screw(M: float, speed: float = 0) -> str:
    return SCREW.replace("MOMENT", repr(M)).replace("SPEED", f", speed = {speed}")


def test_a_screw_raises_lowers_and_holds_by_the_friction_of_its_thread():
    """W r tan(alpha + rho) raises, W r tan(rho - alpha) lowers; between them it rests, alone while tan(alpha) <= mu."""
    alpha, rho = math.atan(1 / 8), math.atan(0.15)
    up, down = (500 * 0.008 * math.tan(rho + sign * alpha) for sign in (1, -1))
    for M, holds in ((0.999 * up, True), (1.001 * up, False), (-0.999 * down, True), (-1.001 * down, False)):
        assert (not eomgen.statics(eomgen.loads(screw(M))).broken) == holds
    text = screw(0).replace(", M = 0", "").replace('torque = "M", ', "")
    assert [found["condition"] for found in ranges(text)] == ["h/r <= mu"]


def test_a_screw_turns_by_the_law_of_its_thread():
    """J q'' = M - F r tan(alpha + rho), m h q'' = F - W of the whole force F along the axis; then it sticks."""
    result = run(screw(0, 10), 0.5)
    k = 0.008 * math.tan(math.atan(1 / 8) + math.atan(0.15))
    slows = 500 * k / (0.02 + 50 * 0.001 * k)
    assert senses(result, "nut") == [1, 0]
    assert result.phases[0].end == pytest.approx(10 / slows)
    assert result["T"][-1] == pytest.approx(500 * 0.001)
    assert result.certify().ok


def test_a_stop_along_a_slide_presses_no_friction():
    """Up with e v against g (sin a + mu cos a), down by g (sin a - mu cos a): each hit e sqrt(down/up) of the last."""
    text = RAMP.replace("mu_s = 0.6", "mu_s = 0.2").replace("speed = -1", "speed = 2")
    result = run(text.replace("friction = {", 'limits = ["-inf", 1]\nrestitution = 0.5\nfriction = {'), 1.25)
    down, up = (G * (math.sin(0.5) + sign * 0.2 * math.cos(0.5)) for sign in (-1, 1))
    v, t = math.sqrt(4 + 2 * down), 0.0
    due = [(math.sqrt(4 + 2 * down) - 2) / down]
    for _ in range(2):
        v, t = v / 2 * math.sqrt(down / up), v / 2 / up
        due.append(due[-1] + t + v / down)
    assert [impact.t for impact in result.impacts[:3]] == pytest.approx(due, rel=1e-9)


LOOKED_AT = "an equilibrium that all contacts allow exists, or is denied, as reported"


@pytest.mark.parametrize(("torque", "rests"), [(-3, False), (-2.1, False), (-1.9, True), (0, True), (50, True)])
def test_a_stop_and_friction_share_what_they_hold_and_neither_pulls_nor_holds_more(torque, rests):
    """Hinge at its stop: from it only friction holds, up to 2; towards it the stop takes whatever comes."""
    text = f"""
    eomgen = 1
    space = "plane"
    coordinates = {{ q = 0.5 }}
    bodies.bar.inertia = 1
    [bodies.bar.joint]
    kind = "revolute"
    angle = "q"
    limits = ["-inf", 0.5]
    torque = {torque}
    friction.torque = 2
    """
    found = eomgen.statics(eomgen.loads(textwrap.dedent(text)))
    assert found.found.structure.indeterminacy == 1 and bool(found.broken) != rests
    assert rests or "'bar_high' pushes, the joint 'bar' holds" in found.failed
    assert LOOKED_AT in {check.name for check in found.certify().checks} and found.certify().ok


@pytest.mark.parametrize(("push", "height"), [(3.8, 0.2), (4.0, 0.2), (3.8, 1.3), (-3.8, 0.2), (-4.0, 0.2)])
def test_a_box_on_two_rough_feet_slides_where_both_together_hold_no_more(push, height):
    """At rest where |P| <= mu m g, and where it does not tip: |P| h <= m g b. Friction of each foot is open."""
    text = f"""
    eomgen = 1
    space = "plane"
    parameters = {{ m = 1, g = 9.81, mu = 0.4, b = 0.5 }}
    coordinates = {{ x = 0, y = 0, q = 0 }}
    [bodies.box]
    mass = "m"
    inertia = 1
    points = {{ L = ["-b", 0], R = ["b", 0], P = [0, {height}] }}
    joint = {{ kind = "free", x = "x", y = "y", angle = "q" }}
    [constraints]
    left = {{ kind = "support", point = "box.L", normal = [0, 1], unilateral = true, friction = "mu" }}
    right = {{ kind = "support", point = "box.R", normal = [0, 1], unilateral = true, friction = "mu" }}
    [forces]
    weight = {{ kind = "gravity", acceleration = [0, "-g"] }}
    push = {{ kind = "force", point = "box.P", force = [{push}, 0] }}
    """
    found = eomgen.statics(eomgen.loads(textwrap.dedent(text)))
    rests = abs(push) <= 0.4 * 9.81 and abs(push) * height <= 9.81 * 0.5
    assert found.found.structure.indeterminacy == 1 and bool(found.broken) != rests
    assert LOOKED_AT in {check.name for check in found.certify().checks} and found.certify().ok


@pytest.mark.parametrize("angle", [0.6, 0.7, 0.75, 1.2])
def test_a_ladder_with_a_rough_foot_and_top_rests_where_it_is_steep(angle):
    """tan(q) >= (1 - mu^2)/(2 mu): each of its four reactions is open, and what all of them allow is not."""
    text = f"""
    eomgen = 1
    space = "plane"
    parameters = {{ m = 10, g = 9.81, mu = 0.45, L = 3 }}
    coordinates = {{ x = 0, y = 0, q = {angle} }}
    [bodies.ladder]
    mass = "m"
    inertia = 1
    center = ["L/2", 0]
    points = {{ F = [0, 0], T = ["L", 0] }}
    joint = {{ kind = "free", x = "x", y = "y", angle = "q" }}
    [constraints]
    floor = {{ kind = "support", point = "ladder.F", normal = [0, 1], unilateral = true, friction = "mu" }}
    [constraints.wall]
    kind = "support"
    point = "ladder.T"
    normal = [-1, 0]
    at = ["L*cos({angle})", 0]
    unilateral = true
    friction = "mu"
    [forces]
    weight = {{ kind = "gravity", acceleration = [0, "-g"] }}
    """
    found = eomgen.statics(eomgen.loads(textwrap.dedent(text)))
    rests = math.tan(angle) >= (1 - 0.45**2) / (2 * 0.45)
    assert len(found.found.open) == 4 and bool(found.broken) != rests and found.certify().ok
