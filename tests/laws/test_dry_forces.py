"""Brakes, clutches and belts: dry friction of any rate of slipping, of a size that inputs and the motion may give."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import eomgen
from eomgen.errors import ModelError

pytestmark = pytest.mark.slow  # certificates of runs compile the code that they prove

G = 9.81


def run(text: str, time: float, **options):
    return eomgen.simulate(eomgen.loads(text), time=time, target="numpy", rtol=1e-12, atol=1e-12, **options)


def senses(result, name: str) -> list[int | None]:
    return [phase.model.configuration.modes[name].sense for phase in result.phases]


def ranges(text: str) -> list[dict]:
    return eomgen.statics(eomgen.loads(text)).entries()["rest_range"]


CLUTCH = """
eomgen = 1
space = "plane"
parameters = { I1 = 2, I2 = 3, M = 4, w0 = 10 }
coordinates = { a = { speed = "w0" }, b = 0 }
bodies.drive = { inertia = "I1", joint = { kind = "revolute", angle = "a" } }
bodies.load = { inertia = "I2", joint = { kind = "revolute", angle = "b" } }
outputs = { T = "friction(clutch)" }
[forces.clutch]
kind = "clutch"
bodies = ["drive", "load"]
torque = "M"
"""


def test_a_clutch_locks_and_takes_the_energy_of_the_slip():
    """t = w_0 I_1 I_2/((I_1 + I_2) M); E lost = I_1 I_2/(I_1 + I_2) w_0^2/2; then both turn at I_1 w_0/(I_1 + I_2)."""
    result = run(CLUTCH, 5)
    assert senses(result, "clutch") == [-1, 0]
    assert result.phases[0].end == pytest.approx(10 * 6 / (5 * 4))
    assert result["energy"][0] - result["energy"][-1] == pytest.approx(6 / 5 * 100 / 2)
    assert (result["a'"][-1], result["b'"][-1]) == pytest.approx((4, 4))
    assert (result["T"][0], result["T"][-1]) == pytest.approx((4, 0))
    assert result.certify().ok


def test_a_clutch_slips_again_where_it_would_have_to_transmit_more():
    """Locked, it passes I_2 L t/(I_1 + I_2) of a torque L t on the drive, up to static M_s; from then on M alone."""
    text = CLUTCH.replace('speed = "w0"', "speed = 0").replace('torque = "M"', 'torque = "M"\nstatic = 6')
    text = text.replace('angle = "a" }', 'angle = "a", torque = "5*t" }')
    result = run(text, 3)
    assert senses(result, "clutch") == [0, -1]
    assert result.phases[0].end == pytest.approx(6 * 5 / (3 * 5))
    assert result["T"][-1] == pytest.approx(4)
    assert result.certify().ok


def test_two_clutches_in_series_slip_where_the_weaker_one_is():
    """M_1 = 4 before M_2 = 0.5: both slip, the first locks and later the second; M_2 = 2 would hold from the start."""
    text = (
        CLUTCH.replace("b = 0", "b = 0, c = 0")
        + """
[forces.second]
kind = "clutch"
bodies = ["load", "end"]
torque = 0.5
[bodies.end]
inertia = 1
joint = { kind = "revolute", angle = "c" }
"""
    )
    result = run(text, 20)
    assert (senses(result, "clutch")[0], senses(result, "second")[0]) == (-1, -1)
    assert (senses(result, "clutch")[-1], senses(result, "second")[-1]) == (0, 0)
    assert result["c'"][-1] == pytest.approx(20 / 6)  # of I_1 w_0 over all
    assert result.certify().ok


BRAKE = """
eomgen = 1
space = "plane"
parameters = { J = 2, mu = 0.4, r = 0.2, w0 = 6 }
coordinates.q = { speed = "w0" }
inputs.N = "10*t - 5"
outputs.T = "friction(brake)"
bodies.disc = { inertia = "J", joint = { kind = "revolute", angle = "q" } }
[forces.brake]
kind = "brake"
body = "disc"
normal = "N"
coefficient = "mu"
radius = "r"
faces = 2
"""


def test_a_brake_closes_by_an_input_and_never_drives():
    """J w' = - 2 mu r max(0, 10 t - 5): free up to 0.5 s, then w = w_0 - mu r 10 (t - 0.5)^2/J; it stops and stays."""
    result = run(BRAKE, 6)
    stops = 0.5 + math.sqrt(6 * 2 / (0.4 * 0.2 * 10))
    assert result.phases[0].end == pytest.approx(stops, rel=1e-9)
    assert result["q"][-1] == pytest.approx(6 * stops - 0.4 * (stops - 0.5) ** 3 / 3, rel=1e-9)
    assert result["T"][np.searchsorted(result.t, 0.4)] == 0
    assert result.certify().ok
    assert "2*mu*r*sign(q')*max(0, N)" in str(eomgen.derive(eomgen.loads(BRAKE)))


