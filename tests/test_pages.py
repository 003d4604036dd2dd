"""A report is one page that asks nothing of anybody, a paper, a text, a notebook; it holds what the verbs say."""

from __future__ import annotations

import csv
import html
import json
import re
import shutil
import subprocess
import sys
from base64 import b64decode
from fractions import Fraction
from functools import cache
from html.parser import HTMLParser
from importlib.util import find_spec
from itertools import accumulate
from pathlib import Path

import numpy as np
import pytest
from browser import visited
from slow_run import in_slow_run, sampled, usual
from tools import REQUIRED, needs
from typesetting import lost_in_mathml, lost_in_typst

import eomgen
from eomgen.documents.document import DISTRUST
from eomgen.equations import Equations
from eomgen.errors import ToolMissing, UsageError
from eomgen.page.contents import SECTIONS
from eomgen.page.formats import CALLS, written_as
from eomgen.page.html import html_page
from eomgen.page.packing import packed_columns
from eomgen.page.paper import UnknownCommand, typst_math, typst_text
from eomgen.page.report import report, report_document
from eomgen.proof.check import Certificate, Check
from eomgen.symbolic.print.names import COMMANDS

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"
HOSTILE = (
    '</script><script>alert(1)</script><img src=x onerror=alert(2)> " \' & #sys.read("x") $ \\input{x} `x` ]\u202e'
)


def has(package: str) -> pytest.MarkDecorator:
    """The mark of a test that takes an extra."""
    return pytest.mark.skipif(find_spec(package) is None and not REQUIRED, reason=f"not installed: {package}")


@cache
def of(name: str, **requested: object) -> eomgen.report:
    """A report, made once."""
    return report(MODELS / f"{name}.toml", **requested)


@pytest.fixture(scope="module")
def pendulum():
    return of("double_pendulum", time=2)


@pytest.fixture(scope="module")
def page(pendulum):
    return html_page(pendulum)


# -- what stands in it -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "expected"),
    usual(
        [
            ("double_pendulum", "data derivation reactions plots certificate downloads"),
            ("a_frame", "data reactions statics outputs certificate downloads"),
            ("slider_crank", "data derivation reactions outputs plots certificate downloads"),
            ("cart_pole", "data derivation reactions outputs linearize plots certificate downloads"),
            ("seeds/ch11_p3", "kinematics outputs certificate downloads"),
            ("seeds/s1_inertia_tensor", "data inertia outputs certificate downloads"),
        ],
        3,
    ),
)
def test_the_sections_are_those_that_fit_the_model(name, expected):
    """A motion has its derivation, a structure its reactions, a mechanism its instant, a lone body its inertia."""
    found = [section.key for section in of(name, time=0.5).sections]
    assert [key for key in found if key not in ("figure", "motion")] == expected.split()


def test_sections_are_added_and_left_out_by_name():
    """--with linearize --without plots,downloads; another name is refused with the nearest."""
    found = [
        section.key for section in of("double_pendulum", with_=("linearize",), without=("plots", "downloads")).sections
    ]
    assert "linearize" in found and not {"plots", "downloads"} & set(found)
    with pytest.raises(UsageError, match="did you mean 'plots'"):
        of("double_pendulum", without=("plot",))


def test_the_page_says_what_the_verbs_say(page):
    """The equations of motion, a reaction, the outputs' numbers: the same LaTeX as `derive`, the same text."""
    derived = eomgen.derive(MODELS / "double_pendulum.toml")
    body = html.unescape(page)
    for block in re.findall(r"\\\[(.*?)\\\]", derived.latex(), re.S):
        assert block in body
    assert "multiplied by 6 and divided by" in page


def test_the_proof_is_that_of_every_verb_in_it():
    """The checks of derive, solve, simulate and codegen, each once; without any there is no section of it."""
    found = of("simple_pendulum", time=0.5)
    model = eomgen.load(MODELS / "simple_pendulum.toml")
    names = [check.name for check in found.certificate.checks]
    assert {check.name for check in eomgen.solve(model).certify().checks} <= set(names)
    assert {check.name for check in eomgen.derive(model).certify().checks} <= set(names)
    assert len(found.certificate.checks) == len(set(found.certificate.checks))
    bare = of("simple_pendulum", time=0.5, certify=False)
    assert bare.certificate is None and "certificate" not in [section.key for section in bare.sections]


