"""A sheet without answers holds none, in no format and no part of its bytes; variants are the same everywhere."""

from __future__ import annotations

import csv
import json
import re
import subprocess
import zlib
from base64 import b64decode
from pathlib import Path

import pytest
from click.testing import CliRunner
from each import each
from slow_run import ALL, sampled, usual
from tools import needs

import eomgen
from eomgen.cli import main
from eomgen.documents import Formula, Quantity
from eomgen.documents.document import SECTION_GROUPS
from eomgen.documents.pages_read import latex_page
from eomgen.page.report import report, step_titles
from eomgen.page.reports_read import unpacked

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
CONKER = MODELS / "conker.toml"
USUAL = ("conker", "slider_crank", "gerber_beam", "simple_pendulum", "seeds/ch22_p1", "seeds/ch16_p5", "seeds/ch11_p3")
NAMES = sorted(str(path.relative_to(MODELS).with_suffix("")) for path in MODELS.rglob("*.toml"))
SEARCHED = NAMES if ALL else USUAL[::2]
TEXTS = (".html", ".tex", ".md")
PACKED = re.compile(r"H4sI[A-Za-z0-9+/]{20,}={0,2}")  # gzip in base64
STREAM = re.compile(rb"stream\r?\n(.*?)endstream", re.DOTALL)
DRAWN = re.compile(r' (?:d|transform|viewBox|x|y|width|height)=\\?"[^"\\]*')  # places of lines and letters
BLANKS = re.compile(r"[\s*\\{}]|cdot")


def everything(path: Path) -> str:
    """All that a file holds: its text, and what it carries packed."""
    data = path.read_bytes()
    if path.suffix == ".pdf":
        streams = b"".join(_inflated(found[1]) for found in STREAM.finditer(data))
        words = subprocess.run(["pdftotext", path, "-"], capture_output=True, check=True).stdout
        return (data + streams + words).decode("latin-1")
    text = data.decode("utf-8")
    packed = "".join(unpacked(found[0]).decode("utf-8", "replace") for found in PACKED.finditer(text))
    return (
        text + packed + b"".join(map(b64decode, re.findall(r'"([A-Za-z0-9+/]{400,}={0,2})"', text))).decode("latin-1")
    )


def _inflated(stream: bytes) -> bytes:
    try:
        return zlib.decompress(stream)
    except zlib.error:
        return stream


def answers(model: eomgen.Model) -> dict[str, str]:
    """{what: an answer without blanks, as a page could hold it}: formulas, and numbers of four digits."""
    open_ = BLANKS.sub("", "".join(map(str, (model.text, *(x.value for x in model.parameters.values() if x.value)))))
    found = {}
    for name, answer in eomgen.solve(model).items():
        if answer.exact is not None and len(answer.exact) > 6 and re.search(r"[-+*/^(]", answer.exact):
            found[f"{name} as a formula"] = BLANKS.sub("", answer.exact)
        if answer.value is not None and len(digits := f"{abs(answer.value):.4g}".replace(".", "").strip("0")) >= 4:
            found[f"{name} as a number"] = f"{abs(answer.value):.4g}" if "e" not in digits else digits[:4]
    return {what: text for what, text in found.items() if text not in open_}


def written(name: str, audience: str, ending: str, folder: Path) -> list[Path]:
    report(MODELS / f"{name}.toml", folder / f"sheet{ending}", for_=audience)
    return [path for path in folder.iterdir() if path.suffix in (".svg", ending)]


@sampled(2)
@pytest.mark.by_model
@pytest.mark.parametrize("name", SEARCHED)
def test_no_answer_is_in_a_sheet(name, tmp_path):
    sought = answers(eomgen.load(MODELS / f"{name}.toml"))
    for ending in TEXTS:
        held = BLANKS.sub("", DRAWN.sub("", "".join(map(everything, written(name, "problem", ending, tmp_path)))))
        assert not {what: text for what, text in sought.items() if text in held}, ending


@needs("pdftotext")
@each("ending", (".pdf", ".ipynb"))
def test_no_answer_is_in_papers_and_notebooks(ending, tmp_path):
    sought = answers(eomgen.load(CONKER)) | {"its code": "tension(thread)"}
    for audience in ("problem", "worksheet"):
        held = "".join(map(everything, written("conker", audience, ending, tmp_path)))
        assert not {what: text for what, text in sought.items() if text in BLANKS.sub("", held)}
        assert "proven" not in held and "[outputs]" not in held


