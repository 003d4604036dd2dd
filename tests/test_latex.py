"""LaTeX compiles as pasted and shows in KaTeX: balanced, amsmath's common ground only, no user's text is markup."""

from __future__ import annotations

import re
import shutil
import subprocess
from fractions import Fraction
from pathlib import Path

import pytest
from derivations import by_methods, derivable, equations
from each import each
from slow_run import sampled
from typesetting import lost_in_mathml, lost_in_typst

from eomgen.documents import rendered
from eomgen.documents.derivation import derivation_of
from eomgen.documents.latex import equations_latex, unit_latex, value_latex
from eomgen.documents.markdown import markdown_escaped as escaped_markdown
from eomgen.documents.statements import Omitted
from eomgen.symbolic.expression.formula import cos, sin, sqrt
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.node import Scalar
from eomgen.symbolic.print.breaking import PAPER
from eomgen.symbolic.print.latex import Notation, Setter, latex_escaped, rows_of, runs_of

pytestmark = [pytest.mark.slow, pytest.mark.by_model]

GOLDEN = Path(__file__).parent / "golden"
MATHEMATICS = set(
    r"""begin end left right bigl bigr big frac tfrac sqrt sum partial cdot quad leq lvert rvert dot ddot dddot text
    mathrm mathsf operatorname sin cos tan sinh cosh tanh arcsin arccos arctan ln min max times pi
    alpha beta gamma delta varepsilon zeta eta theta iota kappa lambda mu nu xi rho sigma tau upsilon phi chi psi omega
    varphi vartheta Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega""".split()
)
"""commands that amsmath and KaTeX both know"""


def tex(x: Scalar) -> str:
    return Setter().set(x).tex


def names(text: str) -> list[Scalar]:
    graph = Graph()
    return [graph.symbol(name) for name in text.split()]


def balanced(text: str) -> bool:
    """Braces close, and environments and \\left \\right nest."""
    opened: list[str] = []
    for token in re.finditer(r"\\(begin|end)\{(\w+)\}|\\left(?![a-z])|\\right(?![a-z])|(?<!\\)[{}]", text):
        piece = token[0]
        if piece.startswith(r"\begin"):
            opened.append(token[2])
        elif piece in (r"\left", "{"):
            opened.append(piece)
        else:
            expected = token[2] if piece.startswith(r"\end") else {r"\right": r"\left", "}": "{"}[piece]
            if not opened or opened.pop() != expected:
                return False
    return not opened


def formulas(markdown: str) -> list[str]:
    """Everything between dollars."""
    displays = re.findall(r"\$\$(.*?)\$\$", markdown, re.S)
    rest = re.sub(r"\$\$.*?\$\$", "", markdown, flags=re.S).replace(r"\$", "")
    return displays + re.findall(r"\$([^$\n]+)\$", rest)


@sampled(6)
@pytest.mark.parametrize(("name", "method"), by_methods())
def test_formulas_keep_to_what_amsmath_and_katex_share(name, method):
    """every command is known to both, every brace and environment closes, only aligned and cases are used"""
    found = formulas(rendered(equations(name, method).derivation, "markdown"))
    found += formulas(equations_latex(equations(name, method).derivation))
    assert found
    for formula in found:
        assert balanced(formula), formula
        assert set(re.findall(r"\\([a-zA-Z]+)", formula)) <= MATHEMATICS, formula
        assert set(re.findall(r"\\begin\{(\w+)\}", formula)) <= {"aligned", "cases"}
        rows = re.sub(r"\\begin\{cases\}.*?\\end\{cases\}", "", formula, flags=re.S).split(r"\\")
        assert all(row.count("&") <= 1 for row in rows)
        assert all(row.count(r"\left") == row.count(r"\right") for row in rows)
        assert not lost_in_mathml(formula) and not lost_in_typst(formula), formula