def test_a_contradiction_marks_the_page_and_ends_in_exit_3(monkeypatch, tmp_path):
    """The result is written, and says first that it is not to be trusted."""
    wrong = Certificate((Check("M is symmetric", "fails", "prime field", "M[1, 2] differs"),))
    monkeypatch.setattr(Equations, "certify", lambda *given, **options: wrong)
    model = eomgen.load(MODELS / "double_pendulum.toml")
    document = report_document(model, output=str(tmp_path / "r.html"), time=0.1)
    assert document.wrong == DISTRUST
    text = (tmp_path / "r.html").read_text()
    assert f'<p class="wrong" role="alert">{DISTRUST}</p>' in text and "proven by" not in text


def test_what_a_missing_value_keeps_away_is_said():
    """No value for m: no plots, and the page says why; the derivation is there."""
    text = (MODELS / "double_pendulum.toml").read_text()
    model = eomgen.loads(re.sub(r"(?m)^m1 = .*$", "m1 = {}", text))
    found = {section.key: section for section in report(model).sections}
    assert "no value for parameter 'm1'" in found["plots"].remark and found["derivation"].steps


def test_the_same_bytes_every_time(page):
    """Nothing of the clock or of memory stands in a page or a paper."""
    again = report(MODELS / "double_pendulum.toml", time=2)
    assert html_page(again) == page


# -- the page --------------------------------------------------------------------------------------


@needs("chromium")
def test_a_browser_shows_the_page_without_a_request_or_an_error(page, pendulum):
    """Offline: no address is asked for, the console is silent; LaTeX and text come out as they are meant."""
    script = """
    const copied = [];
    navigator.clipboard.writeText = async (text) => { copied.push(text); };
    while (!document.documentElement.dataset.typeset) await new Promise((go) => setTimeout(go, 20));
    const buttons = [...document.querySelectorAll("button[data-copy], button[data-copied]")];
    for (const button of buttons.slice(-2)) button.click();
    while (copied.length < 2) await new Promise((go) => setTimeout(go, 20));
    const rows = [...document.querySelectorAll("math[display]")].map((math) => math.querySelectorAll("mtr").length);
    const count = (what) => document.querySelectorAll(what).length;
    return { copied, rows, formulas: count("math"), left: count(".tex") };
    """
    found = visited(page, script)
    assert found.requests == () and found.console == ()
    displays = re.findall(r"\\\[(.*?)\\\]", html.unescape(page), re.S)
    assert found.found["left"] == 0 and found.found["formulas"] >= page.count("<math") + len(displays) > 20
    assert len(found.found["rows"]) == len(displays) > 9
    latex, text = found.found["copied"]
    assert latex.startswith(r"\[\begin{aligned}") and "arm2_y = 1/2*m2*" in text


FILES = """
HTMLAnchorElement.prototype.click = () => {};
const files = {};
let held = null;
URL.createObjectURL = (blob) => { held = blob; return "#"; };
for (const link of document.querySelectorAll("a[data-name]")) {
    held = null;
    link.dispatchEvent(new MouseEvent("click", { cancelable: true }));
    while (!held) await new Promise((go) => setTimeout(go, 20));
    const bytes = new Uint8Array(await held.arrayBuffer());
    files[link.dataset.name] = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
}
return files;
"""


@needs("chromium")
@pytest.mark.parametrize("name", usual(["double_pendulum", "disc_leaves_cylinder", "sleeping_top"], 2, 1))
def test_files_come_out_of_the_page_as_they_went_in(name):
    """The model and the code byte by byte; the motion, which the page computes where it can, to 9 digits."""
    found = of(name, time=2)
    files = {key: b64decode(text) for key, text in visited(html_page(found), FILES).found.items()}
    given = {file.name: file.content for section in found.sections for file in section.attachments}
    columns = given.pop(f"{name}.csv")
    head, *rows = files.pop(f"{name}.csv").decode().splitlines()
    assert files == given and len(files) == 2
    assert next(csv.reader([head])) == list(columns)
    numbers = np.array([[float(word) for word in row.split(",")] for row in rows])
    for column, right in zip(numbers.T, columns.values(), strict=True):
        assert column == pytest.approx(right, rel=0, abs=2e-9 * np.nanmax(np.abs(right), initial=1e-3), nan_ok=True)


