"""Dependent coordinates: the rates that constraints give, equations in the independent speeds, and starts that close.

q' = N u + nu,  N = [1; A],  nu = [0; b]
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from each import each
from moving import equal
from slow_run import usual

import eomgen
from eomgen.errors import DerivationError, UsageError
from eomgen.mechanics.constraints import elimination
from eomgen.mechanics.dynamics.system import System
from eomgen.proof import certificate, identities
from eomgen.symbolic.exact import cramer
from eomgen.symbolic.exact.equality import equal_at_random_states

pytestmark = pytest.mark.slow

HEAD = """
eomgen = 1
name = "with dependent coordinates"
space = "plane"
[parameters]
m = 1.0
g = 9.81
l = 0.7
R = 0.3
w = 2.0
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def rod(name: str, joint: str, length: str = "l") -> str:
    return f"""
[bodies.{name}]
shape = {{ kind = "rod", mass = "m", length = "{length}" }}
joint = {{ {joint} }}
"""


def cranks(*names: str) -> str:
    """Equal cranks on hinges a metre apart, each by the angle of its own name."""
    return "".join(
        rod(name.upper(), f'kind = "revolute", at = [{k}, 0], angle = "{name}"') for k, name in enumerate(names)
    )


COUPLER = """
[bodies.D]
mass = "m"
inertia = 0.1
points = { B = [1, 0], C = [2, 0] }
joint = { kind = "revolute", on = "A.end", angle = "d - a" }
[constraints.P]
kind = "pin"
points = ["B.end", "D.B"]
"""
LADDER = (
    HEAD
    + rod("bar", 'kind = "planar", point = "center", x = "x", y = "y", angle = "theta"')
    + """
[coordinates]
theta = 0.3
x = { dependent = true, near = 0.1 }
y = { dependent = true, near = 0.3 }
[constraints]
wall = { kind = "support", point = "bar.start", normal = [1, 0], at = [0, 0] }
floor = { kind = "support", point = "bar.end", normal = [0, 1], at = [0, 0] }
"""
)
PARALLELOGRAM = (
    HEAD
    + cranks("a", "b")
    + COUPLER
    + """
[coordinates]
a = { start = 1.0, speed = -3 }
b = { dependent = true, near = 1.1 }
d = { dependent = true, near = 0.05 }
"""
)
THREE_CRANKS = (
    HEAD
    + cranks("a", "b", "c")
    + COUPLER
    + """
[coordinates]
a = 1.0
b = { dependent = true, near = 1.1 }
c = { dependent = true, near = 0.9 }
d = { dependent = true, near = 0.05 }
[constraints.Q]
kind = "pin"
points = ["C.end", "D.C"]
"""
)
ONE_OF_TWO = HEAD + cranks("a", "b") + COUPLER + "[coordinates]\na = 1\nb = { dependent = true, near = 1 }\nd = 0\n"
GEARS = (
    HEAD
    + rod("arm", 'kind = "revolute", angle = "b"')
    + """
[coordinates]
a = { motion = "sin(w*t)" }
b = 0.2
c = { dependent = true, start = 0.4 }
x = { dependent = true, start = 0.1 }
[bodies.sun]
shape = { kind = "disc", mass = "m", radius = "R" }
joint = { kind = "revolute", angle = "a" }
[bodies.planet]
shape = { kind = "disc", mass = "m", radius = "R" }
joint = { kind = "revolute", on = "arm.end", angle = "c" }
[bodies.rack]
shape = { kind = "rectangle", mass = "m", width = 1, height = 0.1 }
joint = { kind = "prismatic", axis = [1, 1], displacement = "x" }
[constraints]
teeth = { kind = "equation", rate = "R*(b' + c') + R*a' - l*b'*cos(b)" }
pinion = { kind = "equation", rate = "x' - R*c'*(1 + b)" }
[forces.spring]
kind = "spring"
points = ["rack.center", "planet.center"]
stiffness = 5
length = 0.3
[forces.drag]
kind = "generalized"
coordinate = "c"
value = "-0.1*c'"
"""
)
SKATE = (
    HEAD
    + rod("S", 'kind = "planar", point = "center", x = "x + z", y = "y", angle = "theta"')
    + """
[coordinates]
x = 0.2
y = { dependent = true, start = 0.4 }
theta = { start = 0.3, speed = 1 }
z = { motion = "t^2" }
[constraints.edge]
kind = "equation"
rate = "(x' + z')*sin(theta) - y'*cos(theta)"
"""
)
MOVING_WALL = LADDER.replace(
    'wall = { kind = "support", point = "bar.start", normal = [1, 0], at = [0, 0] }',
    'wall = { kind = "equation", gap = "x - l/2*cos(theta) - sin(w*t)" }',
)
CASES = {
    "ladder": LADDER,
    "parallelogram": PARALLELOGRAM,
    "three cranks": THREE_CRANKS,
    "one of two": ONE_OF_TWO,
    "gears": GEARS,
    "skate": SKATE,
    "moving wall": MOVING_WALL,
}

