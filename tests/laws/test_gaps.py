"""Laws of what lies between two others: rest beside velocity constraints, runs measured at their steps, drives,
branches."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from slow_run import usual

import eomgen
from eomgen.mechanics.start.assembly_modes import Branches
from eomgen.mechanics.start.state import Start
from eomgen.model.model import Model
from eomgen.simulation.constraint_drift import projection_of
from eomgen.simulation.integration import integrate

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"

# -- rest beside velocity constraints ---------------------------------------------------------------------------

SLEIGH = """eomgen = 1
space = "plane"
[parameters]
m = 2.0
a = {offset}
g = 9.81
slope = 0.3
[coordinates]
x = 0
y = 0
th = 0.4
[bodies.sleigh]
mass = "m"
center = ["a", 0]
inertia = 0.3
joint = {{ kind = "free", x = "x", y = "y", angle = "th" }}
[constraints]
edge = {{ kind = "skate", point = "sleigh.origin", along = [1, 0] }}
[forces.weight]
kind = "gravity"
acceleration = [0, "-g*sin(slope)"]
"""

CAR = """eomgen = 1
space = "plane"
[parameters]
k = 2.0
[coordinates]
x = 0
y = 0
th = 0.3
de = 0.4
ga = 0.2
[bodies.car]
mass = 2
inertia = 0.3
points = { front = [1, 0], hitch = [-0.2, 0] }
joint = { kind = "free", x = "x", y = "y", angle = "th" }
[bodies.steer]
mass = 0.1
inertia = 0.01
joint = { kind = "revolute", on = "car.front", angle = "de", stiffness = "k" }
[bodies.trailer]
mass = 2
inertia = 0.3
points = { hook = [1, 0] }
joint = { kind = "revolute", on = "car.hitch", point = "hook", angle = "ga" }
[constraints]
rear = { kind = "skate", point = "car.origin", along = [1, 0] }
front = { kind = "skate", point = "steer.origin", along = [1, 0] }
wheels = { kind = "skate", point = "trailer.origin", along = [1, 0] }
"""

WHEEL = """eomgen = 1
space = "space"
[parameters]
m = 2.0
r = 0.3
g = 9.81
[coordinates]
x = 0
y = 0
z = 0.3
psi = 0.7
lean = { start = 80, unit = "deg" }
phi = 0.2
[bodies.wheel]
shape = { kind = "disc", mass = "m", radius = "r" }
joint = { kind = "free", position = ["x", "y", "z"], orientation = "zxz", angles = ["psi", "lean", "phi"] }
[constraints.floor]
kind = "rolling"
body = "wheel"
axis = [0, 0, 1]
plane = { at = [0, 0, 0], normal = [0, 0, 1] }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""


def resting(model: Model) -> dict:
    return eomgen.statics(model).as_dict()


def still(model: Model, place: dict) -> float:
    """The largest acceleration there of the equations of motion, which know nothing of the search for rest."""
    rhs = eomgen.derive(model).rhs("numpy")
    x = [place["coordinates"][name]["value"] for name in rhs.coordinates] + [0.0] * len(rhs.speeds)
    return float(np.max(np.abs(rhs(0.0, np.array(x), rhs.p0))))


def test_a_sleigh_rests_across_the_slope_if_its_mass_centre_is_at_the_edge():
    """N = m g sin(slope) along the left normal, at th = 0; beside the edge the weight turns it: no rest."""
    found = resting(eomgen.loads(SLEIGH.format(offset=0)))
    assert [place["coordinates"]["th"]["value"] for place in found["equilibria"]] == [0]
    assert found["reactions"]["reaction_n(edge)"]["value"] == pytest.approx(2 * 9.81 * math.sin(0.3), rel=1e-12)
    assert not resting(eomgen.loads(SLEIGH.format(offset=0.4)))["equilibria"]


