"""What eomgen prints is right when it is handed in: derivations, answers, reactions, small motions, structures."""

from __future__ import annotations

import json
import random
import re
from pathlib import Path

import pytest
from click.testing import CliRunner
from each import each
from slow_run import ALL, sampled

import eomgen
from eomgen.cli import main
from eomgen.judge.case import Case
from eomgen.judge.derivations import Derivation, judged_derivation
from eomgen.judge.judge import Judge
from eomgen.model import model_at
from eomgen.study import model_to_study

MODELS = Path(__file__).parents[2] / "models"
VERBS = ("derive", "solve", "reactions", "linearize", "statics")
USUAL = (
    *(("simple_pendulum", verb) for verb in VERBS),
    ("cart_pole", "derive"),
    ("gyrostat", "derive"),
    ("disc_leaves_cylinder", "solve"),
    ("beam_with_overhang", "statics"),
    ("two_mass_oscillator", "statics"),
    ("seeds/ch22_p1", "solve"),
    ("seeds/ch16_p5", "derive"),
)
NAMES = sorted(str(path.relative_to(MODELS).with_suffix("")) for path in MODELS.rglob("*.toml"))
SPREAD = [(name, verb) for name in NAMES[::8] for verb in ("derive", "solve")]  # each line of all would take an hour
CASES = (*USUAL, *(case for case in SPREAD if case not in USUAL)) if ALL else USUAL
UNJUDGED = re.compile(  # what is printed and is no statement on the model's quantities, or is not judged
    r"it names nothing|general law|numbers alone|'dM'|'x' is neither|unknown names? "
    r"|no sign between|a value that is assumed|'\\sum'|'\\partial'|'\\begin'|'\['|statically indeterminate|unexpected"
)
PENDULUM = MODELS / "simple_pendulum.toml"


def printed(verb: str, model: Path, form: str) -> str:
    """What a verb prints of a model, without its proof."""
    words = [verb, str(model), "--no-certify", "--format", form, "--patience", "none"]
    return CliRunner().invoke(main, words).stdout


def judge_of(model: Path | str) -> Judge:
    return Judge(Case(model_to_study(model_at(model) if isinstance(model, Path) else eomgen.loads(model))))


@sampled(2)
@pytest.mark.slow
@pytest.mark.by_model
@pytest.mark.parametrize("name, verb", CASES)
def test_each_line_that_is_printed_is_right(name, verb):
    """Text and LaTeX: no line is wrong; what is not read, or not decided, is none of the quantities.

    Slow: each line is a verdict.
    """
    judge, wrong = judge_of(MODELS / f"{name}.toml"), []
    for form in ("text", "latex"):
        derivation = judged_derivation(judge, printed(verb, MODELS / f"{name}.toml", form))
        for line in derivation.lines:
            if not (line.verdict or line.defines or _is_condition(verb, line.verdict.reason, line.equation.text)):
                wrong.append((form, line.equation.line, line.equation.text, str(line.verdict)))
        for equation, why in derivation.skipped:
            if not UNJUDGED.search(why):
                wrong.append((form, equation.line, equation.text, why))
    assert not wrong


def _is_condition(verb: str, reason: str, text: str) -> bool:
    """True of the general law of small motions, and of an equilibrium that is none in closed form."""
    small = verb == "linearize" and "unknown name" in reason
    return small or (verb == "statics" and ("none is found" in reason or text.startswith("F_")))


@sampled(2)
@pytest.mark.slow
@pytest.mark.parametrize("name", ("simple_pendulum", "cart_pole"))
def test_no_line_with_another_number_or_sign_is_right(name):
    """A number before a letter, or the first sign, is changed: what was right is right no more, unless both are 0."""
    judge, draw, passed = judge_of(MODELS / f"{name}.toml"), random.Random(5), []
    lines = judged_derivation(judge, printed("derive", MODELS / f"{name}.toml", "latex")).lines
    for line in lines:
        left, sign, right = line.equation.text.partition("=")
        if line.defines or right.strip() in ("0", ""):
            continue
        changed = f"{left}{sign} {draw.choice((3, 5, 7))} ({right})"
        found = judged_derivation(judge, f"\\[{changed}\\]")
        passed += [changed for each in found.lines if each.verdict]
    assert len(lines) > 10 and not passed


SHEET = r"""\documentclass{article}\begin{document}
The kinetic energy is \[ T = \frac12 m l^2 \dot\theta^2 \] where $v = l\dot\theta$; with $h = l\cos\theta$
\[ V = m g h \]
\begin{align}
  \frac{d}{dt}\frac{\partial T}{\partial \dot\theta} &= m l^2 \ddot\theta \\
  Q_\theta &= m g l \sin\theta
\end{align}
so that $\sum Q_k = 0$ and $$ m l^2 \ddot\theta - m g l\sin\theta = 0. $$
\end{document}
"""