def test_the_same_as_a_size_of_the_joints_own_friction():
    """torque = 2 mu N r of the joint: the same motion."""
    own = BRAKE[: BRAKE.index("[forces")].replace('angle = "q"', 'angle = "q", friction = { torque = "2*mu*N*r" }')
    own, brake = run(own.replace("friction(brake)", "friction(disc)"), 6), run(BRAKE, 6)
    assert own["q"][-1] == pytest.approx(brake["q"][-1], abs=1e-11) and own.certify().ok


def test_friction_by_a_curve_of_the_speed_and_of_the_place():
    """m x'' = - k x - (F + D exp(-|x'|/v)) (1 + x^2) sign x' until it rests: Stribeck's curve, integrated."""
    text = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 50, F = 3, D = 4, v = 0.3 }
coordinates.x = { start = 0.7 }
[bodies.block]
mass = "m"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k", friction = { force = "SIZE" } }
""".replace("SIZE", "(F + D*exp(-abs(x')/v))*(1 + x^2)")
    result = run(text, 5)
    assert senses(result, "block")[-1] == 0

    def rate(t, y):
        return [y[1], (-50 * y[0] + (3 + 4 * math.exp(-abs(y[1]) / 0.3)) * (1 + y[0] ** 2)) / 2]

    def rests(t, y):
        return y[1] if t > 0 else -1.0

    rests.terminal, rests.direction = True, 1
    found = solve_ivp(rate, (0, 2), [0.7, -1e-13], events=rests, rtol=1e-12, atol=1e-13)
    assert result.phases[0].last["x"] == pytest.approx(found.y[0, -1], abs=1e-8)
    assert result.certify().ok


def test_a_brake_on_a_slide_that_a_drive_carries_along():
    """On a belt at v a block on a spring k sticks until k v t = F_s, in the C of its own integrators too."""
    text = """
