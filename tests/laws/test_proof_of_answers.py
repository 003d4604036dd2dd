"""Answers carry their proof: an error in a value, a text, an instant, a law or a definition is seen."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from click.testing import CliRunner
from slider_crank import SLIDER_CRANK

import eomgen
from eomgen.cli import main
from eomgen.model.forces import weights as distributed
from eomgen.proof.answers import _by_coincidence
from eomgen.questions import outputs_answered as answers
from eomgen.study import StateAtInstant

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent.parent / "models"
FORMULAS = "formulas, read back, hold at other states"
TEXTS = "exact texts, read back, give the numbers"
NUMBERS = "numbers are those of the formulas at the state"
INSTANTS = "a run in time leads to the requested instants"
WAYS = "functions of the configuration hold along the motion"
REST = "at rest all forces balance"


def solved(text: str):
    return eomgen.solve(eomgen.loads(text))


def failing(found) -> dict[str, str]:
    return {check.name: check.detail for check in found.certify().checks if check.status == "fails"}


def holding(found) -> set[str]:
    return {check.name for check in found.certify().checks if check.status == "holds"}


PENDULUM = """
eomgen = 1
space = "plane"
[parameters]
g = 9.81
l = 0.5
m = 2
[coordinates]
phi = { start = "pi/3" }
[bodies.rod]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "phi - pi/2" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
[outputs]
force = { value = "reaction_y(rod)" }
speed_of_end = { value = "vx(rod.end)", at = "phi = 0" }
kinetic = { value = "kinetic_energy()", from = "start" }
rest = { value = "x(rod.end)", at = "equilibrium" }
"""


def test_every_way_to_an_answer_is_proven():
    """At the start, at an instant, along the motion, at rest."""
    found = solved(PENDULUM)
    assert not failing(found)
    assert {TEXTS, NUMBERS, INSTANTS, WAYS, REST} <= holding(found)
    assert isinstance(found, dict) and list(found) == ["force", "speed_of_end", "kinetic", "rest"]


def test_a_number_that_lost_its_digits_is_seen():
    """A driven slider-crank at 30 degrees: 3829276.778 N was said for 3407.9598222043 N."""
    found = solved(SLIDER_CRANK + 'B30 = { value = "reaction_x(B)", at = "a = pi/6" }\n')
    assert found["B30"].value == pytest.approx(3407.9598222043, rel=1e-12)
    assert NUMBERS in holding(found) and not failing(found)
    found["B30"] = replace(found["B30"], value=3829276.778)
    assert NUMBERS in failing(found)
    found["B30"] = replace(found["B30"], value=3407.9598222043 * (1 + 1e-7))
    assert NUMBERS in failing(found)


@pytest.mark.parametrize("name", ["force", "speed_of_end", "rest"])
def test_a_text_that_says_something_else_is_seen(name):
    """The number is right, the formula beside it is twice as large."""
    found = solved(PENDULUM)
    exact = found[name].exact if found[name].exact != "0" else "l"
    found[name] = replace(found[name], exact=f"2*({exact})" if exact != "l" else "l")
    wrong = failing(found)
    assert {TEXTS} <= wrong.keys() <= {TEXTS, FORMULAS} and name in wrong[TEXTS]


def test_a_wrong_sense_of_the_speed_is_seen():
    """sqrt(...) with the other sign: text and number agree, the motion does not."""
    found = solved(PENDULUM)
    answer = found["speed_of_end"]
    found["speed_of_end"] = replace(answer, exact=f"-({answer.exact})", value=-answer.value)
    assert set(failing(found)) == {NUMBERS}


def test_a_wrong_law_of_the_configuration_is_seen():
    """T = m g l (cos phi - cos phi_0)/2 with another factor: right at the start, wrong on the way."""
    found = solved(PENDULUM)
    found["kinetic"] = replace(found["kinetic"], exact=f"3/2*({found['kinetic'].exact})")
    assert set(failing(found)) == {WAYS}


def test_an_instant_that_is_not_the_first_is_seen(monkeypatch):
    """phi = 0 after a quarter of the period: with a time a tenth later the state is none of the motion."""
    until = answers.MotionFromStart.until

    def late(self, condition, side=None):
        found = until(self, condition, side)
        t = found.phase.system.symbols.t
        return StateAtInstant(found.phase, found.exact, {**found.numbers, t: 1.1 * found.numbers[t]}, found.method)

    monkeypatch.setattr(answers.MotionFromStart, "until", late)
    assert INSTANTS in failing(solved(PENDULUM))


def test_a_place_that_is_no_rest_is_seen(monkeypatch):
    """phi = 0.01 in place of 0."""
    resting = StateAtInstant.resting

    def aside(study):
        found = resting(study)
        (phi,) = found.phase.system.symbols.q
        return StateAtInstant(found.phase, found.exact, {**found.numbers, phi: 0.01}, found.method)

    monkeypatch.setattr(StateAtInstant, "resting", aside)
    assert REST in failing(solved(PENDULUM))


def test_a_velocity_that_is_another_component_is_seen(monkeypatch):
    """vx read as vy by the solver and by its proof alike: it is not the rate of x."""
    from eomgen.mechanics.instant.quantities import Quantities

    value = Quantities.value

    def swapped(self, call):
        return value(self, replace(call, name="vy") if call.name == "vx" else call)

    monkeypatch.setattr(Quantities, "value", swapped)
    text = PENDULUM.replace('at = "phi = 0"', 'at = "phi = pi/6"')
    assert "functions of the motion hold by their second definitions" in failing(solved(text))


def test_units_are_part_of_what_is_read_back():
    """A value in km/h beside a formula in m/s."""
    text = PENDULUM.replace('vx(rod.end)", at', 'vx(rod.end)", unit = "km/h", at')
    found = solved(text)
    assert not failing(found)
    found["speed_of_end"] = replace(found["speed_of_end"], value=found["speed_of_end"].value / 3.6)
    assert set(failing(found)) == {NUMBERS, TEXTS}


def test_a_failing_proof_ends_in_exit_3(monkeypatch, tmp_path):
    """The result is shown and marked; --no-certify shows it as it is."""
    path = tmp_path / "pendulum.toml"
    path.write_text(PENDULUM)
    answer = answers._Solver.answer

    def doubled(self, output):
        found = answer(self, output)
        return replace(found, value=2 * found.value)

    monkeypatch.setattr(answers._Solver, "answer", doubled)
    found = CliRunner().invoke(main, ["solve", str(path), "--json"])
    certificate = json.loads(found.stdout)["certificate"]
    assert found.exit_code == 3 and certificate["ok"] is False
    text = CliRunner().invoke(main, ["solve", str(path)])
    assert text.stdout.startswith("the certificate FAILS") and "certificate: FAILS" in text.stdout
    free = CliRunner().invoke(main, ["solve", str(path), "--no-certify", "--json"])
    assert free.exit_code == 0 and json.loads(free.stdout)["certificate"] is None


APART = {
    "small": "answers of small motions are those of the matrices in numbers",
    "instant": "answers of the instant are those of its proven state",
}


@pytest.mark.parametrize(("model", "kind"), [("two_mass_oscillator", "small"), ("seeds/ch11_p4", "instant")])
def test_what_is_of_no_state_of_a_motion_is_proven_too(model, kind):
    """Frequencies by the matrices in numbers; a mechanism's instant by the state that `kinematics` proves."""
    found = eomgen.solve(MODELS / f"{model}.toml")
    assert not failing(found) and APART[kind] in holding(found)
    name = next(name for name in reversed(found) if found[name].value)
    number, text = found[name].value, found[name].exact
    found[name] = replace(found[name], value=number * 1.001, exact=None)
    assert APART[kind] in failing(found)
    if kind == "instant":
        found[name] = replace(found[name], value=number, exact=f"2*({text})")
        assert APART[kind] in failing(found)


