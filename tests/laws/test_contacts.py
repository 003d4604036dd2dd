"""Contacts that end, slide and stick: each law of the textbook, through the phases of a simulation."""

from __future__ import annotations

import math

import numpy as np
import pytest
from each import each
from scipy.integrate import solve_ivp

import eomgen
from eomgen.codegen.rhs import RightHandSide
from eomgen.errors import DerivationError
from eomgen.mechanics.constraints.rank import Rank
from eomgen.simulation.integrator import Stepping
from eomgen.simulation.motion import Plan
from eomgen.simulation.phase_change import PhaseStart
from eomgen.simulation.phase_models import PhaseModels
from eomgen.simulation.phase_run import PhaseRun, phase_text
from eomgen.simulation.result import Trajectory

pytestmark = pytest.mark.slow

G = 9.81
HEAD = """
eomgen = 1
space = "plane"
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
"""


def run(text: str, time: float, *, target: str = "numpy", **options) -> Trajectory:
    return eomgen.simulate(eomgen.loads(HEAD + text), time=time, target=target, **options)


def ends(result: Trajectory) -> list[str]:
    """What ended the phases, without the times."""
    return [phase.ended_by.split(" at t = ")[0] for phase in result.phases]


def last(result: Trajectory, phase: int, name: str) -> float:
    """A column at the end of a phase."""
    return result.phases[phase].last[name]


def first(result: Trajectory, phase: int, name: str) -> float:
    return result.phases[phase].first[name]


# -- wires and walls -------------------------------------------------------------------------------

ANGLE = """
coordinates.theta = { start = 0, speed = "v0/l" }
bodies.ball.shape = { kind = "particle", mass = "m" }
bodies.ball.joint = { kind = "placed", at = ["l*sin(theta)", "-l*cos(theta)"] }
"""
PLANE = """
coordinates.x = { speed = "v0" }
coordinates.y = { start = "-l" }
bodies.ball.shape = { kind = "particle", mass = "m" }
bodies.ball.joint = { kind = "placed", at = ["x", "y"] }
"""
WIRE = """
parameters = { m = 0.7, g = 9.81, l = 1.2, v0 = 5.9 }
points.O = [0, 0]
constraints.wire = { kind = "link", points = ["ball.origin", "O"], length = "l", unilateral = true }
"""


def place(result: Trajectory) -> np.ndarray:
    """(x, y) of the ball, n x 2, whatever its coordinates."""
    if "x" in result.coordinates:
        return np.column_stack([result["x"], result["y"]])
    r = 1.2 - result["wire_gap"]
    return np.column_stack([r * np.sin(result["theta"]), -r * np.cos(result["theta"])])


@each("coordinates", [ANGLE, PLANE])
def test_a_ball_on_a_wire_leaves_its_circle_where_the_tension_vanishes(coordinates):
    """T = 0 at cos(theta) = (2 g l - v0^2)/(3 g l); a parabola until it is taut; then the radial speed is lost."""
    m, l, v0 = 0.7, 1.2, 5.9
    result = run(WIRE + coordinates, 2.5)
    assert ends(result)[:2] == ["the link 'wire' goes slack", "the link 'wire' is taut again"]
    assert np.all(np.diff(result.t) > 0)
    xy, rows = place(result), [phase.rows for phase in result.phases]
    off, on = xy[rows[1][0]], xy[rows[2][0]]  # places do not jump
    assert -off[1] / l == pytest.approx((2 * G * l - v0**2) / (3 * G * l), abs=1e-8)
    v = math.sqrt(v0**2 - 2 * G * (l + off[1]))
    t = result.t[slice(*rows[1])] - result.phases[0].end
    flight = [off[0] - v * off[1] / l * t, off[1] + v * off[0] / l * t - G * t**2 / 2]
    assert xy[slice(*rows[1])].T == pytest.approx(np.array(flight), abs=1e-7)
    assert np.hypot(*on) == pytest.approx(l, abs=1e-9)
    lost = last(result, 1, "energy") - first(result, 2, "energy")
    flown = result.phases[1].end - result.phases[0].end
    n, speed = on / l, np.array([-v * off[1] / l, v * off[0] / l - G * flown])
    assert lost == pytest.approx(m * (n @ speed) ** 2 / 2, rel=1e-6)
    assert np.hypot(*xy[slice(*rows[2])].T) == pytest.approx(l, abs=1e-7)


def test_both_descriptions_of_the_wire_give_the_same_motion():
    """One angle and a displacement from the wire, or x and y with a multiplier."""
    one, other = run(WIRE + ANGLE, 2.0), run(WIRE + PLANE, 2.0)
    assert place(one)[-1] == pytest.approx(place(other)[-1], abs=1e-6)
    assert [p.end for p in one.phases] == pytest.approx([p.end for p in other.phases], abs=1e-8)


