"""Bodies of the notes that turn in space: what `solve` answers against texts by hand and an oracle in floats."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache
from random import Random
from typing import Any

import pytest
from answers_of_turning_bodies import ANSWERS, INFERRED, UNITS
from derivations import answers as answers_of
from derivations import model_path
from each import each
from oracle_of_turning_bodies import ORACLES
from other_units import grown

import eomgen
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.text import as_expression, parse
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

REQUESTED = [(system, output) for system in ANSWERS for output in ANSWERS[system]]
BY_HAND = [(system, output) for system, output in REQUESTED if ANSWERS[system][output] is not None]
MOVING = ("w1", "w2", "w3", "phi", "theta", "psi", "phi'", "theta'", "psi'")
ALL_UNITS = {system: UNITS.get(system, {}) | INFERRED.get(system, {}) for system in ANSWERS}


@cache
def model_of(system: str, other: bool = False) -> eomgen.Model:
    """The model file; or the same with every parameter another number."""
    model = eomgen.load(model_path(system))
    if not other:
        return model
    changed = {
        name: replace(model.parameters[name], value=as_expression(f"{x.numerator}/{x.denominator}"))
        for name, x in numbers_of(system, other).items()
    }
    return replace(model, parameters=dict(model.parameters) | changed)


def numbers_of(system: str, other: bool = False) -> dict[str, Fraction]:
    """The parameters of the file; or others, close enough for moments of inertia to belong to a body."""
    rng = Random(system)
    file = {name: Fraction(p.value.literal) for name, p in model_of(system).parameters.items()}
    return {name: x * Fraction(rng.randint(90, 99), 100) for name, x in file.items()} if other else file


@cache
def answers(system: str, other: bool = False) -> dict[str, Any]:
    return answers_of(model_path(system)) if not other else eomgen.solve(model_of(system, other))


@cache
def found_by_the_oracle(system: str, other: bool) -> dict[str, float]:
    return ORACLES[system]({name: float(x) for name, x in numbers_of(system, other).items()})


@each("other", [False, True])
@each("system, output", REQUESTED, by="system")
def test_the_number_is_the_oracles(system, output, other):
    """dL/dt = torque and R' = R w~, at the file's parameters and at others."""
    answer, expected = answers(system, other)[output], found_by_the_oracle(system, other)[output]
    assert answer.value is not None, answer.message
    assert answer.value == pytest.approx(expected, rel=1e-7, abs=1e-8)
    assert answer.unit == ALL_UNITS[system][output]


@each("system", ANSWERS)
def test_each_output_has_a_unit_declared_or_of_its_quantity(system):
    """One of the two, and the files declare what is said here."""
    declared = {name: part.unit.text for name, part in model_of(system).outputs.items() if part.unit is not None}
    assert declared == UNITS.get(system, {})
    assert not declared.keys() & INFERRED.get(system, {}).keys()
    assert ALL_UNITS[system].keys() == ANSWERS[system].keys()


@each("system, output", BY_HAND, by="system")
def test_the_answer_by_hand_grows_as_its_unit_says(system, output):
    """kg, m and s replaced by others: p_phi grows as kg m^2/s."""
    rng, digits, graph = Random(system), fifty_digits(), Graph()
    units = {name: part.unit.text for name, part in model_of(system).parameters.items()}
    units |= {name: "1/s" if name.startswith("w") or name.endswith("'") else "" for name in MOVING}
    symbols = {name: graph.symbol(name) for name in units}
    state = {name: Fraction(rng.randint(20, 90), 30) for name in units}
    scalar = parse(ANSWERS[system][output], references=True).evaluate(symbols | {"pi": graph.pi})
    known, found = (
        evaluate((scalar,), {symbols[name]: digits.number(x) for name, x in values.items()}, digits)[0]
        for values in (state, {name: x * grown(units[name]) for name, x in state.items()})
    )
    expected = known * digits.number(grown(answers(system)[output].unit))
    assert known and abs(found - expected) <= 1e-30 * abs(expected)


@each("system, output", BY_HAND, by="system")
def test_the_exact_answer_is_the_one_by_hand(system, output):
    """The text that solve gives, at random states and parameters, to 30 digits."""
    answer, rng, digits, graph = answers(system)[output], Random(system), fifty_digits(), Graph()
    assert answer.exact is not None, answer.message
    assert answer.method
    symbols = {name: graph.symbol(name) for name in (*model_of(system).parameters, *MOVING)}
    for _ in range(2):
        state = {x: digits.number(Fraction(rng.randint(20, 90), 30)) for x in symbols.values()}
        texts = (answer.exact, ANSWERS[system][output])
        read = [parse(text, references=True).evaluate(symbols | {"pi": graph.pi}) for text in texts]
        ours, book = evaluate(read, state, digits)
        assert abs(ours - book) <= 1e-30 * max(1, abs(book)), answer.exact


@pytest.mark.parametrize("system", ANSWERS)
def test_every_output_of_the_file_is_answered(system):
    """All of them stand in the table, and have a value."""
    found = answers(system)
    assert [name for name, answer in found.items() if not answer.answered] == []
    assert set(found) == set(ANSWERS[system]) == set(found_by_the_oracle(system, False))
    assert model_of(system).source == system.replace("_", "-")
