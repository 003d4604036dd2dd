"""Chapters 11, 13, 21 and the inertia of the notes: what `solve` answers against an oracle in floats."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from functools import cache
from random import Random
from typing import Any

import pytest
from answers_of_chapters_11_13_21 import ANSWERS, AS_PRINTED
from derivations import answers as answers_of
from derivations import model_path
from each import each
from oracle_of_chapters_11_13_21 import ORACLES
from other_units import grown

import eomgen
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.text import as_expression, parse
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

REQUESTED = [(system, output) for system in ANSWERS for output in ANSWERS[system]]
UNITS = (  # (system and output, as a pattern): the unit that is asked for
    (r"ch11_p\d (c\d\d_[xy]|[xy]\d)", "m"),
    (r"ch11_p\d omega\d", "rad/s"),
    (r"ch11_p\d v_._[xy]", "m/s"),
    (r"ch13_p\d M\d", "kg"),
    (r"ch13_p[13] J_O", "kg*cm^2"),
    (r"ch13_p[24] J_\w+", "kg*m^2"),
    # by what they are, where the file asks for none
    (r"ch11_p\d omega2_over_omega1", ""),
    (r"ch13_b\d J_\w+", "kg*m^2"),
    (r"ch21_p\d ([VH]_[A-E]|[NR]\d\w*)", "N"),
    (r"ch21_p\d M_[A-E]", "N*m"),
    (r"s1_\w+ I[ck]?_\w+", "kg*m^2"),
    (r"s1_particles L_[xyz]", "kg*m^2/s"),
    (r"s1_particles T", "J"),
)
BOOKS = {"p": "N/m", "P": "N", "a": "m"}  # units of what chapter 21 leaves in letters


@cache
def model_of(system: str, other: bool = False) -> eomgen.Model:
    """The model file; or the same with every parameter another number."""
    model = eomgen.load(model_path(system))
    return with_numbers(model, numbers_of(system, other)) if other else model


def with_numbers(model: eomgen.Model, numbers: dict[str, Fraction]) -> eomgen.Model:
    """The model with other values of its parameters."""
    texts = {name: f"{x.numerator}/{x.denominator}" for name, x in numbers.items()}
    changed = {name: replace(model.parameters[name], value=as_expression(x)) for name, x in texts.items()}
    return replace(model, parameters=dict(model.parameters) | changed)


def numbers_of(system: str, other: bool = False) -> dict[str, Fraction]:
    """The parameters of the file; or others, each within a factor of 2."""
    rng = Random(system)
    file = {name: Fraction(p.value.literal) for name, p in model_of(system).parameters.items()}
    return {name: x * Fraction(rng.randint(60, 90), 100) for name, x in file.items()} if other else file


@cache
def answers(system: str, other: bool = False) -> dict[str, Any]:
    return answers_of(model_path(system)) if not other else eomgen.solve(model_of(system, other))


def found_by_the_oracle(system: str, other: bool) -> dict[str, float]:
    return ORACLES[system]({name: float(x) for name, x in numbers_of(system, other).items()})


def value_of(text: str, numbers: dict[str, Fraction]) -> Any:
    """A text of the grammar at numbers, with 50 digits."""
    graph, digits = Graph(), fifty_digits()
    symbols = {name: graph.symbol(name) for name in numbers}
    scalar = parse(text).evaluate(symbols | {"pi": graph.pi})
    return evaluate((scalar,), {symbols[name]: digits.number(x) for name, x in numbers.items()}, digits)[0]


@each("other", [False, True])
@pytest.mark.parametrize("system", ANSWERS)
def test_the_answers_by_hand_are_those_of_the_oracle(system, other):
    """Velocity fields, sums over particles and equilibrium of bodies and joints, in floats."""
    found = found_by_the_oracle(system, other)
    assert set(found) == set(ANSWERS[system])
    for output, text in ANSWERS[system].items():
        by_hand = float(value_of(text, numbers_of(system, other)))
        assert by_hand == pytest.approx(found[output], rel=1e-10, abs=1e-10), output


@each("system, output", REQUESTED, by="system")
def test_the_exact_answer_is_the_one_by_hand(system, output):
    """The text that solve gives, read back, at two sets of numbers to 30 digits."""
    answer = answers(system)[output]
    assert answer.exact is not None, answer.message
    assert answer.method
    for other in (False, True):
        numbers = numbers_of(system, other)
        ours, book = value_of(answer.exact, numbers), value_of(ANSWERS[system][output], numbers)
        assert abs(ours - book) <= 1e-30 * max(1.0, abs(book)), answer.exact


@each("other", [False, True])
@each("system, output", REQUESTED, by="system")
def test_the_number_is_the_oracles(system, output, other):
    """At the file's parameters and at others."""
    answer, expected = answers(system, other)[output], found_by_the_oracle(system, other)[output]
    assert answer.value is not None, answer.message
    in_unit = 10_000 if "cm^2" in (answer.unit or "") else 1
    assert answer.value == pytest.approx(in_unit * expected, rel=1e-9, abs=1e-9)


