"""Runs with constraints: they stay closed, energy stays, by every method and for long; published motions are met."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from float_loops import bricard
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipk
from slow_run import in_slow_run, sampled, usual

import eomgen
from eomgen.codegen.rhs import RightHandSide
from eomgen.runs.single_run import run
from eomgen.simulation.constraint_drift import projection_of
from eomgen.simulation.integrator import Stepping

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
G = 9.81

# -- models ---------------------------------------------------------------------------------------

FOUR_BAR = """
eomgen = 1
name = "Four-bar linkage, closed by multipliers"
space = "plane"
coordinates = { a = { start = 1, speed = 4 }, b = 0.48, c = 1.57 }
bodies.crank = { shape = { kind = "rod", mass = 1, length = 0.4 }, joint = { kind = "revolute", angle = "a" } }
[bodies.coupler]
shape = { kind = "rod", mass = 2, length = 1 }
joint = { kind = "revolute", on = "crank.end", angle = "b - a" }
[bodies.rocker]
shape = { kind = "rod", mass = 1, length = 0.8 }
joint = { kind = "revolute", at = [1.1, 0], angle = "c" }
[constraints]
B = { kind = "pin", points = ["coupler.end", "rocker.end"] }
[forces]
weight = { kind = "gravity", acceleration = [0, -9.81] }
"""

IN_SPACE = (  # two of the three rows more of the hinge at B, and its third, are redundant
    FOUR_BAR.replace('"plane"', '"space"')
    .replace("at = [1.1, 0]", "at = [1.1, 0, 0]")
    .replace('"rocker.end"] }', '"rocker.end"], axis = [0, 0, 1] }')
    .replace("[0, -9.81]", "[0, -9.81, 0]")
)

PENDULUM = """
eomgen = 1
name = "Simple pendulum (IFToMM multibody benchmark A01)"
space = "plane"
coordinates = { x = -1, y = 0 }
points = { O = [0, 0] }
bodies.bob = { shape = { kind = "particle", mass = 1 }, joint = { kind = "placed", at = ["x", "y"] } }
constraints.rod = { kind = "link", points = ["bob.origin", "O"], length = 1 }
forces.weight = { kind = "gravity", acceleration = [0, -9.81] }
"""

SLEIGH = """
eomgen = 1
name = "Chaplygin sleigh"
space = "plane"
coordinates = { x = { speed = 1 }, y = {}, angle = { speed = 2 } }
[bodies.sleigh]
mass = 2
inertia = 0.3
center = [0.4, 0]
joint = { kind = "planar", x = "x", y = "y", angle = "angle" }
[constraints]
edge = { kind = "skate", point = "sleigh.origin", along = [1, 0] }
"""

TOP = """
eomgen = 1
name = "Torque-free body"
space = "space"
coordinates = { x = 0, y = 0, z = 0, e0 = 1, e1 = 0, e2 = 0, e3 = 0 }
speeds = { w1 = { start = 0.1 }, w2 = { start = 3 }, w3 = { start = 0.2 } }
[bodies.B]
mass = 2
inertia = [1, 2, 3]
[bodies.B.joint]
kind = "free"
position = ["x", "y", "z"]
orientation = "quaternion"
quaternion = ["e0", "e1", "e2", "e3"]
omega = ["w1", "w2", "w3"]
"""


def motion(text: str, time: float, **options) -> eomgen.Trajectory:
    return run(eomgen.derive(eomgen.loads(text)), time=time, how=Stepping(**options))


# -- what stays -----------------------------------------------------------------------------------


def test_a_four_bar_runs_for_a_thousand_seconds():
    """rtol = 1e-9: max |phi| < 10 atol, relative energy drift < 1e-6."""
    found = run(eomgen.derive(eomgen.loads(FOUR_BAR)), time=1000, samples=201)
    assert found.ok and found.gap < 1e-8 and found.gap_rate < 1e-8
    assert found.drift < 1e-6
    assert found["a"][-1] > 2 * math.pi * 500


@pytest.mark.parametrize("text", [IN_SPACE, (MODELS / "four_bar.toml").read_text()], ids=["space", "dependent"])
def test_the_same_holds_in_space_and_of_dependent_coordinates(text):
    """A tenth of the time, a tenth of the drift; the hinge in space has three redundant rows."""
    found = motion(text, 100)
    assert found.ok and found.gap < 1e-8 and found.drift < 1e-7


def test_without_projection_the_loop_opens():
    """What is measured is there: phi drifts with the integrator's errors, and by projection it does not."""
    free, kept = (motion(FOUR_BAR, 20, rtol=1e-6, atol=1e-6, stabilization=way) for way in ("none", "projection"))
    assert free.gap > 3e-6 and kept.gap < 1e-6 and kept.gap_rate < 1e-6