LADDER = """
parameters = { M = 2, g = 9.81, l = 0.8, theta0 = 0.2, slope = 0 }
coordinates.theta = { start = "theta0" }
constraints.floor = { kind = "support", point = "bar.start", normal = [0, 1], at = [0, 0] }
constraints.wall = { kind = "support", point = "bar.end", normal = [1, 0], at = [0, 0], unilateral = true }
[bodies.bar]
shape = { kind = "rod", mass = "M", length = "2*l" }
joint = { kind = "placed", point = "bar.center", at = ["l*sin(theta)", "l*cos(theta)"], angle = "theta + pi/2" }
"""
FREE_LADDER = LADDER.replace(
    'coordinates.theta = { start = "theta0" }',
    'coordinates = { x = { start = "l*sin(theta0)" }, y = { start = "l*cos(theta0)" }, theta = { start = "theta0" } }',
).replace('at = ["l*sin(theta)", "l*cos(theta)"]', 'at = ["x", "y"]')


@each("text", [LADDER, FREE_LADDER])
def test_a_ladder_leaves_the_wall_at_two_thirds_of_its_height(text):
    """N_wall = 0 at cos(theta) = 2/3 cos(theta_0); from there the mass centre keeps its horizontal speed."""
    result = run(text, 0.9)
    assert ends(result)[0] == "the support 'wall' opens"
    theta, rate = last(result, 0, "theta"), last(result, 0, "theta'")
    assert math.cos(theta) == pytest.approx(2 / 3 * math.cos(0.2), abs=1e-8)
    after = slice(*result.phases[1].rows)
    if text is LADDER:
        x = result["x"] if "x" in result.coordinates else 0.8 * np.sin(result["theta"]) + result["wall_gap"]
    else:
        x = result["x"]
    v = 0.8 * math.cos(theta) * rate
    assert x[after] == pytest.approx(x[after][0] + v * (result.t[after] - result.t[after][0]), abs=1e-7)
    assert result.drift < 1e-7


def test_a_body_that_leaves_an_inclined_wall_stays_on_the_floor():
    """What frees the ladder from its wall is the displacement that the floor leaves: one freedom more, N > 0."""
    wall = LADDER.replace("normal = [1, 0]", 'normal = ["cos(0.3)", "sin(0.3)"]')
    text = wall.replace("l*sin(theta)", "l*(sin(theta) - 2*tan(0.3)*cos(theta))")
    text = text.replace("theta0 = 0.2", "theta0 = 0.5")
    result = run(text, 0.8)
    assert ends(result)[0] == "the support 'wall' opens" and result.ok
    assert result.reactions["reaction_n(floor)"].min() > 0
    assert result["wall_gap"][-1] > 0 and result.drift < 1e-7


def test_a_ball_falls_on_the_floor_and_stays():
    """Open at the start, it lands after sqrt(2 h/g), without rebound, and loses m g h."""
    text = """
    parameters = { m = 2, g = 9.81, h = 1.5 }
    coordinates = { x = { speed = 1 }, y = { start = "h" } }
    bodies.ball = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", "y"] } }
    constraints.floor = { kind = "support", point = "ball.origin", normal = [0, 1], at = [0, 0], unilateral = true }
    """
    result = run(text, 1.0)
    assert result.phases[0].end == pytest.approx(math.sqrt(3 / G), abs=1e-12)
    assert result.phases[0].ended_by == "the support 'floor' closes at t = 0.553001 s, without rebound"
    assert result["energy"][0] - result["energy"][-1] == pytest.approx(2 * G * 1.5)
    assert result["x"][-1] == pytest.approx(1.0) and abs(result["y"][-1]) < 1e-9
    assert result.reactions["reaction_n(floor)"][-1] == pytest.approx(2 * G)


def test_contacts_that_never_touch_at_once_are_left_one_by_one():
    """A ball falls past a higher floor's wall and a slope: t = sqrt(2 h/g), though no place touches all three."""
    text = """
parameters = { m = 2, g = 9.81 }
coordinates = { x = { start = 0.5 }, y = { start = 2 } }
bodies.ball.shape = { kind = "particle", mass = "m" }
bodies.ball.joint = { kind = "placed", at = ["x", "y"] }
constraints.floor = { kind = "support", point = "ball.origin", normal = [0, 1], at = [0, 0], unilateral = true }
constraints.wall = { kind = "support", point = "ball.origin", normal = [1, 0], at = [-1, 0], unilateral = true }
constraints.slope = { kind = "support", point = "ball.origin", normal = [1, 1], at = [0, 0], unilateral = true }
"""
    result = run(text, 2)
    assert ends(result)[0] == "the support 'floor' closes"
    assert result.phases[0].end == pytest.approx(math.sqrt(4 / G), abs=1e-10)
    assert result["y"][-1] == pytest.approx(0, abs=1e-9)


