"""What stands on sheets is read as it is meant, and a mistake in the same dress is no more right than in any other.

The lines are of kinds that were refused, or judged wrongly, when `helpers/sheet_mistakes` were judged first.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
from each import each

import eomgen
from eomgen.judge.case import Case
from eomgen.judge.judge import Judge

HELPERS = Path(__file__).parents[1] / "helpers"
MODELS = Path(__file__).parents[2] / "models"


@cache
def judge_of(name: str) -> Judge:
    (path,) = (*(HELPERS / "sheet_mistakes").glob(f"{name}*.toml"), *MODELS.glob(f"{name}.toml"))
    return Judge(Case(eomgen.load(path)))


SPOKEN = [
    ("17", "y¨ = -y_0 Ω^2 cos(Ω t)", "y¨ = -y_0 Ω cos(Ω t)"),  # dots behind their letter
    ("17", "m/2 (y˙^2 + l^2 θ˙^2 - 2 l y˙ θ˙ sin θ) = T", "m/2 (y˙^2 + l^2 θ˙^2 + 2 l y˙ θ˙ sin θ) = T"),
    ("03", "\\sum M_A = 0: 3a B - 4 q a^2 - H h = 0", "\\sum M_A = 0: 3a B - 4 q a^2 + H h = 0"),  # labels; B alone
    ("03", "M(2a) = B_y a - q a^2/2", "M(2a) = B_y a - q a^2"),  # a section by its place, and along the beam
    ("03", "M(x) = B_y (3a - x) - q (3a - x)^2/2", "M(x) = B_y (3a - x) - q (3a - x)^2"),
    ("05", "A_H + B_H + 2 w a = 0", "A_H - B_H + 2 w a = 0"),
    ("09", "J_S = m r^2/2 - m (4r/(3π))^2", "J_S = m r^2/2"),
    ("13", "v_C = \\dot x_C = -2 l \\dot\\varphi\\sin\\varphi", "v_C = \\dot x_C = -l \\dot\\varphi\\sin\\varphi"),
    ("13", "U = (m g + P) l sin φ + k/2 (2 l cos φ - l_0)^2", "U = (m g - P) l sin φ + k/2 (2 l cos φ - l_0)^2"),
    ("15", "J_x φ¨ = m R^2/4 (1 + cos^2 δ) φ¨ = M_0", "J_x φ¨ = m R^2/4 (1 + sin^2 δ) φ¨ = M_0"),
    ("16", "m \\dot v = F - m g \\sin\\alpha - c v^2", "m \\dot v = F - m g \\cos\\alpha - c v^2"),
    ("06", "\\omega_0^2 = \\frac{k + (m/2 + M) g l}{m l^2/3 + M R^2/2 + M l^2}", "\\omega_0^2 = k/(m l^2/3)"),
    ("19", "T = m Ω^2 (3/4 a^2 + 1/8 R^2)", "T = m Ω^2 3/4 a^2"),  # a kinetic energy is fixed up to no constant
]


@each("model, right, wrong", SPOKEN)
def test_a_line_of_a_sheet_is_read_as_it_is_meant(model, right, wrong):
    """The line, up to what its dress says."""
    assert judge_of(model).verdict(right).verdict == "right"


@pytest.mark.slow
@each("model, right, wrong", SPOKEN)
def test_no_mistake_is_right_in_the_dress_of_a_sheet(model, right, wrong):
    """The same with a mistake in it. Slow: each is explained."""
    assert judge_of(model).verdict(wrong).verdict == "wrong"


@pytest.mark.slow
@each(
    "line, told",
    [
        ("A_z = B_z", "wrong sign"),  # in space no balances are searched; a turn may be one table in the file
        ("A_z = m R^2 φ'^2 sin(2 δ)/(4 (a + b))", "factor 2"),
    ],
)
def test_a_reaction_in_space_is_explained(line, told):
    """A sign, a factor. Slow: changes of the model file are tried."""
    assert told in " ".join(judge_of("15").verdict(line).causes[0].lines)


def test_a_missing_force_in_space_is_named():
    """F a = (S_B + S_C) b h/d: with S_B alone S_C is missing."""
    (cause,) = judge_of("11").verdict("F a = S_B b h/\\sqrt{b^2 + c^2 + h^2}").causes
    assert cause.kind == "missing_term" and "S_C is missing" in cause.text


PRINTED = [
    ("A = [0  0  1  0] [0  0  0  1] [0  3*m*g/(4*M + m)  0  0] [0  6*(M + m)*g/((4*M + m)*l)  0  0]", "right"),
    ("B = [[1], [0]]", "right"),
    ("B = [[0], [0], [4/(4*M + m)], [6/((4*M + m)*l)]]", "right"),
    ("B = [[0], [0], [4/(4*M + m)], [3/((4*M + m)*l)]]", "wrong"),
    ("A(theta', theta) = 6*(M + m)*g/((4*M + m)*l)", "right"),
    ("A(theta', theta) = 3*(M + m)*g/((4*M + m)*l)", "wrong"),
    ("W_{\\theta,F} = \\frac{6}{(4 M + m) l s^{2} - 6 (M + m) g}", "right"),
    ("W[theta, F] = 6/((4*M + m)*l*s^2 + 6*(M + m)*g)", "wrong"),
    ("det(s^2*M + s*C + K) = 1/12*(4*M + m)*m*l^2*s^4 - 1/2*(M + m)*m*l*g*s^2 = 0", "right"),
    ("det(s^2*M + s*C + K) = 1/12*(4*M + m)*m*l^2*s^4 + 1/2*(M + m)*m*l*g*s^2", "wrong"),
    ("(4 M + m) l \\lambda^4 = 6 (M + m) g \\lambda^2", "right"),
    ("(4 M + m) l \\omega^4 + 6 (M + m) g \\omega^2 = 0", "right"),
    ("(4 M + m) l \\omega^4 = 6 (M + m) g \\omega^2", "wrong"),
    ("h_{1} = -(M + m) g", "right"),
]


@each("line, verdict", PRINTED)
def test_state_matrices_and_characteristic_equations_are_judged(line, verdict):
    """As `linearize` prints them, and as authors have them: proportional to det(s^2 M + s C + K)."""
    assert judge_of("cart_pole").verdict(line).verdict == verdict