def test_a_car_with_a_trailer_rests_at_any_angle_once_its_steering_spring_is_slack():
    """Q_de = -k de = 0; th and ga stay where they start, and V rises only with de: K = diag(k, 0)."""
    model = eomgen.loads(CAR)
    found = resting(model)
    (place,) = found["equilibria"]
    assert {name: place["coordinates"][name]["exact"] for name in ("th", "de", "ga")} == {
        "th": "3/10",
        "de": "0",
        "ga": "1/5",
    }
    assert found["chosen"] == ["th", "ga"] and place["stability"]["kind"] == "stable"
    assert still(model, place) < 1e-12


def test_a_wheel_on_a_plane_stands_upright_at_any_heading_and_falls():
    """K = -m g r along the lean; the plane carries m g, and friction nothing."""
    model = eomgen.loads(WHEEL)
    found = resting(model)
    upright = found["equilibria"][0]
    assert upright["coordinates"]["lean"]["exact"] == "pi/2" and upright["coordinates"]["z"]["exact"] == "r"
    assert upright["coordinates"]["psi"]["value"] == 0.7 and "psi" in found["chosen"]
    assert upright["stability"]["kind"] == "unstable" and ["0", "0", "-m*g*r"] in upright["stability"]["K"]
    assert [found["reactions"][f"reaction_{k}(floor)"]["exact"] for k in "nts"] == ["m*g", "0", "0"]
    assert still(model, upright) < 1e-12


def test_small_motions_are_about_the_place_where_statics_finds_rest():
    """One rule for both: the wheel that starts leaning is linearized upright, lean'' = m g r/(I + m r^2) lean."""
    found = eomgen.linearize(eomgen.loads(WHEEL))
    rates = sorted(np.linalg.eigvals(found.A).real)
    assert rates[-1] == pytest.approx(math.sqrt(9.81 / (1.25 * 0.3)), rel=1e-9)


# -- runs measured at their steps ------------------------------------------------------------------------

SWING = """eomgen = 1
space = "plane"
[parameters]
g = 9.81
[coordinates]
x = 1
y = 0
[bodies.bob]
shape = { kind = "particle", mass = 1 }
joint = { kind = "free", x = "x", y = "y", angle = 0 }
[points]
O = [0, 0]
[constraints]
rod = { kind = "link", points = ["O", "bob.center"] }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def test_few_samples_tell_of_drift_and_gap_between_them():
    """max |E - E(0)| and max |r - 1| at the integrator's own steps, by hand; the samples are two of the rests."""
    model = eomgen.loads(SWING)
    period = 2 * math.pi / math.sqrt(9.81) * 1.180340599016096  # of an amplitude of 90 degrees: 2 K(1/2)/pi
    few = eomgen.simulate(model, samples=2, time=period, rtol=1e-5, atol=1e-5)
    equations = eomgen.derive(model)
    projection = projection_of(equations.system, equations.rhs().p0)
    steps = integrate(equations.rhs(), time=period, rtol=1e-6, atol=1e-6, samples=None, projection=projection)
    assert few.steps == steps.steps == len(steps.t) - 1
    x, y, vx, vy = steps.x.T
    E = (vx**2 + vy**2) / 2 + 9.81 * y
    assert few.gap == pytest.approx(np.max(np.abs(np.hypot(x, y) - 1)), rel=1e-3)
    assert few.drift * 9.81 == pytest.approx(np.max(np.abs(E - E[0])), rel=0.05)
    assert few.gap > 1.05 * abs(np.hypot(few["x"][-1], few["y"][-1]) - 1)


# -- what drives a coordinate ----------------------------------------------------------------------------

DRIVEN_ARM = """eomgen = 1
space = "plane"
[coordinates]
th = {th}
ph = 0.3
[bodies.arm]
shape = {{ kind = "rod", mass = 2, length = 1 }}
joint = {{ kind = "revolute", angle = "pi/3 - 2*th" }}
[bodies.tip]
shape = {{ kind = "rod", mass = 1, length = 0.7 }}
joint = {{ kind = "revolute", on = "arm.end", angle = "ph" }}
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
{constraint}
"""