def test_what_two_contacts_hold_alike_becomes_free_once():
    """A disc on two tracks in one line: of the second its push alone becomes free, its no-slip row is the first's."""
    text = """
parameters = { m = 2, g = 9.81, r = 0.5 }
coordinates = { x = { speed = 1 }, phi = {} }
bodies.disc.shape = { kind = "disc", mass = "m", radius = "r" }
bodies.disc.joint = { kind = "placed", at = ["x", "r"], angle = "phi" }
constraints.one = { kind = "rolling", body = "disc", line = { at = [0, 0], normal = [0, 1] } }
constraints.other = { kind = "rolling", body = "disc", line = { at = [0, 0], normal = [0, 1] }, unilateral = true }
"""
    model = eomgen.loads(HEAD + text)
    system = PhaseModels(model, RightHandSide.parameter_values(model), "numpy").without_contacts.system
    assert {row.constraint for row in system.constraints.rows} == {"one"} and Rank(
        system.constraints
    ).degrees_of_freedom() == 2


def test_a_start_below_the_floor_is_refused():
    """What is passed through, and by how much."""
    text = """
    parameters = { m = 2, g = 9.81 }
    coordinates = { y = { start = -0.25 } }
    bodies.ball = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = [0, "y"] } }
    constraints.floor = { kind = "support", point = "ball.origin", normal = [0, 1], at = [0, 0], unilateral = true }
    """
    with pytest.raises(DerivationError, match=r"the support 'floor' is passed through at the start, by 0\.25 m"):
        run(text, 1.0)


def test_one_of_two_cables_goes_slack_and_the_bar_swings_on_the_other():
    """A bar on two parallel cables, pushed up at one end: there the tension vanishes at F = M g/2."""
    text = """
    parameters = { M = 2, l = 1, g = 9.81 }
    coordinates.theta = { start = "pi/2" }
    inputs.F = "60*t"
    points = { O1 = [0, 0], O2 = ["2*l", 0] }
    constraints.left = { kind = "link", points = ["bar.start", "O1"], length = "l", unilateral = true }
    constraints.right = { kind = "link", points = ["bar.end", "O2"], length = "l", unilateral = true }
    forces.push = { kind = "force", point = "bar.start", force = [0, "F"] }
    [bodies.bar]
    shape = { kind = "rod", mass = "M", length = "2*l" }
    joint = { kind = "placed", at = ["l*cos(theta)", "-l*sin(theta)"] }
    """
    result = run(text, 0.5)
    assert ends(result)[0] == "the link 'left' goes slack"
    assert result.phases[0].end == pytest.approx(2 * G / 2 / 60, abs=1e-9)  # M g/2 = F
    assert result.reactions["tension(right)"][-1] > 0 and result.gap < 1e-8


# -- friction --------------------------------------------------------------------------------------

BLOCK = """
parameters = { m = 2, g = 9.81, mu = 0.3, v0 = 4, alpha = 0.5 }
coordinates.x = { speed = "v0" }
bodies.block.shape = { kind = "particle", mass = "m" }
bodies.block.joint = { kind = "placed", at = ["x*cos(alpha)", "x*sin(alpha)"] }
[constraints.plane]
kind = "support"
point = "block.origin"
normal = ["-sin(alpha)", "cos(alpha)"]
at = [0, 0]
friction = "mu"
"""


def test_a_block_on_a_rough_incline_stops_and_slides_back():
    """x = v0^2/(2 g (sin + mu cos)); it is back with v0 sqrt((sin - mu cos)/(sin + mu cos)), having lost 2 x mu N."""
    up, down = math.sin(0.5) + 0.3 * math.cos(0.5), math.sin(0.5) - 0.3 * math.cos(0.5)
    stop, height = 4 / (G * up), 16 / (2 * G * up)
    back = stop + math.sqrt(2 * height / (G * down))
    result = run(BLOCK, back)
    assert ends(result) == ["the support 'plane' slides back", f"Reached t = {back:.6g} s."]
    assert result.phases[0].end == pytest.approx(stop, abs=1e-10)
    assert last(result, 0, "x") == pytest.approx(height, abs=1e-10)
    assert result["x'"][-1] == pytest.approx(-4 * math.sqrt(down / up), abs=1e-9)
    lost = result.energy[0] - result.energy[-1]
    assert lost == pytest.approx(2 * height * 0.3 * 2 * G * math.cos(0.5), rel=1e-9)
    assert result.drift is None