HANGING = """
eomgen = 1
space = "plane"
parameters = { m = 2, k = 50, g = 10 }
coordinates = { x = 0.1 }
points = { O = [0, 0] }
bodies.block.shape = { kind = "particle", mass = "m" }
bodies.block.joint = { kind = "prismatic", axis = [0, -1], displacement = "x" }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
forces.spring = { kind = "spring", points = ["O", "block.center"], stiffness = "k", length = 0 }
outputs = { low = { value = "x", at = "equilibrium" }, fast = { value = "x'", at = "x = 0.2" } }
"""


def test_a_closed_form_holds_beside_the_parameters_too():
    """x = m g/k = 2/5 at rest: the number 2/5 in its place balances at these parameters alone."""
    found = solved(HANGING)
    moment = found._solver.at_rest
    (x,) = moment.phase.system.symbols.q
    wrong = replace(moment, exact={**moment.exact, x: Fraction(2, 5)})
    assert found["low"].exact == "m*g/k" and failing(found) == {}
    assert _by_coincidence(moment, None) == "" and "by coincidence" in _by_coincidence(wrong, None)
    there = found._solver.motions[False].until(at := found._solver.model.outputs["fast"].at)
    if all(node in there.exact for node in (x, *moment.phase.system.symbols.u)):
        assert _by_coincidence(there, at) == ""
        assert "by coincidence" in _by_coincidence(replace(there, exact={**there.exact, x: Fraction(1, 4)}), at)


def test_a_load_on_what_stands_is_the_one_that_is_declared(monkeypatch):
    """A = q L/2 of a beam, by the fields of its load: what pushes otherwise is seen where no coordinate moves."""
    text = """
eomgen = 1
space = "plane"
bodies.beam = { points = { A = [0, 0], B = [4, 0] } }
[constraints]
A = { kind = "pin", points = ["beam.A"] }
B = { kind = "support", point = "beam.B", normal = [0, 1] }
[forces]
load = { kind = "distributed", body = "beam", between = ["A", "B"], intensity = [0, -3] }
[outputs]
A = "reaction_y(A)"
"""
    assert solved(text)["A"].exact == "6" and not failing(solved(text))
    resultant = distributed._resultant
    monkeypatch.setattr(distributed, "_resultant", lambda length, near, far: resultant(2 * length, near, far))
    assert any("applied" in name for name in failing(solved(text)))