@sampled(5)
@pytest.mark.parametrize("name", derivable())
def test_documents_are_balanced(name):
    assert balanced(rendered(equations(name).derivation, "latex"))


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="no LaTeX on this machine")
@pytest.mark.parametrize(
    ("name", "method", "full"),
    [
        ("double_pendulum", "lagrange", False),
        ("loop", "lagrange", False),
        ("andrews_squeezer", "lagrange", False),
        ("arm7", "lagrange", True),
        ("arm3", "kinetostatic", False),
        ("four_cranks", "kinetostatic", False),
        ("ch16_p7", "kinetostatic", False),
    ],
)
def test_a_document_compiles_as_it_stands_and_fits_its_pages(name, method, full, tmp_path):
    """pdflatex ends without an error, whatever stands in the user's names and remarks, and no line is too wide"""
    derived = equations(name, method)
    derivation = derivation_of(derived.graph, method, full=full)
    (tmp_path / "a.tex").write_text(rendered(derivation, "latex"))
    run = subprocess.run(
        ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "a.tex"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stdout[-2000:]
    assert "Overfull" not in run.stdout


def test_a_kinetic_energy_is_set_as_in_a_textbook():
    """27/2 M R^2 theta'^2 cos^2 theta: juxtaposed, functions last"""
    M, R, theta, rate = names("M R theta theta'")
    T = 27 * M * R * R * cos(theta) * cos(theta) * rate * rate / 2
    assert tex(T) == r"\frac{27}{2} M R^{2} \dot{\theta}^{2} \cos^{2}\theta"


@each(
    "make, expected",
    [
        (lambda a, b: a - 2 * b, "a - 2 b"),
        (lambda a, b: -(a + b) * a, r"- a (a + b)"),
        (lambda a, b: a / (2 * b), r"\frac{a}{2 b}"),
        (lambda a, b: (a + b) / b, r"\frac{a + b}{b}"),
        (lambda a, b: sin(a - b), r"\sin(a - b)"),
        (lambda a, b: sin(a) * b, r"b \sin a"),
        (lambda a, b: cos(2 * a) * cos(2 * a), r"\cos^{2}2 a"),
        (lambda a, b: sqrt(a + b), r"\sqrt{a + b}"),
        (lambda a, b: a.graph.call("exp", a) * a.graph.call("exp", a), r"(e^{a})^{2}"),
        (lambda a, b: (a + b) * (a + b), r"(a + b)^{2}"),
        (lambda a, b: 2 * sqrt(a) * b, r"2 b \sqrt{a}"),
        (lambda a, b: a.graph.pow(2, b) * 3, r"3 \cdot 2^{b}"),
        (lambda a, b: a.graph.pow(a + b, b), r"(a + b)^{b}"),
        (lambda a, b: a.graph.call("abs", a), r"\left\lvert a \right\rvert"),
        (lambda a, b: a.graph.call("atan2", a, b), r"\operatorname{atan2}(a, b)"),
        (
            lambda a, b: a.graph.select(a.graph.call("less", a, b), 1, b),
            r"\begin{cases} 1 & a < b \\ b & \text{otherwise} \end{cases}",
        ),
    ],
)
def test_each_operation_is_set_by_its_own_rule(make, expected):
    assert tex(make(*names("a b"))) == expected


@each(
    "name, expected",
    [
        ("theta", r"\theta"),
        ("theta'", r"\dot{\theta}"),
        ("theta1''", r"\ddot{\theta}_{1}"),
        ("m1", "m_{1}"),
        ("k_max", r"k_{\mathrm{max}}"),
        ("tau1", r"\tau_{1}"),
        ("lambda", r"\lambda"),
        ("lam(B, 1)", r"\lambda_{B,1}"),
        ("mb", "m_{b}"),
        ("lAB", "l_{AB}"),
        ("IA'", r"\dot{I}_{A}"),
        ("EI", r"\mathrm{EI}"),
        ("phiA", r"\phi_{A}"),
        ("B_x", "B_{x}"),
        ("R_stick_x", r"R_{\mathrm{stick},x}"),
        ("x" + 4 * "'", "x^{(4)}"),
        ("Ixx1", "I_{xx,1}"),
        ("x_1_2", "x_{1,2}"),
        ("θ2'", r"\dot{\theta}_{2}"),
        ("_", r"\mathrm{\_}"),
        ("δθ", r"\delta \theta"),
        ("δs", r"\delta s"),
        ("δ", r"\delta"),
    ],
)
def test_names_are_set_with_greek_letters_subscripts_and_dots(name, expected):
    assert Notation().latex(name) == expected


def reported_apart(names: list[str]) -> dict[str, str]:
    found = Notation().reported_apart(names)
    return {name: found.latex(name) for name in names}


def test_two_names_that_would_look_alike_are_told_apart_everywhere():
    """theta1 and theta_1, and their rates"""
    found = reported_apart(["theta_1", "theta1", "theta1'", "theta_1''"])
    assert found == {
        "theta_1": r"\theta_{1}",
        "theta1": r"\mathrm{theta1}",
        "theta1'": r"\dot{\mathrm{theta1}}",
        "theta_1''": r"\ddot{\theta}_{1}",
    }
    assert len(set(found.values())) == len(found)


@pytest.mark.parametrize("name", derivable())
def test_no_two_symbols_of_a_derivation_look_alike(name):
    derived = equations(name)
    s = derived.graph.symbols
    symbols = [x.name for x in (*s.parameters.values(), *s.inputs.values(), *s.q, *s.u, *s.a, *s.lam)]
    found = reported_apart(symbols)
    assert len(set(found.values())) == len(symbols)


def test_a_users_text_is_never_markup():
    """each special character stands for itself"""
    assert latex_escaped(r"50% of #1 & {a_b}^$\x$ ~<>") == (
        r"50\% of \#1 \& \{a\_b\}\textasciicircum{}\$\textbackslash{}x\$ \textasciitilde{}\textless{}\textgreater{}"
    )
    assert escaped_markdown("a|b *c* <b> $x$\n# d") == r"a\|b \*c\* \<b\> \$x\$ \# d"
    assert unit_latex("kg*m^2/s^-3") == r"kg$\cdot$m$^{2}$/s$^{-3}$"
    assert unit_latex("m/s^2") == "m/s$^{2}$"


def test_values_are_set_as_numbers():
    """-0.5 with a minus sign, 2.2e-06 with a power of ten; an expression as it stands"""
    assert value_latex("-0.5") == "$-0.5$"
    assert value_latex("2.2e-06") == r"$2.2 \cdot 10^{-6}$"
    assert value_latex("50% of l_0") == r"50\% of l\_0"
    assert value_latex("") == ""


def test_numbers_are_set_as_decimals_where_they_are_printed_so():
    """0.0825 a, a/2, pi/2"""
    graph = Graph()
    a, b = graph.symbol("a"), graph.symbol("b")
    assert tex(a * Fraction(33, 400)) == "0.0825 a"
    assert tex(a * Fraction(33, 400) / b) == r"\frac{0.0825 a}{b}"
    assert tex(a * Fraction(529, 625000000)) == r"8.464 \cdot 10^{-7} a"
    assert tex(a - 3 * graph.pi / 4) == r"a - \frac{3 \pi}{4}"


def test_equality_signs_of_neighbours_stand_below_one_another():
    """narrow left sides share their room; a wide one begins another display"""
    symbols = names(" ".join(f"x{i}" for i in range(60)))
    wide = sum(symbols[1:20], start=symbols[0])
    setter = Setter()
    runs = runs_of(setter, [(symbols[0], 1), (symbols[0] + symbols[1], 2), (wide, 3), (symbols[0], 4)], 40)
    assert [[row.startswith("&") for row in run] for run in runs] == [[False, False], [True, True], [False]]
    assert [len(run) for run in runs_of(setter, [(symbols[0], 1)] * 10, 4)] == [4, 4, 2]


def test_long_sums_are_broken_before_their_signs():
    """no row is wider than its line, and the rows together are the whole"""
    symbols = names(" ".join(f"x{i}" for i in range(60)))
    total = sum(symbols[1:], start=symbols[0])
    setter = Setter()
    rows = rows_of(setter, [setter.set(symbols[0]), total])
    assert len(rows) > 2
    assert all(row.startswith(r"&\quad + ") for row in rows[1:])
    bare = [row.replace(r"&\quad", r"\quad").replace("&=", "=") for row in rows]
    assert all(0.8 * PAPER.room < PAPER.width(row) <= PAPER.room for row in bare[:-1])
    joined = " ".join(row.replace(r"&\quad", "").replace("&=", "=").strip() for row in rows)
    assert joined == f"x_{{0}} = {setter.set(total).tex}"


def test_a_long_factor_is_broken_inside_its_parentheses():
    """\\bigl( ... \\bigr): a \\left( may not be closed on another line"""
    symbols = names(" ".join(f"x{i}" for i in range(60)))
    product = symbols[0] * sum(symbols[2:], start=symbols[1])
    rows = rows_of(Setter(), [product])
    assert len(rows) > 1
    assert r"\left" not in "".join(rows)
    assert rows[0].count(r"\bigl(") == rows[-1].count(r"\bigr)") == 1


def test_a_long_quotient_is_written_on_lines():
    """a fraction cannot be broken: (above) / (below)"""
    symbols = names(" ".join(f"x{i}" for i in range(60)))
    quotient = sum(symbols[2:], start=symbols[1]) / (symbols[0] + 1)
    rows = rows_of(Setter(), [quotient])
    assert len(rows) > 1 and r"\frac" not in "".join(rows) and r"\bigr) \big/ \bigl(" in rows[-1]


def test_notebooks_get_the_equations_in_one_display():
    """$$ aligned $$, and an honest word where they are too long"""
    found = equations("ch22_p1")._repr_latex_()
    assert found.startswith("$$\\begin{aligned}") and found.endswith("\\end{aligned}$$")
    assert r"R (4 + 9 \cos^{2}\theta) \ddot{\theta} - 9 R" in found
    assert "too long" in equations("chain20")._repr_latex_()


def test_nothing_is_left_out_in_silence():
    """Omitted stands for its size"""
    from eomgen.documents.latex import side_latex
    from eomgen.documents.text import side_text

    x = Graph().symbol("x")
    long = Omitted(((x * x + 1,), (sin(x), x / 3)))
    assert side_text(long) == "(4 operations, not printed)"
    assert "4 operations" in side_latex(Setter(), long)


def test_the_document_is_the_golden_one():
    """tests/golden: read it, and write it anew where a change is meant"""
    assert rendered(equations("ch22_p1").derivation, "latex") == (GOLDEN / "ch22_p1.tex").read_text()
