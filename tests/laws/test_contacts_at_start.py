"""How the contacts of a model are at its start: by its numbers; where one is missing, what was assumed is said."""

from __future__ import annotations

import json
import pickle
import subprocess
from pathlib import Path

import pytest

import eomgen
from eomgen.codegen.rhs import RightHandSide
from eomgen.errors import OpenConstraints
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.free_bodies.friction import equations_of_motion
from eomgen.mechanics.kinematics.scene import ContactMode
from eomgen.mechanics.start import state as open_constraints
from eomgen.mechanics.start.state import Start
from eomgen.proof.contact_phases import leaving_at_start
from eomgen.questions.reactions import reactions_document
from eomgen.simulation.phase_models import PhaseModels

MODELS = Path(__file__).parents[2] / "models"
BALL = """
eomgen = 1
space = "plane"
[parameters]
m = 1.0
g = 9.81
h = HEIGHT
[coordinates]
x = 0
y = { start = "START" }
[bodies.ball]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", "y"] }
[constraints.floor]
kind = "support"
point = "ball.center"
at = [0, 0]
normal = [0, 1]
unilateral = true
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
SLEEVE = """
eomgen = 1
space = "plane"
[parameters]
m = MASS
[coordinates]
x = { start = 0.2, speed = 0.5 }
y = 0.3
[bodies.sleeve]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", "y"] }
[constraints.bar]
kind = "support"
point = "sleeve.center"
at = [0, 0.3]
normal = [0, NORMAL]
friction = 0.2
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""


def ball(height: str = "1", start: str = "h") -> eomgen.Model:
    return eomgen.loads(BALL.replace("HEIGHT", height).replace("START", start))


def sleeve(mass: str = "2", normal: str = "1") -> eomgen.Model:
    return eomgen.loads(SLEEVE.replace("MASS", mass).replace("NORMAL", normal))


@pytest.mark.parametrize(("model", "open"), [(ball(), True), (ball("0"), False), (ball("{ unit = 'm' }", "0"), False)])
def test_a_contact_is_open_where_its_gap_is_positive_and_nothing_is_assumed(model, open):
    """y > 0 at the start: no row of the floor; y = 0, whatever h: one."""
    equations = eomgen.derive(model)
    assert equations.assumptions == () and len(equations.graph.J) == (not open)


def test_a_gap_that_hangs_on_a_missing_number_is_assumed_closed_and_said_in_every_format():
    """y(0) = h, h has no value: closed, in words."""
    equations, words = eomgen.derive(ball("{ unit = 'm' }")), "floor assumed closed: h has no value"
    assert equations.assumptions == (words,) and len(equations.graph.J) == 1
    for format in ("text", "latex", "markdown"):
        assert words in equations.render(format)
    assert json.loads(equations.render("json"))["assumptions"] == [words]


def test_a_start_inside_of_a_contact_is_said():
    """y(0) = -0.25: the ball is below its floor."""
    assert eomgen.derive(ball("-0.25")).assumptions == ("floor assumed closed: the start passes through it, by 0.25 m",)


@pytest.mark.parametrize(("normal", "push"), [("1", 1), ("-1", -1)])
def test_what_holds_both_ways_pushes_by_the_sign_of_its_normal_force(normal, push):
    """N = m g along +y: against a normal that points down."""
    equations = eomgen.derive(sleeve(normal=normal))
    assert equations.system.modes.get("bar", ContactMode()).push == push and equations.assumptions == ()
    assert equations.certify().ok


def test_a_normal_force_without_a_number_is_assumed_to_push_along_its_normal():
    assert eomgen.derive(sleeve(mass="{ unit = 'kg' }")).assumptions == (
        "bar assumed to push along its normal: m has no value",
    )


def test_modes_that_are_given_are_taken():
    """The floor open although the ball lies on it; closed although it does not."""
    assert not eomgen.derive(ball("0"), contacts={"floor": ContactMode(closed=False)}).graph.J
    assert len(eomgen.derive(ball(), contacts={}).graph.J) == 1


@pytest.mark.slow
def test_derive_runs_no_simulation_and_no_compiler(monkeypatch):
    """Of every model with contacts: no program is made, no phase is looked at."""

    def refused(*_, **__):
        raise AssertionError("derive ran a simulation, a program or a compiler")

    monkeypatch.setattr(PhaseModels, "of", refused)
    monkeypatch.setattr(RightHandSide, "__init__", refused)
    monkeypatch.setattr(subprocess, "run", refused)
    touched = [model for path in sorted(MODELS.rglob("*.toml")) if (model := eomgen.load(path)).contacts]
    for model in touched:
        eomgen.derive(model)
    assert len(touched) > 8