def test_a_block_stays_where_friction_holds_it():
    """tan(alpha) < mu: it stops for good; from rest it does not move at all."""
    result = run(BLOCK.replace("mu = 0.3", "mu = 0.6"), 2.0)
    assert ends(result)[0] == "the support 'plane' sticks" and result["x'"][-1] == pytest.approx(0, abs=1e-12)
    still = run(BLOCK.replace("mu = 0.3", "mu = 0.6").replace("v0 = 4", "v0 = 0"), 2.0)
    assert len(still.phases) == 1 and np.abs(still["x"]).max() == 0


def test_a_block_of_free_coordinates_slides_as_the_placed_one_does():
    """The normal reaction as a multiplier, or from the balance of the bodies: one motion."""
    free = BLOCK.replace(
        'coordinates.x = { speed = "v0" }',
        """
    coordinates = { X = { speed = "v0*cos(alpha)" }, Y = { speed = "v0*sin(alpha)" } }""",
    ).replace('["x*cos(alpha)", "x*sin(alpha)"]', '["X", "Y"]')
    one, other = run(BLOCK, 1.5), run(free, 1.5)
    assert one["x"][-1] == pytest.approx(other["X"][-1] / math.cos(0.5), abs=1e-7)
    assert [p.end for p in one.phases] == pytest.approx([p.end for p in other.phases], abs=1e-9)


SLED = """
parameters = { m = 10, g = 9.81, mu = 0.3, beta = BETA, s = SINE, c = COSINE }
coordinates.x = { speed = 5 }
coordinates.y = { dependent = true }
bodies.sled.mass = "m"
bodies.sled.joint = { kind = "planar", x = "x", y = "y", angle = 0 }
constraints.floor = { kind = "support", point = "sled.center", normal = NORMAL, friction = "mu" }
"""


@each("normal", ['["-sin(beta)", "cos(beta)"]', '["-s", "c"]'])
@each("beta", [-0.1, 0, 1e-9, 0.1])
def test_a_sled_slides_on_a_slope_as_on_level_ground(beta, normal):
    """N = m g cos b and x'' = -g (sin b + mu cos b) cos b: nothing is divided by sin b, which may be 0."""
    sine, cosine = math.sin(beta), math.cos(beta)
    text = SLED.replace("NORMAL", normal).replace("BETA", f"{beta!r}")
    result = run(text.replace("COSINE", f"{cosine!r}").replace("SINE", f"{sine!r}"), 1)
    assert result.reactions["reaction_n(floor)"] == pytest.approx(10 * G * cosine, rel=1e-9)
    assert result["x"][-1] == pytest.approx(5 - G * (sine + 0.3 * cosine) * cosine / 2, rel=1e-9)


def test_a_stick_on_two_fingers_that_come_together_slides_on_one_then_on_the_other():
    """m x'' = mu (N_1 - N_2), N_1 + N_2 = m g, about the centre; it sticks to the nearer one until N_1 = N_2."""
    text = """
    parameters = { m = 1, g = 9.81, mu = 0.3, v = 0.02 }
    coordinates = { x = 0, left = { motion = "-0.4 + v*t" }, right = { motion = "0.3 - v*t" } }
    bodies.stick.shape = { kind = "rectangle", mass = "m", width = 1.2, height = 0.001 }
    bodies.stick.points = { a = [-0.6, 0], b = [0.6, 0] }
    bodies.stick.line = ["a", "b"]
    bodies.stick.joint = { kind = "placed", at = ["x", 0] }
    """
    for name in ("left", "right"):
        text += f"""
    bodies.{name}.joint = {{ kind = "prismatic", axis = [1, 0], displacement = "{name}" }}
    constraints.on_{name} = {{ kind = "slider", point = "{name}.origin", on = "stick", friction = "mu" }}
    """
    result = run(text, 3.0)

    def stops(t: float, y: np.ndarray) -> float:
        return float(y[1] + 0.02)

    stops.terminal = True
    slid = solve_ivp(  # (N_1 - N_2)/m g = -(0.1 + 2 x)/(0.7 - 2 v t)
        lambda t, y: [y[1], -0.3 * G * (0.1 + 2 * y[0]) / (0.7 - 0.04 * t)],
        (0, 1),
        [0, 0],
        events=stops,
        rtol=1e-11,
        atol=1e-13,
    )
    t, x = slid.t[-1], slid.y[0, -1]
    assert ends(result)[:2] == ["the slider 'on_right' sticks", "the slider 'on_right' begins to slide"]
    assert [each.end for each in result.phases[:2]] == pytest.approx([t, t + (x + 0.05) / 0.02], rel=1e-8)
    assert result.reactions["reaction_n(on_left)"][0] == pytest.approx(-G * 0.3 / 0.7)