def test_a_quaternion_keeps_its_norm_and_a_free_body_its_angular_momentum():
    """|e| = 1; R I w constant in space, R from the quaternion by its textbook matrix; T constant."""
    found = motion(TOP, 1000)
    e, w = (np.array([found[name] for name in names]) for names in (("e0", "e1", "e2", "e3"), ("w1", "w2", "w3")))
    assert np.max(np.abs(np.sum(e * e, axis=0) - 1)) < 1e-12 and found.drift < 1e-6
    inertia = np.array([[1.0], [2.0], [3.0]]) * w
    r, v = e[0], e[1:]
    momentum = inertia + 2 * np.cross(v.T, np.cross(v.T, inertia.T) + r[:, None] * inertia.T).T
    assert momentum == pytest.approx(np.repeat(momentum[:, :1], len(found), axis=1), abs=1e-6)


def test_a_knife_edge_keeps_its_direction():
    """x' sin(angle) = y' cos(angle) all along, and T is constant: in the end it goes straight ahead with all of it."""
    found = motion(SLEIGH, 200)
    across = found["x'"] * np.sin(found["angle"]) - found["y'"] * np.cos(found["angle"])
    assert np.max(np.abs(across)) < 1e-9 and found.gap_rate < 1e-9 and found.drift < 1e-8
    m, b, inertia = 2, 0.4, 0.3
    still = math.sqrt((m * 1 + (inertia + m * b**2) * 4) / m)  # all energy in the forward speed
    along = found["x'"] * np.cos(found["angle"]) + found["y'"] * np.sin(found["angle"])
    assert along[-1] == pytest.approx(still, rel=1e-7)
    assert found["angle'"][-1] == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize("method", usual(["RK45", "Radau", "BDF", "LSODA"], 2, 1))
def test_every_method_keeps_the_loop_closed(method):
    """Against DOP853 at a much finer tolerance; samples between the steps lie on the constraints as well."""
    fine = motion(FOUR_BAR, 1, rtol=1e-12, atol=1e-12)
    found = motion(FOUR_BAR, 1, method=method, rtol=1e-7, atol=1e-7)
    assert found.gap <= 1e-7 and found.gap_rate <= 1e-7
    assert found.x[-1] == pytest.approx(fine.x[-1], abs=2e-4)


def test_projection_at_every_so_many_steps():
    """At each step: what is left is what opens in one; at each 400th it adds up in between."""
    often, seldom = (motion(FOUR_BAR, 20, rtol=1e-6, atol=1e-6, every=n) for n in (1, 400))
    assert often.gap < 1e-6 and 10 * often.gap < seldom.gap < 1e-4


# -- projection -----------------------------------------------------------------------------------


