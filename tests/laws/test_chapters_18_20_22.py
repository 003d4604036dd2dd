"""Chapters 18, 20 and 22: what `solve` answers is what Newton and Euler give, in symbols and in numbers."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache
from random import Random
from typing import Any

import mpmath
import oracle_of_chapters_18_20_22 as oracle
import pytest
from alternatives_of_chapters_18_20_22 import ALTERNATIVES, CLOSURES, HEAD
from answers_of_chapters_18_20_22 import ANSWERS, LINEARIZED
from derivations import answers as answers_of
from derivations import model_path
from each import each
from slow_run import usual

import eomgen
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.text import as_expression, parse
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

REQUESTED = [(system, output) for system in ANSWERS for output in ANSWERS[system]]
STATES = 3  # random states of a comparison


@cache
def model_of(system: str, other: bool = False) -> eomgen.Model:
    """The model file; or the same with every parameter another number."""
    model = eomgen.load(model_path(system))
    return with_numbers(model, others(model)) if other else model


def others(model: eomgen.Model) -> dict[str, Fraction]:
    """Another number for every parameter, within a factor of 2."""
    rng = Random(model.name)
    file = {name: parameter.value.literal for name, parameter in model.parameters.items()}
    return {name: Fraction(x) * Fraction(rng.randint(60, 180), 100) for name, x in file.items()}


def with_numbers(model: eomgen.Model, numbers: dict[str, Fraction]) -> eomgen.Model:
    """The model with other values of its parameters."""
    texts = {name: f"{x.numerator}/{x.denominator}" for name, x in numbers.items()}
    changed = {name: replace(model.parameters[name], value=as_expression(x)) for name, x in texts.items()}
    return replace(model, parameters=dict(model.parameters) | changed)


@cache
def answers(system: str, other: bool = False) -> dict[str, Any]:
    return answers_of(model_path(system)) if not other else eomgen.solve(model_of(system, other))


def parameters_of(model: eomgen.Model, other: bool) -> dict[str, Fraction]:
    literals = {name: parameter.value.literal for name, parameter in model.parameters.items()}
    return others(model) if other else {name: Fraction(x) for name, x in literals.items()}


def random_states(model: eomgen.Model, count: int = STATES) -> list[dict[str, Fraction]]:
    """Positive parameters, coordinates beyond the start, rates of either sign."""
    rng = Random(model.name)

    def between(low: int, high: int) -> Fraction:
        return Fraction(rng.randint(low * 997, high * 997), 99700)

    return [
        {name: between(40, 200) for name in model.parameters}
        | {name: between(10, 120) for name in model.coordinates}
        | {f"{name}'": between(-100, 100) for name in model.coordinates}
        for _ in range(count)
    ]


def value_of(text: str, state: dict[str, Fraction]) -> Any:
    """A text of the grammar at a state, with 50 digits."""
    graph, digits = Graph(), fifty_digits()
    symbols = {name: graph.symbol(name) for name in state}
    scalar = parse(text).evaluate(symbols | {"pi": graph.pi})
    return evaluate((scalar,), {symbols[name]: digits.number(x) for name, x in state.items()}, digits)[0]


def in_digits(state: dict[str, Fraction]) -> dict[Any, Any]:
    """The state for the oracle: its symbols by their names."""
    known = {symbol.name: symbol for symbol in oracle.PARAMETERS}
    with mpmath.workdps(oracle.DIGITS):
        return {known.get(n, oracle.Symbol(n)): mpmath.mpf(x.numerator) / x.denominator for n, x in state.items()}


def close(a: Any, b: Any) -> bool:
    return bool(abs(float(a - b)) <= 1e-30 * max(1.0, abs(float(b))))


# -- the answers by hand against Newton and Euler ------------------------------------------------------------------


@pytest.mark.parametrize("system", usual([*ANSWERS], 3, 2))
def test_the_answers_by_hand_are_those_of_newton_and_euler(system):
    """m a_C = sum F and I alpha = sum M_C, body by body, at random states to 30 digits."""
    book = oracle.ALL[system]()
    for state in random_states(model_of(system)):
        found = oracle.answers(book, in_digits(state))
        for output, text in ANSWERS[system].items():
            assert close(value_of(text, state), found[output]), output


@pytest.mark.parametrize("system", oracle.ALL)
def test_newton_and_euler_keep_the_energy(system):
    """d/dt (T + V) = 0, so the energy theorem may give the rates."""
    for state in random_states(model_of(system)):
        assert abs(oracle.energy_rate(oracle.ALL[system](), in_digits(state))) < 1e-30


# -- the model files ---------------------------------------------------------------------------------------------


@each("system, output", REQUESTED, by="system")
def test_the_exact_answer_is_the_one_by_hand(system, output):
    """The text that solve gives, read back, at random states to 30 digits."""
    answer = answers(system)[output]
    assert answer.exact is not None, answer.message
    assert answer.method
    for state in random_states(model_of(system)):
        assert close(value_of(answer.exact, state), value_of(ANSWERS[system][output], state)), answer.exact


@each("other", [False, True])
@each("system, output", REQUESTED, by="system")
def test_the_number_is_the_one_of_newton_and_euler(system, output, other):
    """At the file's parameters and at others; a function of the place at the start."""
    model, answer = model_of(system, other), answers(system, other)[output]
    state = parameters_of(model_of(system), other)
    for values in model.start_values():
        state |= {name: Fraction(x) for name, x in values.items()}
    expected = value_of(ANSWERS[system][output], state)
    assert answer.value is not None, answer.message
    assert answer.value == pytest.approx(float(expected), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("system", ANSWERS)
def test_every_output_of_the_file_is_answered(system):
    """Also those that the exercise does not ask for."""
    missing = {name: a.message for name, a in answers(system).items() if a.exact is None}
    assert not missing


@pytest.mark.parametrize("system", LINEARIZED)
def test_a_small_oscillation_is_answered_as_by_hand(system):
    """K, M and the squares of the frequencies, exactly: as formulas at two sets of parameters, and as numbers."""
    state = parameters_of(model_of(system), False)
    for output, text in LINEARIZED[system].items():
        answer = answers(system)[output]
        assert answer.value == pytest.approx(float(value_of(text, state)), rel=1e-12)
        for other in (False, True):
            values = parameters_of(model_of(system), other)
            assert float(value_of(answer.exact, values)) == pytest.approx(float(value_of(text, values)), rel=1e-12)


@pytest.mark.parametrize("system", oracle.ALL)
def test_the_equations_certify_themselves(system):
    """Two routes to the equations agree, and the reactions balance."""
    certificate = eomgen.derive(model_of(system)).certify()
    assert certificate.ok, certificate


# -- the same systems, written otherwise ---------------------------------------------------------------------------


@cache
def alternative(name: str) -> eomgen.Model:
    return eomgen.loads(HEAD + ALTERNATIVES[name][1])


@cache
def alternative_answers(name: str) -> dict[str, Any]:
    return eomgen.solve(alternative(name))


def closed_states(name: str) -> list[dict[str, Fraction]]:
    """Random states at which the constraints hold, to 50 digits."""
    states = random_states(alternative(name))
    for state in states:
        for coordinate, text in CLOSURES.get(ALTERNATIVES[name][0], {}).items():
            state[coordinate] = Fraction(str(value_of(text, state)))
    return states


@each("name, output", [(name, o) for name in ALTERNATIVES for o in alternative(name).outputs], by="name")
def test_a_system_answers_the_same_however_it_is_written(name, output):
    """With free bodies, dependent coordinates or multipliers: the number, and the exact text where there is one."""
    model, answer, text = alternative(name), alternative_answers(name)[output], ANSWERS[ALTERNATIVES[name][0]][output]
    state = parameters_of(model, False)
    for values in model.start_values():
        state |= {symbol: Fraction(x) for symbol, x in values.items()}
    assert answer.value is not None, answer.message
    assert answer.value == pytest.approx(float(value_of(text, state)), rel=1e-8, abs=1e-8)
    if answer.exact is not None:
        for place in closed_states(name):
            assert close(value_of(answer.exact, place), value_of(text, place)), answer.exact


@pytest.mark.parametrize("name", ALTERNATIVES)
def test_however_it_is_written_it_certifies_itself(name):
    """Eliminated and closing constraints too: two routes agree."""
    certificate = eomgen.derive(alternative(name)).certify()
    assert certificate.ok, certificate