def test_the_search_sees_what_a_solution_holds(tmp_path):
    sought = answers(eomgen.load(CONKER))
    assert len(sought) >= 2
    for ending in TEXTS:
        held = BLANKS.sub("", "".join(map(everything, written("conker", "solution", ending, tmp_path))))
        assert "1.98" in held and "lowestpoint" in held, ending


def test_a_section_with_answers_is_refused_on_a_sheet():
    with pytest.raises(eomgen.UsageError, match="'plots' holds answers"):
        report(CONKER, for_="problem", with_=["plots"])
    with pytest.raises(eomgen.UsageError, match="no sheet is written for 'students'"):
        report(CONKER, for_="students")


def test_a_worksheet_has_room_for_each_answer(tmp_path):
    sections = {section.key: section for section in report(CONKER, for_="worksheet").sections}
    assert list(sections) == ["statement", "figure", "data", "questions"]
    assert all(step.room for step in sections["questions"].steps)
    assert not any(step.room for section in report(CONKER, for_="problem").sections for step in section.steps)
    report(CONKER, tmp_path / "w.html", for_="worksheet")
    assert (tmp_path / "w.html").read_text().count('class="room"') == 2


def test_the_step_titles_a_solution_are_chosen_by_name(tmp_path):
    runner = CliRunner()
    listed = runner.invoke(main, ["report", str(CONKER), "--steps", "help"]).stdout.split("\n")
    names = [line.split()[0] for line in listed if line]
    assert {"positions", "kinetic_energy", "equations", "reactions", *SECTION_GROUPS} <= set(names)
    found = report(CONKER, for_="solution", steps=["positions", "energies"])
    keys = [step.key for section in found.sections if section.key == "derivation" for step in section.steps]
    assert keys == ["positions", "kinetic_energy", "work"]
    assert [section.key for section in found.sections][-1] == "outputs"
    wrong = runner.invoke(
        main, ["report", str(CONKER), "--for", "solution", "--steps", "positons", "-o", str(tmp_path / "a.md")]
    )
    assert wrong.exit_code == 2 and "did you mean 'positions'?" in wrong.stderr


def test_every_step_of_every_solution_has_a_name():
    from eomgen.page.report import Sheet, Subject

    for name in USUAL:
        subject = Subject(eomgen.load(MODELS / f"{name}.toml"), None, False, "", "", Sheet("solution"))
        steps = [
            step for section in report(subject.model, for_="solution", certify=False).sections for step in section.steps
        ]
        assert {step.key for step in steps if step.title} <= {*step_titles(subject), "data"}


# -- words of the problem --------------------------------------------------------------------------


def model_with(text: str, **more: str) -> str:
    tables = "\n".join(more.values())
    return (
        f"eomgen = 1\nspace = 'plane'\ntext = '''{text}'''\n[parameters]\nm = {{ value = 2, unit = 'kg' }}\n{tables}\n"
    )


def test_words_of_a_problem_are_set_with_values_and_formulas(tmp_path):
    report(CONKER, tmp_path / "p.md", for_="problem")
    page = (tmp_path / "p.md").read_text()
    assert r"mass $m = 20\ \text{g}$ hangs" in page and r"$\varphi = 60^{\circ}$" in page
    assert r"$S_{\mathrm{max}} = 0.5\ \text{N}$" in page and r"$g = 9.81\,\mathrm{m/s^2}$" in page
    path = tmp_path / "m.toml"
    path.write_text(CONKER.read_text().replace("of mass {m}", "of mass $m$ = {m}"))
    report(path, tmp_path / "p.md", for_="problem")
    assert r"mass $m$ = $20\ \text{g}$ hangs" in (tmp_path / "p.md").read_text()


@each(
    "text, what",
    [
        ("of mass {mm}", "'mm' in braces is no parameter, coordinate or input"),
        ("costs 5 $", "a formula begins at $ and does not end"),
    ],
)
def test_words_with_a_mistake_are_refused_at_their_place(text, what):
    with pytest.raises(eomgen.ModelError) as error:
        eomgen.loads(model_with(text))
    assert error.value.problems[0].what == what and ":3:" in error.value.problems[0].where


