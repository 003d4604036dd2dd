"""The public functions of a whole journey: inputs that are replaced, matrices that a person reads."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import sympy

import eomgen
from eomgen.errors import UsageError

BEAM = """
eomgen = 1
name = "ball on a beam"
space = "plane"
[parameters]
m = { value = 0.11, positive = true }
R = 0.015
J = 0.02
g = 9.8
[coordinates]
r = 0.1
alpha = 0
phi = { dependent = true }
[inputs]
tau = 0
[bodies.beam]
mass = 1
inertia = "J"
joint = { kind = "revolute", angle = "alpha", torque = "tau" }
[bodies.ball]
shape = { kind = "disc", mass = "m", radius = "R" }
joint = { kind = "planar", on = "beam", x = "r", y = "R", angle = "phi" }
[constraints.roll]
kind = "rolling"
body = "ball"
on = "beam"
line = { at = [0, 0], normal = [0, 1] }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def test_matrices_are_multiplied_out_where_a_person_reads_them():
    """By hand: the disc rolls with r' - R alpha' ... so m (3/2 r' - 3/2 R alpha') is its share."""
    m, R, J, r = sympy.symbols("m R J r", real=True)
    M = eomgen.derive(eomgen.loads(BEAM)).M
    by_name = {str(x): x for x in M.free_symbols}
    assert set(by_name) == {"m", "R", "J", "r"}  # cos^2 + sin^2 is 1
    table = {by_name[str(x)]: x for x in (m, R, J, r)}
    wanted = sympy.Matrix([[3 * m / 2, -3 * m * R / 2], [-3 * m * R / 2, J + m * r**2 + 3 * m * R**2 / 2]])
    assert (M.subs(table) - wanted).expand().is_zero_matrix


@pytest.mark.slow
def test_inputs_are_replaced_by_expressions_numbers_and_samples():
    """A driven beam alone: J alpha'' = tau."""
    bar = 'eomgen = 1\nspace = "plane"\n[coordinates]\nq = 0\n[inputs]\ntau = 0\n[bodies.bar]\nmass = 1\ninertia = 2\n'
    model = eomgen.loads(bar + 'joint = { kind = "revolute", angle = "q", torque = "tau" }\n')
    run = eomgen.simulate(model, time=1, inputs={"tau": "6*t"})
    assert run["q"] == pytest.approx(run.t**3 / 2, abs=1e-9)
    steady = eomgen.simulate(model, time=1, inputs={"tau": 4})
    assert steady["q"] == pytest.approx(steady.t**2, abs=1e-9)
    times = np.linspace(0, 1, 5)
    sampled = eomgen.simulate(model, time=1, inputs={"tau": eomgen.samples(times, 6 * times)})
    assert sampled["q"] == pytest.approx(sampled.t**3 / 2, abs=1e-9)


@pytest.mark.parametrize(
    "inputs, error, words",
    [
        ({"tua": 1}, UsageError, "no input 'tua'"),
        ({"tau": lambda t: t}, UsageError, r"Python function of \(t\), and is called with \(t, x\)"),
        ({"tau": {"value": lambda t, q, u: t, "every": 0.1}}, UsageError, r"Python function of \(t, q, u\)"),
        ({"tau": "2*x"}, UsageError, "unknown name 'x'"),
    ],
)
def test_inputs_that_cannot_be_replaced(inputs, error, words):
    with pytest.raises(error, match=words):
        eomgen.simulate(eomgen.loads(BEAM), time=1, inputs=inputs)


def test_the_symbols_of_equations_are_those_in_its_matrices():
    """Numbers in place of every free symbol of M and the forcing: none is left."""
    equations = eomgen.derive(Path(__file__).parent.parent / "models" / "double_pendulum.toml")
    left = equations.M.row_join(equations.forcing)
    assert left.subs(dict.fromkeys(equations.symbols.values(), 2)).free_symbols == set()
    assert left.free_symbols <= set(equations.symbols.values())
    assert equations.symbols["theta1'"] in equations.forcing.free_symbols
