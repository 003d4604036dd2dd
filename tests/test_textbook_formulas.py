"""Formulas as textbooks print them beside ours: the same statement, and how long each is."""

from __future__ import annotations

import statistics
from pathlib import Path

import pytest
from each import each
from golden_formulas import (
    LIST,
    OWN,
    Golden,
    agrees,
    compared,
    golden_formulas,
    letters_of_latex,
    letters_of_text,
)
from slow_run import sampled, usual

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

LIMIT = 1.3  # of our length over the author's
MEDIAN = 1.0
SAME = {"cot": "tan"}  # a function that the grammar has not, by the one that stands in the text for it


@sampled(3)
@each("path, golden", [(golden.path, golden) for golden in golden_formulas()], by="path")
def test_ours_says_what_the_author_says_about_as_shortly(path: Path, golden: Golden) -> None:
    """f_ours = f_his at random exact states, of an equation of motion up to a factor; in at most 1.3 times his marks.

    Exceptions are those that the list names, and each still is one.
    """
    (row,) = compared((golden,))
    assert agrees(golden, row.ours)
    assert (row.ratio > LIMIT) is bool(golden.above), row.ratio


@each("golden", golden_formulas())
def test_latex_and_text_of_the_author_hold_the_same_letters(golden: Golden) -> None:
    """What is proven equal is what is measured: neither has a letter more."""
    letters = letters_of_latex(golden.author)
    for function, stands in SAME.items():
        letters[stands] += letters.pop(function, 0)
    assert +letters == letters_of_text(golden.text)


def test_the_list_is_as_large_as_it_says() -> None:
    """80 formulas, 40 of them of models written for the list, each named once and with its source."""
    formulas = golden_formulas()
    assert len(formulas) >= 80
    assert sum(golden.model.startswith(OWN) for golden in formulas) >= 40
    assert len({golden.name for golden in formulas}) == len(formulas)
    assert all(golden.source for golden in formulas)
    written = {f"{OWN}{path.stem}" for path in (LIST.parent / OWN).glob("*.toml")}
    assert written == {golden.model for golden in formulas if golden.model.startswith(OWN)}


def test_ours_are_as_short_as_the_authors() -> None:
    """Median of the ratios at most 1.0; each is asked for by itself beside its model."""
    rows = compared(usual(golden_formulas(), 8))
    assert statistics.median(row.ratio for row in rows) <= MEDIAN