def test_a_derivation_is_judged_line_by_line():
    """V has the wrong sign; the force and the equation of motion only carry that on."""
    found = judged_derivation(judge_of(PENDULUM), SHEET)
    assert isinstance(found, Derivation)
    reported = [(x.equation.line, x.verdict.verdict, x.carried_on, x.defines) for x in found.lines]
    assert reported == [
        (2, "right", False, ""),
        (2, "right", False, ""),
        (2, "undecided", False, "h"),
        (3, "wrong", False, ""),
        (5, "right", False, ""),
        (6, "wrong", True, ""),
        (8, "wrong", True, ""),
    ]
    assert found.first_wrong is found.lines[3]
    assert [why for _, why in found.skipped] == ["a general law: its index stands for each of several"]


def test_a_wrong_number_of_an_output_is_answered_by_its_value():
    """theta_dd is -8.2548 1/s^2 at the start; no difference of formulas is shown."""
    found = eomgen.verify(PENDULUM, "theta_dd = -9 1/s^2")
    assert found.verdict == "wrong" and found.causes[0].text.startswith("it is theta_dd = -8.254830361 1/s")


def test_an_index_that_the_model_has_is_no_general_law():
    """r_i is a length of the file, Q_k stands for each generalized force."""
    text = PENDULUM.read_text(encoding="utf-8").replace('"l"', '"r_i"').replace("\nl = {", "\nr_i = {")
    found = judged_derivation(judge_of(text), "$ x_{bob} = r_i \\sin\\theta $ and $ Q_k = 0 $")
    assert [line.verdict.verdict for line in found.lines] == ["right"] and len(found.skipped) == 1


def test_another_mistake_is_not_carried_on():
    """Beside the wrong V the equation of motion has a mistake of its own."""
    found = judged_derivation(
        judge_of(PENDULUM), SHEET.replace("m l^2 \\ddot\\theta - m g", "2 m l^2 \\ddot\\theta - m g")
    )
    assert [x.carried_on for x in found.lines if x.verdict.verdict == "wrong"] == [False, True, False]


@pytest.mark.slow
@pytest.mark.parametrize("ending", [".tex", ".md", ".ipynb", ".txt"])
def test_files_of_derivations_have_lines_in_json(tmp_path, ending):
    """.tex, .md, .ipynb are derivations, others with --derivation; JSON says line, first_wrong, carried_on, skipped."""
    text = SHEET
    if ending == ".ipynb":
        text = json.dumps(
            {"cells": [{"cell_type": "markdown", "source": [SHEET]}, {"cell_type": "code", "source": []}]}
        )
    path = tmp_path / f"sheet{ending}"
    path.write_text(text)
    words = ["verify", str(PENDULUM), "--file", str(path), "--json", "--no-certify"]
    found = CliRunner().invoke(main, [*words, *(["--derivation"] if ending == ".txt" else [])])
    reported = json.loads(found.stdout)
    assert found.exit_code == 5 and len(reported["equations"]) == 7 and len(reported["skipped"]) == 1
    assert [x["first_wrong"] for x in reported["equations"]] == [False, False, False, True, False, False, False]
    assert [x["carried_on"] for x in reported["equations"]][5:] == [True, True]
    assert reported["equations"][2]["defines"] == "h" and reported["skipped"][0]["line"] == 8


RIGHT_LINES = [
    "x_{\\mathrm{bob}} = l\\sin\\theta",
    "v_{x,bob} = l \\dot\\theta \\cos\\theta",
    "v_{bob}^2 = l^2 \\dot\\theta^2",
    "\\omega_{rod} = \\dot\\theta",
    "V_{weight} = -m g l \\cos\\theta",
    "Q_\\theta = -m g l \\sin\\theta",
    "E_kin = 1/2*m*l^2*theta'^2",
    "E_{pot} = -m g l\\cos\\theta",
    "U = -m*g*l*cos(theta)",
    "K = 1/2*m*l^2*theta'^2",
    "T = 2\\pi\\sqrt{l/g}",
    "f = 1/(2*pi)*sqrt(g/l)",
    "omega_0 = sqrt(g/l)",
    "theta_dd = -8.254830361 1/s^2",
    "theta_dd = -8.255 1/s²",
    "K = [[m*g*l]]",
    "m*l^2*theta''*deltatheta + m*g*l*sin(theta)*deltatheta = 0",
    "K[theta, theta] = m*l*g",
    "T = 1/2*m*v_bob^2 = 1/2*m*l^2*theta'^2",
    "\\begin{aligned} T &= \\tfrac12 m l^2\\dot\\theta^2 \\\\ V &= -m g l\\cos\\theta \\end{aligned}",
    "x_bob = l*sin(theta) where theta <= 1; l*sin(theta) otherwise",
]
WRONG_LINES = [
    "x_{bob} = l\\cos\\theta",
    "T = 2\\pi\\sqrt{g/l}",
    "f = sqrt(g/l)*pi",
    "theta_dd = -8.26 1/s^2",
    "theta_dd = -8.2548 1/s",
    "K = [[m*g]]",
    "U = m*g*l*cos(theta)",
    "Q_\\theta = m g l \\sin\\theta",
    "m*l^2*theta''*deltatheta - m*g*l*sin(theta)*deltatheta = 0",
    "K[theta, theta] = 2*m*l*g",
    "T = 1/2*m*v_bob^2 = m*l^2*theta'^2",
    "\\begin{aligned} T &= \\tfrac12 m l^2\\dot\\theta^2 \\\\ V &= m g l\\cos\\theta \\end{aligned}",
    "x_bob = l*sin(theta) where theta <= 1; l*cos(theta) otherwise",
]


