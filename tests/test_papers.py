"""Every page of the repository: the files, commands, options and names that it speaks of are there today."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest

from eomgen.cli import main

ROOT = Path(__file__).parents[1]
FOLDERS = ("eomgen", "tests", "docs", "models", "benchmarks", "notebooks", "editors", ".ci", ".github")
PAGES = (
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "AGENTS.md")),
    *sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.md") if "node_modules" not in path.parts),
)  # not CHANGELOG.md, which tells what was
ENDINGS = ("", ".py", ".toml", ".md")  # that a page may leave out
OTHERS = {"eomgen.command", "eomgen.vsix"}  # an editor's setting, and its package
EXAMPLE = re.compile(r"[A-Z]{2,}|[*<{$]")  # KIND, DIR, *: a name that stands for many


@cache
def paths() -> frozenset[str]:
    """All files and folders, each by its way from the root and by every end of that."""
    found = [ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "AGENTS.md", "pyproject.toml")]
    found += [path for folder in FOLDERS for path in ((ROOT / folder), *(ROOT / folder).rglob("*"))]
    ways = [path.relative_to(ROOT).parts for path in found if "__pycache__" not in path.parts]
    return frozenset("/".join(way[k:]) for way in ways for k in range(len(way)))


@cache
def sources() -> str:
    """The text of all programs."""
    return "\n".join(path.read_text("utf-8") for folder in FOLDERS[:5] for path in (ROOT / folder).rglob("*.py"))


def code(text: str) -> list[str]:
    """What stands between backticks, without roles, and the lines of blocks for the shell."""
    blocks = [
        line for block in re.findall(r"^```(?:sh|text)\n(.*?)^```$", text, re.M | re.S) for line in block.splitlines()
    ]
    return [*re.findall(r"(?<![`}])`([^`\n]+)`(?!`)", re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)), *blocks]


def lost(text: str) -> Iterator[str]:
    """What a page speaks of and is not there."""
    for span in code(text):
        for word in re.findall(r"[^\s,;()`\"'=]+", span):
            yield from _lost_word(word.rstrip(".:"))
        yield from _lost_options(span)


def _lost_word(word: str) -> Iterator[str]:
    head, slash, _ = word.partition("/")
    is_path = re.fullmatch(r"[\w.-]+(/[\w.-]+)*/?", word) and (slash or re.search(r"\w\.pyi?$", word))
    known = any(word.rstrip("/") + ending in paths() for ending in ENDINGS)
    if EXAMPLE.search(word) or "\\" in word:
        if re.fullmatch(r"EOMGEN_[A-Z_]+", word) and word not in sources():
            yield f"the variable {word}"
    elif is_path and not known and (head in paths() if slash else True):
        yield f"the file {word}"
    elif re.fullmatch(r"eomgen(\.\w+)+", word) and word not in OTHERS and not _is_there(word):
        yield f"the name {word}"
    elif re.fullmatch(r"test_\w+", word) and word not in sources():
        yield f"the test {word}"


def _is_there(name: str) -> bool:
    found = import_module("eomgen")
    for k, part in enumerate(parts := name.split(".")[1:], start=1):
        if not hasattr(found, part):
            if not any("/".join(("eomgen", *parts[:k])) + ending in paths() for ending in ENDINGS[:2]):
                return False
            import_module(".".join(("eomgen", *parts[:k])))
        found = getattr(found, part)
    return True


def _lost_options(span: str) -> Iterator[str]:
    """Commands of eomgen that there are not, and options that a command, or a program of ours, does not have."""
    plain = re.sub(r'"[^"]*"', "", span)
    for verb, rest in re.findall(r"(?:^|/|\$ |&& )eomgen ([a-z]+)([^|#&;]*)", plain):
        if verb not in main.commands:
            yield f"the command eomgen {verb}"
            continue
        had = {option for each in main.commands[verb].params for option in (*each.opts, *each.secondary_opts)}
        options = set(re.findall(r"(?<!\S)--[a-z][a-z-]*", rest))
        yield from (f"the option {option} of eomgen {verb}" for option in sorted(options - had - {"--help"}))
    for program, rest in re.findall(r"python ((?:benchmarks|tests|docs|notebooks)/\S+\.py)([^|#&;]*)", plain):
        if (ROOT / program).exists():
            text = (ROOT / program).read_text("utf-8")
            options = set(re.findall(r"(?<!\S)--[a-z][a-z-]*", rest))
            yield from (f"the option {option} of {program}" for option in sorted(options) if not _has(text, option))


def _has(text: str, option: str) -> bool:
    """True if a program reads an option; one that it makes of a list of words counts by its word."""
    return option in text or f'"{option[2:]}"' in text


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_what_a_page_speaks_of_is_there(page):
    """Files, tests, variables, names of Python, commands and options in code; the files of links."""
    text = page.read_text("utf-8")
    assert sorted({*lost(text)}) == [], f"{page.relative_to(ROOT)} speaks of what there is not"
    links = re.findall(r"\]\((?!https?:|mailto:|#)<?([^)#\s>]+)", re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S))
    assert [link for link in links if not (page.parent / link).exists()] == []


def test_what_is_gone_is_found():
    """One of each kind, beside one that is there."""
    test, variable = "test_of_" + "unicorns", "EOMGEN_" + "STALE"  # in no source
    there = "`model/part`, `part.py`, `seeds/ch22_p1`, `docs/examples/KIND.toml`, `eomgen.derive(m)`, `EOMGEN_FRESH=1`"
    gone = "`model/gone`, `gone.py`, `eomgen.derives`, `eomgen derives m.toml`, `eomgen derive m.toml --full --half`"
    gone += ", `python benchmarks/house.py --half`, " + f"`{test}`, `{variable}=1`"
    assert not [*lost(there)]
    assert sorted({*lost(gone)}) == [
        "the command eomgen derives",
        "the file gone.py",
        "the file model/gone",
        "the name eomgen.derives",
        "the option --half of benchmarks/house.py",
        "the option --half of eomgen derive",
        f"the test {test}",
        f"the variable {variable}",
    ]