MODELS = Path(__file__).parents[2] / "models"
cases = pytest.mark.parametrize("name", CASES)


def model(name: str):
    return eomgen.loads(CASES[name])


@cases
def test_the_certificate_holds(name):
    """Reduced Lagrange, projection, recursion, and the free bodies with every constraint's multiplier agree."""
    certificate = eomgen.derive(model(name)).certify()
    assert certificate.ok, str(certificate)


@cases
def test_rates_of_dependent_coordinates_keep_the_ties(name):
    """W^T xi + s_t = 0 for each eliminated row that determines a coordinate, whatever u."""
    rows = [row for row in System.of(model(name)).constraints.rows if row.eliminates]
    assert len(rows) == CASES[name].count("dependent = true")
    assert equal_at_random_states([(row.velocity, 0) for row in rows]).equal


def with_multipliers(name: str) -> str:
    """The same model with every coordinate free, at the same start."""
    equations = eomgen.derive(model(name))
    rhs, text = equations.rhs("numpy"), CASES[name]
    assert rhs.x0 is not None and rhs.p0 is not None
    rates = rhs(0.0, rhs.x0, rhs.p0)
    for q, start, speed in zip(equations.coordinates, rhs.x0, rates, strict=False):
        start_of = f"{q} = {{ start = {float(start)!r}, speed = {float(speed)!r} }}"
        text = re.sub(rf"^{q} = {{ dependent = true.*$", start_of, text, flags=re.M)
    return text


@pytest.mark.parametrize("name", usual([*[name for name in CASES if name != "three cranks"]], 3))
def test_the_motion_is_that_with_multipliers(name):
    """M a + c = Q + J^T lam, J a + gamma = 0 over all coordinates gives the same q(t), up to a change point."""
    run = eomgen.simulate(model(name), time=0.2, target="numpy")
    other = eomgen.simulate(eomgen.loads(with_multipliers(name)), time=0.2, target="numpy")
    assert run.ok and other.ok
    for q in run.coordinates:
        assert run[q] == pytest.approx(other[q], abs=1e-7)


def test_speeds_are_the_independent_ones_and_eliminated_rows_leave_J():
    """DESIGN 5: coordinates hold all q, speeds u alone; J, sigma, gamma, phi the rows that still close."""
    whole, part = eomgen.derive(model("parallelogram")), eomgen.derive(model("one of two"))
    assert (whole.coordinates, whole.speeds) == (("a", "b", "d"), ("a'",))
    assert [len(row) for row in whole.graph.N] == [1, 1, 1]
    assert (whole.graph.J, whole.graph.phi) == ((), ())
    assert (part.speeds, len(part.graph.J)) == (("a'", "d'"), 1)


def test_redundant_loops_leave_nothing_to_multipliers():
    """Rows that follow from those used up are eliminated too: on phi = 0 their J would be nothing but rounding."""
    system = System.of(model("three cranks"))
    assert [row.status for row in system.constraints.rows] == ["eliminated"] * 4
    assert [row.eliminates == "" for row in system.constraints.rows].count(True) == 1


def test_a_four_bar_follows_in_closed_form():
    """b beta' = -a sin(alpha - gamma) alpha' / sin(beta - gamma): by determinants, no pivot below the line."""
    system = System.of(eomgen.load(MODELS / "four_bar.toml"))
    names = system.scope.names
    alpha, beta, gamma = (names[name] for name in ("alpha", "beta", "gamma"))
    sin = system.scope.graph.call
    a, b, u = names["a"], names["b"], names["alpha'"]
    expected = -(a * sin("sin", alpha - gamma) * u) / (b * sin("sin", beta - gamma))
    assert equal((names["beta'"],), (expected,))
    rhs = eomgen.derive(eomgen.load(MODELS / "four_bar.toml")).rhs("numpy")
    for state in ([1, 0.5, 0, 2], [1, 0, 0.5, 2], [0, 0.5, 1, 2]):  # where one coefficient of J vanishes, J does not
        assert np.all(np.isfinite(rhs(0.0, state, rhs.p0)))


