"""What leaves as text is read back: formulas of a derivation, and what `derive --json` carries."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

import eomgen
from eomgen.certificate import certify
from eomgen.documents.derivation import printed_formulas
from eomgen.equations import Equations
from eomgen.proof.printed import Printed

MODELS = Path(__file__).parent.parent / "models"


@cache
def equations() -> Equations:
    return eomgen.derive(MODELS / "elastic_pendulum.toml", method="lagrange")


def carried() -> Printed:
    """What is printed, and what the file for machines holds."""
    found = equations()
    texts = found._texts
    named = tuple((name, text, x) for (name, x), text in zip(texts.scalars, texts.texts, strict=True))
    return replace(printed_formulas(found.derivation), texts=named, definitions=tuple(texts.definitions))


def failing(printed: Printed) -> list[str]:
    return [check.name for check in certify(equations().graph, printed=printed).checks if check.status == "fails"]


def test_texts_of_a_derivation_and_of_its_file_hold():
    """Each text, read back, is worth at any state what it stands for."""
    assert carried().texts and not failing(carried())


@pytest.mark.parametrize("entry", ["mass_matrix", "forcing", "kinetic_energy", "generalized_forces", "equations"])
def test_a_wrong_text_for_machines_is_a_contradiction(entry: str):
    """Twice the text of one entry is not that entry."""
    printed = carried()
    k = next(k for k, (name, text, _) in enumerate(printed.texts) if name == entry and text != "0")
    name, text, scalar = printed.texts[k]
    texts = (*printed.texts[:k], (name, f"2*({text})", scalar), *printed.texts[k + 1 :])
    assert failing(replace(printed, texts=texts)) == ["texts for machines, read back, are the equations"]


def test_an_expression_that_the_grammar_does_not_read_is_a_contradiction():
    """A quotient without its divisor is no formula, and is not passed over."""
    printed = carried()
    broken = replace(printed, expressions=printed.expressions | {"m*l/()"})
    assert "what is printed, read back, holds along the motion" in failing(broken)


def test_cases_are_printed_in_words_that_the_grammar_does_not_have():
    """V of a bead on a path of two pieces, "... where s <= L; ...", is no broken expression."""
    found = eomgen.derive(MODELS / "loop_the_loop.toml")
    printed = printed_formulas(found.derivation)
    sides = {text for sides in printed.formulas for text in sides}
    assert any(" where " in text for text in sides) and not any(" where " in text for text in printed.expressions)