def test_the_stop_is_found_to_the_order_of_the_tolerance():
    """A mass on a spring and a rough floor: half swings of pi/omega, each turn 2 mu g/omega^2 nearer than the last."""
    text = """
    parameters = { m = 2, g = 9.81, mu = 0.1, k = 50 }
    coordinates.x = { start = 1 }
    points.W = [-5, 0]
    bodies.block = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", 0] } }
    constraints.floor = { kind = "support", point = "block.origin", normal = [0, 1], friction = "mu" }
    forces.spring = { kind = "spring", points = ["W", "block.origin"], stiffness = "k", length = 5 }
    """
    w, shift = math.sqrt(25), 0.1 * G / 25
    errors = []
    for rtol in (1e-5, 1e-7, 1e-9):
        result = run(text, 20.0, rtol=rtol, atol=rtol)
        stops = [phase.end for phase in result.phases[:-1]]
        errors.append(abs(stops[2] - 3 * math.pi / w))
        turns = [last(result, k, "x") for k in range(3)]
        assert turns == pytest.approx([-1 + 2 * shift, 1 - 4 * shift, -1 + 6 * shift], abs=10 * rtol)
    assert errors[2] < 1e-8 and errors[1] < errors[0] / 5
    assert ends(result)[-2] == "the support 'floor' sticks" and len(stops) == math.ceil((1 / shift - 1) / 2)


def test_friction_follows_the_reaction_through_its_change_of_sign():
    """A bead on a rough rail, N = m g (1 - 2 t): v = v0 - mu g times the integral of |1 - 2 t|."""
    text = """
    parameters = { m = 2, g = 9.81, mu = 0.3, v0 = 4 }
    coordinates.x = { speed = "v0" }
    inputs.F = "2*m*g*t"
    bodies.bead = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", 0] } }
    constraints.rail = { kind = "support", point = "bead.origin", normal = [0, 1], friction = "mu" }
    forces.lift = { kind = "force", point = "bead.origin", force = [0, "F"] }
    """
    result = run(text, 1.0)
    assert ends(result)[0] == "the support 'rail' pushes from the other side"
    assert result.phases[0].end == pytest.approx(0.5, abs=1e-10)
    assert result["x'"][-1] == pytest.approx(4 - 0.3 * G * 0.5, abs=1e-9)
    assert result.reactions["reaction_n(rail)"][-1] == pytest.approx(-2 * G)


def test_what_drags_a_block_over_a_rough_floor_overcomes_its_friction():
    """F = m x'' + mu m g sign(x') along the driven coordinate and at its joint alike."""
    text = """
    parameters = { m = 2, g = 9.81, mu = 0.3, a = 1.5 }
    coordinates = { x = { motion = "a*t^2/2 + t" }, y = 0 }
    bodies.carriage.joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
    constraints.floor = { kind = "support", point = "block.center", normal = [0, 1], friction = "mu" }
    outputs = { F = "drive(x)", N = "reaction_n(floor)" }
    [bodies.block]
    mass = "m"
    joint = { kind = "prismatic", on = "carriage", axis = [0, 1], displacement = "y" }
    """
    model = eomgen.loads(HEAD + text)
    found = eomgen.solve(model)
    assert found["F"].value == pytest.approx(2 * 1.5 + 0.3 * 2 * G) and found["N"].value == pytest.approx(2 * G)
    assert run(text, 1.0).reactions["drive(x)"] == pytest.approx(2 * 1.5 + 0.3 * 2 * G)


@each(
    "coordinates",
    [
        'coordinates.x = { speed = "v0" }',
        'coordinates = { x = { speed = "v0" }, y = 0 }',
    ],
)
def test_a_rail_that_pulls_brakes_as_one_that_pushes(coordinates):
    """N = -m g along the normal [0, -1]: x'' = -mu g sign(x') in the equations that `derive` gives, too."""
    text = """
    parameters = { m = 2, g = 9.81, mu = 0.3, v0 = 4 }
    bodies.bead = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", 0] } }
    constraints.rail = { kind = "support", point = "bead.origin", normal = [0, -1], friction = "mu" }
    """.replace('["x", 0]', '["x", "y"]' if "y = 0" in coordinates else '["x", 0]')
    equations = eomgen.derive(eomgen.loads(HEAD + coordinates + text))
    for sense in (1, -1):
        q, u = ([0.0, 0.0], [4.0 * sense, 0.0]) if "y = 0" in coordinates else ([0.0], [4.0 * sense])
        rates = equations.rhs("numpy")(0.0, np.array([*q, *u]), equations.rhs("numpy").p0)
        assert rates[len(q)] == pytest.approx(-0.3 * G * sense)
    assert equations.certify().ok
    result = run(coordinates + text, 1.0)
    assert result["x'"][-1] == pytest.approx(4 - 0.3 * G) and result.reactions["reaction_n(rail)"][0] < 0


