"""Limits of joints: rigid stops that can only push, with restitution."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import eomgen
from eomgen.errors import ModelError
from eomgen.results import impact

G = 9.81
PENDULUM = """
eomgen = 1
space = "plane"
parameters = { m = 1, g = 9.81, l = 1, lo = -0.3, e = 0.5 }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
coordinates = { q = { start = 60, unit = "deg" } }
[bodies.rod]
shape = { kind = "rod", mass = "m", length = "l" }
[bodies.rod.joint]
kind = "revolute"
angle = "q"
point = "rod.start"
turned = { angle = "-pi/2" }
limits = ["lo", 90]
restitution = "e"
"""


def run(text: str, time: float, **options):
    return eomgen.simulate(eomgen.loads(text), time=time, target="numpy", **options)


@pytest.mark.slow
def test_a_pendulum_rebounds_from_the_stop_of_its_hinge():
    """I q'' = -m g (l/2) sin q up to q = lo, then q' = -e q'; the impulse is I (1 + e) |q'|, I = m l^2/3."""

    def rate(t, x):
        return [x[1], -1.5 * G * math.sin(x[0])]

    def stop(t, x):
        return x[0] + 0.3

    stop.terminal, stop.direction = True, -1
    t, x, times = 0.0, [math.pi / 3, 0.0], []
    for _ in range(2):
        found = solve_ivp(rate, (t, 9), x, events=stop, rtol=1e-13, atol=1e-13)
        t, x = found.t[-1], [-0.3, -0.5 * found.y[1, -1]]
        times.append((t, -found.y[1, -1]))
    result = run(PENDULUM, 2)
    assert [impact.t for impact in result.impacts] == pytest.approx([t for t, _ in times], abs=1e-8)
    assert [i.impulses["rod_low"] for i in result.impacts] == pytest.approx([v * 0.5 for _, v in times], rel=1e-7)
    assert [i.loss for i in result.impacts] == pytest.approx([v * v * 0.75 / 6 for _, v in times], rel=1e-7)
    assert result.certify().ok


def test_a_plain_number_is_in_the_unit_of_the_coordinate():
    """limits = [.., 90] of q in degrees: pi/2; expressions are in SI."""
    low, high = eomgen.loads(PENDULUM).constraints.values()
    assert high.bound.value_at({"pi": math.pi}) == pytest.approx(math.pi / 2) and low.bound.text == "lo"


def _bounds(angle, limits):
    """The bounds of a rod on a hinge, q in degrees: those of rigid stops, then those of stops that yield."""
    text = PENDULUM.replace('angle = "q"', f'angle = "{angle}"').replace('["lo", 90]', limits)
    assert text.count(limits) == text.count(f'angle = "{angle}"') == 1
    rigid = eomgen.loads(text)
    soft = eomgen.loads(text.replace('restitution = "e"', "stop = { stiffness = 1 }"))
    given = soft.bodies["rod"].joint.limits
    values = [[c.bound for c in rigid.constraints.values()], [given.low, given.high]]
    return [[x.value_at({"pi": math.pi}) for x in each] for each in values], rigid.warnings


BOUNDS = [
    ("q", "[-30, 90]", (-math.pi / 6, math.pi / 2), ""),
    ("q - pi/2", "[-30, 90]", (-math.pi / 6, math.pi / 2), ""),
    ("lo - 2*q", "[-30, 90]", (-math.pi / 6, math.pi / 2), ""),
    ("q", '["-pi/6", { value = 1, unit = "rad" }]', (-math.pi / 6, 1), ""),
    ("q", '[-30, { value = 90, unit = "deg" }]', (-math.pi / 6, math.pi / 2), ""),
    ("sin(q)", "[-30, 90]", (-30, 90), "-30 is in rad, though 'q' is in deg"),
    ("sin(q)", '["-pi/6", "pi/2"]', (-math.pi / 6, math.pi / 2), ""),
]