@each(
    "given, what",
    [
        ("m2 = { value = 1, range = [3, 1] }", "the first end of a range is not below the second"),
        ("m2 = { value = 1, range = [3] }", "two numbers or more are needed here, not a list"),
        ('[outputs]\nF = { value = "2*m", digits = 0 }', "a whole number from 1 to 15 is needed here, not 0"),
        ('[[questions]]\ntext = "How heavy?"\noutputs = "G"', "unknown output 'G' in [questions]"),
    ],
)
def test_ranges_digits_and_questions_are_checked(given, what):
    with pytest.raises(eomgen.ModelError) as error:
        eomgen.loads(model_with("a stone", more=given))
    assert error.value.problems[0].what == what


@each(
    "value, digits, printed",
    [
        (6.9812, 3, "6.98"), (7.0, 3, "7.00"), (9.999, 3, "10.0"), (12345.6, 3, "12300"), (0.00012345, 2, "0.00012"),
        (1.234e7, 3, "1.23e+07"), (0.0, 3, "0.00"), (-0.5, 1, "-0.5"), (999.96, 4, "1000"),
    ],
)  # fmt: skip
def test_a_number_is_printed_with_the_digits_that_are_asked(value, digits, printed):
    assert Quantity(value=value, digits=digits).number == printed


def test_an_empty_formula_and_a_lone_brace_are_set(tmp_path):
    model = eomgen.loads(model_with("A stone $ $ of mass {m}; $\\{a, b\\}$, 5 \\$."))
    for ending in (".html", ".tex", ".md", ".pdf"):
        report(model, tmp_path / f"p{ending}", for_="problem")
        assert (tmp_path / f"p{ending}").stat().st_size > 150


def test_a_reaction_has_the_letter_of_its_author_in_a_report_too(tmp_path):
    report(CONKER, tmp_path / "s.md", for_="solution", steps=["reactions"])
    page = (tmp_path / "s.md").read_text()
    assert r"S &= m (l \dot{\varphi}^{2} + g \cos\varphi)" in page and "T_{S}" not in page


def test_the_letter_of_an_output_is_judged():
    text = CONKER.read_text().replace(
        'S = { value = "tension(thread)", at = "phi = 0",', 'S = { value = "tension(thread)", symbol = "F_S",'
    )
    model = eomgen.loads(text)
    right, wrong = "F_S = m*(l*phi'^2 + g*cos(phi))", "F_S = m*(l*phi'^2 - g*cos(phi))"
    assert eomgen.verify(model, right).verdict == "right" and eomgen.verify(model, wrong).verdict == "wrong"


# -- variants --------------------------------------------------------------------------------------


def test_a_variant_is_the_same_at_every_draw_and_round():
    first, again = eomgen.variant(CONKER, 7), eomgen.variant(CONKER, 7)
    assert first == again and first.name == "Conker on a thread, variant 7"
    drawn = [eomgen.variant(CONKER, k) for k in range(1, 30)]
    lengths = {float(model.parameters["l"].value.value_at({})) for model in drawn}
    assert lengths <= {x / 100 for x in range(20, 81, 5)} and len(lengths) > 6
    assert {float(model.parameters["S_max"].value.value_at({})) for model in drawn} == {0.4, 0.6, 0.8}


def test_a_further_range_leaves_the_other_values_as_they_are():
    text = CONKER.read_text()
    more = text.replace('g = { value = 9.81, unit = "m/s^2",', 'g = { value = 9.81, unit = "m/s^2", range = [1.6, 25],')
    assert more != text
    values = [eomgen.variant(eomgen.loads(each), 5).parameters for each in (text, more)]
    assert values[0]["l"] == values[1]["l"] and values[0]["g"] != values[1]["g"]


FOUR_BAR = (MODELS / "four_bar.toml").read_text()


