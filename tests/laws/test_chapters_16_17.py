"""Chapters 16 and 17: what `solve` answers is what Newton and Euler give, in symbols and in numbers."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from functools import cache
from random import Random
from typing import Any

import oracle_of_chapters_16_17
import pytest
import sympy
from answers_of_chapters_16_17 import ANSWERS, NUMBERS_ONLY, OTHER_NUMBERS
from derivations import answers as answers_of
from derivations import model_path
from each import each
from slow_run import in_slow_run, usual

import eomgen
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.text import as_expression, parse
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

REQUESTED = [(system, output) for system in ANSWERS for output in ANSWERS[system]]
EXACT = [requested for requested in REQUESTED if requested not in NUMBERS_ONLY]
STATES = 3  # random states of a comparison


@cache
def model_of(system: str, other: bool = False) -> eomgen.Model:
    """The model file; or the same with every parameter's number another one."""
    model = eomgen.load(model_path(system))
    return with_numbers(model, OTHER_NUMBERS[system]) if other else model


def with_numbers(model: eomgen.Model, numbers: dict[str, float]) -> eomgen.Model:
    """The model with other values of its parameters."""
    changed = {name: replace(model.parameters[name], value=as_expression(x)) for name, x in numbers.items()}
    return replace(model, parameters=dict(model.parameters) | changed)


@cache
def answers(system: str, other: bool = False) -> dict[str, Any]:
    return answers_of(model_path(system)) if not other else eomgen.solve(model_of(system, other))


@cache
def derived_by_hand(system: str) -> dict[str, Any]:
    return oracle_of_chapters_16_17.ORACLES[system]()


def numbers_of(system: str, other: bool = False) -> dict[str, float]:
    return model_of(system, other).numeric_parameters()


def states(system: str) -> list[dict[str, float]]:
    """Parameters within 2 % of the two sets of the system, with places on its way."""
    rng = Random(system)
    bases = [numbers_of(system, other) for other in (False, True)]
    near = [{name: x * rng.uniform(0.98, 1.02) for name, x in base.items()} for base in bases for _ in range(STATES)]
    return [state | {"theta": rng.uniform(0.2, 1.2), "x": rng.uniform(0.2, 1.2)} for state in near]


def value_of(text: str, state: dict[str, float]) -> Any:
    """A text of the grammar at a state, with 50 digits."""
    graph, digits = Graph(), fifty_digits()
    symbols = {name: graph.symbol(name) for name in state}
    scalar = parse(text).evaluate(symbols | {"pi": graph.pi})
    values = {symbols[name]: digits.number(Fraction(x)) for name, x in state.items()}
    return evaluate((scalar,), values, digits)[0]


def oracle_value(expression: Any, state: dict[str, float]) -> Any:
    """An expression of the oracle at a state, with 50 digits."""
    expression = sympy.sympify(expression)
    numbers = {symbol: sympy.Rational(state[symbol.name]) for symbol in expression.free_symbols}
    return expression.xreplace(numbers).evalf(50)  # of symbols that sympy keeps and those that equal them


def close(a: Any, b: Any, tolerance: float = 1e-30) -> bool:
    apart = sympy.Float(str(a), 60) - sympy.Float(str(b), 60)  # two arithmetics meet in decimals
    return bool(abs(float(apart)) <= tolerance * max(1.0, abs(float(b))))


def test_every_parameter_has_another_number():
    """A formula with a number in it that should be a parameter is seen."""
    for system in ANSWERS:
        file, other = numbers_of(system), numbers_of(system, True)
        assert file.keys() == other.keys() and all(file[name] != other[name] for name in file)


@pytest.mark.parametrize("system", usual([*ANSWERS], 3, 2))
def test_the_answers_by_hand_are_those_of_newton_and_euler(system):
    """At 6 random states of the parameters and the place, to 30 digits; numbers to 1e-15."""
    oracle = derived_by_hand(system)
    assert set(oracle) == set(ANSWERS[system])
    for output, text in ANSWERS[system].items():
        if (system, output) in NUMBERS_ONLY:
            assert close(value_of(text, {}), oracle_value(oracle[output], numbers_of(system)), 1e-15), output
            continue
        for state in states(system):
            assert close(value_of(text, state), oracle_value(oracle[output], state)), output


@each("system, output", EXACT, by="system")
def test_the_exact_answer_is_the_one_by_hand(system, output):
    """The text that solve gives, read back, at random states to 30 digits."""
    answer = answers(system)[output]
    assert answer.exact is not None, answer.message
    assert answer.method
    for state in states(system):
        assert close(value_of(answer.exact, state), value_of(ANSWERS[system][output], state)), answer.exact


@each("other", [False, True])
@each("system, output", REQUESTED, by="system")
def test_the_number_is_the_one_of_newton_and_euler(system, output, other):
    """At the file's parameters and at others; a function of the place at the start."""
    model, answer = model_of(system, other), answers(system, other)[output]
    start, _ = model.start_values()
    expected = oracle_value(derived_by_hand(system)[output], start | numbers_of(system, other))
    assert answer.value is not None, answer.message
    assert answer.value == pytest.approx(float(expected), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("system", ANSWERS)
def test_the_equations_certify_themselves(system):
    """Two routes to the equations agree, and the reactions balance."""
    certificate = eomgen.derive(model_of(system)).certify()
    assert certificate.ok, certificate


def test_a_particle_that_friction_can_hold_stays():
    """mu > tan(alpha): the stop is for good, the acceleration after it is zero and A is never reached again."""
    held = eomgen.solve(with_numbers(model_of("ch16_p6"), {"mu": 0.75}))
    assert held["stays"].value == 1
    assert held["s_dd_down"].value == 0
    assert not held["v_return_to_A"].answered and held["v_return_to_A"].message


@in_slow_run
def test_a_wire_that_stays_taut_has_no_place_where_it_is_slack():
    """v0^2 > 5 g l: the tension never vanishes, and the answer says so.

    Slow: the motion is followed for thousands of steps, as nothing ends it.
    """
    model = with_numbers(model_of("ch16_p4"), {"v0": 8})
    fast = eomgen.solve(replace(model, outputs={x: model.outputs[x] for x in ("cos_theta_slack", "v0_full_circle")}))
    assert fast["cos_theta_slack"].value is None and fast["cos_theta_slack"].message
    assert fast["v0_full_circle"].value == pytest.approx(math.sqrt(5 * 9.81))


@pytest.mark.parametrize(
    ("system", "start", "quantity", "expected"),
    [
        ("ch16_p4", {}, lambda t, end: math.cos(end["theta"]), "cos_theta_slack"),
        ("ch16_p6", {}, lambda t, end: t, "t_stop"),
        ("ch16_p6", {}, lambda t, end: end["x"], "x_stop"),
        ("ch16_p5", {}, lambda t, end: end["s'"], "v_B"),
        ("ch16_p7", {}, lambda t, end: end["s'"], "v_B"),
        ("ch17_p5", {"theta": 1e-4}, lambda t, end: end["theta"], "theta_sep"),
        ("ch17_p5", {"theta": 1e-4}, lambda t, end: end["theta'"] ** 2, "theta_d_squared_at_sep"),
    ],
)
def test_a_simulation_ends_its_first_phase_where_solve_says(system, start, quantity, expected):
    """The wire slack, the block at rest, the particle on the arc, the ladder off the wall."""
    run = eomgen.simulate(model_of(system), time=4, start=start)
    first = run.phases[0]
    assert run.status == "finished" and first.end < 4
    assert quantity(first.end, first.last) == pytest.approx(answers(system)[expected].value, rel=1e-6)
