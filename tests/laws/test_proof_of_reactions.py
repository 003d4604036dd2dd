"""Reactions carry their proof: a formula that says something else, and a number that is another, are seen."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

import eomgen
from eomgen.cli import main

MODELS = Path(__file__).parent.parent.parent / "models"
BALANCE = "formulas, read back, are the reactions of the free bodies"
START = "formulas, read back, give the numbers at the start"
STATE = "numbers are those of the formulas at the state"


def reactions(name: str, **requested):
    return eomgen.reactions(eomgen.load(MODELS / f"{name}.toml"), **requested)


def failing(found) -> set[str]:
    return {check.name for check in found.certify().checks if check.status == "fails"}


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["simple_pendulum", pytest.param("slider_crank", marks=pytest.mark.slow), "sliding_ladder", "four_bar"]
)
def test_formulas_and_numbers_hold(name):
    """Trees, loops and contacts; formulas with accelerations left in them; numbers without a formula."""
    certificate = reactions(name).certify()
    assert certificate.ok, str(certificate)
    assert any("formula" in check.name and check.status == "holds" for check in certificate.checks)


def test_a_sign_in_a_formula_is_seen():
    """-R for R is right nowhere."""
    found = reactions("simple_pendulum")
    name = "reaction_x(rod)"
    found[name] = replace(found[name], exact=f"-({found[name].exact})")
    assert failing(found) == {BALANCE, START}


def test_a_term_that_vanishes_at_the_start_is_seen():
    """The pendulum starts at rest: a forgotten m l theta'^2 shows at other states alone."""
    found = reactions("simple_pendulum")
    name = "reaction_y(rod)"
    found[name] = replace(found[name], exact=f"({found[name].exact}) + theta'^2")
    assert failing(found) == {BALANCE}


def test_a_wrong_number_at_the_start_is_seen():
    """A millionth off."""
    found = reactions("simple_pendulum")
    name = "reaction_y(rod)"
    found[name] = replace(found[name], value=found[name].value * (1 + 1e-6))
    assert failing(found) == {START}


@pytest.mark.slow
def test_a_wrong_number_at_an_instant_is_seen():
    """The proof of outputs, under the names of the reactions."""
    found = reactions("simple_pendulum", at="theta = 0")
    assert found.certify().ok
    name = "reaction_y(rod)"
    found[name] = replace(found[name], value=1.001 * found[name].value)
    wrong = [check for check in found.certify().checks if check.name == STATE and check.status == "fails"]
    assert wrong and wrong[0].detail.startswith(f"{name}: ")


def test_the_command_tells_the_proof():
    """In text, in JSON; null with --no-certify."""
    words = ["reactions", str(MODELS / "simple_pendulum.toml")]
    assert "certificate: holds" in CliRunner().invoke(main, words).stdout
    assert json.loads(CliRunner().invoke(main, [*words, "--json"]).stdout)["certificate"]["ok"] is True
    assert json.loads(CliRunner().invoke(main, [*words, "--json", "--no-certify"]).stdout)["certificate"] is None


CRAB = """eomgen = 1
name = "Crab, hoisting"
space = "plane"
[parameters]
mt = { value = 500, unit = "kg" }
mp = { value = 2, unit = "t" }
c = { value = 50, unit = "N*s/m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
x = { start = 2, unit = "m" }
phi = { start = 0, unit = "deg" }
s = { motion = "12 - t/2" }
[points]
O = [0, 0]
[bodies.trolley]
shape = { kind = "particle", mass = "mt" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[bodies.rope]
joint = { kind = "revolute", on = "trolley", angle = "phi" }
[bodies.load]
shape = { kind = "particle", mass = "mp" }
joint = { kind = "prismatic", on = "rope", axis = [0, -1], displacement = "s" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[forces.drag]
kind = "damper"
points = ["load.origin", "O"]
damping = "c"
"""


@pytest.mark.slow
def test_a_reaction_divides_by_nothing_that_its_loads_do_not_divide_by():
    """Hanging straight N = (mt + mp) g + F cos, not (mt x'' - ...)/tan(phi), which has no value there; F = c |r'|."""
    found = eomgen.reactions(eomgen.loads(CRAB))
    r = (4 + 144) ** 0.5
    push = 50 * (12 * 0.5 / r) * 12 / r  # of the damper that shortens, downwards on the load
    assert found["reaction_n(trolley)"].value == pytest.approx(2500 * 9.81 + push)
    checks = {check.name: check.status for check in found.certify().checks}
    assert checks[START] == checks[BALANCE] == "holds"
