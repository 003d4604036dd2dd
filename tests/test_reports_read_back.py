"""Reports that leave are read again: text, formulas, numbers, curves and tables are those of what was found."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import pytest
from slow_run import sampled, usual

import eomgen
from eomgen.documents.figures import KINDS, kinds_of_lines
from eomgen.documents.pages_read import tokens_of
from eomgen.page.contents import Attachment, Report, ReportSection
from eomgen.page.figure import COLORS, number_axis
from eomgen.page.formats import written_as
from eomgen.page.markup import mathml
from eomgen.page.read_back import _carried, report_read_back
from eomgen.page.report import Subject, report, report_of
from eomgen.page.reports_read import copies_undone, curves_of, markup_of, tex_of
from eomgen.simulation.result import Trajectory
from eomgen.symbolic.print.names import ACCENTS, STYLES

MODELS = sorted((Path(__file__).parent.parent / "models").rglob("*.toml"))
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
FORMS = (".html", ".tex", ".md")


@cache
def subject() -> Subject:
    found = Subject(eomgen.loads(SWING), 0.5, False, "swing.toml", SWING)
    vars(found)["followed"] = (eomgen.simulate(found.model, time=0.5, samples=101, target="numpy"), "")
    return found


@cache
def made() -> Report:
    return report_of(subject(), without=["motion", "downloads"])


@cache
def page(form: str) -> str:
    return str(written_as(made(), form, "r" + form)["r" + form])


def wrong(form: str, text: str, run: Trajectory | None = None) -> list[str]:
    """What is contradicted."""
    checks = report_read_back(made(), {"r" + form: text}, form, run or subject().run)
    return [f"{check.name}: {check.detail}" for check in checks if check.status == "fails"]


@sampled(3)
@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS)
def test_a_report_says_what_was_found(form: str):
    """read(write(report)) = report"""
    assert not wrong(form, page(form))


CHANGES = {
    "a digit of a table": ("9.81", "9.18"),
    "an exponent": ("\\dot{\\theta}_{1}^{2}", "\\dot{\\theta}_{1}^{3}"),
    "a factor of a formula": (r"\frac{1}{2} m", r"\frac{1}{3} m"),
    "an index": (r"x_{\mathrm{slider}} ", r"x_{\mathrm{rod}} "),
    "a heading": ("Kinetic energy", "Potential energy"),
    "a word": ("of the rod", "of the slider"),
    "a unit": ("rad/s", "rad/m"),
}


SIZED = """
eomgen = 1
name = "A size, and forces at rest"
space = "plane"
[coordinates]
q = { start = 0.3, speed = -1 }
[bodies.bob]
shape = { kind = "rod", mass = 1, length = 2 }
joint = { kind = "revolute", angle = "q" }
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""


@sampled(3)
@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS)
def test_a_report_of_several_verbs_says_what_was_found(form: str):
    """Q_q of the motion and Q_q at rest are one quantity; |q'| is read as it is set."""
    found = Subject(eomgen.loads(SIZED), 0.5, False, "swing.toml", SIZED)
    report = report_of(found, with_=["statics", "kinematics"], without=["motion", "downloads", "plots", "reactions"])
    text = str(written_as(report, form, "r" + form)["r" + form])
    checks = [*report_read_back(report, {"r" + form: text}, form, None)]
    assert checks and not [x for x in checks if x.status == "fails"]


@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("change", CHANGES)
def test_a_change_of_a_report_is_seen(form: str, change: str):
    """read(changed) != report"""
    old, new = CHANGES[change]
    assert old in page(form), f"'{old}' does not stand in {form}"
    assert wrong(form, page(form).replace(old, new, 1))


def test_curves_and_tables_are_those_of_the_run():
    """What an axis says at a place of a curve is the column's value then, and the table's column is the run's."""
    run = subject().run
    for column in (0, 1):
        x = run.x.copy()
        x[:, column] = -x[:, column]
        assert wrong(".html", page(".html"), replace(run, x=x)), f"column {column}"
    assert wrong(".html", page(".html"), replace(run, t=run.t * 1.1))


def test_numbers_at_an_axis_are_read():
    """A wrong number at an axis moves the curve."""
    text = page(".html")
    at = text.index('text-anchor="end">') + len('text-anchor="end">')
    end = text.index("<", at)
    assert wrong(".html", text[:at] + str(float(text[at:end].replace("\N{MINUS SIGN}", "-")) + 0.7) + text[end:])


DRAWING = """<svg><path d="M10 0V50" class="axis"></path><text text-anchor="middle">0</text>
<path d="M90 0V50" class="axis"></path><text text-anchor="middle">4</text>
<path d="M10 40H90" class="axis"></path><text text-anchor="end">\N{MINUS SIGN}1</text>
<path d="M10 20H90" class="axis"></path><text text-anchor="end">1</text>
<path d="m10 30 40 -10 30 20" class="curve c0"></path></svg>"""


def test_a_curve_is_read_by_the_numbers_at_its_axes():
    """t = 4 (x - 10) / 80, y = (30 - y) / 10"""
    ((style, places),) = curves_of(markup_of(DRAWING), "0 0 100 50").curves
    assert style == "curve c0"
    assert places.tolist() == [pytest.approx(x) for x in ([0, 0], [2, 1], [3.5, -1])]
    with pytest.raises(ValueError, match="leaves its drawing"):
        curves_of(markup_of(DRAWING), "0 0 70 50")


