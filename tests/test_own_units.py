"""What a run gives, in the units of the file: the CLI's table, --units of the CSV; plain names are SI."""

from __future__ import annotations

import csv
import json
from math import pi
from pathlib import Path

import pytest
from click.testing import CliRunner

import eomgen
from eomgen.cli import main

WHEEL = """
eomgen = 1
name = "Wheel"
space = "plane"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 50, unit = "cm" }
[coordinates]
x = { start = 20, speed = 5, unit = "cm" }
phi = { start = 30, speed = 90, unit = "deg" }
[bodies.cart]
mass = "m"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[bodies.wheel]
shape = { kind = "disc", mass = "m", radius = "l" }
joint = { kind = "revolute", on = "cart", angle = "phi" }
"""


def run(folder: Path, *words: str) -> tuple[str, list[list[str]]]:
    (folder / "wheel.toml").write_text(WHEEL)
    file = folder / "run.csv"
    requested = [
        "simulate",
        str(folder / "wheel.toml"),
        "--time",
        "1",
        "--samples",
        "2",
        "--target",
        "numpy",
        "--no-certify",
    ]
    result = CliRunner().invoke(main, [*requested, "-o", str(file), *words])
    assert result.exit_code == 0, result.stderr
    return result.stderr, list(csv.reader(file.open()))


def test_the_first_line_of_a_csv_is_plain_names_and_its_numbers_are_si(tmp_path):
    """x = 0.2 m, phi = pi/6."""
    _, (head, first, _) = run(tmp_path)
    assert head[:6] == ["t", "x", "phi", "x'", "phi'", "energy"]
    assert list(map(float, first[1:5])) == pytest.approx([0.2, pi / 6, 0.05, pi / 2], rel=1e-15)


def test_with_units_its_columns_are_in_those_of_the_file(tmp_path):
    """x [cm], phi [deg], their rates per second; after a second x = 25 cm, phi = 120 deg."""
    _, (head, first, last) = run(tmp_path, "--units")
    assert head[:6] == ["t [s]", "x [cm]", "phi [deg]", "x' [cm/s]", "phi' [deg/s]", "energy [J]"]
    assert list(map(float, first[1:5])) == pytest.approx([20, 30, 5, 90], rel=1e-14)
    assert list(map(float, last[1:3])) == pytest.approx([25, 120], rel=1e-9)


def test_the_table_of_a_run_is_in_the_units_of_the_file(tmp_path):
    """phi [deg]  30  120."""
    reported, _ = run(tmp_path)
    assert ["phi", "[deg]", "30", "120"] in [line.split() for line in reported.splitlines()]


def test_reactions_and_functions_have_units_by_what_they_are():
    """N of a force, N*m of a couple, rad/s of omega; what nobody knows has none."""
    model = eomgen.loads(WHEEL.replace('start = 20, speed = 5, unit = "cm"', "start = 20"))
    names = ("reaction_x(wheel)", "reaction_couple(cart)", "omega(wheel)", "x", "x'", "multiplier(cart)")
    found = {name: str(unit) for name, unit in model.units_of(names).items()}
    assert found == dict(zip(names, ("N", "N*m", "rad/s", "m", "m/s"), strict=False))


REQUESTED = """
[outputs]
F = "reaction_x(cart)"
M = "reaction_couple(cart)"
p = "m*x'"
P = "m*x'*x'' + kinetic_energy()/t"
w = "omega(wheel)"
angle = { value = "phi", unit = "deg" }
n = "x/l"
open = "k*x"
root = "sqrt(m)"
"""
UNITS = {"F": "N", "M": "N*m", "p": "kg*m/s", "P": "W", "w": "rad/s", "angle": "deg", "n": "", "open": "", "root": ""}
"""of what is asked alone its function's; else by dimension; none of a number, of what nobody knows, of a root"""


def test_an_output_has_the_unit_of_its_formula_wherever_it_is_told(tmp_path):
    """solve, JSON, the table of a run, --units of its CSV and derive --units name one unit for each output."""
    text = WHEEL.replace("[coordinates]", "k = 3\n[coordinates]") + REQUESTED
    path, file = tmp_path / "wheel.toml", tmp_path / "run.csv"
    path.write_text(text)

    def reported(*words: str):
        result = CliRunner().invoke(main, [words[0], str(path), *words[1:], "--no-certify"])
        assert result.exit_code in (0, 3), result.stderr
        return result

    answers = json.loads(reported("solve", "--json").stdout)["outputs"]
    assert {name: answer["unit"] for name, answer in answers.items()} == UNITS
    assert " N   [" in reported("solve").stdout and "kg·m/s   [" in reported("solve").stdout
    derived = json.loads(reported("derive", "--units", "--json").stdout)["units"]["outputs"]
    assert {name: unit for name, unit in derived.items() if UNITS[name]} == {n: u for n, u in UNITS.items() if u}
    run = reported("simulate", "--time", "1", "--samples", "3", "--target", "numpy", "--units", "-o", str(file))
    (head, *rows) = csv.reader(file.open())
    for name, unit in UNITS.items():
        shown = f"{name} [{unit}]" if unit else name
        assert shown in head, name
        assert shown in run.stderr, name
    start = dict(zip(head, rows[0], strict=True))
    for name, answer in answers.items():
        if answer["value"] is not None:
            column = f"{name} [{answer['unit']}]" if answer["unit"] else name
            assert float(start[column]) == pytest.approx(answer["value"], rel=1e-9, abs=1e-12), name
