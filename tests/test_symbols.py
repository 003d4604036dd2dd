r"""Declared symbols: what is let in compiles everywhere, what is not says why; a formula tells two things apart.

symbol = '\dot\gamma'
"""

from __future__ import annotations

import re

import pytest
from each import each
from hypothesis import given, settings
from hypothesis import strategies as st
from math_core import LatexToMathML
from slow_run import ALL, usual

import eomgen
from eomgen.documents import rendered
from eomgen.documents.figures import mathtext
from eomgen.documents.latex import names_in, setter_of
from eomgen.errors import ExpressionError, ModelError
from eomgen.model.checks.plausible import warnings_of
from eomgen.symbolic.print.names import COMMANDS, SPACES, Symbol

TOKENS = (*COMMANDS, *SPACES, *"abcXYZ019_^{}'{}__", " ", ",", "+", r"\input", "$", "%", "θ", "\t")

MODEL = r"""
eomgen = 1
space = "plane"
parameters.m = { value = 1, symbol = 'm_C' }
parameters.l = 1
parameters.g = 9.81
coordinates.th = { start = 0.3, symbol = '\theta_A' }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
[bodies.arm]
symbol = 'a'
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "th", symbol = SYMBOL }
"""


def derived(symbol: str = "'A'") -> eomgen.Equations:
    return eomgen.derive(eomgen.loads(MODEL.replace("SYMBOL", symbol)))


@pytest.mark.slow
@settings(derandomize=True, deadline=None, max_examples=250 if ALL else 80)
@given(st.lists(st.sampled_from(TOKENS), min_size=1, max_size=12).map("".join))
def test_what_is_let_in_is_a_symbol_for_whoever_sets_it(text):
    """It is read once more as the same, its braces close, its commands are few; matplotlib draws it."""
    from matplotlib.mathtext import MathTextParser

    try:
        symbol = Symbol.parsed(text)
    except ExpressionError as error:
        assert 0 <= error.column <= len(text) and error.what and error.fix
        return
    assert len(symbol.tex) > Symbol.LONGEST or Symbol.parsed(symbol.tex) == symbol
    for tex in (symbol.tex, symbol.dotted(2), symbol.with_index("x").tex):
        assert tex.count("{") == tex.count("}")
        assert set(re.findall(r"\\(?:[a-zA-Z]+|.)", tex)) <= {*COMMANDS, *SPACES, r"\dddot"}
        MathTextParser("agg").parse(f"${tex}$")


@pytest.mark.slow
@settings(derandomize=True, deadline=None, max_examples=250)
@given(st.lists(st.sampled_from(TOKENS), min_size=1, max_size=12).map("".join))
def test_what_is_let_in_is_mathematics_for_a_browser(text):
    """MathML of it by math-core, which knows nothing of our grammar."""
    converter = LatexToMathML()
    try:
        symbol = Symbol.parsed(text)
    except ExpressionError:
        return
    for tex in (symbol.tex, symbol.dotted(1), f"{symbol.tex} {symbol.dotted(2)}"):
        assert "<math" in converter.convert_with_local_state(tex, displaystyle=False)


@each(
    "text, tex, rate",
    [
        (r"\dot\gamma", r"\dot{\gamma}", r"\ddot{\gamma}"),
        ("J_C", "J_{C}", r"\dot{J}_{C}"),
        (r"\bar x_{\mathrm{max}}^*", r"\bar{x}_{\mathrm{max}}^{*}", r"\dot{\bar{x}}_{\mathrm{max}}^{*}"),
        ("x'_A", r"x_{A}^{\prime}", r"\dot{x}_{A}^{\prime}"),
        (r"\Delta x", r"\Delta x", r"\dot{\Delta x}"),
    ],
)
def test_a_rate_has_its_dot_over_the_letter(text, tex, rate):
    """d/dt J_C is a dotted J with the index C; a dot more on what has one."""
    assert (Symbol.parsed(text).tex, Symbol.parsed(text).dotted(1)) == (tex, rate)