# -- what a wrong elimination does -------------------------------------------------------------------


@cases
def test_a_wrong_rate_turns_the_certificate_red(monkeypatch, name):
    """A with the other sign: the free bodies and the eliminated rows do not follow it."""
    right = cramer.solution_by_minors

    def wrong(rows, right_side, **options):
        solution, blocks = right(rows, right_side, **options)
        return tuple(tuple(-x for x in row) for row in solution), blocks

    monkeypatch.setattr(elimination.cramer, "solution_by_minors", wrong)
    equations = eomgen.derive(model(name))
    assert not certificate.certify(equations.graph).ok


def test_ties_that_move_by_themselves_and_do_not_commute_carry_power(monkeypatch):
    """d/dt (u . dT/du - T + V) has p . [nu, N u] in addition, where rolling constraints are carried along."""
    monkeypatch.setattr(identities, "_carried_power", lambda system: 0)
    equations = eomgen.derive(model("skate"))
    checks = certificate.certify(equations.graph).checks
    assert [check.ok for check in checks if "energy theorem" in check.name] == [False]


# -- dependent coordinates that are not determined ---------------------------------------------------


def test_a_dependent_coordinate_without_a_tie_is_named():
    """What is wrong, where, and how to fix it."""
    with pytest.raises(DerivationError) as caught:
        eomgen.derive(eomgen.loads(HEAD + cranks("a", "b") + "[coordinates]\na = 1\nb = { dependent = true }\n"))
    assert str(caught.value) == (
        "coordinates.b: 'b' is dependent, but there is no constraint\n"
        "fix: add the constraint that moves it, or leave out `dependent`"
    )


def test_dependent_coordinates_that_ties_leave_free_are_named():
    """Two rows cannot move three coordinates."""
    text = PARALLELOGRAM.replace("a = { start = 1.0, speed = -3 }", "a = { dependent = true, near = 1 }")
    with pytest.raises(DerivationError, match="'b' is dependent, but the constraints leave it free"):
        eomgen.derive(eomgen.loads(text))


# -- the start ---------------------------------------------------------------------------------------


@each("near, below", [("1.1", False), ("-1.2", True)])
def test_near_picks_the_branch(near, below):
    """The anti-parallelogram has the other crank below: b in (-pi, 0)."""
    guess = {"1.1": "0.05", "-1.2": "-1"}[near]
    text = PARALLELOGRAM.replace("near = 1.1", f"near = {near}").replace("near = 0.05", f"near = {guess}")
    equations = eomgen.derive(eomgen.loads(text))
    a, b, d, _ = equations.start()
    l = 0.7
    assert abs(l * np.exp(1j * a) + np.exp(1j * d) - 1 - l * np.exp(1j * b)) < 1e-14
    assert bool(b < 0) == below


def test_what_only_velocities_move_starts_at_its_start():
    """The gears' angle and the rack's place are free in position."""
    assert list(eomgen.derive(model("gears")).start()) == [0.0, 0.2, 0.4, 0.1, 0.0]


def test_a_start_may_be_given_and_the_dependent_coordinates_follow():
    """x = l cos(theta)/2, y = -l sin(theta)/2."""
    equations = eomgen.derive(model("ladder"))
    assert equations.start(start={"theta": 0.8}) == pytest.approx([0.8, 0.35 * np.cos(0.8), -0.35 * np.sin(0.8), 0])
    assert equations.start({"l": 1.4})[1] == pytest.approx(0.7 * np.cos(0.3))
    with pytest.raises(UsageError, match="no coordinate or speed 'x''"):
        equations.start(start={"x'": 1})


OUT_OF_REACH = PARALLELOGRAM.replace("at = [1, 0]", "at = [9, 0]")
OPEN = re.sub(r"\{ dependent = true, near = (.*) \}", r"\1", PARALLELOGRAM.replace("{ start = 1.0, speed = -3 }", "1"))
WIDE = OPEN.replace("at = [1, 0]", "at = [9, 0]")


