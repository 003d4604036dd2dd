"""Textbook systems with known answers: the models of this folder's neighbours, and short ones that once went wrong."""

from __future__ import annotations

from math import acosh, asin, cos, pi, sin, sqrt
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import eomgen

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
G = 9.81
PLANE = 'eomgen = 1\nspace = "plane"\n'
HEAD = PLANE + 'forces.weight = { kind = "gravity", acceleration = [0, "-g"] }\n'


def values(text: str) -> dict[str, float | None]:
    return {name: answer.value for name, answer in eomgen.solve(eomgen.loads(text)).items()}


def falling_ladder(theta: float, rate: float, m: float, L: float, mu: float) -> np.ndarray:
    """(theta'', N of the floor, N of the wall) of a ladder that slides down, by its three equations.

    Centre (L/2)(cos, sin): m x'' = W - mu N,  m y'' = N + mu W - m g,
    I theta'' = (L/2)(mu sin - cos) N + (L/2)(sin + mu cos) W.
    """
    c, s = L / 2 * cos(theta), L / 2 * sin(theta)
    equations = [
        [-m * s, mu, -1],
        [m * c, -1, -mu],
        [m * L * L / 12, c - mu * s, -s - mu * c],
    ]
    right = [m * c * rate**2, m * s * rate**2 - m * G, 0]
    return np.linalg.solve(np.array(equations), np.array(right))


def ladder_lets_go() -> float:
    """The angle at which the wall's force ends [deg]."""

    def wall(t: float, x: np.ndarray) -> float:
        return falling_ladder(x[0], x[1], 8, 3, 0.25)[2]

    wall.terminal = True  # type: ignore[attr-defined]
    run = solve_ivp(
        lambda t, x: [x[1], falling_ladder(x[0], x[1], 8, 3, 0.25)[0]],
        (0, 5),
        [pi / 4, 0.0],
        events=wall,
        rtol=1e-11,
        atol=1e-12,
    )
    return float(np.degrees(run.y_events[0][0][0]))


a1 = G * (3 * 1.9 - 4 * 0.84) / (3 * 1.9 + 4 * 0.84)
wedge = 2 + 0.5 * sin(pi / 6) ** 2

KNOWN: dict[str, dict[str, float]] = {
    "scotch_yoke": {"N": 2 * 0.3 * 25, "T": 0, "C": 0},
    "block_on_wedge": {
        "a_wedge": -0.5 * G * sin(pi / 6) * cos(pi / 6) / wedge,
        "N": G * cos(pi / 6) / wedge,
        "N_floor": 5 * G / wedge,
    },
    "disc_leaves_cylinder": {"N": 2 * G, "cos_theta": 4 / 7, "v": sqrt(5 * G / 7)},
    "ball_on_free_hemisphere": {"theta_d_squared": 0, "cos_theta": sqrt(3) - 1},
    "bowling_ball": {
        "t_rolls": 10 / (1.4 * G),
        "v_rolls": 25 / 7,
        "x_rolls": 300 / (9.8 * G),
        "v_later": 25 / 7,
        "F_later": 0,
    },
    "double_atwood": {"a1": a1, "T_upper": 3 * (G - a1), "T_lower": 1.5 * (G - a1)},
    "box_on_two_feet": {"a": 0, "N_left": 5 * G - 8, "N_right": 5 * G + 8},
}


@pytest.mark.parametrize("name", KNOWN)
def test_the_answers_are_those_of_the_textbooks(name):
    answers = eomgen.solve(eomgen.load(MODELS / f"{name}.toml"))
    assert {k: a.value for k, a in answers.items()} == pytest.approx(KNOWN[name], rel=1e-8, abs=1e-9)


def test_a_box_that_is_pushed_harder_slides_on_both_feet():
    """F > mu m g: m a = F - mu m g, and the friction's moment about the centre shifts the weight."""
    text = (MODELS / "box_on_two_feet.toml").read_text().replace("20.0", "60.0")
    assert values(text) == pytest.approx({"a": 6 - 0.3 * G, "N_left": 38 * G / 10, "N_right": 62 * G / 10})


