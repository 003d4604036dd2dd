"""The systems in models/ against what is known of them: textbook equations, independent derivations, frequencies."""

from __future__ import annotations

import math
import runpy
from functools import cache

import answers_of_chapters_9_10
import answers_of_chapters_11_13_21
import answers_of_turning_bodies
import numpy as np
import pytest
import sympy
from each import each
from known_answers import CLASSICS, MODELS, OUTPUTS, SEEDS
from newton_euler import inverse_dynamics, read_arm

import eomgen
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.text import parse
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

pytestmark = pytest.mark.slow

KNOWN = {name: (MODELS / f"{name}.toml", known) for name, known in CLASSICS.items()} | {
    name: (MODELS / "seeds" / f"{name}.toml", known) for name, known in SEEDS.items()
}


@cache
def derived(path):
    """The equations of a model file."""
    return eomgen.derive(eomgen.load(path))


def names_of(symbols) -> dict:
    """Every symbol of a derivation by its name, for the evaluation of text."""
    listed = (*symbols.x, *symbols.a)
    named = {symbol.name: symbol for symbol in listed}
    return named | symbols.parameters | symbols.inputs | {"t": symbols.t, "pi": symbols.graph.pi}


def in_graph(text: str, symbols):
    """The text as an expression of the derivation's graph."""
    return parse(text).evaluate(names_of(symbols))


def residuals(assembly) -> list:
    """M a - forcing, one scalar for each speed."""
    rows = zip(assembly.M, assembly.forcing, strict=True)
    return [sum(m * a for m, a in zip(row, assembly.symbols.a, strict=True)) - force for row, force in rows]


def values_at(assembly, named: dict[str, float]) -> dict:
    """The values of a state for the float evaluation of a derivation."""
    return {symbol: named[name] for name, symbol in names_of(assembly.symbols).items() if name in named}


def random_state(assembly, rng, parameters: dict[str, float]) -> dict[str, float]:
    """Coordinates in (-3, 3), rates and accelerations in (-2, 2), inputs in (-1, 1), the parameters given."""
    s = assembly.symbols
    state = {x.name: float(rng.uniform(-3, 3)) for x in s.q}
    state |= {x.name: float(rng.uniform(-2, 2)) for x in (*s.u, *s.a)}
    return state | {name: float(rng.uniform(-1, 1)) for name in s.inputs} | parameters | {"t": 0.0}


def file_parameters(model) -> dict[str, float]:
    """The parameters that the file gives as plain numbers."""
    return {name: float(parameter.value.literal) for name, parameter in model.parameters.items()}


@each("name", KNOWN)
def test_the_kinetic_energy_is_the_textbooks(name):
    """T, exactly, at random states of a prime field (50 digits where a root has two signs)."""
    path, known = KNOWN[name]
    graph = derived(path).graph
    assert equal_at_random_states([(graph.T, in_graph(known.kinetic_energy, graph.symbols))]).equal


@each("name", KNOWN)
def test_the_equations_of_motion_are_the_textbooks(name):
    """factor (left - right) = M a - forcing, for each speed."""
    path, known = KNOWN[name]
    graph = derived(path).graph
    ours = residuals(graph)
    book = [in_graph(factor, graph.symbols) * in_graph(text, graph.symbols) for text, factor in known.equations]
    assert len(ours) == len(book)
    verdict = equal_at_random_states(zip(ours, book, strict=True))
    assert verdict.equal, f"equation {verdict.culprit + 1} of {name} differs"


def test_a_wrong_coefficient_of_the_book_is_seen():
    """ch22-p1 as printed, 18 theta'^2 sin cos in place of 9, is not our equation."""
    graph = derived(MODELS / "seeds" / "ch22_p1.toml").graph
    printed = "3*M*R^2*((4 + 9*cos(theta)^2)*theta'' - 18*theta'^2*sin(theta)*cos(theta) - 2*g/R*sin(theta))"
    assert not equal_at_random_states([(residuals(graph)[0], in_graph(printed, graph.symbols))]).equal


@each("name", sorted(OUTPUTS))
def test_a_seed_names_what_the_book_asks_for(name):
    """Every output that the exercise asks for stands in the file, which names its source."""
    model = eomgen.load(MODELS / "seeds" / f"{name}.toml")
    assert set(OUTPUTS[name].split()) <= set(model.outputs)
    assert model.source == name.replace("_", "-")


def test_every_seed_has_its_known_answer():
    """models/seeds/ holds the systems of the tables and no others; what moves has its equations too."""
    files = {path.stem for path in (MODELS / "seeds").glob("*.toml")}
    assert set(SEEDS) == set(OUTPUTS)
    others = (answers_of_chapters_9_10.ANSWERS, answers_of_chapters_11_13_21.ANSWERS, answers_of_turning_bodies.ANSWERS)
    assert files == set(SEEDS).union(*others)


# -- chains and arms against derivations that share nothing with ours -------------------------------------------


