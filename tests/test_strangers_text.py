"""A stranger's text in a model: in no form that is written or shown is it anything but text."""

from __future__ import annotations

import html
import json
import warnings

import pytest

import eomgen
from eomgen.documents import rendered
from eomgen.errors import visible

pytestmark = pytest.mark.slow

NAME = (
    r"<img src=x onerror=alert(1)> $\frac{1}{0}$ | \input{/etc/passwd} %x_^~#& [a](javascript:b) `c`" + "\u202e\x1b[31m"
)
MODEL = f"""
eomgen = 1
name = {json.dumps(NAME)}
about = {json.dumps(NAME)}
source = {json.dumps(NAME)}
space = "plane"
[parameters]
m = {{ value = 1, unit = "kg", about = {json.dumps(NAME)} }}
[coordinates]
x = {{ start = 1, unit = "m", about = {json.dumps(NAME)} }}
[bodies.b]
mass = "m"
joint = {{ kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = 10 }}
"""


@pytest.fixture(scope="module")
def equations():
    return eomgen.derive(eomgen.loads(MODEL))


@pytest.mark.parametrize("form", ["text", "latex", "markdown", "json"])
def test_every_form_escapes_in_its_own_way(equations, form):
    """No tag and no table's bar in Markdown, no command in LaTeX, nothing that steers a terminal in any."""
    text = rendered(equations.derivation, form)
    assert visible(text) == text and "onerror" in text
    if form == "markdown":
        assert r"\<img" in text and "<img" not in text.replace(r"\<img", "")
        assert all(line.count("|") - line.count(r"\|") in (0, 5) for line in text.splitlines() if "onerror" in line)
    if form == "latex":
        assert r"\input{/" not in text and r"\frac{1}{0}" not in text and "%x" not in text.replace(r"\%x", "")
    if form == "json":
        assert text.isascii() and json.loads(text)["name"] == NAME


def test_what_notebooks_show_holds_no_tag(equations):
    """Tables in HTML, equations in LaTeX, results in Markdown."""
    run = eomgen.simulate(equations.model, time=0.1, samples=3)
    shown = run._repr_html_() + equations._repr_latex_() + eomgen.inertia(equations.model)._repr_markdown_()
    assert "<img" not in shown.replace(r"\<img", "") and "<script" not in shown
    assert html.escape("x'") in run._repr_html_()


def test_a_picture_is_drawn_with_the_text_as_it_is(equations, tmp_path):
    """No formula of matplotlib is made of it, nothing is warned of, and the file holds no tag."""
    path = tmp_path / "modes.svg"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        eomgen.linearize(equations.model).plot(path)
    assert b"<img" not in path.read_bytes()


@pytest.mark.parametrize("first", "=+-@\t")
def test_no_cell_of_a_head_begins_as_a_formula_of_a_spreadsheet(first):
    """A name in a model is made of letters, digits and _: none begins with = + - @, and so no column."""
    for text in (f'coordinates = {{ "{first}x" = 0 }}', f'bodies = {{ "{first}b" = {{ mass = 1 }} }}'):
        with pytest.raises(eomgen.ModelError, match=r"cannot name|not TOML"):
            eomgen.loads(f'eomgen = 1\nspace = "plane"\n{text}\n')


def test_an_error_shows_such_a_text_too():
    """The line of the file that is shown, the name in the message."""
    with pytest.raises(eomgen.ModelError) as caught:
        eomgen.loads(MODEL.replace("stiffness", "stifness") + f"x = {json.dumps(NAME)}\n")
    assert visible(str(caught.value)) == str(caught.value)
