"""Warnings: what is allowed and hardly meant is told, at its place; and of no model of ours."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from click.testing import CliRunner
from each import each

import eomgen
from eomgen.cli import main
from eomgen.model.checks.plausible import warnings_of

MODELS = sorted((Path(__file__).parent.parent / "models").rglob("*.toml"))
PENDULUM = """
eomgen = 1
space = "plane"
[parameters]
l = 0.5
k = 3
c = 2
g = 9.81
m = 1
[coordinates]
phi = 0.3
[bodies.bob]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "phi - pi/2", stiffness = "k", damping = "c" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
FLY = '[bodies.fly]\nshape = { kind = "particle", mass = 1 }\n'
DOUBTFUL = {
    "degrees": (
        '"phi - pi/2"',
        '"phi - 90"',
        "90 in the angle of the joint of body 'bob' is 90 rad",
        "for degrees write pi/2",
    ),
    "a stiffness": (
        'stiffness = "k"',
        'stiffness = "-k"',
        "'stiffness' of body 'bob' is below zero",
        "leave out the minus",
    ),
    "a damping": ('damping = "c"', 'damping = "-c"', "'damping' of body 'bob' is below zero", "leave out the minus"),
    "gravity": ('[0, "-g"]', '[0, "g"]', "gravity pulls upward, along y", 'write "-g"'),
    "a body without a joint": (
        "[forces.weight]",
        FLY + "[forces.weight]",
        "body 'fly' has no joint",
        "give it a joint",
    ),
    "masses": ("m = 1\n", "m = 1e9\n", "1e+12 times less", "look at the units"),
    "a parameter": ("m = 1\n", "m = 1\nmass = 2\n", "nothing uses the parameter 'mass'", "use it, or leave it out"),
    "a point": (
        "[forces.weight]",
        "[points]\nwall = [1, 0]\n[forces.weight]",
        "nothing uses the point 'wall'",
        "use it, or leave it out",
    ),
}
LIGHT = '[bodies.dust]\nshape = { kind = "particle", mass = 0.001 }\njoint = { kind = "placed", on = "bob.end" }\n'


@pytest.mark.slow
@each("path", MODELS)
def test_no_model_of_ours_is_warned_of(path):
    """No false alarm."""
    assert warnings_of(eomgen.load(path)) == ()


@pytest.mark.parametrize(("old", "new", "reported", "fix"), DOUBTFUL.values(), ids=DOUBTFUL)
def test_what_is_hardly_meant_is_told_with_its_place(old, new, reported, fix, tmp_path):
    """In the JSON of a verb that has nothing to do with it, on stderr, and in the exit code with --strict."""
    model = tmp_path / "doubtful.toml"
    text = PENDULUM.replace(old, new, 1)
    model.write_text(text.replace("[forces.weight]", LIGHT + "[forces.weight]") if "1e9" in new else text)
    words = ["inertia", str(model), "--json", "--no-certify"]
    result = CliRunner().invoke(main, words)
    (warning,) = json.loads(result.stdout)["warnings"]
    assert reported in warning["what"] and fix in warning["fix"]
    assert warning["file"] == str(model) and warning["line"] > 1 and warning["column"] >= 1
    assert reported in result.stderr
    assert (result.exit_code, CliRunner().invoke(main, [*words, "--strict"]).exit_code) == (0, 1)


@each("angle", ["phi - pi/2", "phi + 6", "90*phi", "phi/90", "sin(90*phi)", "phi*(1 + 90*phi)"])
def test_numbers_that_multiply_are_no_degrees(angle):
    """Only terms of the sum that is the angle."""
    assert warnings_of(eomgen.loads(PENDULUM.replace("phi - pi/2", angle))) == ()


def test_without_doubt_strict_changes_nothing(tmp_path):
    """Exit 0, and no warning."""
    model = tmp_path / "pendulum.toml"
    model.write_text(PENDULUM)
    result = CliRunner().invoke(main, ["check", str(model), "--strict", "--json"])
    assert (result.exit_code, json.loads(result.stdout)["warnings"]) == (0, [])


TWO_NAMES = PENDULUM.replace("phi = 0.3", "phi = 0.3\npsi = 0").replace("phi - pi/2", "phi + psi")
OPEN = PENDULUM.replace(
    "[forces.weight]",
    '[points]\nP = [9, 0]\n[constraints.far]\nkind = "pin"\npoints = ["bob.end", "P"]\n[forces.weight]',
)


@pytest.mark.parametrize(
    ("text", "reported"),
    [(TWO_NAMES, "can move together without moving a mass"), (OPEN, "'far' (row 1) does not close")],
)
def test_check_tells_what_derive_or_simulate_would_refuse(text, reported, tmp_path):
    """Not "no problems found"."""
    model = tmp_path / "wrong.toml"
    model.write_text(text)
    result = CliRunner().invoke(main, ["check", str(model)])
    assert "no problems found" not in result.stdout
    assert reported in result.stderr


def test_check_shows_the_units_that_were_inferred(tmp_path):
    """l stands in a rod: m; phi is an angle."""
    model = tmp_path / "pendulum.toml"
    model.write_text(PENDULUM)
    found = json.loads(CliRunner().invoke(main, ["check", str(model), "--json"]).stdout)["inferred_units"]
    assert found == {"l": "m", "k": "N*m", "c": "kg*m^2/s", "g": "m/s^2", "m": "kg", "phi": "1"}