DRIVEN_CRANK = """eomgen = 1
space = "space"
[coordinates]
th = {th}
ph = {{ near = -0.4 }}
x = {{ near = 1.2 }}
[bodies.crank]
shape = {{ kind = "cylinder", mass = 1, radius = 0.05, length = 0.4 }}
joint = {{ kind = "revolute", axis = [0, 0, 1], angle = "th" }}
points = {{ pin = [0.4, 0, 0] }}
[bodies.rod]
shape = {{ kind = "cylinder", mass = 1, radius = 0.05, length = 1 }}
joint = {{ kind = "revolute", on = "crank.pin", axis = [0, 0, 1], angle = "ph" }}
points = {{ end = [1, 0, 0] }}
[bodies.slide]
mass = 2
inertia = [1, 1, 1]
joint = {{ kind = "prismatic", axis = [1, 0, 0], displacement = "x" }}
[constraints]
pin = {{ kind = "pin", points = ["rod.end", "slide.origin"], axis = [0, 0, 1] }}
{constraint}
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81, 0]
"""

SAME_MOTION = ('{ motion = "0.5*sin(3*t) + 0.2" }', "{ start = 0.2, speed = 1.5 }")
DRIVE = '{ kind = "motion", coordinate = "th", value = "0.5*sin(3*t) + 0.2" }'


@pytest.mark.filterwarnings("ignore:.*Statically indeterminate")
@pytest.mark.parametrize("text", [DRIVEN_ARM, DRIVEN_CRANK])
def test_a_tie_that_drives_has_the_columns_of_a_driven_coordinate(text):
    """drive(th) in both, and E(t) - E(0) = integral of drive th' dt, which knows nothing of reactions."""
    own = eomgen.loads(text.format(th=SAME_MOTION[0], constraint=""))
    constraint = f"[constraints.motor]\n{DRIVE[1:-1].replace(', ', chr(10)).strip()}"
    constrained = eomgen.loads(text.format(th=SAME_MOTION[1], constraint=constraint))
    runs = [eomgen.simulate(model, time=1, samples=2001) for model in (own, constrained)]
    for name, column in runs[0].reactions.items():
        assert runs[1][name] == pytest.approx(column, rel=1e-6, abs=1e-6, nan_ok=True), name
    run = runs[1]
    work = np.concatenate(
        [
            [0],
            np.cumsum(
                np.diff(run.t) / 2 * (run["drive(th)"] * run["th'"])[:-1]
                + np.diff(run.t) / 2 * (run["drive(th)"] * run["th'"])[1:]
            ),
        ]
    )
    assert run.energy - run.energy[0] == pytest.approx(work, abs=1e-4) and np.ptp(run.energy) > 1


def test_drive_reaction_and_multiplier_of_a_tie_are_one_number():
    """lam of q - f(t) = 0 is the force along q, whatever asks for it."""
    outputs = '[outputs]\na = "drive(th)"\nb = "multiplier(motor)"\nc = "-2*reaction_couple(arm)"\n'
    constraint = f"[constraints]\nmotor = {DRIVE}\n{outputs}"
    found = eomgen.solve(eomgen.loads(DRIVEN_ARM.format(th=SAME_MOTION[1], constraint=constraint)))
    assert found["a"].value == pytest.approx(found["b"].value, rel=1e-12)
    assert found["a"].value == pytest.approx(found["c"].value, rel=1e-12)


# -- starts and branches ---------------------------------------------------------------------------------

OPEN_FOUR_BAR = """eomgen = 1
space = "plane"
[coordinates]
a = {{ start = {a}, unit = "deg" }}
b = {{ near = -20, unit = "deg" }}
c = {{ near = 60, unit = "deg" }}
[bodies.crank]
shape = {{ kind = "rod", mass = 1, length = 1 }}
joint = {{ kind = "revolute", angle = "a" }}
[bodies.coupler]
shape = {{ kind = "rod", mass = 1, length = {l} }}
joint = {{ kind = "revolute", on = "crank.end", angle = "b" }}
[bodies.rocker]
shape = {{ kind = "rod", mass = 1, length = {l} }}
joint = {{ kind = "revolute", at = [4, 0], angle = "c" }}
[constraints]
pin = {{ kind = "pin", points = ["coupler.end", "rocker.end"] }}
"""


