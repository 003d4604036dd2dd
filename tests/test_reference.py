"""The user's reference (docs/reference) and README.md: every example in them works, and nothing is left out."""

from __future__ import annotations

import doctest
import re
import shlex
import sys
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from each import each
from slow_run import sampled

import eomgen
from eomgen.cli import main
from eomgen.model.model import Model
from eomgen.model.outputs import FUNCTIONS
from eomgen.model.quantities import UNITS
from eomgen.simulation import WholeRun
from eomgen.symbolic.expression.formula import NAMES

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "docs" / "_ext"))

import reference  # noqa: E402  the site's own extension

pytestmark = pytest.mark.slow

PAGES = {path: path.read_text(encoding="utf-8") for path in reference.pages()}
REFERENCE = "\n".join(PAGES.values())
MODELS = (ROOT / "models" / "README.md").read_text(encoding="utf-8")
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(text: str, language: str) -> list[str]:
    """The code blocks of a page in one language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


EXAMPLES = blocks(REFERENCE, "toml") + blocks(README, "toml")
WHOLE = [example for example in EXAMPLES if example.startswith("eomgen = 1")]
PIECES = [example for example in EXAMPLES if not example.startswith("eomgen = 1")]


def first_table(piece: str) -> str:
    """The name of the first table of a piece."""
    return piece.split("[")[1].split("]")[0]


def whole_with(piece: str) -> Model:
    """The page's model with a piece added, key by key of each named part; every coordinate counts as used."""
    space = "space" if piece.startswith("# in space") else "plane"
    tables = next(raw for raw in map(tomllib.loads, WHOLE) if raw["space"] == space)
    for table, entries in tomllib.loads(piece).items():
        old = tables.setdefault(table, {})
        for name, entry in entries.items():
            both = isinstance(entry, dict) and isinstance(old.get(name), dict)
            old[name] = {**old[name], **entry} if both else entry
    tables.setdefault("outputs", {})["used"] = " + ".join(tables["coordinates"])
    return eomgen.Model(**{key: value for key, value in tables.items() if key != "eomgen"})


@each("text", WHOLE)
def test_a_whole_model_of_the_pages_derives_and_is_certified(text):
    """Every ```toml block that begins with `eomgen = 1`."""
    assert eomgen.derive(eomgen.loads(text)).certify().ok


@sampled(2)
@pytest.mark.parametrize("piece", PIECES, ids=first_table)
def test_a_piece_of_the_reference_derives_and_its_outputs_are_answered(piece):
    """Every other ```toml block, added to the model of the page."""
    model = whole_with(piece)
    assert eomgen.derive(model).M is not None
    of_runs = {name for name, output in model.outputs.items() if WholeRun.answers(output)}
    answers = eomgen.solve(model).items()
    assert {name: a.message for name, a in answers if a.message and name not in of_runs} == {}
    if of_runs:
        found = eomgen.simulate(model, time=20).quantities
        assert found.keys() == of_runs and {name: a.message for name, a in found.items() if a.message} == {}


@each("page", list(PAGES))
def test_the_tables_of_the_reference_are_those_of_the_classes(page):
    """Each kind, key, unit, default and function as the class that reads it says: `filled(page)` = page."""
    same = reference.filled(PAGES[page]) == PAGES[page]
    assert same, f"{page.name} is not what the classes say: python docs/_ext/reference.py writes its tables anew"


def test_every_table_that_can_be_made_stands_in_the_reference_once():
    """No part of the model file is left out, and no page is outside the contents."""
    made = re.findall("<!-- made: (.+?) -->", REFERENCE)
    assert sorted(made) == sorted(reference.MADE)
    assert set(PAGES) == set(reference.PLACE.glob("*.md"))


def test_a_table_that_was_changed_by_hand_is_found():
    """One unit, one key, one kind: what the class does not say."""
    page = PAGES[reference.PLACE / "shapes.md"]
    for old, new in (("`radius`", "`diameter`"), ("| `cone` |", "| `kegel` |"), ("m r^2 / 2", "m r^2 / 3")):
        assert old in page and reference.filled(page.replace(old, new)) == reference.filled(page)


@each("cls", sorted({*reference.TABLES.values(), *reference.BASES.values()}, key=lambda cls: cls.__name__))
def test_every_key_of_a_table_is_explained(cls):
    """By the docstring of the class that reads it, and by its rule."""
    known = cls.meanings()
    assert not [slot.key for slot in cls.slots() if not known.get(slot.name)]
    assert all(reference.value_of(slot.rule) for slot in cls.slots())


def test_the_reference_lists_every_model_of_the_folder():
    """Each file of models/ by its stem, each chapter of models/seeds/ by its first word or its whole name."""
    listed = set(re.findall(r"`(\w+)`", MODELS))
    assert {path.stem for path in (ROOT / "models").glob("*.toml")} <= listed
    for path in (ROOT / "models" / "seeds").glob("*.toml"):
        assert {path.stem, path.stem.partition("_")[0]} & listed, path.stem


