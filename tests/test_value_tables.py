"""Functions through values of any variable: derived, printed and read back, judged, run, emitted as declared."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from each import each
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline, PchipInterpolator

import eomgen
from eomgen.errors import ModelError

CURVE = """
eomgen = 1
name = "Motor by its curve, a spring by its characteristic, a cam"
space = "plane"

[tables]
M = { at = [0, 500, 1000, 1500], values = [12, 14, 10, 0], unit = "N*m", at_unit = "rpm" }
K = { at = [-20, 0, 10, 20], values = [-30, 0, 10, 40], unit = "N", at_unit = "cm" }
C = { at = [0, 90, 180, 270, 360], values = [0, 3, 5, 2, 0], between = "cubic", unit = "cm", at_unit = "deg" }

[parameters]
J = { value = 0.5, unit = "kg*m^2" }
c = { value = 0.02, unit = "N*m*s" }
m = { value = 2, unit = "kg" }
w = { value = 3, unit = "rad/s" }

[coordinates]
phi = { start = 0, speed = 20, unit = "rad" }
x = { start = 0.1, unit = "m" }
y = { motion = "C(w*t)", unit = "m" }

[bodies.rotor]
mass = 1
inertia = "J"
joint = { kind = "revolute", angle = "phi", torque = "M(phi') - c*phi'" }

[bodies.block]
mass = "m"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", force = "-K(x)" }

[bodies.follower]
mass = "m"
joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }

[outputs]
stiffness = "K'(x)"
jump = "y''"
torque = "M(phi')"
"""
RPM, DEG = math.pi / 30, math.pi / 180
M = PchipInterpolator(np.array([0, 500, 1000, 1500]) * RPM, [12, 14, 10, 0])
K = PchipInterpolator([-0.2, 0, 0.1, 0.2], [-30, 0, 10, 40])
C = CubicSpline(np.array([0, 90, 180, 270, 360]) * DEG, np.array([0, 3, 5, 2, 0]) / 100)


def model() -> eomgen.Model:
    return eomgen.loads(CURVE)


def test_a_run_is_that_of_scipys_interpolation():
    """The curve between its values and beyond none of them, by another program; the cam by its second derivative."""
    run = eomgen.simulate(model(), time=1.0, target="numpy", rtol=1e-10, atol=1e-10)
    rates = lambda t, s: [s[1], (M(s[1]) - 0.02 * s[1]) / 0.5, s[3], -K(s[2]) / 2]  # noqa: E731
    due = solve_ivp(rates, (0, 1), [0, 20, 0.1, 0], rtol=1e-12, atol=1e-12).y[:, -1]
    assert [run["phi"][-1], run["phi'"][-1], run["x"][-1], run["x'"][-1]] == pytest.approx(due, rel=1e-7)
    assert run["y"] == pytest.approx(C(3 * run.t), abs=1e-12)


def test_answers_are_those_of_the_tables():
    found = eomgen.solve(model())
    assert found["stiffness"].value == pytest.approx(float(K(0.1, 1)))
    assert found["jump"].value == pytest.approx(9 * float(C(0, 2)))
    assert found["torque"].value == pytest.approx(float(M(20)))
    assert found["stiffness"].unit == "N/m"


@each("form", ["text", "latex", "markdown", "json"])
def test_a_derivation_calls_them_by_name(form):
    """Printed with the argument that the file has, and what is printed is read back by the proof."""
    equations = eomgen.derive(model())
    assert equations.certify().ok
    page = equations.render(form)
    assert ("M(phi')" if form in ("text", "json") else r"M(\dot{\phi})") in page


@each(
    "line, verdict",
    [
        ("J*phi'' = M(phi') - c*phi'", "right"),
        (r"J \ddot\varphi + c\dot\varphi = M(\dot\varphi)", "right"),
        (r"m\ddot{x} = -K\left(x\right)", "right"),
        ("J*phi'' = M(phi) - c*phi'", "wrong"),
        ("m*x'' = K(x)", "wrong"),
    ],
)
def test_lines_with_a_table_are_judged(line, verdict):
    assert eomgen.verify(model(), line).verdict == verdict


def test_beyond_its_ends_a_table_goes_on_straight():
    for x in (-0.5, 0.4):
        found = eomgen.solve(eomgen.loads(CURVE.replace("x = { start = 0.1", f"x = {{ start = {x}")))
        end = -0.2 if x < 0 else 0.2
        assert found["stiffness"].value == pytest.approx(float(K(end, 1)))


@each(
    "old, new, told",
    [
        ("M(phi')", "M(phi)", "M of a number"),  # an angle where the table takes an angular speed
        ("values = [12, 14, 10, 0]", "values = [12, 14, 10]", "4 places and 3 values"),
        ("at = [0, 500, 1000, 1500]", "at = [0, 1000, 500, 1500]", "do not ascend"),
        ("M(phi')", "Q(phi')", "unknown function 'Q'"),
        ('unit = "N*m", at_unit', 'unit = "N", at_unit', ""),
        ('between = "cubic"', 'between = "steps"', "unknown word 'steps'"),
        ("K = {", "c = { at = [0, 1], values = [0, 1] }\nK = {", "'c'"),
        ("K = {", "sin = { at = [0, 1], values = [0, 1] }\nK = {", "'sin'"),
        ("K = {", "speed = { at = [0, 1], values = [0, 1] }\nK = {", "'speed'"),
    ],
)
def test_mistakes_are_told(old, new, told):
    with pytest.raises(ModelError) as error:
        eomgen.loads(CURVE.replace(old, new))
    assert told in str(error.value), error.value


def test_a_model_of_python_has_tables_too():
    """Where its parts are given as the tables of a file."""
    raw = __import__("tomllib").loads(CURVE)
    made = eomgen.Model(**{key: x for key, x in raw.items() if key != "eomgen"})
    assert eomgen.solve(made)["torque"].value == pytest.approx(float(M(20)))


@pytest.mark.slow
@each("target", ["c", "numpy", "javascript"])
def test_code_has_the_values_of_the_tables(target, tmp_path: Path):
    """The rates at states between and beyond the values, by scipy."""
    f = eomgen.derive(model()).rhs(target)
    for speed in (-10.0, 3.0, 60.0, 130.0, 200.0):
        for x in (-0.3, -0.05, 0.07, 0.15, 0.3):
            rates = f(0.2, [0.3, x, float(C(0.6)), speed, 0.1], f.p0)
            inside, place = np.clip(speed, 0, 1500 * RPM), np.clip(x, -0.2, 0.2)
            torque = M(inside) + M(inside, 1) * (speed - inside)
            force = K(place) + K(place, 1) * (x - place)
            assert rates[3:] == pytest.approx([(torque - 0.02 * speed) / 0.5, -force / 2], rel=1e-12, abs=1e-12)


def test_json_names_the_function():
    page = json.loads(eomgen.derive(model()).render("json"))
    assert any("M(phi')" in text for text in json.dumps(page).split('"'))
