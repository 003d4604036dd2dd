"""How long a formula is as a person reads it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from each import each

from eomgen.symbolic.print.length import length_of_latex

SCRIPT = Path(__file__).resolve().parent.parent / "benchmarks" / "formula_length.py"


@each(
    "tex, marks",
    [
        (r"(M + m)\ddot{X} + m\ddot{s}\cos\alpha = 0", 13),
        (r"\frac{27}{2} M R^{2} \dot{\theta}^{2} \cos^{2}\theta", 12),
        (r"\dfrac ab", 3),
        (r"\sqrt{\frac{g}{l}}", 4),
        (r"\sqrt[3]{x}", 3),
        (r"\left(a + b\right)^{2} = \bigl( a+b \bigr)^2", 13),
        (r"\left. x \right|_{0}", 3),
        (r"\left\lvert x \right\rvert", 3),
        (r"\operatorname{sign}\left(\dot{x}\right)", 4),
        (r"k_{\mathrm{max}}", 4),
        (r"R_{\mathit{stick},x}", 8),
        (r"\theta'' \; \ddot{\theta}\,\hat{\boldsymbol{n}}", 3),
        ("\\begin{aligned}\na &= b \\\\[2pt]\n&\\quad + c\n\\end{aligned}", 5),
        (r"\begin{pmatrix} a & b \\ c & d \end{pmatrix}", 6),
        (r"\begin{array}{cc} a & b \end{array}", 2),
        (r"\{a\}", 3),
        (r"1.5 \cdot 10^{-3}", 8),
        (r"\color{red}{x} \label{eq:1}", 1),
        ("$a$ % and what is said of it\n", 1),
        ("", 0),
    ],
)
def test_every_visible_mark_of_a_formula_counts_one(tex: str, marks: int):
    """Letters, digits, operators, brackets, fraction bars and roots 1; a function's name 1; accents and places 0."""
    assert length_of_latex(tex) == marks


@pytest.mark.slow
def test_the_script_tells_the_length_of_each_formula():
    """benchmarks/formula_length.py FORMULA ..., or a formula a line on its input."""
    formulas = [r"M\ddot{X} = 0", r"\frac{a}{b}"]
    requested = subprocess.run([sys.executable, SCRIPT, *formulas], capture_output=True, text=True, check=True)
    piped = subprocess.run(
        [sys.executable, SCRIPT], input="\n".join(formulas), capture_output=True, text=True, check=True
    )
    assert requested.stdout == piped.stdout == "    4  M\\ddot{X} = 0\n    3  \\frac{a}{b}\n"
