"""Whatever a report says is said in the language that is asked; what its author wrote, and every formula, stays."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from importlib import resources
from pathlib import Path

import pytest
from click.testing import CliRunner
from each import each
from matplotlib.text import Text
from slow_run import ALL, sampled, usual

import eomgen
from eomgen.cli import main
from eomgen.documents.document import own_words
from eomgen.documents.languages import PLACE, Catalogue, catalogue, languages, read_catalogue
from eomgen.documents.statements import Formula, Grid, Lines, Prose, Step, Table
from eomgen.documents.text import formula_text
from eomgen.page.player import SAID, SCRIPTS, asset, player_reported
from eomgen.page.report import report
from eomgen.symbolic.expression import Graph

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
USUAL = ("conker", "slider_crank", "gerber_beam", "heavy_top", "two_mass_oscillator", "seeds/ch11_p3", "seeds/ch16_p5")
NAMES = sorted(str(path.relative_to(MODELS).with_suffix("")) for path in MODELS.rglob("*.toml"))
KNOWN = set("rad deg kg sin cos tan sqrt omega speed angle eomgen numpy min max exp atan sign abs diag drive".split())
ENGLISH = re.compile(r"(?<![A-Za-z_'.(])[a-z]{3,}(?![A-Za-z_(])")
WRITTEN = ("statement", "question_1", "question_2")  # steps of the words of an author
OTHERS = [language for language in languages() if language != "en"]


def made_up() -> Catalogue:
    """A language whose words are a sign each: what stays English has letters."""
    messages = {msgid: "¤".join(["", *PLACE.findall(msgid), ""]) for msgid in catalogue("de").messages}
    places = {msgid: re.sub(r"(?<=¤)(\d)", r"{\1}", words) for msgid, words in messages.items()}
    return Catalogue("xx", places, comma=True)


def words(step: Step) -> Iterator[str]:
    """The words of a step that are its own and no formulas."""
    yield step.title
    for statement in step.statements:
        if isinstance(statement, Prose):
            yield " ".join(piece for piece in statement.pieces if isinstance(piece, str))
        elif isinstance(statement, Table):
            yield from (*statement.head, *(row.meaning for row in statement.rows))
        elif isinstance(statement, Grid):
            yield from (cell for row in (statement.head, *statement.rows) for cell in row if isinstance(cell, str))
        else:
            assert isinstance(statement, (Formula, Lines))


@sampled(2)
@pytest.mark.by_model
@pytest.mark.parametrize("name", NAMES if ALL else USUAL[::2])
def test_no_sentence_stays_english(name):
    path = MODELS / f"{name}.toml"
    own = set(re.findall(r"[A-Za-z]+", path.read_text()))
    language = made_up().beside(own_words(eomgen.load(path)))
    sections = [
        section.said_in(language, ("statement", "question_1", "question_2")) for section in report(path).sections
    ]
    assert len(sections) > 3
    for section in sections:
        steps = [step for step in section.steps if step.key not in WRITTEN]
        said = [text for step in steps for text in words(step)]
        said += [section.title, section.remark, *(each.caption for each in section.drawings)]
        said += [each.about for each in section.attachments]
        left = {text: found for text in said if (found := set(ENGLISH.findall(text)) - own - KNOWN)}
        assert not left, f"section {section.key}: write what is left into each eomgen/documents/languages/*.po"


@pytest.mark.parametrize("language", OTHERS if ALL else OTHERS[:1])
def test_a_report_in_another_language_is_proven_and_its_formulas_are_the_same(language, tmp_path):
    models = (("slider_crank", "kinetostatic"), ("conker", "lagrange"), ("gerber_beam", "lagrange"))
    for name, method in usual(models, 3, 1):
        ours, theirs = (report(MODELS / f"{name}.toml", method=method, language=each) for each in ("en", language))
        assert theirs.certificate is not None and theirs.certificate.ok
        formulas = [
            [formula_text(x) for section in each.sections for step in section.steps for x in step.statements
             if isinstance(x, Formula) and not re.search(r"\([^\W\d]{4,}\)", formula_text(x))]
            for each in (ours, theirs)
        ]  # fmt: skip
        assert formulas[0] == formulas[1] and len(formulas[0]) > 4
    for ending in usual((".html", ".tex", ".md"), 3):
        found = report(MODELS / "cart_pole.toml", tmp_path / f"r{ending}", language=language, without=["motion"])
        assert found.certificate is not None and found.certificate.ok, ending


@pytest.mark.parametrize("language", OTHERS)
def test_every_entry_keeps_its_places(language):
    own = catalogue(language)
    for msgid, said in own.messages.items():
        assert sorted(set(PLACE.findall(msgid))) == sorted(set(PLACE.findall(said))), msgid
        assert (msgid[-1:] in ".:") == (said[-1:] in ".:"), msgid
    assert own.messages.keys() == catalogue("de").messages.keys()


@each(
    "language, text, said",
    [
        ("de", "2 bodies, 4 coordinates, 1 of them dependent.", "2 Körper, 4 Koordinaten, davon 1 abhängig."),
        ("de", "1 body, 1 coordinate.", "1 Körper, 1 Koordinate."),
        ("fr", "near 0.25", "près de 0,25"),
        ("es", "force on arm at A, from the ground, along x", "fuerza sobre arm en A, del suelo, según x"),
        ("de", "the widget of my uncle", "the widget of my uncle"),
    ],
)  # fmt: skip
def test_sentences_are_said_whole_or_in_parts(language, text, said):
    assert catalogue(language).say(text) == said


def test_derive_speaks_the_language_of_the_file(tmp_path):
    path = tmp_path / "conker.toml"
    path.write_text('language = "de"\n' + (MODELS / "conker.toml").read_text())
    for words_, head in (([], "Bewegungsgleichungen"), (["--language", "fr"], "Équations du mouvement")):
        found = CliRunner().invoke(main, ["derive", str(path), *words_])
        assert found.exit_code == 0 and head in found.stdout and "9,81" in found.stdout


def test_a_person_adds_a_language(tmp_path):
    own = tmp_path / "it.po"
    own.write_text('msgid ""\nmsgstr "X-Decimal: ,\\n"\n\nmsgid "Equations of motion"\nmsgstr "Equazioni del moto"\n')
    found = CliRunner().invoke(main, ["derive", str(MODELS / "conker.toml"), "--language", str(own)])
    assert found.exit_code == 0 and "Equazioni del moto" in found.stdout
    wrong = CliRunner().invoke(main, ["derive", str(MODELS / "conker.toml"), "--language", "d"])
    assert wrong.exit_code == 2 and "there are no words in the language 'd'" in wrong.stderr


def test_catalogues_are_files_of_gettext():
    text = resources.files("eomgen.documents").joinpath("languages", "de.po").read_text("utf-8")
    assert read_catalogue(text, "de").messages == catalogue("de").messages
    assert read_catalogue('msgid "a \\"b\\""\nmsgstr ""\n"c\\n"\n"d"\n', "x").messages == {'a "b"': "c\nd"}


def test_formulas_stand_in_the_order_of_the_language():
    graph = Graph()
    a, b = graph.symbol("a"), graph.symbol("b")
    said = catalogue("de").prose(Prose(("For ", a, ", divided by ", b, ":")))
    assert said.pieces == ("Für ", a, ", geteilt durch ", b, ":")
    turned = Catalogue("xx", {"For {1}, divided by {2}:": "{2} divides, for {1}:"})
    assert turned.prose(Prose(("For ", a, ", divided by ", b, ":"))).pieces == (b, " divides, for ", a, ":")


def test_the_page_of_a_motion_speaks_the_language():
    """Every sentence of its scripts is known to the catalogues."""
    sentences = {text for name in SCRIPTS for text in SAID.findall(asset(name))}
    assert len(sentences) > 20 and not sentences - catalogue("de").messages.keys()
    page = eomgen.play(MODELS / "cart_pole.toml", time=0.2, language="de").html
    told = player_reported(page)
    assert told["comma"] and told["words"]["Play"] == "Abspielen" and 'lang="de"' in page and "hell oder dunkel" in page
    assert sentences - told["words"].keys() <= {"Pause"}  # the same word in both


def test_pictures_speak_the_language():
    """Words that matplotlib draws, and the numbers of its axes."""
    picture = replace(eomgen.statics(MODELS / "fink_truss.toml").picture, language=catalogue("de"))
    texts: list[str] = []
    picture._drawn(lambda figure: texts.extend(text.get_text() for text in figure.findobj(Text)))
    assert any("Zug blau" in text for text in texts) and not any(re.search(r"\d\.\d", text) for text in texts)


def test_plots_beside_a_page_have_the_decimal_sign_of_the_language(tmp_path):
    """SVG files next to Markdown: matplotlib writes each text of an axis into a remark, too."""
    path, options = tmp_path / "page.md", ["--language", "de", "--time", "1", "--with", "plots"]
    found = CliRunner().invoke(main, ["report", str(MODELS / "simple_pendulum.toml"), "-o", str(path), *options])
    assert found.exit_code == 0, found.output
    numbers = re.findall(r"<!-- (\S*\d\S*) -->", (tmp_path / "page-motion1.svg").read_text("utf-8"))
    assert any("," in number for number in numbers) and not any("." in number for number in numbers)