SLIDER = """
eomgen = 1
space = "plane"
[parameters]
r = 0.2
l = 0.5
w = 20
[coordinates]
phi = { motion = "1 + w*t" }
psi = { dependent = true, GUESS = -0.2 }
[bodies.crank]
shape = { kind = "rod", mass = 0, length = "r" }
joint = { kind = "revolute", angle = "phi" }
[bodies.rod]
shape = { kind = "rod", mass = 1, length = "l" }
joint = { kind = "revolute", on = "crank.end", angle = "psi - phi" }
[bodies.piston]
mass = 2
inertia = 0
joint = { kind = "revolute", on = "rod.end", angle = "-psi" }
[constraints.held]
TIE
"""
CONSTRAINTS = {
    "guide": 'kind = "guide"\npoint = "piston.origin"\nalong = [1, 0]',
    "support": 'kind = "support"\npoint = "piston.origin"\nnormal = [0, 1]',
}


@each("guess, constraint, reported", [("near", "guide", True), ("start", "guide", False)])
def test_a_guess_that_would_be_geometry_is_told(guess, constraint, reported):
    """A guide lies where its point starts: of `near` that is a guess, of `start` what somebody says"""
    found = warnings_of(eomgen.loads(SLIDER.replace("GUESS", guess).replace("TIE", CONSTRAINTS[constraint])))
    assert ["where 'held' lies follows from where 'psi' starts" in each.what for each in found] == [True] * reported


LOCKED = """
eomgen = 1
space = "plane"
[coordinates]
phi = 0
[points]
P = [1, 0]
[bodies.bar]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", angle = "phi" }
[constraints.far]
kind = "pin"
points = ["bar.end", "P"]
"""


def test_a_model_that_cannot_move_is_told(tmp_path):
    """0 degrees of freedom of a coordinate that nobody drives: not "no problems found"; driven it is meant"""
    model = tmp_path / "locked.toml"
    for text, reported in (
        (LOCKED, True),
        (LOCKED + '[constraints.drive]\nkind = "motion"\ncoordinate = "phi"\nvalue = "0*t"\n', False),
        (LOCKED.replace("phi = 0", 'phi = { motion = "0*t" }'), False),
    ):
        model.write_text(text)
        result = CliRunner().invoke(main, ["check", str(model)])
        assert ("nothing can move: the constraints leave 'phi' no freedom" in result.stderr) is reported, text
        assert ("no problems found" in result.stdout) is not reported


def test_what_rests_on_what_it_can_leave_is_not_locked(tmp_path):
    """A bar at its stop can leave it: no word; beyond its stop it says so, at the joint that has the limits."""
    model = tmp_path / "stopped.toml"
    free = LOCKED.split("[constraints.far]")[0]
    for limits, beyond in (("[0, 1]", False), ("[0.25, 1]", True)):
        model.write_text(free.replace('angle = "phi"', f'angle = "phi", limits = {limits}'))
        result = CliRunner().invoke(main, ["check", str(model)])
        assert (
            "stopped.toml:8:9: the limit 'bar_low' is passed through at the start, by 0.25" in result.stderr
        ) is beyond
        assert "nothing can move" not in result.stderr or beyond


def test_a_body_that_nothing_hangs_is_told(tmp_path):
    """Beside a pendulum a rod without a joint stands in the ground: it is named; a massless frame is meant so."""
    model = tmp_path / "unhung.toml"
    rod = 'shape = { kind = "rod", mass = MASS, length = 1 }'
    for more, reported in ((rod.replace("MASS", "1"), True), (rod.replace("MASS", "0"), False), ("points = {}", False)):
        model.write_text(PENDULUM + f"\n[bodies.rest]\n{more}\n")
        result = CliRunner().invoke(main, ["check", str(model)])
        assert ("body 'rest' has no joint, and stands still" in result.stderr) is reported, result.output


IN_DEGREES = PENDULUM.replace("phi = 0.3", 'phi = { start = 30, unit = "deg" }').replace(
    "[bodies.bob]",
    """
[outputs]
v = { value = "phi'", at = "phi = 10" }
w = { value = "phi'", at = "phi = 10 deg" }
[bodies.bob]""".lstrip(),
)


@pytest.mark.slow
def test_a_plain_number_of_an_instant_is_in_the_unit_declared(recwarn):
    """at = "phi = 10" of an angle in deg is 10 deg, as on the command line; in Python it is in SI, and told"""
    model = eomgen.loads(IN_DEGREES)
    v, w = (model.outputs[name].at.right.evaluate({"pi": math.pi}) for name in "vw")
    assert float(v) == pytest.approx(math.radians(10)) and v == w
    assert not [w for w in recwarn if "plain numbers are in SI" in str(w.message)]
    eomgen.derive(model, start={"phi": 45})
    assert [w for w in recwarn if "phi = 45 is 45 rad" in str(w.message)]
    eomgen.derive(model, start={"phi": "60"})
    assert [w for w in recwarn if "phi = 60 is 60 rad" in str(w.message)]
    recwarn.clear()
    for start in (0.4, "45 deg", (45, "deg")):
        eomgen.derive(model, start={"phi": start})
    assert not list(recwarn)