@pytest.mark.parametrize(("angle", "limits", "bounds", "said"), BOUNDS)
def test_limits_are_in_the_unit_of_the_one_coordinate_or_say_that_they_are_not(angle, limits, bounds, said):
    """Plain limits of a q + b are in the unit of q, of anything else in SI, with a warning; others in their own."""
    found, warnings = _bounds(angle, limits)
    assert found == [pytest.approx(list(bounds))] * 2
    assert [w.what for w in warnings if "limits of" in w.what and said in w.what] or not said
    assert bool(said) == any("limits of" in w.what for w in warnings)


def test_the_impulses_of_the_stop_and_of_the_hinge_in_closed_form():
    """m l^2/3 (1 + e) w of the stop, m (l/2) (1 + e) w across the rod of the hinge, w^2 = 3 g/l (cos lo - cos q0)."""
    text = (
        PENDULUM.replace('["lo", 90]', '["lo", "inf"]')
        + """
[outputs]
L = { value = "impulse(rod_low)", at = "q = lo" }
X = { value = "impulse_x(rod)", at = "q = lo" }
Y = { value = "impulse_y(rod)", at = "q = lo" }
"""
    )
    found = eomgen.solve(eomgen.loads(text))
    w = math.sqrt(3 * G * (math.cos(0.3) - 0.5))
    assert found["L"].value == pytest.approx(1.5 * w / 3, rel=1e-9)
    across = 0.5 * 1.5 * w
    assert found["X"].value == pytest.approx(across * math.cos(0.3), rel=1e-9)
    assert found["Y"].value == pytest.approx(-across * math.sin(0.3), rel=1e-9)
    assert found.certify().ok


@pytest.mark.slow
def test_the_impact_on_a_stop_names_the_impulses_of_all_joints():
    """m (v+ - v-) of each body is the sum of the impulses on it: of mast and arm in space too."""
    found = impact(eomgen.loads(SPACE))
    assert found.entries()["impact"]["joints"].keys() == {"mast", "arm"}
    certificate = found.certify()
    bodies = [check for check in certificate.checks if check.name == "each body moves by the impulses on it"]
    assert certificate.ok and [check.status for check in bodies] == ["holds"]


@pytest.mark.slow
def test_many_runs_hit_the_stop_as_single_ones_do():
    """A model made anew keeps its stops: other starts and parameters give the runs of one."""
    model, t = eomgen.loads(PENDULUM), np.linspace(0, 1.5, 4)
    many = eomgen.simulate_many(model, time=1.5, start={"q": [0.5, 1.0]}, samples=t)
    for k, q in enumerate((0.5, 1.0)):
        assert many["q"][k] == pytest.approx(eomgen.simulate(model, time=1.5, start={"q": q}, samples=t)["q"], abs=1e-9)


CARTS = """
eomgen = 1
space = "plane"
parameters = { m1 = 2, m2 = 1, e = 0.5 }
coordinates = { x = {}, d = { start = 0.5, speed = -1 } }
[bodies.big]
mass = "m1"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[bodies.small]
mass = "m2"
[bodies.small.joint]
kind = "prismatic"
on = "big"
axis = [1, 0]
displacement = "d"
limits = [0, 1]
restitution = "e"
"""


def test_a_stop_between_two_bodies_keeps_their_momentum():
    """d' = -e d', m1 x' + m2 (x' + d') stays; the impulse m1 m2/(m1 + m2) (1 + e) v; at the other end (1 + e) e v."""
    result = run(CARTS, 3)
    low, high = result.impacts[:2]
    assert (low.contact, high.contact) == ("small_low", "small_high")
    assert low.t == pytest.approx(0.5) and high.t == pytest.approx(0.5 + 1 / 0.5)
    assert low.impulses["small_low"] == pytest.approx(2 / 3 * 1.5)
    assert high.impulses["small_high"] == pytest.approx(2 / 3 * 0.75)
    assert low.loss == pytest.approx(2 / 3 * 0.75 / 2)
    P = 3 * result["x'"] + result["d'"]
    assert pytest.approx(np.full(len(P), -1.0)) == P
    assert result.certify().ok