def test_a_table_keeps_its_digits_and_what_is_no_number():
    """Read back, each number is off by half a unit of the 9th digit of its column's largest; nan and inf stay."""
    t = np.linspace(0, 10, 401)
    wild = np.where(t > 4, 1e-7 * np.sin(90 * t), 3.0)
    holes = np.where(t < 2, np.nan, np.where(t > 9, -np.inf, np.cos(t)))
    columns = [t, 1e12 * np.exp(-t), wild, holes, 0 * t, np.full(401, np.inf), t[:0]]
    for column in columns:
        packed = packed_columns([column], 9)
        bound = 0.5001 * 10.0 ** packed.columns[0][0]
        assert read_back(packed) == pytest.approx(column, rel=0, abs=bound, nan_ok=True)
        finite = np.abs(column[np.isfinite(column)])
        assert not finite.size or not finite.max() or bound <= 0.51e-8 * finite.max()
    assert len(packed_columns([np.sin(t)], 9).content) < 2 * len(t)


def read_back(packed):
    """One column by the definition: whole numbers of seven bits a byte, zigzag, summed, times a power of ten."""
    ((power, order, holes),) = packed.columns
    whole, value, size = [], 0, 1
    for byte in packed.content:
        value, size = value + (byte & 127) * size, 128 * size
        if byte < 128:
            whole.append(-(value + 1) // 2 if value % 2 else value // 2)
            value, size = 0, 1
    for _ in range(order):
        whole = list(accumulate(whole))
    found = np.array([float(Fraction(v) * Fraction(10) ** power) for v in whole])
    for first, count, word in holes:
        found[first : first + count] = float(word)
    return found


@sampled(2)
@needs("chromium")
@pytest.mark.parametrize("name", ["double_pendulum", "a_frame"])
def test_nothing_is_wider_than_a_telephone(name):
    """At 360 px the page does not scroll sideways: what is wider scrolls by itself, and can be reached by Tab."""
    inner = html.escape(html_page(of(name, time=0.5)))
    frame = f'<iframe style="width:360px;height:640px;border:0" srcdoc="{inner}"></iframe>'
    script = "const page = document.querySelector('iframe').contentDocument, root = page.documentElement;"
    script += "const wide = [...page.querySelectorAll('.scroll')].filter((e) => e.scrollWidth > e.clientWidth + 1);"
    script += "return [root.scrollWidth, wide.length, wide.every((e) => e.tabIndex === 0)];"
    found = visited(f"<!doctype html><meta charset=utf-8><body>{frame}</body>", script)
    width, count, reachable = found.found
    assert width <= 360 and count > 0 and reachable


@pytest.mark.parametrize(
    ("name", "most"), usual([("double_pendulum", 180_000), ("heavy_top", 400_000), ("arm7", 500_000)], 2, 1)
)
def test_a_page_is_small(name, most):
    """With its motion of 10 s, its letters and its files; benchmarks/pages.py counts all models."""
    assert len(html_page(of(name)).encode()) <= most


class Tags(HTMLParser):
    """The tags of a page and their attributes."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))


def test_a_strangers_text_is_text_in_every_format(tmp_path):
    """Names and remarks that would be tags, programs or commands: no element, no attribute, no code is made of them."""
    said = json.dumps(HOSTILE)
    text = (MODELS / "simple_pendulum.toml").read_text()
    text = re.sub(r"(?m)^name = .*$", lambda _: f"name = {said}\nabout = {said}", text)
    source = tmp_path / "x.toml"
    source.write_text(re.sub(r'about = "[^"]*" }', lambda _: f"about = {said} }}", text))
    found = report(source, time=0.2)
    page = html_page(found)
    tags = Tags()
    tags.feed(page)
    own = [tag for tag, _ in tags.found]
    assert "img" not in own and own.count("script") == page.count("<script>") and "alert(1)</script>" not in page
    assert not [name for _, attributes in tags.found for name in attributes if name.startswith("on")]
    assert all(attributes.get("href", "#").startswith(("#", "data:")) for _, attributes in tags.found)
    assert "\u202e" not in page
    markdown = written_as(found, ".md", "x.md")["x.md"]
    assert "<img" not in markdown.replace(r"\<img", "")
    latex = written_as(found, ".tex", "x.tex")["x.tex"]
    assert r"\input{x}" not in latex
    assert written_as(found, ".pdf", "x.pdf")["x.pdf"].startswith(b"%PDF")


# -- formulas --------------------------------------------------------------------------------------


@sampled(2)
@pytest.mark.parametrize("name", ["a_frame", "seeds/ch11_p3", "seeds/ch21_p1", "cart_pole", "seeds/s1_inertia_tensor"])
def test_no_formula_and_no_row_of_it_is_lost(name):
    """Of structures, mechanisms, small motions and bodies; those of all derivations are looked at in test_latex."""
    found = of(name, time=0.5)
    page = html_page(found)
    displays = re.findall(r"\\\[(.*?)\\\]", html.unescape(page), re.S)
    assert "unset" not in re.sub(r"<style>.*?</style>", "", page, flags=re.S)
    assert not list(filter(None, map(lost_in_mathml, displays))) and not list(
        filter(None, map(lost_in_typst, displays))
    )
    assert displays or name.endswith("tensor")


@pytest.mark.parametrize(
    ("tex", "expected"),
    [
        (r"\frac{27}{2} M R^{2} \dot{\theta}^{2}", "frac(27, 2) M R ^(2) dot(θ) ^(2)"),
        (r"\left(a + b\right)", r"lr(\( a + b \))"),
        (r"x_{\mathrm{stick\_x},1}", r'x _(upright("stick_x") \, 1)'),
        (r"\operatorname{atan2}\left(y, x\right)", r'op("atan2") lr(\( y \, x \))'),
        (r"\sqrt{\lvert x \rvert}", r"sqrt(\| x \|)"),
        (r"9{,}81\ \text{m/s$^2$}", r'"9,81" thick "m/s" ^(2)'),
        (r"2\ \text{N$\cdot$m}", r'2 thick "N" ⋅ "m"'),
        (r"\begin{cases} a & x < 0 \\ b & \text{otherwise} \end{cases}", 'cases(a & x < 0, b & "otherwise")'),
        (r"\begin{pmatrix} a & b \\ c & d \end{pmatrix}", 'mat(delim: "(", a , b; c , d)'),
    ],
)
def test_each_command_has_its_word_in_typst(tex, expected):
    assert typst_math(tex) == expected


def test_symbols_that_a_model_may_declare_are_known_to_both():
    """Every Greek letter, accent and style of the grammar of symbols, alone and with an index."""
    for command in COMMANDS:
        tex = rf"{command}{{x}}_{{\mathrm{{a}}}}^{{2}}"
        assert not lost_in_mathml(tex) and not lost_in_typst(tex), tex


def test_a_command_that_nobody_knows_is_refused():
    with pytest.raises(UnknownCommand, match="foo"):
        typst_math(r"\foo{x}")


def test_planted_losses_are_seen():
    """A row that is joined with the next, a sign that is printed, a command that is shown as an error."""
    two = r"\begin{aligned} a &= b \\ &\quad + c \end{aligned}"
    assert not lost_in_mathml(two) and not lost_in_typst(two)
    assert lost_in_mathml(two, "<math><mtable><mtr></mtr></mtable></math>")
    assert lost_in_mathml("a", "<math><mi>a</mi><mo>&amp;</mo></math>")
    assert lost_in_mathml(r"\foo")


# -- other formats ---------------------------------------------------------------------------------


def test_the_paper_has_its_text(pendulum, tmp_path):
    """A PDF of a few pages, with the same words; a sentence stays with the formula that it introduces."""
    assert '#block(sticky: true)[#"Together:"]\n\n#block(breakable: false)[$' in typst_text(pendulum)
    paper = written_as(pendulum, ".pdf", "r.pdf")["r.pdf"]
    assert paper.startswith(b"%PDF") and paper == written_as(pendulum, ".pdf", "r.pdf")["r.pdf"]
    if shutil.which("pdftotext"):
        (tmp_path / "r.pdf").write_bytes(paper)
        text = subprocess.run(["pdftotext", "-layout", tmp_path / "r.pdf", "-"], capture_output=True, text=True).stdout
        assert all(word in text for word in ("Double pendulum", "Equations of motion", "Certificate"))


def test_latex_brings_its_pictures_and_compiles(pendulum, tmp_path):
    """Each picture that it names is written; where TeX is, a paper comes out."""
    found = written_as(pendulum, ".tex", "r.tex")
    assert set(re.findall(r"\{(r-[\w-]+\.pdf)\}", str(found["r.tex"]))) == found.keys() - {"r.tex"} != set()
    if shutil.which("pdflatex"):
        for name, content in found.items():
            (tmp_path / name).write_bytes(content.encode() if isinstance(content, str) else content)
        words = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "r.tex"]
        assert subprocess.run(words, cwd=tmp_path, capture_output=True).returncode == 0


def test_markdown_names_its_pictures(pendulum):
    found = written_as(pendulum, ".md", "r.md")
    assert set(re.findall(r"\]\(<(r-[\w-]+\.svg)>\)", str(found["r.md"]))) == found.keys() - {"r.md"} != set()


@pytest.mark.parametrize("key", CALLS)
def test_the_call_of_each_section_of_a_notebook_gives_it(key: str):
    """What stands in its cell runs, with values or without."""
    about = {"statics": "cantilever", "kinematics": "seeds/ch11_p2", "inertia": "seeds/ch13_b4"}
    known = {"eomgen": eomgen, "model": eomgen.load(MODELS / f"{about.get(key, 'simple_pendulum')}.toml")}
    for call in (*([CALLS["derivation"]] if key == "certificate" else []), CALLS[key]):
        *before, last = call.format(time=0.1, values="").split("\n")
        exec("\n".join(before), known)
        assert eval(last, known) is not None


@has("nbclient")
def test_a_notebook_was_run_with_the_values_of_the_report(tmp_path):
    """Each cell of code has run without an error; a parameter that was typed holds in it."""
    path = tmp_path / "r.ipynb"
    report(MODELS / "simple_pendulum.toml", path, time=0.2, parameters={"l": "3 m"})
    cells = json.loads(path.read_text())["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert all(cell["execution_count"] for cell in code) and len(code) >= 4
    outputs = [each for cell in code for each in cell["outputs"]]
    assert not [each for each in outputs if each["output_type"] == "error"]
    assert "'parameters': {'l': '3'}" in "".join(code[0]["source"])


@in_slow_run
@has("nbclient")
def test_a_notebook_shows_no_picture_of_what_has_none(tmp_path):
    """Places of rest in space are told without a picture, and every cell runs."""
    path = tmp_path / "r.ipynb"
    report(MODELS / "spherical_pendulum.toml", path, with_=["statics"], without=["motion", "derivation"])
    assert "eomgen.statics(model)" in path.read_text() and ".picture" not in path.read_text()


def test_a_missing_extra_is_named_with_what_mends_it(monkeypatch, pendulum):
    """Exit 4, and what to install; nothing is imported before it is needed."""
    monkeypatch.setitem(sys.modules, "nbclient", None)
    with pytest.raises(ToolMissing, match=r"eomgen\[notebook\]") as caught:
        written_as(pendulum, ".ipynb", "r.ipynb")
    assert caught.value.exit_code == 4


@pytest.mark.parametrize("ending", [".html", ".pdf"])
def test_a_page_and_a_paper_take_no_other_program(monkeypatch, pendulum, ending):
    """What the base installation brings is enough: nothing is on the PATH."""
    monkeypatch.setenv("PATH", "")
    assert written_as(pendulum, ending, f"r{ending}")[f"r{ending}"]


def test_an_ending_that_no_report_has_is_refused():
    with pytest.raises(UsageError, match=r"r\.docx"):
        report(MODELS / "double_pendulum.toml", "r.docx")


def test_the_help_names_every_section():
    """`eomgen report --help` and SECTIONS."""
    from eomgen.cli import main

    reported = main.commands["report"].help
    assert sorted(reported.partition("Sections:")[2].partition(".")[0].split()) == sorted(SECTIONS)