def test_viscous_friction_takes_the_speed_exponentially():
    """-c N v: v = v0 exp(-c g t), without phases."""
    text = BLOCK.replace('friction = "mu"', "friction = { viscous = 0.2 }").replace("alpha = 0.5", "alpha = 0")
    result = run(text, 2.0)
    assert len(result.phases) == 1 and result["x'"] == pytest.approx(4 * np.exp(-0.2 * G * result.t), abs=1e-8)


BELT = """
parameters = {{ m = 2, g = 9.81, mu = 0.3, V = 1.5, k = {k} }}
coordinates = {{ x = {{ speed = {v} }}, belt = {{ motion = "V*t" }} }}
points.W = [-5, 0]
bodies.block = {{ shape = {{ kind = "particle", mass = "m" }}, joint = {{ kind = "placed", at = ["x", 0] }} }}
constraints.contact = {{ kind = "slider", point = "block.origin", on = "belt", friction = "mu" }}
forces.spring = {{ kind = "spring", points = ["W", "block.origin"], stiffness = "k", length = 5 }}
[bodies.belt]
mass = 1
inertia = 1
points = {{ A = [-50, 0], B = [50, 0] }}
line = ["A", "B"]
joint = {{ kind = "prismatic", axis = [1, 0], displacement = "belt" }}
"""


def test_a_block_put_on_a_belt_slides_until_it_runs_with_it():
    """v = mu g t up to V, then the two stick together."""
    result = run(BELT.format(k=0, v=0), 1.0)
    assert ends(result)[0] == "the slider 'contact' sticks"
    assert result.phases[0].end == pytest.approx(1.5 / (0.3 * G), abs=1e-10)
    assert result["x'"][-1] == pytest.approx(1.5, abs=1e-9)


def test_a_block_on_a_spring_lets_go_of_the_belt_where_the_spring_overcomes_friction():
    """Stuck to x = mu m g/k; from there it swings about this place, x = mu m g/k + V/omega sin(omega t)."""
    result = run(BELT.format(k=100, v=1.5), 0.6)
    assert ends(result)[0] == "the slider 'contact' begins to slide"
    place, w = 0.3 * 2 * G / 100, math.sqrt(50)
    assert last(result, 0, "x") == pytest.approx(place, abs=1e-10)
    assert result.phases[0].end == pytest.approx(place / 1.5, abs=1e-10)
    t = result.t - result.phases[0].end
    after = slice(*result.phases[1].rows)
    assert result["x"][after] == pytest.approx(place + 1.5 / w * np.sin(w * t[after]), abs=1e-7)


def test_a_sliding_disc_begins_to_roll_at_two_thirds_of_its_speed():
    """v = v0 - mu g t, R omega = 2 mu g t: they agree at t = v0/(3 mu g), v = 2 v0/3, and friction is gone."""
    text = """
    parameters = { M = 2, R = 0.4, g = 9.81, mu = 0.25, v0 = 3 }
    coordinates = { x = { speed = "v0" }, phi = { start = 0 } }
    [bodies.disc]
    shape = { kind = "disc", mass = "M", radius = "R" }
    joint = { kind = "placed", at = ["x", "R"], angle = "-phi" }
    [constraints.ground]
    kind = "rolling"
    body = "disc"
    line = { at = [0, 0], normal = [0, 1] }
    slip = true
    friction = "mu"
    """
    result = run(text, 1.0)
    assert ends(result)[0] == "the rolling 'ground' sticks"
    assert result.phases[0].end == pytest.approx(3 / (3 * 0.25 * G), abs=1e-10)
    assert result["x'"][-1] == pytest.approx(2.0, abs=1e-9)
    assert result["phi'"][-1] == pytest.approx(2.0 / 0.4, abs=1e-9)


def test_a_piston_turns_back_at_its_dead_centre_without_sticking():
    """There the rate vanishes whatever the forces, and no friction could hold it: it slides back at theta = pi."""
    text = """
    parameters = { m = 1, r = 0.4, l = 1, g = 9.81, mu = 0.2, w = 25 }
    coordinates.theta = { start = 0, speed = "w" }
    coordinates.x = { dependent = true, near = 1.4 }
    constraints.rod = { kind = "link", points = ["crank.end", "piston.origin"], length = "l" }
    constraints.bore = { kind = "support", point = "piston.origin", normal = [0, 1], friction = "mu" }
    bodies.crank.shape = { kind = "rod", mass = "m", length = "r" }
    bodies.crank.joint = { kind = "revolute", angle = "theta" }
    bodies.piston = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", 0] } }
    """
    result = run(text, 0.8)
    backs = [k for k, end in enumerate(ends(result)) if end == "the support 'bore' slides back"]
    assert result.ok and not any("sticks" in end for end in ends(result)) and len(backs) >= 1
    assert [last(result, k, "theta") / math.pi % 1 for k in backs] == pytest.approx([0] * len(backs), abs=1e-7)
    work = np.trapezoid(result.reactions["reaction_t(bore)"], result["x"])
    assert result.energy[-1] - result.energy[0] == pytest.approx(work, rel=1e-4) and work < 0