def chain_in_floats(m, l, g, q, u):
    """Mass matrix and forcing of a chain of rods in relative angles, from its absolute angles f = A q.

    With s_ij = l_i l_j (m_j/2 + mass beyond j) for i < j, s_ii = l_i^2 (m_i/3 + mass beyond i):
    M_ij = s_ij cos(f_i - f_j);  forcing_i = -sum_j s_ij sin(f_i - f_j) f_j'^2 - g l_i sin(f_i) (m_i/2 + mass beyond i)
    """
    n = len(q)
    A = np.tril(np.ones((n, n)))
    f, w = A @ q, A @ u
    beyond = np.concatenate([np.cumsum(m[::-1])[::-1][1:], [0.0]])
    shared = np.empty((n, n))
    for i in range(n):
        for j in range(n):
            k = max(i, j)
            shared[i, j] = l[i] * l[j] * ((m[k] / 3 if i == j else m[k] / 2) + beyond[k])
    apart = f[:, None] - f[None, :]
    M = shared * np.cos(apart)
    forcing = -(shared * np.sin(apart)) @ w**2 - g * l * np.sin(f) * (m / 2 + beyond)
    return A.T @ M @ A, A.T @ forcing


def test_a_chain_of_twenty_rods_is_the_one_in_absolute_angles():
    """M and forcing at 5 random states against the double sum over pairs of rods, 1e-12 of the largest entry."""
    path = MODELS / "chain20.toml"
    graph, rng = derived(path).graph, np.random.default_rng(20)
    for _ in range(5):
        p = {name: float(rng.uniform(0.5, 2)) for name in graph.symbols.parameters}
        state = random_state(graph, rng, p)
        flat = evaluate([*(x for row in graph.M for x in row), *graph.forcing], values_at(graph, state), FLOAT)
        M, forcing = np.reshape(flat[:400], (20, 20)), np.array(flat[400:])
        m, l = (np.array([p[f"{k}{i}"] for i in range(1, 21)]) for k in "ml")
        q, u = (np.array([state[f"q{i}{prime}"] for i in range(1, 21)]) for prime in ("", "'"))
        M_known, forcing_known = chain_in_floats(m, l, p["g"], q, u)
        assert np.max(np.abs(M - M_known)) < 1e-12 * np.max(np.abs(M_known))
        assert np.max(np.abs(forcing - forcing_known)) < 1e-12 * np.max(np.abs(forcing_known))


def test_the_shipped_chain_is_what_its_generator_prints():
    """models/chain20.toml = chain(20)."""
    chain = runpy.run_path(str(MODELS / "chain.py"))["chain"]
    assert (MODELS / "chain20.toml").read_text() == chain(20)


@each("name", ["arm3", "arm7"])
def test_an_arm_takes_the_torques_of_newton_and_euler(name):
    """M a - forcing = tau_NewtonEuler(q, u, a) - tau_applied, at 20 random states, 1e-12 of the largest torque."""
    path = MODELS / f"{name}.toml"
    links, g = read_arm(path)
    model, graph = eomgen.load(path), derived(path).graph
    rng, parameters = np.random.default_rng(7), file_parameters(model)
    s = graph.symbols
    for _ in range(20):
        state = random_state(graph, rng, parameters)
        ours = np.array(evaluate(residuals(graph), values_at(graph, state), FLOAT))
        q, u, a = ([state[x.name] for x in group] for group in (s.q, s.u, s.a))
        applied = np.array([state.get(f"tau{i}", 0.0) for i in range(1, len(links) + 1)])
        torques = inverse_dynamics(links, g, q, u, a) - applied
        assert np.max(np.abs(ours - torques)) < 1e-12 * np.max(np.abs(torques))


# -- small oscillations, linearized here -------------------------------------------------------------------------


def linearized(name: str) -> tuple[sympy.Matrix, sympy.Matrix, dict[str, sympy.Symbol]]:
    """Mass matrix and stiffness K = -dQ/dq at q = 0 of a seed, and its symbols by name."""
    equations = derived(MODELS / "seeds" / f"{name}.toml")
    M, Q = sympy.Matrix(equations.M), sympy.Matrix(list(equations.Q))
    names = {symbol.name: symbol for symbol in M.free_symbols | Q.free_symbols}
    q = [names[symbol.name] for symbol in equations.graph.symbols.q]
    at_rest = dict.fromkeys(q, 0)
    assert Q.subs(at_rest).applyfunc(sympy.simplify) == sympy.zeros(len(q), 1)
    return M.subs(at_rest), -Q.jacobian(q).subs(at_rest), names


def test_two_bars_and_a_spring_oscillate_as_derived():
    """ch22-p3: M = diag(12, 4) M a^2; K11 = 6Mga + 19ka^2, K12 = K21 = 12ka^2, K22 = 3Mga + 8ka^2."""
    mass, stiffness, s = linearized("ch22_p3")
    M, a, k, g = (s[name] for name in ("M", "a", "k", "g"))
    assert (mass - sympy.diag(12, 4) * M * a**2).expand() == sympy.zeros(2)
    known = sympy.Matrix(
        [[6 * M * g * a + 19 * k * a**2, 12 * k * a**2], [12 * k * a**2, 3 * M * g * a + 8 * k * a**2]]
    )
    assert (stiffness - known).expand() == sympy.zeros(2)


def test_a_bar_on_two_springs_has_the_frequencies_of_its_quadratic():
    """ch22-p6: 3 (M w^2)^2 - 10 k (M w^2) + 6 k^2 = 0, so w^2 = (5 -+ sqrt(7))/3 k/M."""
    mass, stiffness, s = linearized("ch22_p6")
    numbers = {s["M"]: 1, s["k"]: 1, s["l"]: sympy.Rational(1, 3)}
    squares = (mass.inv() * stiffness).subs(numbers).eigenvals()
    assert sorted(float(value) for value in squares) == pytest.approx([(5 - math.sqrt(7)) / 3, (5 + math.sqrt(7)) / 3])