LADDER = """
[parameters]
m = 8
L = 3
mu = 0.25
g = 9.81
[coordinates]
theta = "pi/4"
[bodies.ladder]
shape = { kind = "rod", mass = "m", length = "L" }
joint = { kind = "placed", point = "center", at = ["L/2*cos(theta)", "L/2*sin(theta)"], angle = "pi - theta" }
[constraints]
floor = { kind = "support", point = "ladder.start", normal = [0, 1], unilateral = true, friction = "mu" }
wall = { kind = "support", point = "ladder.end", normal = [1, 0], unilateral = true, friction = "mu" }
[outputs]
theta_dd = "theta''"
N_floor = "reaction_n(floor)"
N_wall = "reaction_n(wall)"
lets_go = { value = "theta", at = "reaction_n(wall) = 0", unit = "deg" }
"""


def test_a_ladder_slides_down_rough_at_both_ends():
    """Three equations for theta'' and the two forces; the wall lets go where its force is 0."""
    theta_dd, floor, wall = falling_ladder(pi / 4, 0.0, 8, 3, 0.25)
    expected = {"theta_dd": theta_dd, "N_floor": floor, "N_wall": wall, "lets_go": ladder_lets_go()}
    assert values(HEAD + LADDER) == pytest.approx(expected, rel=1e-8)


def test_a_ladder_that_its_friction_can_hold_stays_and_its_forces_are_indeterminate():
    answers = eomgen.solve(eomgen.loads(HEAD + LADDER.replace("0.25", "0.9")))
    assert answers["theta_dd"].value == 0
    assert answers["N_floor"].value is None and "indeterminate" in answers["N_floor"].message


SLOT = """
parameters = { m = 0.3, w = 4 }
coordinates = { phi = { motion = "w*t" }, r = 0.1 }
bodies.rod.joint = { kind = "revolute", angle = "phi" }
bodies.bead.shape = { kind = "particle", mass = "m" }
bodies.bead.joint = { kind = "prismatic", on = "rod", axis = [1, 0], displacement = "r" }
[outputs]
v = { value = "r'", at = "r = 1/2" }
N = { value = "reaction_n(bead)", at = "r = 1/2" }
T = { value = "drive(phi)", at = "r = 1/2" }
t = { value = "t", at = "r = 1/2" }
"""


def test_a_bead_on_a_turning_rod_presses_with_its_coriolis_force():
    """r' = w sqrt(r^2 - r0^2), N = 2 m w r', the couple is N r; r = r0 cosh(w t)."""
    v = 4 * sqrt(0.24)
    expected = {"v": v, "N": 2.4 * v, "T": 1.2 * v, "t": acosh(5) / 4}
    assert values(PLANE + SLOT) == pytest.approx(expected)


def test_a_block_on_a_spring_stops_where_the_energy_is_spent():
    """From x0 at rest: a half swing about mu m g / k, to 2 mu m g / k - x0, in pi sqrt(m / k)."""
    text = """
    parameters = { m = 1, k = 100, mu = 0.25, g = 10 }
    coordinates = { x = 0.2, y = 0 }
    points.O = [0, 0]
    bodies.block.shape = { kind = "particle", mass = "m" }
    bodies.block.joint = { kind = "placed", at = ["x", "y"] }
    constraints.floor = { kind = "support", point = "block.center", normal = [0, 1], friction = "mu" }
    outputs.x = { value = "x", at = "x' = 0" }
    outputs.t = { value = "t", at = "x' = 0" }
    forces.spring = { kind = "spring", points = ["O", "block.center"], stiffness = "k", length = 0, along = [1, 0] }
    """
    assert values(HEAD + text) == pytest.approx({"x": -0.15, "t": pi / 10})


