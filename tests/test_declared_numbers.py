"""Numbers of a file against another reading of it: units, formulas of parameters, starts."""

from __future__ import annotations

import json
from pathlib import Path

from click.testing import CliRunner
from each import each

import eomgen
from eomgen.cli import main
from eomgen.proof.declared_numbers import numbers_otherwise
from eomgen.symbolic.expression.formula import Expression

MODEL = """
eomgen = 1
space = "plane"
[parameters]
m = { value = 250, unit = "g" }
l = { value = 40, unit = "cm" }
k = { value = 3, unit = "N*mm/deg" }
d = { value = 2, unit = "N*m/(rad/s)" }
w = { value = 30, unit = "rpm" }
twice = "2*l^2 - sqrt(m)/3"
g = 9.81
[coordinates]
q = { start = 30, unit = "deg", speed = 5 }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
points = { hook = [0, "l"] }
joint = { kind = "revolute", point = "hook", angle = "q" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def test_each_number_is_that_of_the_file_in_its_unit():
    """value in SI = number times the size of its unit; a formula of parameters as Python works it out."""
    model = eomgen.loads(MODEL)
    assert numbers_otherwise(MODEL.encode(), model) == ""
    for old, new, name in (
        ('"g" }', '"kg" }', "m"),
        ("value = 40", "value = 4", "l"),
        ("N*mm/deg", "N*m/deg", "k"),
        ("rpm", "rev/s", "w"),
        ("2*l^2", "2*l^3", "twice"),
        ("start = 30", "start = -30", "q.start"),
        ("speed = 5", "speed = 6", "q.speed"),
    ):
        assert f"'{name}'" in numbers_otherwise(MODEL.replace(old, new).encode(), model), old


def test_a_unit_that_is_lost_ends_a_verb(monkeypatch, tmp_path):
    """40 cm read as 40 m: exit 3, and the number is named."""
    path = tmp_path / "m.toml"
    path.write_text(MODEL)
    monkeypatch.setattr(Expression, "scaled", lambda self, factor, pi_power=0: self)
    done = CliRunner().invoke(main, ["check", str(path), "--json"])
    reported = json.loads(done.stdout)["error"]["problems"][0]["what"]
    assert done.exit_code == 3 and "the file's number of 'm' is 0.25 in SI, and 250 was read" in reported


@each("path", sorted((Path(__file__).parents[1] / "models").rglob("*.toml")))
def test_no_model_that_ships_is_contradicted(path):
    """The same numbers in every file."""
    assert numbers_otherwise(path.read_bytes(), eomgen.load(path)) == ""