eomgen = 1
space = "plane"
parameters = { m = 1, k = 100, N = 10, mu = 0.2, mu_s = 0.3, v = 0.1 }
coordinates = { b = { motion = "v*t" }, s = 0 }
forces.pull = { kind = "potential", energy = "k*(b + s)^2/2" }
bodies.belt.joint = { kind = "prismatic", axis = [1, 0], displacement = "b" }
[bodies.block]
mass = "m"
joint = { kind = "prismatic", on = "belt", axis = [1, 0], displacement = "s" }
[forces.pad]
kind = "brake"
body = "block"
normal = "N"
coefficient = "mu"
static = "mu_s"
"""
    result = run(text, 1)
    assert result.phases[0].end == pytest.approx(0.03 / 0.1, rel=1e-9)
    assert senses(result, "pad")[:3] == [0, -1, 0]
    assert result.certify().ok


WINCH = """
eomgen = 1
space = "plane"
parameters = { m = 20, g = 9.81, R = 0.1, M_b = 25, J = 0.05 }
coordinates = { phi = 0, y = { dependent = true, near = -1 } }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
bodies.drum = { inertia = "J", joint = { kind = "revolute", angle = "phi" } }
bodies.load = { mass = "m", joint = { kind = "prismatic", at = ["R", 0], axis = [0, 1], displacement = "y" } }
constraints.rope = { kind = "string", path = [{ body = "drum", radius = "R", turn = "cw" }, "load.origin"] }
forces.brake = { kind = "brake", body = "drum", torque = "M_b" }
"""


def test_statics_says_when_a_brake_holds():
    """m g R <= M_b; beyond it the brake is named."""
    (found,) = ranges(WINCH)
    assert (found["condition"], found["extent"]) == ("m*g*R <= M_b", "anywhere")
    slips = eomgen.statics(eomgen.loads(WINCH.replace("M_b = 25", "M_b = 15")))
    assert slips.broken == ("the brake 'brake' slides: it would need more friction than it can have",)


BELT = """
eomgen = 1
space = "plane"
parameters = { I1 = 0.1, I2 = 0.5, r1 = 0.1, r2 = 0.2, T0 = 100, mu = 0.3, phi = 2.8, M = 12, a = 1 }
coordinates = { alpha = 0, beta = 0 }
points.P = ["a", 0]
outputs = { F = "friction(belt)", X = "reaction_x(motor)" }
bodies.motor = { inertia = "I1", joint = { kind = "revolute", angle = "alpha", torque = "M" } }
bodies.fan = { inertia = "I2", joint = { kind = "revolute", at = "P", angle = "beta", torque = "-8*t" } }
[forces.belt]
kind = "belt"
bodies = ["motor", "fan"]
radii = ["r1", "r2"]
tension = "T0"
coefficient = "mu"
wrap = "phi"
"""


def test_a_belt_slips_where_its_tensions_differ_by_more_than_its_arc_holds():
    """T_1 + T_2 = 2 T_0 and T_1 = T_2 e^(mu phi); before, one acceleration; the bearings carry both strands."""
    largest = 200 * (math.exp(0.84) - 1) / (math.exp(0.84) + 1)
    result = run(BELT, 4)
    assert senses(result, "belt") == [0, -1]
    # r1 w1 = r2 w2: (I1 + I2 r1^2/r2^2) a1 = M - (r1/r2) 8 t, F = (M - I1 a1)/r1
    slips = (12 - 0.1 * (12 - 0.1 * largest) / 0.1) / 1  # of M - r1 F = I1 a1
    a1 = (12 - 0.1 * largest) / 0.1
    slips = (12 - (0.1 + 0.5 / 4) * a1) / 4
    assert result.phases[0].end == pytest.approx(slips, rel=1e-9)
    assert result["F"][-1] == pytest.approx(largest)
    angle = math.asin(0.1)  # of the strands to the line of centres
    assert result["X"][0] == pytest.approx(-200 * math.cos(angle))
    assert result.certify().ok


def test_a_crossed_belt_turns_the_other_way():
    """r_1 w_1 = - r_2 w_2 while it sticks."""
    result = run(BELT.replace('wrap = "phi"', 'wrap = "phi"\ncrossed = true').replace("-8*t", "0"), 0.5)
    assert senses(result, "belt") == [0]
    assert result["beta'"][-1] == pytest.approx(-result["alpha'"][-1] / 2)
    assert result.certify().ok


def test_a_clutch_in_space_acts_along_the_axis_of_its_second_body():
    """The middle of a shaft (1, 2, 2)/3 that both turn about: as in the plane."""
    text = CLUTCH.replace('"plane"', '"space"').replace("joint = {", "joint = { axis = [1, 2, 2], kind =", 2)
    text = text.replace('kind = kind = "revolute"', 'kind = "revolute"')
    text = text.replace('"I1"', '["I1", "I1", "I1"]').replace('"I2"', '["I2", "I2", "I2"]')
    result = run(text, 5)
    assert result.phases[0].end == pytest.approx(3) and result["b'"][-1] == pytest.approx(4)
    assert result.certify().ok


def test_what_has_no_size_or_two_is_refused():
    for old, new, said in (
        ('torque = "M"', "", "the size of the clutch 'clutch' is not known: it needs 'normal'"),
        ('torque = "M"', "torque = 1\nnormal = 3", "the clutch 'clutch' has 'torque' and 'normal'"),
        ('torque = "M"', "normal = 3\ncoefficient = 0.2", "the clutch 'clutch' needs 'radius'"),
        ('torque = "M"', "torque = 1\nstatic = 2\nsmooth = 3", "smooth friction has no 'static'"),
        ('["drive", "load"]', '["drive", "drive"]', "'clutch' rubs body 'drive' on itself"),
        ("forces.clutch", "forces.drive", "'drive' is the name of a body or a constraint too"),
    ):
        with pytest.raises(ModelError, match=said):
            eomgen.loads(CLUTCH.replace(old, new).replace("friction(clutch)", "a"))
    brake = BRAKE[: BRAKE.index("normal")].replace("outputs.T", "#")
    with pytest.raises(ModelError, match="'brake' brakes a turn, and its size is a force"):
        eomgen.loads(brake + "force = 3")
    with pytest.raises(ModelError, match="the unit 'N' does not fit: this is in"):
        eomgen.loads(brake + 'torque = { value = 3, unit = "N" }')


def test_a_smooth_clutch_has_small_motions():
    """Against w = w_2 - w_1 it is a damper M/w_0: I_1 I_2 s/(I_1 + I_2) = - M/w_0."""
    text = CLUTCH.replace('torque = "M"', 'torque = "M"\nsmooth = 0.5').replace('speed = "w0"', "speed = 0")
    found = eomgen.linearize(eomgen.loads(text))
    values = sorted(found.modes.spectrum.eigenvalues, key=lambda x: x.real)
    assert values[0] == pytest.approx(-4 / 0.5 * 5 / 6) and values[1:] == pytest.approx([0, 0, 0], abs=1e-9)


ROPE = """
eomgen = 1
space = "plane"
parameters = { m1 = 9, m2 = 2, g = 9.81, mu = 0.3, R = 0.1 }
coordinates = { y1 = { start = -1 }, y2 = { dependent = true, near = -1 } }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
outputs = { T1 = "tension(rope, 1)", T2 = "tension(rope, 2)", T = "tension(rope)" }
bodies.one = { mass = "m1", joint = { kind = "prismatic", at = ["-R", 0], axis = [0, 1], displacement = "y1" } }
bodies.two = { mass = "m2", joint = { kind = "prismatic", at = ["R", 0], axis = [0, 1], displacement = "y2" } }
[constraints.rope]
kind = "capstan"
path = ["one.origin", { at = [0, 0], radius = "R", turn = "cw" }, "two.origin"]
coefficient = "mu"
angle = "pi"
"""


def test_a_rope_slips_on_a_fixed_drum_by_eulers_ratio():
    """a = g (m_1 - k m_2)/(m_1 + k m_2), k = e^(mu pi); T_1 = k T_2 = m_1 (g - a)."""
    k = math.exp(0.3 * math.pi)
    a = G * (9 - 2 * k) / (9 + 2 * k)
    result = run(ROPE, 0.5)
    assert senses(result, "rope") == [1]
    assert result["y1"][-1] == pytest.approx(-1 - a / 8, rel=1e-12)
    assert (result["T1"][-1], result["T2"][-1]) == pytest.approx((9 * (G - a), 9 * (G - a) / k))
    assert result["T"][-1] == pytest.approx((result["T1"][-1] + result["T2"][-1]) / 2)
    assert result.certify().ok
    text = eomgen.derive(eomgen.loads(ROPE)).render()
    assert "T_rope + 1/2*F_rope = (T_rope - 1/2*F_rope)*exp(pi*mu*sign(y1'))" in text


def test_statics_has_eulers_condition_and_both_of_its_limits():
    """m_1/m_2 <= e^(mu pi), or m_2/m_1 where that is the heavier: rest between both."""
    k = math.exp(0.3 * math.pi)
    for m1, said in ((3, "m1/m2 <= exp(pi*mu)"), (1, "m2/m1 <= exp(pi*mu)")):
        assert [found["condition"] for found in ranges(ROPE.replace("m1 = 9", f"m1 = {m1}"))] == [said]
    for m1, holds in ((2 * k * 0.999, True), (2 * k * 1.001, False), (2 / k * 1.001, True), (2 / k * 0.999, False)):
        text = ROPE.replace("m1 = 9", f"m1 = {m1}")
        assert (not eomgen.statics(eomgen.loads(text)).broken) == holds


BAND = """
eomgen = 1
space = "plane"
parameters = { J = 2, R = 0.2, mu = 0.3, phi = { value = 240, unit = "deg" }, P = 100, w0 = W0 }
coordinates = { q = { speed = "w0" }, y = { dependent = true, near = -0.5 } }
points.A = [-0.2, -0.5]
bodies.drum = { inertia = "J", joint = { kind = "revolute", angle = "q" } }
[bodies.lever]
mass = 1
joint = { kind = "prismatic", at = ["R", 0], axis = [0, 1], displacement = "y", force = "-P" }
[constraints.band]
kind = "capstan"
path = ["A", { body = "drum", radius = "R", turn = "cw" }, "lever.origin"]
coefficient = "mu"
angle = "phi"
"""


def test_a_band_brake_is_stronger_one_way():
    """M = P R (e^(mu phi) - 1) where the drum draws the held end, P R (1 - e^(-mu phi)) the other way."""
    e = math.exp(0.3 * 4 * math.pi / 3)
    for w0, M in ((30, 20 * (1 - 1 / e)), (-30, 20 * (e - 1))):
        result = run(BAND.replace("W0", str(w0)), 5)
        assert senses(result, "band")[-1] == 0
        assert result.phases[0].end == pytest.approx(60 / M, rel=1e-9), w0
        assert result.certify().ok


def test_a_rope_sticks_to_a_turning_drum_and_then_slips_on_it():
    """A drum is driven up to speed: the rope drags m_1 up, k = e^(mu pi): m_1 (g + a) <= k m_2 (g - a)."""
    text = ROPE.replace("m1 = 9", "m1 = 2.5, J = 0.01, M = 3").replace("{ at = [0, 0]", '{ body = "drum"')
    text = text.replace("coordinates = {", "coordinates = { q = 0,").replace(
        "[constraints",
        '[bodies.drum]\ninertia = "J"\njoint = { kind = "revolute", angle = "q", torque = "-M*t" }\n[constraints',
    )
    result = run(text, 3)
    k, R = math.exp(0.3 * math.pi), 0.1
    a = G * (2 * k - 2.5) / (2.5 + 2 * k)  # the largest with which m_1 is lifted
    moment = (0.01 / R + (2.5 + 2) * R) * a + (2.5 - 2) * G * R
    assert senses(result, "rope") == [0, 1]
    assert result.phases[0].end == pytest.approx(moment / 3, rel=1e-9)
    assert result.certify().ok


def test_a_capstan_in_space_is_that_of_the_plane_and_a_way_without_a_drum_is_refused():
    text = ROPE.replace('"plane"', '"space"').replace("[0, 1]", "[0, 1, 0]").replace('"-g"]', '"-g", 0]')
    text = text.replace('R", 0]', 'R", 0, 0]').replace('R", 0]', 'R", 0, 0]').replace("[0, 0]", "[0, 0, 0]")
    assert run(text, 0.5)["y1"][-1] == pytest.approx(run(ROPE, 0.5)["y1"][-1], rel=1e-12)
    with pytest.raises(ModelError, match="goes from a point about one drum to a point"):
        eomgen.loads(ROPE.replace('{ at = [0, 0], radius = "R", turn = "cw" }, ', ""))


LOOP = """
eomgen = 1
space = "plane"
parameters = { m = 1, N = 900 }
[coordinates]
alpha = { start = 1, speed = 4 }
beta = { dependent = true, near = 0.5 }
gamma = { dependent = true, near = 1.5 }
[bodies.crank]
shape = { kind = "rod", mass = "m", length = 0.4 }
joint = { kind = "revolute", angle = "alpha" }
[bodies.coupler]
shape = { kind = "rod", mass = "m", length = 1 }
joint = { kind = "revolute", on = "crank.end", angle = "beta - alpha" }
[bodies.rocker]
shape = { kind = "rod", mass = "m", length = 0.8 }
joint = { kind = "revolute", at = [1.1, 0], angle = "gamma" }
[constraints.B]
kind = "pin"
points = ["coupler.end", "rocker.end"]
[forces.shoe]
kind = "brake"
body = "rocker"
normal = "N"
coefficient = 0.3
radius = 0.1
[forces.gas]
kind = "pneumatic_cylinder"
points = ["crank.center", "rocker.center"]
areas = [0.002]
volumes = [0.0005]
retracted = 0.2
pressures = [300000]
outside = 100000
exponent = 1.3
"""


def test_a_brake_stops_a_whole_loop_and_a_gas_spring_in_it_presses_at_the_start():
    """It takes 27 N m times the way of the rocker, and then nothing."""
    assert eomgen.derive(eomgen.loads(LOOP)).certify().ok
    result = run(LOOP, 2)
    assert senses(result, "shoe") == [1, 0] and abs(result["alpha'"][-1]) < 1e-9
    way = result["gamma"][-1] - result["gamma"][0]
    assert result["energy"][0] - result["energy"][-1] == pytest.approx(0.3 * 900 * 0.1 * way, rel=1e-8)
