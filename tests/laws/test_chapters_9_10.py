"""Chapters 9 and 10 and the turntable: `solve` answers what differentiated positions give, exactly and in units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import Any

import mpmath
import pytest
from answers_of_chapters_9_10 import ANSWERS, BOOK_SURDS, INFERRED, PRINTED, UNITS
from derivations import answers as answers_of
from derivations import model_path
from each import each
from oracle_of_chapters_9_10 import DIGITS, ORACLES, OTHER, STATEMENT
from other_units import grown

import eomgen
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.text import as_expression, parse
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

REQUESTED = [(system, output) for system in ANSWERS for output in ANSWERS[system]]
SETS = ("statement", "other")
FIFTY = fifty_digits()
STATE = {"x": "0.23", "y": "-0.41", "x'": "0.37", "y'": "-0.19", "xi": "0.53", "eta": "0.29"}
"""A state, for the outputs that are functions of it."""
UNITS_OF_STATE = {"x": "m", "y": "m", "x'": "m/s", "y'": "m/s", "xi": "m", "eta": "m"}


@cache
def model_of(system: str, numbers: str = "statement") -> eomgen.Model:
    """The model file; or the same with every parameter another number."""
    model = eomgen.load(model_path(system))
    if numbers == "statement":
        return model
    changed = {name: replace(model.parameters[name], value=as_expression(x)) for name, x in OTHER[system].items()}
    return replace(model, parameters=dict(model.parameters) | changed)


@cache
def answers(system: str, numbers: str = "statement") -> dict[str, Any]:
    return answers_of(model_path(system)) if numbers == "statement" else eomgen.solve(model_of(system, numbers))


def value_of(text: str, state: Mapping[str, Any]) -> Any:
    """A text of the grammar at a state, with 50 digits."""
    graph = Graph()
    symbols = {name: graph.symbol(name) for name in state}
    scalar = parse(text).evaluate(symbols | {"pi": graph.pi})
    return evaluate((scalar,), {symbols[name]: x for name, x in state.items()}, FIFTY)[0]


@cache
def state_of(system: str, numbers: str) -> dict[str, Any]:
    """Parameters of a set, and the state."""
    given = (STATEMENT if numbers == "statement" else OTHER)[system]
    return {name: value_of(text, {}) for name, text in (STATE | given).items()}


@cache
def by_hand(system: str, numbers: str) -> dict[str, Any]:
    with mpmath.workdps(DIGITS):
        return ORACLES[system]({name: mpmath.mpf(x) for name, x in state_of(system, numbers).items()})


def in_unit(system: str, output: str, value: Any) -> Any:
    return 100 * value if UNITS[system][output].startswith("cm") else value


def close(a: Any, b: Any) -> bool:
    return bool(abs(mpmath.mpf(a) - mpmath.mpf(b)) <= 1e-30 * max(1.0, abs(float(b))))


def test_the_files_have_the_numbers_of_the_statements():
    for system, texts in STATEMENT.items():
        file = model_of(system).numeric_parameters()
        assert file == pytest.approx({name: float(value_of(text, {})) for name, text in texts.items()}, rel=1e-15)
        assert all(value_of(OTHER[system][name], {}) != value_of(text, {}) for name, text in texts.items())


@each("numbers", SETS)
@pytest.mark.parametrize("system", ANSWERS)
def test_the_answers_by_hand_are_the_derivatives_of_the_positions(system, numbers):
    """To 30 digits, and every one that is asked."""
    found = by_hand(system, numbers)
    assert set(found) == set(ANSWERS[system])
    for output, text in ANSWERS[system].items():
        assert close(value_of(text, state_of(system, numbers)), found[output]), output


@each("system, output", [(system, output) for system in PRINTED for output in PRINTED[system]], by="system")
def test_the_book_prints_these_numbers(system, output):
    """Mended, to half a unit of its last digit."""
    text = PRINTED[system][output]
    digits = len(text.partition(".")[2])
    value = in_unit(system, output, by_hand(system, "statement")[output])
    assert abs(float(value) - float(text)) <= 0.500001 * 10**-digits


@each("system", ANSWERS)
def test_the_file_names_what_is_asked_in_its_unit(system):
    outputs = model_of(system).outputs
    assert {name: str(output.unit or "") for name, output in outputs.items()} == UNITS[system]


@each("numbers", SETS)
@each("system, output", REQUESTED, by="system")
def test_the_exact_answer_is_the_one_by_hand(system, output, numbers):
    """The text that solve gives for the statement, read back at both sets, to 30 digits."""
    answer = answers(system)[output]
    assert answer.exact is not None, answer.message
    found = value_of(answer.exact, state_of(system, numbers))
    assert close(found, by_hand(system, numbers)[output]), answer.exact


@each("numbers", SETS)
@each("system, output", REQUESTED, by="system")
def test_the_number_is_the_one_of_the_positions(system, output, numbers):
    """A function of the state at the start."""
    model, answer = model_of(system, numbers), answers(system, numbers)[output]
    starts = [value for values in model.start_values() for value in values.items()]
    state = {**state_of(system, numbers), **dict(starts)}
    expected = in_unit(system, output, value_of(ANSWERS[system][output], state))
    assert answer.value is not None, answer.message
    assert answer.value == pytest.approx(float(expected), rel=1e-12, abs=1e-12)
    assert answer.unit == (UNITS[system][output] or INFERRED[system][output])


@each("system, output", [(system, output) for system in INFERRED for output in INFERRED[system]], by="system")
def test_the_answer_by_hand_grows_as_the_unit_of_its_quantity(system, output):
    """kg, m and s replaced by others: a force grows as kg m/s^2."""
    units = {name: part.unit.text for name, part in model_of(system).parameters.items()} | UNITS_OF_STATE
    state = state_of(system, "statement")
    other = {name: x * FIFTY.number(grown(units[name])) for name, x in state.items()}
    known, found = value_of(ANSWERS[system][output], state), value_of(ANSWERS[system][output], other)
    assert known and close(found, known * FIFTY.number(grown(answers(system)[output].unit)))


@each("system, output", BOOK_SURDS, by="system")
def test_exact_answers_are_the_books_at_its_numbers(system, output):
    """In the book's units: sqrt(61 - 30*sqrt(2))/5."""
    found = value_of(answers(system)[output].exact, state_of(system, "statement"))
    assert close(in_unit(system, output, found), value_of(BOOK_SURDS[system, output], {}))