@pytest.mark.parametrize("text", [FOUR_BAR, IN_SPACE], ids=["plane", "space"])
def test_a_state_is_put_back_by_the_least_change(text):
    """phi = 0 and J u + sigma = 0 after it, and M du is normal to all du with J du = 0."""
    equations = eomgen.derive(eomgen.loads(text))
    projection = projection_of(equations.system, RightHandSide.parameter_values(equations.model))
    x = equations.start()
    x[:3] += np.array([3e-4, -2e-4, 1e-4])
    x[3:] += np.array([0.1, 0.2, -0.1])
    found, left = projection.closed(0.0, x, 1e-12)
    assert left < 1e-12 and np.max(np.abs(found - x)) < 0.5
    values = dict(zip(equations.coordinates, found[:3], strict=True))
    M, J = (
        np.array(A.subs({s: values[s.name] for s in A.free_symbols}), dtype=float) for A in (equations.M, equations.J)
    )
    free = np.linalg.svd(J)[2][2]  # the one direction that the loop leaves
    assert J @ free == pytest.approx(0, abs=1e-9) and free @ M @ (found - x)[3:] == pytest.approx(0, abs=1e-10)


def test_driven_coordinates_stay():
    """A driven crank: only coupler and rocker are moved."""
    text = FOUR_BAR.replace("a = { start = 1, speed = 4 }", 'a = { motion = "1 + 4*t" }')
    equations = eomgen.derive(eomgen.loads(text))
    projection = projection_of(equations.system, RightHandSide.parameter_values(equations.model))
    x = equations.start()
    found, left = projection.closed(0.0, x + 1e-4, 1e-12)
    assert left < 1e-11 and found[0] == x[0] + 1e-4 and abs(found[1] - x[1] - 1e-4) > 1e-6


# -- published motions ----------------------------------------------------------------------------


def test_the_simple_pendulum_of_the_benchmark_library():
    """A01: sin(theta/2) = k cd(omega t, k), k = sin(pi/4), from x = -1 at rest; T + V to 5e-5 J for 10 s."""
    found = motion(PENDULUM, 10)
    k = math.sin(math.pi / 4)
    sn = ellipj(math.sqrt(G) * found.t + ellipk(k**2), k**2)[0]
    theta = -2 * np.arcsin(k * sn)
    assert found["x"] == pytest.approx(np.sin(theta), abs=1e-6)
    assert found["y"] == pytest.approx(-np.cos(theta), abs=1e-6)
    assert np.ptp(found.energy) < 5e-8 and found.gap < 1e-9


@in_slow_run
def test_bricards_mechanism_of_the_benchmark_library():
    """A04 for its 10 s: energy and loop kept; three seconds of it as free bodies on hinges move, by least squares."""
    with pytest.warns(RuntimeWarning, match="indeterminate"):
        found = eomgen.simulate(eomgen.load(MODELS / "bricard.toml"), time=10, samples=101)
    assert found.ok and found.gap < 1e-9 and found.drift < 1e-8
    chain, times = bricard(), found.t[:31]

    def rate(t, x):
        return np.concatenate([x[5:], chain.accelerations(x[:5], x[5:])])

    oracle = solve_ivp(rate, (0, 3), np.zeros(10), "DOP853", times, rtol=1e-8, atol=1e-8).y.T
    assert found.x[:31] == pytest.approx(oracle, abs=1e-5)