def test_draws_that_cannot_be_put_together_are_drawn_again():
    """A coupler between 0.1 and 4 times as long as it is: in most draws the loop does not close."""
    parameters = eomgen.loads(FOUR_BAR).parameters.items()
    name = next(name for name, part in parameters if part.unit is not None and part.unit.text == "m")
    ranged = re.sub(rf"^{name} = \{{", f"{name} = {{ range = [0.05, 40],", FOUR_BAR, count=1, flags=re.M)
    model, closed = eomgen.loads(ranged), 0
    numbers = usual(range(6), 3)
    for number in numbers:
        eomgen.simulate(eomgen.variant(model, number), time=0.01)
        closed += 1
    assert closed == len(numbers)


def test_a_model_without_ranges_has_no_variants():
    with pytest.raises(eomgen.UsageError, match="no parameter of the model has a range"):
        eomgen.variant(MODELS / "simple_pendulum.toml", 1)


def test_a_class_gets_its_sheets_and_the_teacher_the_key(tmp_path):
    path = tmp_path / "conker.md"
    words = ["report", str(CONKER), "--for", "problem", "--variant", "3:5", "-o", str(path), "--json"]
    found = CliRunner().invoke(main, words)
    assert found.exit_code == 0 and json.loads(found.stdout)["certificate"]["ok"]
    rows = list(csv.DictReader((tmp_path / "conker_key.csv").read_text().splitlines()))
    assert [row["variant"] for row in rows] == ["3", "4", "5"]
    for row in rows:
        page = (tmp_path / f"conker_{row['variant']}.md").read_text()
        mass, length = float(row["m [g]"]), float(row["l [cm]"])
        assert f"$m = {mass:g}\\ \\text{{g}}$" in page and f"$l = {length:g}\\ \\text{{cm}}$" in page
        assert float(row["S [N]"]) == pytest.approx(2 * mass / 1000 * 9.81)
        assert float(row["v [m/s]"]) == pytest.approx((9.81 * length / 100) ** 0.5)


@each("verb", ["solve", "derive", "simulate", "reactions", "codegen", "sweep"])
def test_verbs_take_the_number_of_a_variant(verb, tmp_path):
    more = {"simulate": ["--time", "0.1"], "codegen": ["-o", str(tmp_path / "c")], "sweep": ["--over", "phi=10:20:2"]}
    words = [verb, str(CONKER), "--variant", "3", "--json", "--no-certify", *more.get(verb, ())]
    found = CliRunner().invoke(main, words)
    assert found.exit_code == 0, found.output
    if verb in ("solve", "derive", "simulate", "reactions"):
        value = float(eomgen.variant(CONKER, 3).parameters["m"].value.value_at({}))
        assert json.loads(found.stdout)["taken"]["m"]["value"] == pytest.approx(1000 * value)
    wrong = CliRunner().invoke(main, [verb, str(CONKER), "--variant", "1:3"])
    assert wrong.exit_code == 2 and "`eomgen report`" in wrong.stderr


# -- formulas to paste -----------------------------------------------------------------------------


@each("name", ["simple_pendulum", "arm3", "slider_crank", "seeds/ch22_p1"])
def test_a_fragment_holds_the_formulas_of_its_section_with_a_number_each(name):
    equations = eomgen.derive(MODELS / f"{name}.toml")
    (step,) = (step for step in equations.derivation.steps if step.key == "equations")
    formulas = sum(isinstance(statement, Formula) for statement in step.statements)
    found = equations.latex("motion", fragment=True, numbered=True)
    inside = "".join(re.findall(r"\\begin\{align\}(.*?)\\end\{align\}", found, re.S))
    rows = inside.count(r"\\" + "\n") + found.count(r"\begin{align}")
    assert rows - inside.count(r"\notag") == formulas > 0
    assert not re.search(r"\\(?:usepackage|documentclass|section|subsection)|longtable|\\\[", found)
    blocks = [block.sides for block in latex_page(found) if block.kind == "formula"]
    whole = [block.sides for block in latex_page(equations.latex("motion")) if block.kind == "formula"]
    assert blocks == whole


def test_a_fragment_is_of_latex_and_its_section_is_there():
    def refused(*words: str) -> str:
        found = CliRunner().invoke(main, ["derive", str(CONKER), *words])
        assert found.exit_code == 2
        return found.stderr

    assert "is of --format latex" in refused("--fragment")
    assert "did you mean 'motion'?" in refused("--format", "latex", "--section", "motoin")
    assert "numbers are those of a fragment" in refused("--format", "latex", "--numbered")