def test_the_reference_names_every_function_and_unit():
    """The functions of expressions and of outputs, and the names of units, word by word."""
    words = set(re.findall(r"[\wµμ°]+", REFERENCE))
    assert {*NAMES, *FUNCTIONS} <= words
    assert set(UNITS) - words <= {"μm", "μs"}  # the other code point of the same letter


def test_the_python_session_of_the_reference_runs_as_it_stands(monkeypatch):
    """Every ```python block of the reference, as one doctest session."""
    monkeypatch.chdir(ROOT)
    session = "\n".join(blocks(REFERENCE, "python"))
    test = doctest.DocTestParser().get_doctest(session, {}, "docs/reference", "docs/reference", 0)
    reported: list[str] = []
    outcome = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(test, out=reported.append)
    assert outcome.attempted > 10
    assert outcome.failed == 0, "".join(reported)


def test_the_python_of_the_readme_runs_as_it_stands(monkeypatch):
    """Every ```python block of README.md, one after the other; what it asserts holds."""
    monkeypatch.chdir(ROOT)
    namespace: dict[str, Any] = {}
    for block in blocks(README, "python"):
        exec(compile(block, "README.md", "exec"), namespace)
    assert namespace["equations"].M.shape == (2, 2)


CONSOLE = [block for page in (README, REFERENCE) for block in blocks(page, "text") if block.startswith("$ eomgen ")]


@pytest.mark.parametrize("block", CONSOLE, ids=lambda block: block.splitlines()[0].removeprefix("$ eomgen "))
def test_what_the_pages_show_of_a_command_is_what_it_prints(block, tmp_path, monkeypatch):
    """```text blocks that begin with `$ eomgen ...`: the lines after it are lines of the output, in their order."""
    (tmp_path / "models").symlink_to(ROOT / "models")
    monkeypatch.chdir(tmp_path)
    command, *shown = block.splitlines()
    result = CliRunner().invoke(main, shlex.split(command)[2:])
    printed = iter(result.stdout.splitlines())
    assert result.exit_code == 0
    assert [line for line in shown if line != "..." and line not in printed] == []


@each("page", [ROOT / "README.md", ROOT / "models" / "README.md", *PAGES])
def test_links_inside_the_repository_lead_somewhere(page):
    """[text](path) is a file, [text](path#heading) a heading of it."""
    for target in re.findall(r"\]\(([^)]+)\)", page.read_text(encoding="utf-8")):
        path, _, anchor = target.partition("#")
        if not path.startswith("http"):
            to = page.parent / path if path else page
            assert to.exists() and (not anchor or anchor in headings(to)), target


def headings(page: Path) -> set[str]:
    """The anchors of a page."""
    words = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading).strip().lower().replace(" ", "-") for heading in words}


def test_the_readme_is_short():
    """At most 1 300 words, code included; what is longer stands in docs/."""
    assert len(README.split()) <= 1300


def test_what_the_readme_offers_next_does_what_it_says(tmp_path, monkeypatch):
    """The third ```sh block: five commands; `verify` finds the mistake that README names (exit 5)."""
    (tmp_path / "models").symlink_to(ROOT / "models")
    monkeypatch.chdir(tmp_path)
    lines = blocks(README, "sh")[2].splitlines()
    done = {}
    for line in lines:
        _, *words = shlex.split(line, comments=True)
        result = CliRunner().invoke(main, words)
        assert result.exit_code == (5 if words[0] == "verify" else 0), line
        done[words[0]] = result.stdout
        assert all(Path(file).exists() for option, file in pairwise(words) if option == "-o"), line
    assert list(done) == ["new", "report", "play", "verify", "codegen"] and Path("my_model.toml").exists()
    reported = re.search(r"`(the term with[^`]*)`", README)
    assert reported and " ".join(reported[1].split()) in " ".join(done["verify"].split())


def test_every_command_has_its_row_in_the_page_of_commands():
    """docs/commands.md: `eomgen NAME` begins one row of the table for each command, and for no other."""
    page = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `eomgen (\w+)", page, re.M)
    lacking = [f"| `eomgen {name} MODEL` | what it gives |" for name in main.commands if name not in rows]
    assert not lacking, "rows that docs/commands.md lacks"
    assert sorted(rows) == sorted(main.commands)


def test_the_first_two_shell_blocks_set_everything_up():
    """What a newcomer runs first, and what the check of every change runs: nothing before them is a shell block."""
    first, second = blocks(README, "sh")[:2]
    assert all(block.startswith("python3 -m venv .venv && ") for block in (first, second))
    assert "eomgen derive" in first and second.rstrip().endswith("pytest -q -n 2")
