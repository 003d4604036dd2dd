"""Mechanisms of which every coordinate is given or follows: no speed is left, and every verb answers all the same."""

from __future__ import annotations

import math

import pytest
from click.testing import CliRunner
from slow_run import sampled

import eomgen
from eomgen.cli import main

pytestmark = pytest.mark.slow

RUBBING = """
eomgen = 1
space = "plane"
[parameters]
r = 0.2
w = 5
m = 2
mu = 0.3
g = 9.81
[coordinates]
x = { motion = "r*cos(w*t)" }
y = { dependent = true, start = 0 }
[bodies.block]
shape = { kind = "particle", mass = "m" }
joint = { kind = "planar", x = "x", y = "y", angle = 0 }
[constraints.floor]
kind = "support"
point = "block.center"
normal = [0, 1]
friction = "mu"
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
F = { value = "reaction_t(floor)", at = "t = 0.9" }
"""
"""A block is pushed to and fro on a floor: its friction turns at t = k pi/w."""

GUIDED = """
eomgen = 1
space = "plane"
[parameters]
l = 0.5
w = 3
m = 1
g = 9.81
[coordinates]
phi = { motion = "w*t" }
x = { dependent = true, start = 0.5 }
y = { dependent = true, start = 0 }
[bodies.crank]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "phi" }
[bodies.pin]
shape = { kind = "particle", mass = "m" }
joint = { kind = "planar", x = "x", y = "y", angle = 0 }
[constraints.hinge]
kind = "pin"
points = ["crank.end", "pin.center"]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""

CALLS = {
    "check": "check",
    "derive": "derive",
    "latex": "solve --format latex",
    "solve": "solve",
    "reactions": "reactions",
    "kinematics": "kinematics",
    "inertia": "inertia",
    "simulate": "simulate --time 1.5",
    "sweep": "sweep --over m=1,2 --time 1 --ask power()",
    "report": "report --time 0.7 -o {folder}/r.html",
    "play": "play --time 0.7 -o {folder}/p.html",
    "strip": "animate --time 0.7 --forces -o {folder}/a.png",
    "codegen": "codegen --target numpy -o {folder}/code",
}


@sampled(2)
@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("text", [RUBBING, GUIDED], ids=["friction that turns", "a pin that is carried along"])
def test_what_is_driven_wholly_is_answered_by_every_verb(tmp_path, text, call):
    """No rates are free: arrays of 0 columns come through, and nothing ends in an internal error"""
    file = tmp_path / "model.toml"
    file.write_text(text)
    verb, *words = CALLS[call].format(folder=tmp_path).split()
    result = CliRunner().invoke(main, [verb, str(file), *words])
    assert result.exit_code == 0, result.output[-800:]


def test_friction_of_a_block_that_is_pushed_to_and_fro():
    """-mu m g sign(x'), x' = -r w sin(w t): at t = 0.9, 4.5 rad, the block moves to +x; F = -mu m g"""
    answer = eomgen.solve(eomgen.loads(RUBBING))["F"]
    assert abs(answer.value) == pytest.approx(0.3 * 2 * 9.81) and math.sin(5 * 0.9) < 0
    run = eomgen.simulate(eomgen.loads(RUBBING), time=1.5)
    assert len(run.phases) == 3 and run.certify().ok


@pytest.mark.parametrize("name", ["arm3", "double_pendulum", "four_bar"])
def test_a_file_that_asks_nothing_is_typeset_all_the_same(name):
    """`solve --format latex` of a model without [outputs]: a step without statements"""
    from pathlib import Path

    path = Path(__file__).parent.parent / "models" / f"{name}.toml"
    text = path.read_text().split("[outputs")[0]
    for form in ("latex", "markdown", "text", "json"):
        result = CliRunner().invoke(main, ["solve", "-", "--format", form], input=text)
        assert result.exit_code == 0, result.output[-500:]


def test_answers_of_what_is_driven_wholly_rest_on_proven_rates():
    """No speed is left, and the rates that follow are put to the constraints all the same."""
    certificate = eomgen.solve(eomgen.loads(GUIDED + '[outputs]\nv = "vx(pin.origin)"\n')).certify()
    assert certificate.ok and "eliminated rows hold whatever the speeds" in [x.name for x in certificate.checks]