def test_so_much_friction_that_no_state_agrees_ends_the_run():
    """Painleve's rod: at a steep friction cone neither contact nor separation satisfies the equations."""
    text = """
    parameters = { M = 1, l = 1, g = 9.81, mu = 3 }
    coordinates = { x = { speed = 1 }, y = { start = "l*sin(0.9)/2" }, phi = { start = 0.9, speed = 0 } }
    [constraints.floor]
    kind = "support"
    point = "rod.start"
    normal = [0, 1]
    at = [0, 0]
    unilateral = true
    friction = "mu"
    [bodies.rod]
    shape = { kind = "rod", mass = "M", length = "l" }
    joint = { kind = "placed", point = "rod.center", at = ["x", "y"], angle = "pi - phi" }
    """
    result = run(text, 1.0)
    assert result.status == "contact" and "no forces of the contacts 'floor' agree" in result.message


# -- paths -----------------------------------------------------------------------------------------

PATH = """
parameters = { m = 0.5, g = 9.81, L = 2, R = 0.8, slope = 0.5, mu = 0.2, v0 = 1 }
coordinates.s = { speed = "v0" }
[bodies.ball]
shape = { kind = "particle", mass = "m" }
[bodies.ball.joint]
kind = "path"
along = "s"
at = [0, 3]
heading = "-slope"
pieces = [{ name = "plane", line = "L"FRICTION }, { name = "arc", arc = "R", turn = "ccw", angle = "pi" }]
"""


def test_the_reaction_jumps_where_the_curvature_does():
    """Line, then arc: the energy stays, and N grows by m v^2/R at the joint of the two."""
    result = run(PATH.replace("FRICTION", ""), 0.9)
    assert ends(result)[0] == "the body 'ball' comes to the piece 'arc' of its path"
    v = math.sqrt(1 + 2 * G * 2 * math.sin(0.5))
    assert last(result, 0, "s") == pytest.approx(2, abs=1e-10) and last(result, 0, "s'") == pytest.approx(v, abs=1e-9)
    N = last(result, 0, "reaction_n(ball)")
    assert N == pytest.approx(0.5 * G * math.cos(0.5))
    assert first(result, 1, "reaction_n(ball)") - N == pytest.approx(0.5 * v**2 / 0.8, rel=1e-8)
    assert result.drift < 1e-8 and np.ptp(result.energy) < 1e-7


def test_friction_on_one_piece_takes_energy_there_alone():
    """mu m g cos(slope) L on the plane, nothing on the arc."""
    result = run(PATH.replace("FRICTION", ', friction = "mu"'), 0.9)
    lost = first(result, 0, "energy") - last(result, 0, "energy")
    assert lost == pytest.approx(0.2 * 0.5 * G * math.cos(0.5) * 2, rel=1e-9)
    assert np.ptp(result.energy[result.phases[1].rows[0] :]) < 1e-8


def test_a_rough_path_holds_a_body_at_rest():
    """mu > tan(slope): from rest it stays."""
    result = run(PATH.replace("FRICTION", ', friction = "mu"').replace("mu = 0.2, v0 = 1", "mu = 0.7, v0 = 0"), 0.5)
    assert len(result.phases) == 1 and np.abs(result["s"]).max() == 0


# -- a condition on the way ------------------------------------------------------------------------


def runs_until(text: str, name: str, level: int, time: float) -> tuple[PhaseModels, list[PhaseRun]]:
    """The phases until a coordinate or rate is at a level."""
    model = eomgen.loads(HEAD + text)
    models = PhaseModels(model, RightHandSide.parameter_values(model), "numpy")
    fine = Stepping(rtol=1e-12, atol=1e-12)
    plan = Plan(time, fine, until=lambda phase: phase.system.scope.names[name] - level)
    return models, list(plan.through(models, PhaseStart.of(models, 0.0, None, None)))


def test_a_condition_is_met_in_the_phase_in_which_it_holds():
    """Up the incline and back: x = 0 again is met in the second phase, after the stop."""
    models, (up, down) = runs_until(BLOCK, "x", 0, 5.0)
    assert (up.bound.kind, up.bound.owner) == ("stops", "plane") and not up.is_met
    assert phase_text(models, up)[:31] == "the support 'plane' slides back"
    assert down.is_met and down.after is None and up.run.end == down.here.t
    climb, fall = math.sin(0.5) + 0.3 * math.cos(0.5), math.sin(0.5) - 0.3 * math.cos(0.5)
    assert down.end["x'"] == pytest.approx(-4 * math.sqrt(fall / climb), abs=1e-11)