def test_a_stop_without_restitution_holds_and_lets_go():
    """A mass on a spring against a wall at -1/2: it stays there, the spring pulls it to the wall no more than k/2."""
    text = CARTS.replace('restitution = "e"\n', "").replace(
        "limits = [0, 1]", 'limits = [0, "inf"]\nstiffness = 4\nrest = 0.25'
    )
    text = text.replace("e = 0.5", "e = 0").replace(", e = 0", "")
    result = run(text, 1.0)
    first = result.impacts[0]
    assert first.contact == "small_low" and first.impulses["small_low"] == pytest.approx(2 / 3, rel=1e-8)
    assert result.phases[-1].model.configuration.open == ("small_low",)


def test_a_planar_joint_has_limits_of_each_variable():
    """x and angle of one body: each rebounds alone, as the mass centre is the joint's point."""
    text = """
eomgen = 1
space = "plane"
parameters = { m = 2, J = 0.3 }
coordinates = { x = { speed = 1 }, y = {}, phi = { speed = -2 } }
[bodies.disc]
mass = "m"
inertia = "J"
[bodies.disc.joint]
kind = "planar"
x = "x"
y = "y"
angle = "phi"
limits = { x = ["-inf", 0.5], angle = [-0.4, "inf"] }
restitution = 1
"""
    result = run(text, 1)
    assert [(i.contact, i.t) for i in result.impacts] == [
        ("disc_angle_low", pytest.approx(0.2)),
        ("disc_x_high", pytest.approx(0.5)),
    ]
    assert result.impacts[0].impulses["disc_angle_low"] == pytest.approx(1.2)
    assert result.impacts[1].impulses["disc_x_high"] == pytest.approx(4)
    assert (result["x"][-1], result["phi"][-1]) == pytest.approx((0.0, 1.2))


SPACE = """
eomgen = 1
space = "space"
parameters = { m = 1, g = 9.81 }
forces.weight = { kind = "gravity", acceleration = [0, 0, "-g"] }
coordinates = { a = { speed = 2 }, b = { start = 0.8 } }
[bodies.mast]
mass = "m"
inertia = [0.2, 0.2, 0.1]
joint = { kind = "revolute", angle = "a" }
[bodies.arm]
mass = "m"
center = [0.5, 0, 0.1]
inertia = [0.02, 0.1, 0.1]
[bodies.arm.joint]
kind = "revolute"
on = "mast"
at = [0.2, 0, 1]
axis = [0, -1, 0]
angle = "b"
limits = [-0.5, "inf"]
restitution = 0.3
"""


@pytest.mark.slow
def test_a_stop_in_space_pushes_both_bodies_of_its_joint():
    """b' = -0.3 b', and the angular momentum about the mast's axis stays as it is: proven by momenta of the bodies."""
    result = run(SPACE, 1)
    assert result.impacts[0].contact == "arm_low"
    before, after = result.phases[0].last, result.phases[1].first
    assert after["b'"] == pytest.approx(-0.3 * before["b'"], rel=1e-9)
    assert result.certify().ok


