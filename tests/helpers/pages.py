"""The pages of docs/ as a reader uses them: their files are written, their commands run, what they show came out."""

from __future__ import annotations

import doctest
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from click.testing import CliRunner

from eomgen.cli import main

BLOCK = re.compile(r"^```(\{code-block\} )?(\w+)\n(?::caption: (\+ )?(\S+)\n)?(.*?)^```$", re.M | re.S)
PROGRAMS = {"cc", "./selftest"}


def ellipsis(text: str) -> str:
    """A pattern: `...` alone on a line stands for any lines, inside one for any letters."""
    parts = []
    for line in text.splitlines():
        parts.append("(?:.*\n)*?" if line == "..." else re.escape(line.rstrip()).replace(r"\.\.\.", ".*") + r" *\n")
    return "".join(parts)


def said(command: str) -> str:
    """What a command prints on stdout; its exit code is 0."""
    words = shlex.split(command)
    assert words[0] == "eomgen", command
    done = CliRunner().invoke(main, words[1:], catch_exceptions=False)
    assert done.exit_code == 0, f"{command}\n{done.output}"
    return done.stdout


def run_shell(text: str) -> None:
    """Each line of a shell block: eomgen's commands, and the compilers' of what it wrote."""
    for line in filter(None, text.splitlines()):
        if line.startswith("eomgen "):
            said(line)
            continue
        assert set(shlex.split(part)[0] for part in line.split("&&")) <= PROGRAMS, line
        if shutil.which("cc"):
            subprocess.run(["sh", "-c", line], check=True)


def run_page(text: str) -> int:
    """All blocks of a page in their order, in the working folder; how many were run."""
    count = 0
    for _, language, more, name, body in BLOCK.findall(text):
        if name:
            with Path(name).open("a" if more else "w", encoding="utf-8") as file:
                file.write(body)
        elif language == "sh":
            run_shell(body)
        elif language == "text" and body.startswith("$ eomgen "):
            session(body)
        elif language == "python" and body.startswith(">>> "):
            found = doctest.DocTestParser().get_doctest(body, {}, "page", None, 0)
            runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
            runner.run(found, out=sys.stderr.write)
            assert runner.summarize(verbose=False).failed == 0
        else:
            continue
        count += 1
    return count


def session(body: str) -> None:
    """Commands after `$ `, each with what it prints."""
    for command, shown in re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", body, re.M):
        printed = "".join(f"{line.rstrip()}\n" for line in said(command).splitlines())
        assert re.fullmatch(ellipsis(shown), printed), f"{command}\n--- the page:\n{shown}\n--- printed:\n{printed}"