@pytest.mark.parametrize(
    ("text", "message"),
    usual(
        [
            (OUT_OF_REACH, "'P' (row 1) does not close at the start: it is open by "),
            (OUT_OF_REACH, "fix: give start values at which it can close, or another guess: `near` of 'b', 'd'"),
            (WIDE, "'P' (row 1) does not close at the start: it is open by 7.94"),
            (WIDE, "fix: give start values that close it, or mark a coordinate as `dependent`: 'a', 'b', 'd'"),
        ],
        2,
    ),
)
def test_a_loop_that_does_not_close_at_the_start_is_refused(text, message):
    """From the run, not from the derivation: which constraint, by how much, and the fix."""
    equations = eomgen.derive(eomgen.loads(text))
    assert equations.rhs("numpy").x0 is None
    for run in (equations.start, lambda: eomgen.simulate(eomgen.loads(text), time=1)):
        with pytest.raises(DerivationError) as caught:
            run()
        assert message in str(caught.value)


def test_start_values_rounded_to_seven_digits_close():
    """A loop open by less than 1e-6 of its size is taken as it is."""
    text = OPEN.replace("1.1", "1.00000002").replace("0.05", "0")
    assert list(eomgen.derive(eomgen.loads(text)).start())[:3] == [1, 1.00000002, 0]


# -- singular configurations -------------------------------------------------------------------------


@pytest.mark.parametrize("speed", usual([0, -3, 8], 2, 1))
def test_a_parallelogram_passes_its_change_point(speed):
    """All hinges in line: N is 0/0 there, and 1 on either side."""
    text = PARALLELOGRAM.replace("speed = -3", f"speed = {speed}")
    run = eomgen.simulate(eomgen.loads(text), time=4, target="numpy")
    assert run.ok and run.drift is not None and run.drift < 1e-6
    assert np.min(np.sin(run["a"])) < 0 < np.max(np.sin(run["a"]))
    assert run["b"] == pytest.approx(run["a"], abs=1e-6)


def by_piston(x: str) -> eomgen.Model:
    """A slider-crank of which the piston's place is the coordinate."""
    slider = (MODELS / "slider_crank.toml").read_text()
    slider = re.sub("^theta = .*$", "theta = { dependent = true, near = 1 }", slider, flags=re.M)
    return eomgen.loads(re.sub("^x = .*$", f"x = {x}", slider, flags=re.M))


def test_a_flywheel_carries_a_slider_crank_across_its_dead_centres():
    """Over x or over theta it is one motion: theta' = x'/(dx/dtheta)."""
    run = eomgen.simulate(by_piston("{ start = 1.1577728, speed = -3 }"), time=2, target="numpy")
    assert run.ok and not run.carried
    first = {q: run[q][0] for q in ("theta", "phi")}
    rate = 3 * np.cos(first["phi"]) / (0.4 * np.sin(first["theta"] - first["phi"]))
    start = {"theta": first["theta"], "theta'": rate}
    other = eomgen.simulate(eomgen.load(MODELS / "slider_crank.toml"), time=2, target="numpy", start=start)
    assert run["theta"] == pytest.approx(other["theta"], abs=1e-7)


def test_a_run_that_cannot_pass_a_dead_centre_ends_with_time_and_tie():
    """Pulled on by the piston, the crank has no place beyond x = l - r."""
    run = eomgen.simulate(by_piston('{ motion = "1.1577728 - 3*t" }'), time=2, target="numpy")
    message = r"Stopped at t = 0\.18\d* s: 'wrist' does not determine 'theta', 'phi' there "
    assert run.status == "singular"
    assert re.fullmatch(message + r"\(a dead centre or a change point\)\.", run.message)
    assert run.phases[-1].ended_by == run.message
    assert run["x"][-1] == pytest.approx(0.6, abs=5e-3) and run["theta"][-1] == pytest.approx(np.pi, abs=0.2)


def test_a_start_in_a_change_point_is_an_outcome_that_names_it():
    """0/0 at once."""
    text = PARALLELOGRAM.replace("start = 1.0", "start = 0").replace("near = 1.1", "start = 0")
    with pytest.warns(RuntimeWarning, match="No single value in singular positions, first at t = 0 s"):
        run = eomgen.simulate(eomgen.loads(text.replace("near = 0.05", "start = 0")), time=1, target="numpy")
    assert (run.status, run.message[:45]) == ("singular", "Stopped at t = 0 s: 'P' does not determine 'b")


def test_the_free_system_has_every_coordinate():
    """Before the elimination nothing is dependent."""
    free = System.free_of(model("three cranks"))
    assert len(free.symbols.u) == 4 and {row.status for row in free.constraints.rows} == {"closing"}