def test_a_force_that_grows_tears_a_block_loose():
    """F sin t = mu m g; until then the friction is -F sin t, after it -mu m g, with friction given as a number too."""
    text = """
    parameters = { m = 2, F = 3 }
    coordinates.x = 0
    bodies.block.shape = { kind = "particle", mass = "m" }
    bodies.block.joint = { kind = "placed", at = ["x", 0] }
    constraints.floor = { kind = "support", point = "block.center", normal = [0, 1], friction = 0.1 }
    forces.weight = { kind = "gravity", acceleration = [0, -10] }
    forces.push = { kind = "force", point = "block.center", force = ["F*sin(t)", 0] }
    outputs.before = { value = "reaction_x(floor)", at = "t = 3/10" }
    outputs.after = { value = "reaction_x(floor)", at = "t = 1" }
    outputs.v = { value = "x'", at = "t = 1" }
    outputs.loose = { value = "t", at = "reaction_x(floor) = -2" }
    """
    t = asin(2 / 3)
    expected = {"before": -3 * sin(0.3), "after": -2, "v": 1.5 * (cos(t) - cos(1)) - (1 - t), "loose": t}
    assert values(PLANE + text) == pytest.approx(expected)


def test_a_body_that_is_driven_along_a_path_comes_to_its_next_piece():
    """On the arc, going straight up: the drive holds the weight, the normal force is m v^2 / R."""
    text = """
    parameters = { m = 2, R = 1, g = 9.81 }
    coordinates.s = { motion = "t" }
    outputs.F = { value = "drive(s)", at = "t = 1 + pi/2" }
    outputs.N = { value = "reaction_n(ball)", at = "t = 1 + pi/2" }
    [bodies.ball]
    shape = { kind = "particle", mass = "m" }
    [bodies.ball.joint]
    kind = "path"
    along = "s"
    at = [0, 0]
    heading = 0
    pieces = [{ name = "floor", line = 1 }, { name = "arc", arc = "R", turn = "ccw", angle = "pi" }]
    """
    assert values(HEAD + text) == pytest.approx({"F": 2 * G, "N": 2})


def test_a_motion_that_time_begins_is_followed_from_rest():
    """m x'' = F sin t: at rest at the start and without acceleration, yet x = F (t - sin t) / m."""
    text = """
    parameters = { m = 2, F = 3 }
    coordinates.x = 0
    bodies.P.shape = { kind = "particle", mass = "m" }
    bodies.P.joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
    forces.push = { kind = "force", point = "P.center", force = ["F*sin(t)", 0] }
    outputs.t = { value = "t", at = "x = 3*pi/2" }
    outputs.v = { value = "x'", at = "x = 3*pi/2" }
    """
    assert values(PLANE + text) == pytest.approx({"t": pi, "v": 3})


def test_speeds_from_rest_have_the_sense_in_which_the_motion_begins():
    """A rod let go at theta0 > 0 falls to smaller angles: theta' = -sqrt(3 g (cos theta - cos theta0) / l)."""
    text = """
    parameters = { m = 2, l = 1, g = 9.81 }
    coordinates.theta = 0.5
    bodies.rod.shape = { kind = "rod", mass = "m", length = "l" }
    bodies.rod.joint = { kind = "revolute", angle = "theta - pi/2" }
    outputs.w = { value = "theta'", from = "rest" }
    """
    answer = eomgen.solve(eomgen.loads(HEAD + text))["w"]
    assert answer.exact is not None and answer.exact.startswith("-sqrt")


def test_an_instant_may_be_the_start_and_must_be_an_instant():
    text = """
    parameters = { m = 2, l = 1, g = 9.81 }
    coordinates.theta = "pi/2"
    bodies.rod.shape = { kind = "rod", mass = "m", length = "l" }
    bodies.rod.joint = { kind = "revolute", angle = "theta - pi/2" }
    outputs.R = { value = "reaction_y(rod)", at = "t = 0" }
    outputs.never = { value = "theta", at = "m = 3" }
    """
    answers = eomgen.solve(eomgen.loads(HEAD + text))
    assert (answers["R"].exact, answers["R"].value) == ("1/4*m*g", pytest.approx(G / 2))
    assert answers["never"].message.startswith("'m = 3' names no instant")