def test_a_condition_that_ends_a_phase_has_a_before_and_an_after():
    """x' = 0 is the stop itself: the phase before decelerates, the one after slides back."""
    models, (only,) = runs_until(BLOCK, "x'", 0, 5.0)
    phase = models.of(only.after.configuration)
    t, x = np.array([only.run.end]), phase.state(only.after.values)[None, :]
    before, after = (s.functions.evaluated(t, x, s.system.symbols.a)[0, 0] for s in (only.phase, phase))
    assert only.is_met and only.run.end == pytest.approx(4 / (G * (math.sin(0.5) + 0.3 * math.cos(0.5))))
    assert before == pytest.approx(-G * (math.sin(0.5) + 0.3 * math.cos(0.5)))
    assert after == pytest.approx(-G * (math.sin(0.5) - 0.3 * math.cos(0.5)))


def test_a_condition_that_is_never_met_ends_with_the_time():
    """x = 100 up the incline."""
    _, runs = runs_until(BLOCK, "x", 100, 1.0)
    assert [run.run.status for run in runs] == ["event", "finished"] and not any(run.is_met for run in runs)


# -- strings ---------------------------------------------------------------------------------------


def test_a_string_that_hangs_loose_is_taut_again_when_its_slack_is_used_up():
    """A weight thrown up on its string comes back after 2 v0/g, and stops."""
    text = """
    parameters = { m = 2, g = 9.81, v0 = 3 }
    coordinates.y = { start = -2, speed = "v0" }
    points.O = [0, 0]
    bodies.ball = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = [0, "y"] } }
    constraints.rope = { kind = "string", path = ["O", "ball.origin"], unilateral = true }
    """
    result = run(text, 1.0)
    assert ends(result)[0] == "the string 'rope' is taut again"
    assert result.phases[0].end == pytest.approx(6 / G, abs=1e-9)
    assert result["y"][-1] == pytest.approx(-2, abs=1e-9) and result["y'"][-1] == pytest.approx(0, abs=1e-9)
    assert result.reactions["tension(rope)"][-1] == pytest.approx(2 * G)


def test_two_cables_that_lose_their_tension_together_go_slack_together():
    """A level bar on two cables: T = 3 M g sin(theta) in either, and 0 in both where it comes back to the horizontal.

    There it flies, for as long as nothing is stretched, and swings on with all of its energy:

        theta'^2 = 2 g sin(theta)/l
    """
    with pytest.warns(RuntimeWarning, match="No single value in singular positions"):
        result = eomgen.simulate(eomgen.load("models/seeds/ch17_p6.toml"), time=12)
    assert result.ok
    first, second, *_ = ends(result)
    assert first == "the link 'left' goes slack, the link 'right' goes slack"
    assert second == "the link 'left' is taut again, the link 'right' is taut again"
    assert len(result.phases) == 3
    assert np.max(np.abs(result["theta'"] ** 2 - 2 * G * np.sin(result["theta"]))) < 1e-5
    turn = result.phases[2].start - result.phases[1].start
    swung = np.interp(2.0, result.t, result["theta"])
    assert np.interp(result.phases[1].start + 2.0, result.t, result["theta"]) == pytest.approx(swung, abs=1e-3)
    assert turn < 0.01


LIFTED = """
[parameters]
m = 2
g = 9.81
[coordinates]
x = 0
y = 0
a = 0
[inputs]
F = { value = "10*t", unit = "N" }
[bodies.plate]
shape = { kind = "rectangle", mass = "m", width = 1, height = 1 }
points = { left = [-0.5, -0.5], right = [0.5, -0.5] }
joint = { kind = "free", x = "x", y = "y", angle = "a" }
[forces.crane]
kind = "force"
point = "plate.center"
force = [0, "F"]
"""
FEET = "".join(
    f'[constraints.{foot}]\nkind = "support"\npoint = "plate.{foot}"\nnormal = [0, 1]\nunilateral = true\n'
    for foot in ("left", "right")
)


def test_two_feet_that_a_crane_lifts_leave_the_floor_together():
    """N = (m g - 10 t)/2 in each: at t = m g/10 both open, in one event, and y = (t - m g/10)^3 10/(6 m) then."""
    leaves = 2 * G / 10
    result = eomgen.simulate(eomgen.loads(HEAD + LIFTED + FEET), time=4)
    assert ends(result)[:-1] == ["the support 'left' opens, the support 'right' opens"]
    assert result.phases[0].end == pytest.approx(leaves, abs=1e-9)
    assert result["y"][-1] == pytest.approx(10 * (4 - leaves) ** 3 / 12, rel=1e-6)
    assert abs(result["a"][-1]) < 1e-9
