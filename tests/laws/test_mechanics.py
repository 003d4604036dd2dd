"""Laws that hold for every system in models/."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from random import Random

import derivations
import numpy as np
import pytest
from derivations import LARGE, moving
from slow_run import sampled, usual

import eomgen
from eomgen.equations import Equations
from eomgen.mechanics.dynamics.accelerations import exact_accelerations
from eomgen.proof.states import closed_state, real_state
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.derivatives import depends_on, gradient, substituted
from eomgen.symbolic.expression.node import Scalar, is_zero
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

MODELS = Path(__file__).parents[2] / "models"


@pytest.fixture(scope="module", params=moving(), ids=lambda path: path.stem)
def equations(request) -> Equations:
    return derivations.equations(request.param.stem)


def loads(text: str) -> Equations:
    return eomgen.derive(eomgen.loads(text))


def scleronomic(equations: Equations) -> bool:
    """Nothing moves by itself."""
    graph = equations.graph
    return all(is_zero(x) for x in graph.nu) and not depends_on(graph.T, (graph.symbols.t,))


def quadratic(M, u) -> Scalar:
    return sum((M[i][j] * a * b for i, a in enumerate(u) for j, b in enumerate(u)), start=0)


def test_the_mass_matrix_is_positive_definite(equations):
    """w^T M w > 0 for w != 0, at a random state."""
    graph = equations.graph
    state = real_state(equations.system, Random(3))
    M = np.array([[float(x) for x in evaluate(row, state, fifty_digits())] for row in graph.M])
    if len(M):
        assert np.linalg.eigvalsh(M).min() > 0


def test_the_kinetic_energy_is_quadratic_in_the_speeds(equations):
    """T = u^T M u / 2 + u . dT/du(u = 0) + T(u = 0), the last two 0 where nothing moves by itself."""
    graph = equations.graph
    u = graph.symbols.u
    still = {speed: 0 for speed in u}
    momenta = substituted(gradient(graph.T, u), still)
    rest = substituted((graph.T,), still)[0]
    if scleronomic(equations):
        assert equal_at_random_states([(rest, 0), *((p, 0) for p in momenta)]).equal
    linear = sum((p * w for p, w in zip(momenta, u, strict=True)), start=rest)
    assert equal_at_random_states([(graph.T, Fraction(1, 2) * quadratic(graph.M, u) + linear)]).equal


def test_inertia_terms_do_the_work_of_the_changing_mass_matrix(equations):
    """u^T c = u^T M' u / 2 where nothing moves by itself."""
    if not scleronomic(equations):
        pytest.skip("the law is of systems in which nothing moves by itself")
    graph, scope = equations.graph, equations.system.scope
    rates = tuple(scope.time_derivative(row) for row in graph.M)
    work = sum((c * u for c, u in zip(graph.c, graph.symbols.u, strict=True)), start=0)
    assert equal_at_random_states([(work, Fraction(1, 2) * quadratic(rates, graph.symbols.u))]).equal


def test_forcing_is_Q_minus_c(equations):
    """forcing = Q - c"""
    graph = equations.graph
    assert equal_at_random_states((f, Q - c) for f, Q, c in zip(graph.forcing, graph.Q, graph.c, strict=True)).equal


@sampled(3)
@pytest.mark.parametrize("name", sorted({*usual([path.stem for path in moving()], 3), *LARGE}))
def test_the_emitted_code_gives_the_accelerations_of_the_symbols(name):
    """rhs(t, x, p) = (N u + nu, a) with M a = forcing + J^T lam, J a + gamma = 0, in C.

    Of the large models and a third of all, in the slow run of all; each certificate looks at the emitted code besides.
    """
    equations = derivations.equations(name)
    graph, symbols = equations.graph, equations.graph.symbols
    for seed in range(1, 20):
        state, _ = closed_state(equations.system, Random(seed))
        try:
            a = np.array(exact_accelerations(graph, state), dtype=float)
            break
        except NoValue:
            continue
    x = [float(state[s]) for s in symbols.x]
    p = [float(state[s]) for s in symbols.parameters.values()]
    inputs = [float(state[s]) for s in symbols.inputs.values()]
    dx = equations.rhs("c")(float(state[symbols.t]), x, p, inputs)
    assert dx[len(symbols.q) :][: len(symbols.u)] == pytest.approx(
        a, rel=1e-9, abs=1e-9 * (1 + max(map(abs, a), default=0))
    )