def test_a_loop_that_never_closes_says_how_near_it_comes():
    """Links of 1, 1/2 and 1/2 over a base of 4: all in line they leave 4 - 2."""
    with pytest.raises(eomgen.DerivationError, match=r"'pin' stays open: by 2 at a = 0 deg, b = 0 deg, c = 180 deg"):
        eomgen.simulate(eomgen.loads(OPEN_FOUR_BAR.format(a=30, l=0.5)), time=1)


def test_a_loop_that_closes_elsewhere_says_where():
    """The crank stands away from the base at 179 degrees, and links of 2 and 2 reach 4 < 5: other crank angles do."""
    with pytest.raises(eomgen.DerivationError, match="all constraints close at a = ") as refused:
        eomgen.simulate(eomgen.loads(OPEN_FOUR_BAR.format(a=179, l=2)), time=1)
    a, b, c = (math.radians(float(x)) for x in re.findall(r"= (-?[\d.]+) deg", str(refused.value)))
    left = np.exp(1j * a) + 2 * np.exp(1j * (a + b)) - 4 - 2 * np.exp(1j * c)
    assert abs(left) < 1e-4


def test_what_assembly_moved_is_told_in_the_units_of_the_user():
    """The angles of the triangle of links 2.5 and 2.5 over the diagonal, in degrees."""
    model = eomgen.loads(OPEN_FOUR_BAR.format(a=30, l=2.5))
    words = eomgen.simulate(model, time=0.01).assembled
    end = np.exp(1j * math.pi / 6)
    diagonal = 4 - end
    b = np.angle(diagonal) + math.acos(abs(diagonal) / 5) - math.pi / 6
    assert f"b = {math.degrees(b):.9g} deg" in words and "c = 120.3346" in words


@pytest.mark.parametrize("name", ["four_bar", "slider_crank", "spatial_four_bar", "andrews_squeezer"])
def test_each_branch_that_check_lists_is_chosen_by_a_start_near_it(name):
    """From 0.01 beside each of the ways the loops close on that way, whose constraints hold; no two are the same."""
    model = eomgen.load(MODELS / f"{name}.toml")
    system = eomgen.derive(model).system
    found = Branches.of(system, Start.of(system).values)
    ways = (found.here, *found.others)
    assert len(ways) > 1 and len({str(way) for way in ways}) == len(ways)
    for way in ways:
        near = {q: x + 0.01 for q, x in way.values.items()}
        again = Start.of(system, start=near)
        turns = [(again.values[q] - x) / (2 * math.pi) for q, x in way.values.items()]
        assert list(turns) == pytest.approx(list(np.round(turns)), abs=2e-3), (name, str(way))


def test_the_side_of_a_pin_tells_the_ways_of_a_four_bar():
    """Im conj(Q - P) (R - P) > 0: R to the left of the way from the crank's end P to the rocker's foot Q."""
    system = eomgen.derive(eomgen.loads(OPEN_FOUR_BAR.format(a=30, l=2.5))).system
    found = Branches.of(system, Start.of(system).values)
    P, Q = np.exp(1j * math.pi / 6), 4.0
    for way in (found.here, *found.others):
        R = P + 2.5 * np.exp(1j * (math.pi / 6 + way.values["b"]))
        assert [side.left for side in way.sides] == [((Q - P).conjugate() * (R - P)).imag > 0]
    assert found.here.sides[0].left != found.others[0].sides[0].left


# -- change points in phases -----------------------------------------------------------------------------

PARALLELOGRAM = """eomgen = 1
space = "plane"
[coordinates]
a = { start = 1, speed = 4 }
b = { start = 1 }
c = { near = -1 }
s = { start = 0.1 }
[bodies.one]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", angle = "a" }
[bodies.two]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", at = [2, 0], angle = "b" }
[bodies.bar]
shape = { kind = "rod", mass = 1, length = 2 }
joint = { kind = "revolute", on = "one.end", angle = "c" }
[bodies.block]
shape = { kind = "particle", mass = 0.5 }
joint = { kind = "prismatic", at = [5, 0], axis = [0, 1], displacement = "s" }
[constraints]
pin = { kind = "pin", points = ["bar.end", "two.end"] }
floor = { kind = "support", point = "block.center", normal = [0, 1], at = [5, 0], unilateral = true }
[forces]
weight = { kind = "gravity", acceleration = [0, -9.81] }
"""


