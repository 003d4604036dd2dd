"""Generated code carries its proof: the text that is written is run, and an error in any function of it is seen."""

from __future__ import annotations

import json
from copy import copy
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from click.testing import CliRunner
from forked import needs_sh
from slow_run import beside, sampled
from tools import each_target, every_target

import eomgen
from eomgen.cli import main
from eomgen.codegen import build
from eomgen.codegen.targets import ALL

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent.parent / "models"
ROLES = ("rhs", "reactions", "outputs", "matrices", "jacobian", "inverse", "regressor")
needs_cc = pytest.mark.skipif(build.compiler() is None, reason="no C compiler")


def generated(target: str, name: str = "cart_pole"):
    actuated = {"four_bar": ("alpha",), "robot_with_trailer": ("left", "right")}.get(name, ())
    model, slopes = eomgen.load(MODELS / f"{name}.toml"), name != "robot_with_trailer"
    return eomgen.generate(model, (target,), name=name, actuated=actuated, jacobian=slopes, regressor=slopes)


@cache
def generated_once(target: str, name: str = "cart_pole"):
    return generated(target, name)


def failing(found) -> set[str]:
    return {check.name for check in found.certify().checks if check.status == "fails"}


@sampled(2)
@each_target
@pytest.mark.parametrize("name", [*beside("cart_pole"), "four_bar"])  # the other is asked below, role by role
def test_every_function_that_is_written_is_run(target, name):
    """Equations, reactions, inverse dynamics and Y in each language, trees and loops."""
    certificate = generated_once(target, name).certify()
    assert certificate.ok, str(certificate)
    held = [check.name for check in certificate.checks if check.status == "holds"]
    for role in ROLES:
        assert f"{name}_{role} in {target} gives the symbols' numbers" in held


@needs_cc
def test_redundant_ties_that_contradict_one_another_say_nothing_of_the_code():
    """Two wheels on one axle: at a random state their rows contradict, and no acceleration is the right one."""
    certificate = generated("c", "robot_with_trailer").certify()
    (reactions,) = (check for check in certificate.checks if "robot_with_trailer_reactions in c" in check.name)
    assert certificate.ok and reactions.status == "holds", str(certificate)


@sampled(3)
@each_target
@pytest.mark.parametrize("first", range(2))
def test_a_wrong_letter_in_a_file_is_seen_there_and_in_no_other(target, first):
    """The cosine of a joint's angle written as its sine in every second function: these fail, and none beside them."""
    found, roles = copy(generated_once(target)), ROLES[first::2]
    texts = {
        path: text.replace("cos(theta)", "sin(theta)") if Path(path).stem.endswith(roles) else text
        for path, text in found.texts.items()
    }
    assert sum(texts[path] != text for path, text in found.texts.items()) >= len(roles)
    assert found is not generated_once(target)
    found.__dict__["_files"] = copy(found._files)
    found._files.__dict__["texts"] = texts
    assert failing(found) == {f"cart_pole_{role} in {target} gives the symbols' numbers" for role in roles}


@needs_cc
@needs_sh
def test_code_that_is_wrong_is_not_written(monkeypatch, tmp_path):
    """A compiler that bends sine: exit 3, no files, the certificate in JSON; with --no-certify the files come."""
    script = tmp_path / "cc"
    script.write_text(f'#!/bin/sh\nexec {build.compiler()} -Dsin=tanh "$@"\n')
    script.chmod(0o755)
    monkeypatch.setenv("CC", str(script))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    words = ["codegen", str(MODELS / "simple_pendulum.toml"), "-o", str(tmp_path / "out"), "--json"]
    found = CliRunner().invoke(main, words)
    reported = json.loads(found.stdout)
    assert found.exit_code == 3 and reported["files"] == [] and reported["certificate"]["ok"] is False
    assert not (tmp_path / "out").exists()
    free = CliRunner().invoke(main, [*words, "--no-certify"])
    assert free.exit_code == 0 and len(json.loads(free.stdout)["files"]) == 10


def test_a_language_that_nothing_here_runs_is_unchecked(monkeypatch):
    """No contradiction and no proof: 'could not be checked' is its own word."""
    silent = [replace(target, run=None) for target in ALL]
    monkeypatch.setattr("eomgen.codegen.rhs.ALL", tuple(silent))
    certificate = generated("numpy").certify()
    left = {check.name: check.detail for check in certificate.checks if check.status == "unchecked"}
    assert left["cart_pole_rhs in numpy gives the symbols' numbers"] == "nothing here runs numpy"
    assert certificate.ok  # the equations hold


HOSTILE = """
eomgen = 1
name = "x\\"\\"\\"\\nopen('MARK', 'w')\\n\\"\\"\\"\\"\\"*/ \\\\"
about = "y\\n\\"\\"\\"\\nopen('MARK', 'w') \\\\"
source = "\\"\\"\\"\\"\\nopen('MARK', 'w')"
space = "plane"
[parameters]
import = { value = 2, about = "m\\nopen('MARK', 'w') */ int main(){" }
[coordinates]
lambda = { start = 0.3, about = "q\\nopen('MARK', 'w')" }
[bodies.b]
mass = 1
inertia = "import"
joint = { kind = "revolute", angle = "lambda", torque = 1 }
"""


@sampled(3)
@every_target
def test_nothing_that_a_model_says_is_executed_when_its_files_are_run(target, tmp_path):
    """Names and remarks of a stranger stand in headers and comments; no quote and no line end leaves them."""
    mark = tmp_path / "mark"
    model = eomgen.loads(HOSTILE.replace("MARK", str(mark)))
    assert model.name.count(chr(34) * 3) and mark.name in model.name
    assert eomgen.generate(model, (target,), name="a); import os; (").certify().ok
    assert not mark.exists()
