"""Messages about a value name the file and the line in which the parameter or coordinate is declared."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from eomgen.cli import main
from eomgen.errors import MissingValues, Problem
from eomgen.model.reader import located

MODEL = """eomgen = 1
space = "plane"
[parameters]
m = { unit = "kg" }
k = { value = 3, unit = "N/m" }
s0 = { unit = "m" }
[coordinates]
x = { start = "s0" }
[bodies.b]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k" }
"""


@pytest.mark.parametrize("verb", [("simulate", "--time", "1"), ("animate", "-o", "a.png"), ("play", "-o", "p.html")])
def test_a_parameter_without_a_value_is_named_where_it_is_declared(verb: tuple[str, ...], tmp_path: Path):
    """file:4:1 of m, file:6:1 of s0: every one that lacks a value."""
    path = tmp_path / "m.toml"
    path.write_text(MODEL)
    found = CliRunner().invoke(main, [verb[0], str(path), *verb[1:]])
    assert found.exit_code == 1
    for line, name in ((4, "m"), (6, "s0")):
        assert re.search(rf"m\.toml:{line}:1: no value for parameter '{name}'\n    {name} = ", found.stderr)


def test_a_message_without_a_place_is_told_at_what_it_names():
    """'x' is declared in line 8, 'm' in line 4; of what is in no table, or in two, nothing is guessed."""
    data = MODEL.encode()

    def place(what: str) -> str:
        return located(Problem("", what), data, "f", by_name=True).where

    assert place("'x' leaves all bounds") == "f:8:1"
    assert place("no start for 'x'' beside 'm'") == "f:8:1"
    assert place("the mass 'm' is too small") == "f:4:1"
    assert place("nobody declares 'z'") == ""
    two = (MODEL + "[outputs]\nk = 'k'\n").encode()
    assert located(Problem("", "'k' is below zero"), two, "f", by_name=True).where == ""
    assert located(Problem("", "'x' leaves all bounds"), data, "f").where == ""


def test_missing_values_are_told_one_by_one():
    """Each its own problem, at its own parameter; together in one line for Python."""
    error = MissingValues(("m", "s0"))
    assert [problem.where for problem in error.problems] == ["parameters.m", "parameters.s0"]
    assert error.what == "no value for parameters 'm', 's0'"