@pytest.mark.filterwarnings("ignore:.*No single value in singular positions")
@pytest.mark.parametrize(
    ("until", "at", "passed"), usual([(None, None, 6), ("a = 8", 8, 2), ("a = 3*pi", 3 * math.pi, 3)], 2, 1)
)
def test_change_points_are_passed_in_runs_with_contacts_too(until, at, passed):
    """A block that lands beside a parallelogram changes nothing of it: b = a, c = -a, and its own energy stays.

    T = 1/3 a'^2 of both cranks and (m/2) a'^2 of the bar, which does not turn (m = 1); V = 2 g sin a.
    """
    run = eomgen.simulate(eomgen.loads(PARALLELOGRAM), time=4, until=until)
    assert run.ok and len(run.carried) == passed and len(run.phases) == 2
    a, da = run["a"], run["a'"]
    E = (1 / 3 + 1 / 2) * da**2 + 2 * 9.81 * np.sin(a)
    assert E == pytest.approx(np.full(len(E), E[0]), rel=1e-7)
    assert run["b"] == pytest.approx(a, abs=1e-7) and run["c"] == pytest.approx(-a, abs=1e-7)
    assert at is None or a[-1] == pytest.approx(at, abs=1e-9)


# -- rest where angles lock ------------------------------------------------------------------------------

BALL_JOINT = """eomgen = 1
space = "space"
[coordinates]
a = 0.2
b = 0.1
c = 0.3
[bodies.pear]
mass = 2
center = [0, 0, -0.1]
inertia = [0.05, 0.05, 0.06]
joint = {{ kind = "spherical", orientation = "{sequence}", angles = ["a", "b", "c"] }}
[forces.weight]
kind = "gravity"
acceleration = [0, 0, -9.81]
"""


@pytest.mark.parametrize("sequence", ["xyz", "zxz", "yxz", "zyx"])
def test_a_body_on_a_ball_joint_rests_only_below_and_above(sequence):
    """m g x r = 0: not where the angles lock, however their three forces vanish there."""
    found = resting(eomgen.loads(BALL_JOINT.format(sequence=sequence)))
    turns = {
        "x": lambda w: [[1, 0, 0], [0, math.cos(w), -math.sin(w)], [0, math.sin(w), math.cos(w)]],
        "y": lambda w: [[math.cos(w), 0, math.sin(w)], [0, 1, 0], [-math.sin(w), 0, math.cos(w)]],
        "z": lambda w: [[math.cos(w), -math.sin(w), 0], [math.sin(w), math.cos(w), 0], [0, 0, 1]],
    }
    heights = []
    for place in found["equilibria"]:
        R = np.eye(3)
        for axis, name in zip(sequence, "abc", strict=True):
            R = R @ turns[axis](place["coordinates"][name]["value"])
        heights.append(R[2, 2])
    assert np.abs(heights) == pytest.approx(np.ones(len(heights)), abs=1e-9)
    assert min(heights) == pytest.approx(-1) and max(heights) == pytest.approx(1)


TWO_CONSTRAINTS = """eomgen = 1
space = "plane"
[coordinates]
a = {{ start = 40, speed = 100, unit = "deg" }}
b = {{ {how} near = 0 }}
c = {{ {how} near = 1.4 }}
x = {{ speed = 1 }}
ph = {{ speed = 3 }}
[bodies.crank]
shape = {{ kind = "rod", mass = 1, length = 1 }}
joint = {{ kind = "revolute", angle = "a" }}
[bodies.coupler]
shape = {{ kind = "rod", mass = 1, length = 2 }}
joint = {{ kind = "revolute", on = "crank.end", angle = "b" }}
[bodies.rocker]
shape = {{ kind = "rod", mass = 1, length = 1.5 }}
joint = {{ kind = "revolute", at = [2, 0], angle = "c" }}
[bodies.wheel]
shape = {{ kind = "disc", mass = 1, radius = 0.2 }}
joint = {{ kind = "free", x = "x", y = 0.2, angle = "ph" }}
[constraints]
pin = {{ kind = "pin", points = ["coupler.end", "rocker.end"] }}
roll = {{ kind = "rolling", body = "wheel", line = {{ at = [0, 0], normal = [0, 1] }} }}
"""