@in_slow_run
@pytest.mark.parametrize("method", ["BDF", "DOP853"])
def test_the_stiff_flyball_governor_of_the_benchmark_library(method):
    """A05 for its 10 s: slider and rods by Lagrange's equations with H = I(alpha) phi' known, the shaft by H."""
    model = eomgen.load(MODELS / "flyball_governor.toml")
    found = eomgen.simulate(model, time=10, samples=101, method=method, rtol=1e-8)
    rod, slider, ball, k, c = 3000 * 0.01**2, 3000 * 0.1**3, 5, 8e5, 4e4
    across = rod * (1 + 0.01**2) / 12 + rod / 4

    def spin(alpha):  # I(alpha), thin about the rods' own axes
        out, along = np.cos(alpha), rod * 0.01**2 / 6
        hung = rod * (0.05**2 + 0.05 * out) + across * out**2 + along * np.sin(alpha) ** 2 + ball * (0.05 + out) ** 2
        return along + slider * 0.1**2 / 6 + 2 * hung

    H = 2 * np.pi * spin(np.pi / 6)

    def rate(t, x):
        s, alpha, ds, dalpha = x
        out, down = np.cos(alpha), np.sin(alpha)
        wire, opening = np.array([out / 2, 1 - down / 2 - s]), np.array([-down * dalpha / 2, -out * dalpha / 2 - ds])
        length = np.hypot(*wire)
        pull = (k * (length - 0.5) + c * (wire @ opening) / length) * wire / length
        flung = np.imag(spin(alpha + 1e-30j)) / 1e-30 * (H / spin(alpha)) ** 2 / 2
        turning = pull[0] * down + pull[1] * out + 2 * G * out * (rod / 2 + ball) + flung
        return [ds, dalpha, 2 * pull[1] / slider - G, turning / (2 * (across + ball))]

    s, alpha, _, _ = solve_ivp(rate, (0, 10), [0.5, np.pi / 6, 0, 0], "LSODA", found.t, rtol=1e-10, atol=1e-10).y
    assert found.ok and found["s"] == pytest.approx(s, abs=2e-6)
    assert found["alpha"] == pytest.approx(alpha, abs=2e-6) and found["beta"] == pytest.approx(alpha, abs=2e-6)
    assert found["phi'"] == pytest.approx(H / spin(alpha), abs=2e-5)


@sampled(2)
@pytest.mark.parametrize("tolerance", usual([1e-8, 1e-9, 1e-10, 1e-12], 2))
def test_change_points_of_the_benchmark_library_are_crossed_at_any_tolerance(tolerance):
    """A02 for its 10 s, through every position in line: T + V of the one pendulum that it is, and the loops closed."""
    how = {"rtol": tolerance, "atol": tolerance, "target": "numpy"}
    found = eomgen.simulate(eomgen.load(MODELS / "n_four_bar.toml"), time=10, samples=101, **how)
    assert found.ok and len(found.carried) > 8 and found.gap < 1e-8 and found.drift < 20 * tolerance + 1e-11
    moving = 3 / 2 * found["a1'"] ** 2 + 7 / 2 * G * np.sin(found["a1"])
    assert moving == pytest.approx(3 / 2 + 7 / 2 * G, rel=1e-8)


# -- dead centres of dependent coordinates --------------------------------------------------------

THREE_RODS = """
eomgen = 1
space = "plane"
parameters.g = 9.81
coordinates.al = 1.3
coordinates.be = { dependent = true, near = -0.0924828399 }
coordinates.ga = { dependent = true, near = 1.7223985602 }
points.D = [1.2, 0]
bodies.one = { shape = { kind = "rod", mass = 1.2, length = 1 }, joint = { kind = "revolute", angle = "al" } }
constraints.P = { kind = "pin", points = ["two.end", "three.end"] }
forces.w = { kind = "gravity", acceleration = [0, "-g"] }
[bodies.two]
shape = { kind = "rod", mass = 0.9, length = 0.8 }
joint = { kind = "revolute", on = "one.end", angle = "be - al" }
[bodies.three]
shape = { kind = "rod", mass = 1.4, length = 0.9 }
joint = { kind = "revolute", at = "D", angle = "ga" }
"""
THERE = {"al": 1.3915198690941, "be": -0.1427471208401, "ga": 1.8290108299821}  # mpmath, two step widths agree to 1e-13


@sampled(3)
@pytest.mark.parametrize("tolerance", [1e-9, 1e-11, 1e-13])
def test_four_dead_centres_of_dependent_coordinates_cost_no_accuracy(tolerance):
    """At the dead centre of rod two det J_d = 0; the error at 3 s follows the tolerance all the same."""
    found = eomgen.simulate(eomgen.loads(THREE_RODS), time=3, rtol=tolerance, atol=tolerance, target="numpy")
    assert found.ok and found.speeds == ("al'",)
    assert max(abs(found[name][-1] - there) for name, there in THERE.items()) < 20 * tolerance + 1e-12