@each("system, output", AS_PRINTED, by="system")
def test_an_exact_answer_is_as_short_as_the_books(system, output):
    assert answers(system)[output].exact == AS_PRINTED[system, output]


@each("system, output", REQUESTED, by="system")
def test_an_answer_is_in_the_unit_that_is_asked_for(system, output):
    """Each output has one: declared, or that of its quantity."""
    (expected,) = (unit for pattern, unit in UNITS if re.fullmatch(pattern, f"{system} {output}"))
    assert answers(system)[output].unit == expected


@pytest.mark.parametrize("system", [system for system in ANSWERS if not system.startswith("ch11")])
def test_the_oracles_numbers_grow_as_their_units_say(system):
    """kg, m and s replaced by others: a moment of inertia grows as kg m^2. Chapter 11 has no parameters."""
    parameters, numbers = model_of(system).parameters, numbers_of(system)
    units = {name: BOOKS[name] if part.unit is None else part.unit.text for name, part in parameters.items()}
    known = found_by_the_oracle(system, False)
    found = ORACLES[system]({name: float(x * grown(units[name])) for name, x in numbers.items()})
    for output, answer in answers(system).items():
        if output in known:
            expected = known[output] * float(grown(answer.unit))
            assert found[output] == pytest.approx(expected, rel=1e-9, abs=1e-9), output


@pytest.mark.parametrize("system", ANSWERS)
def test_every_output_of_the_file_is_answered(system):
    """Also those that the exercise does not ask for."""
    assert [name for name, answer in answers(system).items() if not answer.answered] == []
    assert model_of(system).source == system.replace("_", "-")


# -- triangulated parts as rigid bodies ------------------------------------------------------------------------------

BLOCKS = """
eomgen = 1
space = "plane"
parameters = { P = 1, a = 1 }
[bodies.left]                    # the joints 1 to 7
points = { n1 = [0, 0], n2 = ["3*a", "a"], n6 = ["9*a", "3*a"], n7 = ["9*a", 0] }
[bodies.right]                   # the joints 10 to 13
points = { n10 = ["15*a", "4*a"], n11 = ["15*a", 0], n12 = ["18*a", "4*a"], n13 = ["18*a", 0] }
[trusses.M]
members = ["n6-n8", "n8-n10", "n7-n9", "n9-n11", "n8-n9", "n6-n9", "n9-n10"]
[trusses.M.nodes]
n6 = ["9*a", "3*a"]
n7 = ["9*a", 0]
n8 = ["12*a", "4*a"]
n9 = ["12*a", 0]
n10 = ["15*a", "4*a"]
n11 = ["15*a", 0]
[constraints]
R1 = { kind = "pin", points = ["left.n1"] }
R13 = { kind = "support", point = "right.n13", normal = [0, 1] }
J6 = { kind = "pin", points = ["left.n6", "M.n6"] }
J7 = { kind = "pin", points = ["left.n7", "M.n7"] }
J10 = { kind = "pin", points = ["right.n10", "M.n10"] }
J11 = { kind = "pin", points = ["right.n11", "M.n11"] }
[forces]
at_2 = { kind = "force", point = "left.n2", force = [0, "-4*P"] }
at_6 = { kind = "force", point = "left.n6", force = [0, "-6*P"] }
at_8 = { kind = "force", point = "M.n8", force = [0, "-12*P"] }
at_12 = { kind = "force", point = "right.n12", force = ["-3*P", 0] }
[outputs]
N79 = "tension(M, n7-n9)"
N69 = "tension(M, n6-n9)"
N89 = "tension(M, n9-n8)"
N9_10 = "tension(M, n9, n10)"
R1_x = "reaction_x(R1)"
R1_y = "reaction_y(R1)"
R13_y = "reaction_y(R13)"
"""


def test_a_truss_of_rigid_blocks_has_the_forces_of_the_whole():
    """ch21-p5: what is triangulated is one rigid body; the members between and the reactions do not see it."""
    blocks = eomgen.solve(eomgen.loads(BLOCKS))
    assert {name: answer.exact for name, answer in blocks.items()} == {
        name: answers("ch21_p5")[name].exact for name in blocks
    }


@pytest.mark.parametrize("system", [system for system in ANSWERS if system.startswith("ch21")])
def test_virtual_work_and_equilibrium_agree(system):
    """Each reaction from its released mechanism alone is that of the balance of the bodies."""
    found = eomgen.statics(model_of(system)).found
    assert found.reactions and not found.disagreeing
    assert all(reaction.agree and reaction.work is not None for reaction in found.reactions)