@pytest.mark.parametrize("how", ["", "dependent = true,"])
def test_a_given_speed_moves_only_for_the_ties_that_need_it(how):
    """x' = 1 and ph' = 3 contradict x' + ph'/5 = 0, and move; a' of the linkage, whose b' and c' are free, stays."""
    system = eomgen.derive(eomgen.loads(TWO_CONSTRAINTS.format(how=how))).system
    found = Start.of(system).values
    assert found["a'"] == math.radians(100) and found["x'"] + found["ph'"] / 5 == pytest.approx(0, abs=1e-15)


def test_given_speeds_that_break_a_tie_change_as_in_an_impact_without_rebound():
    """A sleigh that points to 0.3 rad keeps the velocity along its edge, (1, 2) . d: it gains no energy."""
    text = """
eomgen = 1
space = "plane"
[coordinates]
x = { start = 0, speed = 1 }
y = { start = 0, speed = 2 }
phi = { start = 0.3, speed = 0 }
[bodies.sleigh]
mass = 2
inertia = 0.5
joint = { kind = "planar", x = "x", y = "y", angle = "phi" }
[constraints.edge]
kind = "skate"
point = "sleigh.origin"
along = [1, 0]
"""
    run = eomgen.simulate(eomgen.loads(text), time=0.1)
    d = np.array([np.cos(0.3), np.sin(0.3)])
    assert [run["x'"][0], run["y'"][0]] == pytest.approx((np.array([1, 2]) @ d) * d)
    assert run["phi'"][0] == pytest.approx(0, abs=1e-12)


REACHING = """
eomgen = 1
space = "plane"
[coordinates]
a = 0.5
b = 0.5
[points]
W = [{away}, 0]
[bodies.p]
shape = {{ kind = "rod", mass = 1, length = 1 }}
joint = {{ kind = "revolute", angle = "a" }}
[bodies.q]
shape = {{ kind = "rod", mass = 1, length = 1 }}
joint = {{ kind = "revolute", on = "p.end", angle = "b" }}
[constraints.c]
kind = "pin"
points = ["q.end", "W"]
"""


@pytest.mark.parametrize(
    ("away", "says"),
    [
        ("2.0000000001", "'c' stays open: by 1"),
        ("2.00000001", "'c' stays open: by 1"),
        ("2", "all constraints close at"),
        ("3", "'c' stays open: by 1"),
    ],
)
def test_a_gap_that_is_small_for_ever_is_not_closed(away, says):
    """Two rods of length 1 against a point beyond 2: 1e-10 m is missing, whatever doubles take for 0."""
    with pytest.raises(eomgen.DerivationError, match=says):
        eomgen.simulate(eomgen.loads(REACHING.format(away=away)), time=1)


def test_a_link_that_cannot_close_is_open_by_a_length():
    """|L - |r||, not (L - r^2/L)/2 = 0.75:  1.8 m between ends 1 m and 0.2 m from places 3 m apart, L = 1.2 m"""
    text = """
eomgen = 1
space = "plane"
coordinates = { a = 0.1, b = { dependent = true, near = 0.2 } }
points = { O = [0, 0], P = [3, 0] }
bodies.r = { shape = { kind = "rod", mass = 1, length = 1 }, joint = { kind = "revolute", angle = "a" } }
bodies.s.shape = { kind = "rod", mass = 1, length = 0.2 }
bodies.s.joint = { kind = "revolute", at = "P", angle = "b" }
constraints.L = { kind = "link", points = ["r.end", "s.end"], length = 1.2 }
"""
    with pytest.raises(eomgen.EomgenError, match=r"stays open: by 0\.6 at"):
        eomgen.simulate(eomgen.loads(text), time=0.1)
