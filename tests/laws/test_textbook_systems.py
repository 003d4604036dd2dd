"""Textbook systems: accelerations, energies and outputs against an independent derivation by plain sympy."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from lagrange import Frame, accelerations, numbers
from slow_run import sampled, usual
from textbook import SYSTEMS

import eomgen
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = pytest.mark.slow

TOLERANCE = 1e-9  # relative to the largest of its kind; a loop near a dead centre magnifies rounding


@cache
def derived(name):
    """The equations of a system, the symbols of the independent derivation, and what is known."""
    text, given, known = SYSTEMS[name]
    equations = eomgen.derive(eomgen.loads(text))
    free = [speed.removesuffix("'") for speed in equations.speeds]
    frame = Frame(free, given, (*equations.parameters, *equations.inputs))
    return equations, frame, known(frame)


def random_states(equations, frame, count=4):
    """(t, q, u, p, inputs) with q in the order of the frame, inputs part of p too."""
    rng = np.random.default_rng(3)
    for _ in range(count):
        q = rng.uniform(0.2, 1.4, len(frame.q))
        u = rng.uniform(-1.5, 1.5, len(frame.names))
        inputs = rng.uniform(-1, 1, len(equations.inputs))
        parameters = equations.rhs("numpy").p0
        yield float(rng.uniform(0.1, 2)), q, u, parameters, inputs


def of_the_model(equations, frame, q) -> np.ndarray:
    """Coordinates in the model's order."""
    by_name = dict(zip(frame.q, q, strict=True))
    return np.array([by_name[name] for name in equations.coordinates])


@sampled(3)
@pytest.mark.parametrize(
    ("name", "target"), usual([(name, target) for target in ("numpy", "c") for name in SYSTEMS], 2)
)
def test_accelerations_are_those_of_lagrange_by_sympy(name, target):
    """M a = forcing + J^T lam, J a + gamma = 0 from d/dt dT/dq' - dT/dq + dV/dq = Q + dphi/dq lam"""
    equations, frame, book = derived(name)
    try:
        rhs = equations.rhs(target)
    except eomgen.ToolMissing:
        pytest.skip("no C compiler")
    independent = accelerations(frame, book)
    for t, q, u, p, inputs in random_states(equations, frame):
        ours = rhs(t, [*of_the_model(equations, frame, q), *u], p, inputs)[len(q) :]
        expected = independent(t, q, u, [*p, *inputs])
        assert ours == pytest.approx(expected, abs=TOLERANCE * (1 + abs(expected).max()))


@pytest.mark.parametrize("name", SYSTEMS)
def test_kinetic_energy_is_that_of_the_lecture(name):
    """T, term by term in numbers."""
    equations, frame, book = derived(name)
    kinetic = numbers(frame, [book.T])
    for t, q, u, p, inputs in random_states(equations, frame):
        (ours,) = evaluate([equations.graph.T], _graph_values(equations, frame, (t, q, u, p, inputs)), FLOAT)
        (expected,) = kinetic(t, q, u, [*p, *inputs], u)
        assert ours == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("name", [name for name, (text, _, _) in SYSTEMS.items() if "[outputs]" in text])
def test_outputs_are_those_of_the_lecture(name):
    """Velocities, accelerations, seen from bodies too, momenta, powers and generalized forces at random states."""
    equations, frame, book = derived(name)
    answers = eomgen.solve(equations.model)
    assert answers.keys() == book.outputs.keys()
    expected_of, rhs = numbers(frame, list(book.outputs.values())), equations.rhs("numpy")
    for t, q, u, p, inputs in random_states(equations, frame):
        x = of_the_model(equations, frame, q)
        a = rhs(t, [*x, *u], p, inputs)[len(q) :]
        values = {"t": t, "pi": np.pi} | dict(zip((*equations.coordinates, *equations.speeds), (*x, *u), strict=True))
        values |= dict(zip((*equations.parameters, *equations.inputs), (*p, *inputs), strict=True))
        ours = [parse(answers[output].exact).evaluate(values) for output in book.outputs]
        assert ours == pytest.approx(expected_of(t, q, u, [*p, *inputs], a), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", SYSTEMS)
def test_the_certificate_of_a_textbook_system_holds(name):
    """All routes agree."""
    certificate = derived(name)[0].certify()
    assert certificate.ok, str(certificate)


def _graph_values(equations, frame, state) -> dict:
    t, q, u, p, inputs = state
    s = equations.graph.symbols
    values = dict(zip((*s.q, *s.u), (*of_the_model(equations, frame, q), *u), strict=True))
    return values | dict(zip((*s.parameters.values(), *s.inputs.values()), (*p, *inputs), strict=True)) | {s.t: t}