HANGING_MASS = """
eomgen = 1
space = "plane"
name = "A mass on a slide, held up by a tie"
[parameters]
m = 2.0
g = 9.81
[coordinates]
y = 0.0
[bodies.mass]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [0, 1], displacement = "y" }
[constraints.hold]
kind = "pin"
points = ["mass.origin"]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def test_a_pin_holds_up_the_weight_of_a_hanging_mass():
    """At rest J^T lam balances the weight (and so fixes the sign of lam): J^T lam = + m g."""
    equations = loads(HANGING_MASS)
    graph = equations.graph
    state = {s: fifty_digits().number(2) for s in graph.symbols.parameters.values()}
    state |= {s: fifty_digits().number(0) for s in graph.symbols.x}
    assert np.array(exact_accelerations(graph, state), dtype=float) == pytest.approx([0.0])
    forcing = float(evaluate(graph.forcing, state, fifty_digits())[0])
    J = float(evaluate(graph.J[0], state, fifty_digits())[0])
    assert J * 4.0 == pytest.approx(-forcing)  # m g = 2 * 2, so lam = m g


def test_redundant_rows_do_not_stop_the_motion():
    """A parallelogram of three equal cranks moves as one crank with all the mass."""
    equations = eomgen.derive(eomgen.load(MODELS / "parallelogram_reactions.toml"))
    rhs = equations.rhs("numpy")
    M, l, g = 1.3, 0.7, 9.81
    theta = 0.4
    acceleration = rhs(0.0, [theta, 0.9], [M, l, g])[1]
    assert acceleration == pytest.approx(7 * g / (12 * l) * np.cos(theta), rel=1e-12)


PENDULUM = """
eomgen = 1
space = "plane"
name = "Pendulum with a driven pivot"
[parameters]
m = 1.3
l = 0.8
g = 9.81
A = 0.1
w = 3.0
[coordinates]
s = { motion = "A*sin(w*t)" }
theta = 0.3
[bodies.cart]
joint = { kind = "prismatic", axis = [1, 0], displacement = "s" }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", on = "cart", at = ["l*sin(theta)", "-l*cos(theta)"] }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


def test_a_driven_pivot_acts_through_its_acceleration():
    """l theta'' = - g sin(theta) - s'' cos(theta), s = A sin(w t)."""
    equations = loads(PENDULUM)
    _, l, g, A, w = p = [1.3, 0.8, 9.81, 0.1, 3.0]
    t, theta, rate = 0.7, 0.4, 1.1
    dx = equations.rhs("numpy")(t, [A * np.sin(w * t), theta, rate], p)
    pivot = -A * w**2 * np.sin(w * t)
    assert dx == pytest.approx([A * w * np.cos(w * t), rate, (-g * np.sin(theta) - pivot * np.cos(theta)) / l])


def test_the_order_of_convergence_shows_in_the_energy():
    """A tolerance 1000 times finer keeps the energy at least 100 times better."""
    model = eomgen.load(MODELS / "double_pendulum.toml")
    coarse = eomgen.simulate(model, time=5, rtol=1e-6, atol=1e-6, target="numpy").drift
    fine = eomgen.simulate(model, time=5, rtol=1e-9, atol=1e-9, target="numpy").drift
    assert fine < coarse / 100
    assert fine < 1e-7


def test_redundant_loops_move_as_one_crank_would():
    """(4 m l^2 / 3 + m l^2) a'' = - 3 m g l cos(a), in both targets, with two redundant rows."""
    equations = eomgen.derive(eomgen.load(MODELS / "four_cranks.toml"))
    m, g, l = 1.3, 9.81, 0.6  # in the order of the model
    expected = -9 / 7 * g / l * np.cos(0.4)
    for target in ("numpy", "c"):
        dx = equations.rhs(target)(0.0, [0.4] * 4 + [0.0] + [0.8] * 4 + [0.0], [m, g, l])
        assert dx[5:] == pytest.approx([expected] * 4 + [0.0], rel=1e-9, abs=1e-9)