@each(
    "text, what, column, fix",
    [
        (r"\dot\gama", r"unknown command '\gama'", 4, r"did you mean \gamma?"),
        ("a_b_c", "'_' where the letter has an index already", 3, "one pair of { }"),
        ("x_{a", "a brace that is never closed", 2, "close it: }"),
        ("x}", "a brace is closed that was never opened", 1, "leave out the }"),
        ("$x$", "'$' in a symbol", 0, "leave it out"),
        ("\theta", r"in double quotes '\t' is one", 0, "single quotes"),
        ("θ", "not LaTeX everywhere", 0, r"write \theta"),
        (r"\dot", r"'\dot' has nothing to stand on", 4, r"like \dot{x}"),
        ("1a", "begins with a digit", 0, "begin with a letter"),
        (r"\input{x}", r"unknown command '\input'", 0, r"\mathrm{...}"),
        ("x" * 61, "a symbol of 61 characters", 0, "at most 60"),
        (" ", "a symbol without a letter", 0, "like 'J_C'"),
    ],
)
def test_what_is_no_symbol_says_where_and_how_to_mend_it(text, what, column, fix):
    with pytest.raises(ExpressionError) as caught:
        Symbol.parsed(text)
    assert what in caught.value.what and caught.value.column == column and fix in caught.value.fix


def test_an_error_stands_at_its_place_in_the_file():
    with pytest.raises(ModelError) as caught:
        eomgen.loads(MODEL.replace("SYMBOL", r"'A_\gama'"), "a.toml")
    assert "a.toml:12:56: unknown command" in str(caught.value) and "^^^^^" in str(caught.value)
    with pytest.raises(ModelError, match="in single quotes a backslash is one"):
        eomgen.loads(MODEL.replace("SYMBOL", r'"\gamma"'))


def test_every_format_has_the_symbols_that_are_declared():
    """LaTeX and Markdown set them, JSON names them, and text keeps the names, which are read back."""
    document = derived().derivation
    for form in ("latex", "markdown"):
        text = rendered(document, form)
        for tex in (
            r"\ddot{\theta}_{A}",
            "m_{C}",
            "x_{a}",
            "A_{x}",
            r"T &= \frac{1}{6} m_{C} l^{2} \dot{\theta}_{A}^{2}",
        ):
            assert tex in text, (form, tex)
        assert "mathrm{arm}" not in text
    symbols = derived().as_dict()["symbols"]
    assert {name: symbols[name] for name in ("th'", "m", "R_arm_x")} == {
        "th'": r"\dot{\theta}_{A}",
        "m": "m_{C}",
        "R_arm_x": "A_{x}",
    }
    assert "theta_A" not in rendered(document, "text") and "R_arm_x" in rendered(document, "text")


def test_each_reaction_may_have_a_symbol_of_its_own():
    text = rendered(derived("{ x = 'H', y = 'V_0' }").derivation, "latex")
    assert "H &= " in text and "V_{0} &= " in text


def test_two_things_with_one_symbol_are_a_warning():
    """Declared against declared, and against what a name looks like by itself."""
    (found,) = warnings_of(eomgen.loads(MODEL.replace("SYMBOL", "'A'").replace("'m_C'", "'l'")))
    assert (found.path, found.what) == (("parameters", "m", "symbol"), "l stands for parameter 'l' too")
    (found,) = warnings_of(eomgen.loads(MODEL.replace("SYMBOL", "{ x = 'm_C' }")))
    assert "m_{C} stands for" in found.what
    assert warnings_of(eomgen.loads(MODEL.replace("SYMBOL", "'A'"))) == ()


@pytest.mark.slow
@pytest.mark.parametrize("name", usual(["double_pendulum", "sliding_ladder", "whipple_bicycle", "seeds/ch22_p1"], 2, 1))
def test_no_reaction_looks_like_a_position(name):
    """Whatever stands in a derivation, two names never have one look: stick_x was x_stick."""
    document = eomgen.derive(f"models/{name}.toml").derivation
    names = names_in(document)
    looks = {name: setter_of(document).notation.latex(name) for name in names}
    assert len(set(looks.values())) == len(looks)
    assert not any(
        re.fullmatch(r"[xyz]_\{.*|\\mathrm\{\w{2,}\}_\{[xyz]\}", looks[name]) for name in names if "_" in name
    )


def test_pictures_set_names_as_formulas_do():
    """One rule: theta1' is a dotted theta with an index in both."""
    assert mathtext("theta1'") == r"\dot{\theta}_{1}" and mathtext("m_b") == mathtext("mb") == "m_{b}"