SOFT = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 5000, d = 20, v = 3, hi = 0.5 }
coordinates = { x = { speed = "v" } }
[bodies.cart]
mass = "m"
[bodies.cart.joint]
kind = "prismatic"
axis = [1, 0]
displacement = "x"
limits = ["-inf", "hi"]
stop = { stiffness = "k", damping = "d" }
"""


def test_a_stop_that_yields_pushes_back_and_never_pulls():
    """m x'' = -(k y + d y'), y = x - hi > 0, while that pushes: the speed at which it lets go."""

    def lets_go(t, y):
        return 5000 * y[0] + 20 * y[1]

    lets_go.terminal, lets_go.direction = True, -1
    found = solve_ivp(
        lambda t, y: [y[1], -(5000 * y[0] + 20 * y[1]) / 2], (0, 1), [0, 3], events=lets_go, rtol=1e-12, atol=1e-12
    )
    result = run(SOFT, 0.5, rtol=1e-11, atol=1e-11)
    assert result["x'"][-1] == pytest.approx(found.y[1, -1], rel=1e-7)
    assert not result.impacts and result.certify().ok


def test_an_elastic_stop_returns_the_speed():
    """Without damping: after half a period pi sqrt(m/k) in it, -v."""
    result = run(SOFT.replace(', damping = "d"', "").replace(", d = 20", ""), 0.4, rtol=1e-11, atol=1e-11)
    assert result["x'"][-1] == pytest.approx(-3, rel=1e-7)
    assert result["x"][-1] == pytest.approx(0.5 - 3 * (0.4 - 0.5 / 3 - math.pi * math.sqrt(2 / 5000)), abs=1e-6)
    model = eomgen.loads(SOFT)
    assert replace(model).bodies["cart"].joint.driving == model.bodies["cart"].joint.driving


def test_stops_that_yield_without_limits_or_with_a_restitution_are_refused():
    with pytest.raises(ModelError, match="has no limits"):
        eomgen.loads(SOFT.replace('limits = ["-inf", "hi"]\n', "").replace(", hi = 0.5", ""))
    with pytest.raises(ModelError, match="a restitution is one of rigid stops"):
        eomgen.loads(SOFT + "restitution = 0.5\n")
    with pytest.raises(ModelError, match="is no coordinate"):
        eomgen.loads(SOFT.replace('displacement = "x"', 'displacement = "x + 1"'))


def test_limits_that_leave_nothing_and_stops_of_driven_joints_are_refused():
    with pytest.raises(ModelError, match="leave nothing between 1 and 0"):
        eomgen.loads(CARTS.replace("limits = [0, 1]", "limits = [1, 0]"))
    with pytest.raises(ModelError, match="'d' is driven"):
        eomgen.loads(CARTS.replace("d = { start = 0.5, speed = -1 }", 'd = { motion = "t" }'))


PAWL = """
eomgen = 1
space = "plane"
parameters = { J = 0.05, T = 1, e = 0.5 }
coordinates = { a = { motion = "0.8*sin(6*t)" }, b = { start = 0.5, speed = -3 } }
bodies.lever.joint = { kind = "revolute", angle = "a" }
bodies.wheel = { mass = 1, inertia = "J", joint = { kind = "revolute", angle = "b", friction = { torque = "T" } } }
bodies.pawl.joint = { kind = "revolute", on = "lever", angle = "b - a", limits = [0, "inf"], restitution = "e" }
"""


def test_a_stop_between_what_is_driven_and_what_is_free_is_a_contact():
    """A pawl: J b'' = T up to b = a(t), there b' - a' -> -e (b' - a')."""

    def gap(t):
        return 0.5 - 3 * t + 10 * t * t - 0.8 * math.sin(6 * t)

    t = brentq(gap, 0, 0.15, xtol=1e-15)
    first = run(PAWL, 0.1).impacts[0]
    assert first.t == pytest.approx(t, rel=1e-9)
    assert first.impulses["pawl_low"] == pytest.approx(0.05 * 1.5 * (4.8 * math.cos(6 * t) + 3 - 20 * t), rel=1e-9)


PISTON = """
eomgen = 1
space = "plane"
coordinates = { x = { start = 0.2 } }
states = { p = { start = 30, unit = "bar", rate = "0" } }
[bodies.piston]
mass = 2
[bodies.piston.joint]
kind = "prismatic"
axis = [1, 0]
displacement = "x"
force = "p*1e-6 - 23"
limits = [0, 0.25]
restitution = 0.5
friction = { force = 4 }
"""


def test_the_size_of_a_state_is_no_length():
    """A pressure of 3e6 Pa: x'' = -(20 - 4)/2 from 0.2 m, at 0 x' = -e x', then x'' = -12; also from 0 and 0.25 m."""
    result = run(PISTON, 0.3)
    first = result.impacts[0]
    assert (first.t, first.impulses["piston_low"]) == pytest.approx((math.sqrt(0.05), 3 * math.sqrt(3.2)), rel=1e-9)
    assert result.phases[1].end - first.t == pytest.approx(0.5 * math.sqrt(3.2) / 12, rel=1e-6)
    assert run(PISTON, 0.1, start={"x": 0})["x"][-1] == pytest.approx(0, abs=1e-9)
    assert run(PISTON, 0.1, start={"x": 0.25})["x"][-1] == pytest.approx(0.25 - 8 * 0.005, rel=1e-9)