@pytest.mark.slow
@each("line", RIGHT_LINES)
def test_students_letters_are_read(line):
    """Quantities as books and derivations write them."""
    assert judge_of(PENDULUM).verdict(line)


@pytest.mark.slow
@each("line", WRONG_LINES)
def test_students_letters_make_nothing_right(line):
    """The same with a mistake."""
    assert judge_of(PENDULUM).verdict(line).verdict != "right"


OF_OTHERS = [
    ("atwood", "a = \\frac{2(m_1-m_2)}{2m_1+2m_2+M} g", "right"),
    ("atwood", "S_1 = m_1*(g - a)", "right"),
    ("atwood", "S_2 = m_2*(g + a)", "right"),
    ("atwood", "S_2 = m_2*(g - a)", "not right"),
    ("double_pendulum", "L = T - U", "right"),
    ("double_pendulum", "L = T + U", "wrong"),
    ("two_mass_oscillator", "K = \\begin{pmatrix} k_1+k_2 & -k_2 \\\\ -k_2 & k_2+k_3 \\end{pmatrix}", "right"),
    ("two_mass_oscillator", "K = [[k_1, -k_2], [-k_2, k_2+k_3]]", "wrong"),
    ("cart_pole", "N = (M+m)*g - m*l/2*(sin(theta)*theta'' + cos(theta)*theta'^2)", "right"),
    ("rough_incline", "F_f = mu*m*g*cos(alpha)", "right"),
    ("rough_incline", "R = -mu*N", "right"),
    ("rough_incline", "F_f = 2*mu*m*g*cos(alpha)", "wrong"),
    ("elastic_pendulum", "v^2 = r'^2 + r^2*theta'^2", "right"),
    ("elastic_pendulum", "v^2 = r'^2 + theta'^2", "not right"),
    ("elastic_pendulum", "F_s = k*(r - l0)", "undecided"),
    ("tumbling_body", "L^2 = I_1^2*w1^2 + I_2^2*w2^2 + I_3^2*w3^2", "right"),
    ("tumbling_body", "L^2 = I_1^2*w1^2 + I_2^2*w2^2 - I_3^2*w3^2", "wrong"),
]


@pytest.mark.slow
@each("model, line, verdict", OF_OTHERS)
def test_letters_are_read_as_they_are_meant(model, line, verdict):
    """a, v, S_2, N, F_f, both meanings of L, matrices; an unknown letter stays unknown, and no mistake is right."""
    found = eomgen.verify(MODELS / f"{model}.toml", line)
    assert found.verdict == verdict or (verdict == "not right" and not found)


@pytest.mark.slow
@each(
    "equation, verdict, up_to",
    [
        ("theta'' + g/l*theta = 0", "wrong", "first order about theta = 0"),
        ("theta'' - g/l*theta = 0", "wrong", ""),
        ("theta'' + g/l*sin(theta) = 0", "right", "the factor 1/(m*l^2)"),
    ],
)
def test_what_is_right_to_first_order_says_so(equation, verdict, up_to):
    """It is wrong of the whole motion, and opens with what it is right to; asked for that order it is right."""
    found = eomgen.verify(PENDULUM, equation)
    assert (found.verdict, found.up_to) == (verdict, up_to)
    if "first" in up_to:
        assert str(found).startswith("right to first order about theta = 0")
        assert eomgen.verify(PENDULUM, equation, to_first_order=True).verdict == "right"
        assert eomgen.verify(PENDULUM, equation, to_first_order=True, about="theta = pi").verdict == "wrong"
    with pytest.raises(eomgen.UsageError, match="no coordinate"):
        eomgen.verify(PENDULUM, equation, to_first_order=True, about="phi = 0")