def test_what_is_assumed_of_contacts_stands_with_small_motions_too():
    """A mass on a spring over a floor of unknown height."""
    text = BALL.replace("HEIGHT", "{ unit = 'm' }").replace("START", "h")
    text += '\n[forces.coil]\nkind = "generalized"\ncoordinate = "x"\nvalue = "-50*x"\n'
    found, words = eomgen.linearize(eomgen.loads(text), about="equilibrium"), "floor assumed closed: h has no value"
    assert found.assumptions == (words,) and found.as_dict()["assumptions"] == [words]
    assert f"{words}." in found.render("text")


ROUGH = """
eomgen = 1
space = "plane"
[parameters]
m = 3.0
mu = 0.5
g = 10
P = PUSH
v = SPEED
[coordinates]
s = { speed = "v" }
[bodies.crate]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["s", "z"] }
[coordinates.z]
start = 0
[constraints.floor]
kind = "support"
point = "crate.center"
normal = [0, 1]
unilateral = true
friction = "mu"
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[forces.push]
kind = "force"
point = "crate.center"
force = ["P", "-P/10"]
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("push", "speed", "friction"),
    [(6.0, 0.0, -6.0), (-6.0, 0.0, 6.0), (40.0, 0.0, -17.0), (-40.0, 0.0, 13.0), (6.0, 0.1, -15.3), (6.0, -0.1, 15.3)],
)
def test_friction_of_what_does_not_slide_at_the_start_is_that_of_its_first_phase(push, speed, friction):
    """F = -P while |P| <= mu N, N = m g + P/10; else mu N against the motion that begins; `solve` says the same."""
    text = ROUGH.replace("PUSH", str(push)).replace("SPEED", str(speed))
    model = eomgen.loads(text)
    found, reported = eomgen.reactions(model), " ".join(reactions_document(model, certify=False).notes)
    requested = eomgen.solve(eomgen.loads(text + '[outputs]\nF = "reaction_t(floor)"'))["F"]
    assert found["reaction_t(floor)"].value == pytest.approx(friction) == requested.value
    assert found.certify().ok
    words = "do not slide at the start: floor; the reactions are those there"
    assert (words in reported) == (speed == 0)


def test_a_contact_that_is_taken_as_closed_and_opens_with_the_speeds_is_contradicted():
    """Thrown up from the floor, y' = 1.2: closed at the start is wrong; let go from rest it is right."""
    thrown = BALL.replace("HEIGHT", "0").replace('{ start = "START" }', "{ start = 0, speed = 1.2 }")
    resting = BALL.replace("HEIGHT", "0").replace('"START"', "0")
    reported = [leaving_at_start(equations_of_motion(System.of(eomgen.loads(text)))) for text in (thrown, resting)]
    assert reported == ["'floor' is closed, and opens with 1.2 m/s where the motion starts", ""]


def test_places_of_rest_have_no_speeds_of_the_start():
    """Thrown up, the ball's contact is open as the motion begins; where it rests it is closed: both are proven."""
    thrown = eomgen.loads(BALL.replace("HEIGHT", "0").replace('{ start = "START" }', "{ start = 0, speed = 1.2 }"))
    found = eomgen.statics(thrown)
    assert found.places and found.certify().ok
    assert eomgen.derive(thrown).certify().ok


@pytest.mark.slow
def test_how_near_ties_come_to_closing_is_sought_for_a_reader_alone(monkeypatch):
    """That a contact is open at the start is found by its gap; the search, of seconds beside a loop, is for words."""
    model = eomgen.loads(BALL.replace("HEIGHT", "0.5").replace('{ start = "START" }', "0.5"))
    sought = []
    monkeypatch.setattr(open_constraints, "nearest_miss", lambda *_: sought.append(1))
    assert eomgen.derive(model).graph.system.modes["floor"].closed is False
    assert eomgen.simulate(model, time=0.1, target="numpy").ok
    assert not sought
    with pytest.raises(OpenConstraints) as refused:
        Start.of(System.of(model))
    assert "open by 0.5" in str(pickle.loads(pickle.dumps(refused.value)))
    assert sought == [1]
