"""Pages that leave are read back by a reader of their own: what stands there is what was found."""

from __future__ import annotations

import re
from functools import cache

import pytest

import eomgen
from eomgen.documents import rendered
from eomgen.documents.document import Document
from eomgen.documents.pages_read import SetLetters, tokens_of, tree_value, typeset
from eomgen.documents.read_back import misspelt, page_read_back
from eomgen.documents.texts_read import json_read_back, text_read_back
from eomgen.symbolic.numeric.evaluation import FLOAT
from eomgen.symbolic.print.latex import Notation

SWING = """
eomgen = 1
name = "A rod on a slider"
space = "plane"

[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.5, unit = "m", about = "of the rod" }
k = { value = 30, unit = "N/m" }
I = { value = 0.04, unit = "kg*m^2" }
g = { value = 9.81, unit = "m/s^2" }

[coordinates]
x = { start = 1, unit = "m", about = "of the slider" }
theta1 = { start = 0.3, unit = "rad" }

[bodies.slider]
mass = "m"
inertia = 0
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "k" }

[bodies.rod]
mass = "m"
center = ["l/2", 0]
inertia = "I"
points = { B = ["l", 0] }
joint = { kind = "revolute", on = "slider", at = [0, 0], angle = "theta1" }

[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""


@cache
def document(text: str = SWING) -> Document:
    return eomgen.derive(eomgen.loads(text)).document


def reported(page: str, form: str) -> str:
    """What is wrong with a page; "" where it is read back as it was found."""
    return "; ".join(check.detail for check in page_read_back(document(), page, form) if check.status == "fails")


@pytest.mark.parametrize("form", ["latex", "markdown"])
def test_a_page_says_what_was_found(form: str):
    """Each formula, number, entry and word."""
    assert not reported(rendered(document(), form), form)


CHANGES = {
    "a minus of a first term": ("= - ", "= "),
    "a sign": (" + ", " - "),
    "a square of a cosine": (r"\cos^{2}", r"\cos"),
    "an exponent": ("^{2}", "^{3}"),
    "a dot less": (r"\ddot{", r"\dot{"),
    "a denominator": (r"\frac{1}{2}", r"\frac{1}{3}"),
    "brackets": (r"\left(", r"\right)"),
    "a digit": ("9.81", "9.82"),
    "a unit": ("kg", "N"),
    "a word": ("Equations", "Equation"),
}


@pytest.mark.parametrize("form", ["latex", "markdown"])
@pytest.mark.parametrize("change", CHANGES)
def test_a_change_of_a_page_is_seen(form: str, change: str):
    """Where it stands first and where it stands last."""
    page, (old, new) = rendered(document(), form), CHANGES[change]
    if old not in page:
        pytest.skip("not on this page")
    last = page.rpartition(old)
    assert reported(page.replace(old, new, 1), form)
    assert reported(f"{last[0]}{new}{last[2]}", form)


def test_typeset_formulas_are_read_as_a_person_reads_them():
    r"""- a \sin^{2} 2 x \cos x + \frac{b}{c} \big/ (1 + e^{-x})"""
    letters = SetLetters({"a": "a", "b": "b", "x": "x", "c": "c_{1}", "y": "y"}, ("a", "b", "x", "c", "y", "y''"))
    values = {"a": 2.0, "b": 3.0, "x": 0.7, "c": 5.0, "y": 0.1, "y''": 4.0}

    def read(tex: str) -> float:
        return tree_value(typeset(tokens_of(tex), letters), values, FLOAT)

    from math import cos, exp, sin

    assert read(r"- a \sin^{2} 2 x \cos x") == pytest.approx(-2 * sin(1.4) ** 2 * cos(0.7))
    assert read(r"\frac{b}{c_{1}} \big/ \bigl(1 + e^{-x}\bigr) - 2 \cdot 10^{-3}") == pytest.approx(
        0.6 / (1 + exp(-0.7)) - 2e-3
    )
    assert read(r"\left\lvert y - \ddot{y} \right\rvert^{2}") == pytest.approx(3.9**2)
    assert read(r"\begin{cases} a & x < b \\ 7 & \text{otherwise} \end{cases}") == 2


TEXT = {
    "a sign": (" + ", " - "),
    "an exponent": ("^2", "^3"),
    "a digit": ("9.81", "9.82"),
    "a unit": ("kg", "N"),
    "a word": ("Equations", "Equation"),
    "a cell under another head": ("    m ", "       m "),
    "a number of a section": ("2. ", "3. "),
}


@pytest.mark.parametrize("change", TEXT)
def test_a_change_of_a_text_is_seen(change: str):
    """Where it stands first and where it stands last."""
    page, (old, new) = rendered(document(), "text"), TEXT[change]
    last = page.rpartition(old)
    assert reported_of_text(page) == ""
    assert reported_of_text(page.replace(old, new, 1))
    assert reported_of_text(f"{last[0]}{new}{last[2]}")


def test_columns_of_a_text_that_are_exchanged_are_seen():
    """A cell stands under its head."""
    page = rendered(document(), "text")
    assert reported_of_text(re.sub(r"kg( +)2\b", r"2\1kg", page, count=1))


def reported_of_text(page: str) -> str:
    return "; ".join(check.detail for check in text_read_back(document(), page) if check.status == "fails")


MACHINES = {
    "a number": ("9.81", "9.82"),
    "a sign": (" + ", " - "),
    "a unit": ('"kg"', '"N"'),
    "a title": ("Equations", "Equation"),
    "a key": ('"exact"', '"value"'),
}


@pytest.mark.slow
@pytest.mark.parametrize("change", MACHINES)
def test_a_change_of_what_machines_get_is_seen(change: str):
    """Where it stands first and where it stands last."""
    found = eomgen.linearize(eomgen.loads(SWING)).document
    entries, page, (old, new) = found.entries(), rendered(found, "json"), MACHINES[change]
    last = page.rpartition(old)

    def wrong(text: str) -> bool:
        return any(check.status == "fails" for check in json_read_back(found, entries, text))

    assert not wrong(page) and old in page
    assert wrong(page.replace(old, new, 1)) and wrong(f"{last[0]}{new}{last[2]}")


def test_an_index_that_is_not_set_is_seen():
    r"""R_{\mathrm{bar},x} is R_bar_x, R_{\mathrm{bar}} is not; what is declared is set as it is declared."""
    assert not misspelt(
        {name: Notation().latex(name) for name in ("R_bar_x", "theta_1'", "mu_0", "x_left")}, Notation()
    )
    assert misspelt({"R_bar_x": r"R_{\mathrm{bar}}"}, Notation())