def test_mathml_is_read_as_it_is_set():
    r"""<msub>R, rod</msub> is R_{\mathrm{rod}}; a dot over a letter is its rate; a fraction a fraction."""
    cases = {
        "<math><msub><mi>R</mi><mi>rod</mi></msub></math>": r"R_{\mathrm{rod}}",
        '<math><mover accent="true"><mi>θ</mi><mo>˙</mo></mover></math>': r"\dot{\theta }",
        "<math><mfrac><mn>1</mn><mn>2</mn></mfrac><mi>m</mi></math>": r"\frac{1}{2} m",
        "<math><mn>2</mn><mrow><mo>|</mo><mi>x</mi><mo>|</mo></mrow></math>": r"2 \lvert x \rvert",
    }
    assert {x: tex_of(next(markup_of(x).all("math"))) for x in cases} == cases


SET = (
    r"2 \left\lvert x-\left\lvert y \right\rvert  \right\rvert ^{3}",
    r"\operatorname{sign} x \, \operatorname{atan2}(x, y)",
    r"\max(x, a_{\mathrm{max}}, F_{\mathrm{sin},1}^{2})",
    r"\frac{1}{2} \begin{cases} x & x < y \\ y^{2} & y \leq a_{\mathrm{min}} \\ 3 & \text{otherwise} \end{cases}",
    r"\begin{pmatrix} x & 0 \\ \ln x & \sqrt{y} \end{pmatrix}",
    *(rf"{accent}{{g}}_{{1}}" for accent in sorted(ACCENTS)),
    *(rf"{style}{{{letter}}}" for style in sorted(STYLES) for letter in ("ab", "hb", "GH")),
)


@pytest.mark.parametrize("tex", SET)
def test_what_is_set_for_a_page_is_read_as_it_was_written(tex: str):
    r"""read(mathml(tex)) = tex, but for \left, \right and blanks: an index max is a word"""
    silent = (r"\left", r"\right", r"\,")
    found = tokens_of(tex_of(next(markup_of(mathml(tex)).all("math"))))
    assert [x for x in found if x not in silent] == [x for x in tokens_of(tex) if x not in silent]


def test_what_is_said_by_a_place_far_back_is_put_back():
    """2 new bytes, then 3 from 2 back: abab a, then the rest."""
    assert copies_undone(bytes([3, 2, 2, 3]) + b"abcd") == b"ababacd"


def test_a_file_that_a_page_carries_is_the_one_that_was_made():
    """unpack(pack(content)) = content: a byte more is seen, and a file that is not there."""
    report = replace(made(), sections=(ReportSection("downloads", attachments=(Attachment("a.c", "", b"x", ""),)),))
    for files, seen in (((("a.c", b"x", ()),), False), ((("a.c", b"y", ()),), True), ((), True)):
        assert bool([*_carried(report, SimpleNamespace(files=files))]) == seen


STRANDS = [
    [f"tension(rope, {k})" for k in range(1, 7)],
    ["reaction_n(skate)", "reaction_t(skate)", "reaction_n(skate, 2)"],
]


@pytest.mark.parametrize("owned", [STRANDS, [[f"tension(string{k})"] for k in range(3 * COLORS)]])
def test_no_two_lines_of_a_picture_look_alike(owned: list[list[str]]):
    """(colour, kind) of strands of one rope, of a normal force at each end, of more strings than colours"""
    looks = kinds_of_lines(owned, COLORS)
    assert list(looks) == [name for names in owned for name in names]
    assert len(set(looks.values())) == len(looks)
    assert all(color in range(COLORS) and kind in KINDS for color, kind in looks.values())


def test_an_owner_has_one_colour_and_a_component_one_kind_of_line():
    """x -, y --, z : of each hinge in its colour"""
    looks = kinds_of_lines([[f"reaction_{axis}({owner})" for axis in "xyz"] for owner in "AB"], COLORS)
    assert [*looks.values()] == [(k, kind) for k in (0, 1) for kind in KINDS[:3]]


def test_lines_that_look_alike_are_seen():
    """A dash is lost."""
    assert ' d1"' in page(".html")
    assert any("look alike" in reported for reported in wrong(".html", page(".html").replace(' d1"', '"')))


@pytest.mark.parametrize("ends", [(99980, 100060), (1e-9, 1.00001e-9), (-3e-7, 2e-7), (0, 1e9), (-1.00001e4, -1e4)])
def test_numbers_at_an_axis_are_those_of_its_ticks(ends: tuple[float, float]):
    """|read(text) - tick| < step/100, however small the step is beside the numbers"""
    axis = number_axis(*ends)
    assert len(axis.ticks) > 2
    for tick in axis.ticks:
        assert float(axis.text(tick).replace("\N{MINUS SIGN}", "-")) == pytest.approx(tick, abs=10**axis.power / 100)


@pytest.mark.parametrize("pair", [("L_x", "L_{x}"), (r"x^2_\theta", r"x^{2}_{\theta}"), ("x_12", "x_{1}2")])
def test_an_index_of_one_sign_needs_no_braces(pair: tuple[str, str]):
    """L_x is L_{x}"""
    assert tokens_of(pair[0]) == tokens_of(pair[1])
    assert tokens_of(r"a\_b M_\mathrm{in}") == ("a", r"\_", "b", "M", "_", r"\mathrm", "{", "i", "n", "}")


@pytest.mark.slow
@pytest.mark.parametrize("path", usual(MODELS, len(MODELS), 4), ids=lambda path: path.stem)
def test_the_report_of_every_model_says_what_was_found(path: Path, tmp_path: Path):
    """Its certificate holds, the page read back among its checks."""
    found = report(path, tmp_path / "report.html", time=1)
    assert found.certificate is not None
    assert found.certificate.ok is not False, str(found.certificate)
