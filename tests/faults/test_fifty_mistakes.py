"""What a newcomer does wrong in a model file, on the command line and in Python is reported with a fix.

`python tests/faults/test_fifty_mistakes.py` prints docs/mistakes.md.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner
from each import each

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1] / "helpers"))

from newcomer import CRANE, IN_COMMANDS, IN_FILES, of_python

import eomgen
from eomgen.cli import main
from eomgen.errors import EomgenError

WIDEST = 300
PAGE = Path(__file__).parents[2] / "docs" / "mistakes.md"


def of_file(what: str) -> str:
    """Messages for a model with this mistake."""
    right, wrong, _ = IN_FILES[what]
    assert right in CRANE
    with pytest.raises(EomgenError) as caught:
        eomgen.loads(CRANE.replace(right, wrong, 1))
    return str(caught.value)


def of_command(what: str) -> str:
    """Message for a command with this mistake, in a folder where the model is crane.toml."""
    Path("crane.toml").write_text(CRANE, encoding="utf-8")
    words = [{"MODEL": "crane.toml", "OUT": "code"}.get(word, word) for word in IN_COMMANDS[what][0]]
    result = CliRunner().invoke(main, words)
    assert result.exit_code in (1, 2, 3, 4) and not result.stdout
    return result.stderr


def of_call(what: str) -> str:
    """Message for a call with this mistake."""
    with pytest.raises(EomgenError) as caught:
        of_python()[what][0]()
    return str(caught.value)


@each("what", IN_FILES)
def test_a_mistake_in_a_file_is_told_with_its_mend(what):
    """The word that fixes it stands in the message."""
    assert IN_FILES[what][2] in of_file(what)


@pytest.mark.parametrize("what", IN_COMMANDS)
def test_a_mistake_on_the_command_line_is_told_with_its_mend(what, tmp_path, monkeypatch):
    """Likewise, on stderr alone, with a code of the table."""
    monkeypatch.chdir(tmp_path)
    assert IN_COMMANDS[what][1] in of_command(what)
    assert sorted(tmp_path.iterdir()) == [tmp_path / "crane.toml"]


@pytest.mark.parametrize("what", of_python())
def test_a_mistake_in_python_is_told_with_its_mend(what, tmp_path, monkeypatch):
    """Likewise, as an EomgenError."""
    monkeypatch.chdir(tmp_path)
    assert of_python()[what][1] in of_call(what)


def rows() -> Iterator[str]:
    for what, (_, wrong, _) in IN_FILES.items():
        yield f"| {what} | `{_cell(wrong)}` | {_reported(of_file(what))} |"
    for what, (words, _) in IN_COMMANDS.items():
        yield f"| {what} | `{_cell(' '.join(words))}` | {_reported(of_command(what))} |"
    for what in of_python():
        yield f"| {what} | Python | {_reported(of_call(what))} |"


def _reported(text: str) -> str:
    """First sentence and fix of a message."""
    lines = [line for line in text.splitlines() if line and not line.startswith((" ", "Usage:", "Try "))]
    fixes = [line for line in lines if line.startswith("fix: ")]
    return _cell("; ".join([lines[0], *fixes[:1]]))


def _cell(text: str) -> str:
    """In a table: in one line, what is not seen by its code, of a whole file the beginning."""
    seen = text.replace("\n", " ").replace("|", "\\|")
    shown = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in seen)
    return shown if len(shown) < WIDEST else f"{shown[:WIDEST]}..."


def page() -> str:
    """The mistakes and what is said of them."""
    head = "# Messages for a hundred mistakes\n\n"
    head += "Made on purpose in the model of a crane (`tests/helpers/newcomer.py`); written by\n"
    head += "`python tests/faults/test_fifty_mistakes.py`, whose tests make each of them.\n\n"
    return head + "| mistake | written | message |\n|---|---|---|\n" + "\n".join(rows()) + "\n"


def test_the_page_of_mistakes_is_what_is_said(tmp_path, monkeypatch):
    """docs/mistakes.md = page()."""
    monkeypatch.chdir(tmp_path)
    assert PAGE.read_text(encoding="utf-8") == page()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        text = page()
    sys.stdout.write(text)