@each("system, output", REQUESTED, by="system")
def test_exact_answers_are_short(system, output):
    """No longer than a reader's own: at most three times the formula by hand, and 60 characters."""
    exact = answers(system)[output].exact
    assert len(exact) <= 3 * len(ANSWERS[system][output]) + 60, exact


# -- the files in the other verbs -----------------------------------------------------------------------------------

KINDS = {
    "ch9_p1": {"wheel": "plane motion", "rod": "rectilinear translation"},
    "ch9_p2": {"rod1": "rotation about a fixed axis", "plate": "circular translation"},
    "ch9_p3": {"prism": "rectilinear translation"},
    "ch9_s9_p1": {"disc": "rotation about a fixed axis"},
    "ch9_p6": {"plate": "rotation about a fixed axis"},
    "ch9_p7": {"plate": "rotation about a fixed axis"},
    "ch9_p8": {"rod": "plane motion"},
    "ch9_p10": {"circle": "rotation about a fixed axis", "rod": "plane motion"},
    "ch10_p1": {"prism": "rectilinear translation"},
    "ch10_p3": {"disc": "rectilinear translation", "P": "curvilinear translation"},
    "ch10_p4": {"frame": "rotation about a fixed axis"},
}
"""Of the chapters' bodies, as the book names their motions."""


@pytest.mark.parametrize("system", KINDS)
def test_kinds_of_motion_are_recognised(system):
    bodies = eomgen.kinematics(model_of(system)).as_dict()["bodies"]
    assert {name: bodies[name]["kind"] for name in KINDS[system]} == KINDS[system]


@pytest.mark.parametrize("system", [system for system in ANSWERS if system != "s1_rotating_frame"])
def test_what_is_driven_has_no_freedom_left(system):
    """By rank; the plate of ch9-p11 has three before velocities are given."""
    model = model_of(system)
    assert eomgen.kinematics(model).as_dict()["freedoms"]["by_rank"] == (3 if model.given else 0)
