"""What a person reads of some commands, and the data of the pictures, are as they were looked at.

tests/golden/readings has one file a command. Its first line is the command; below it stand the exit code, what is
printed, the text of the files that are written and, of every picture, what matplotlib is handed: titles, windows,
lines, areas, letters. Numbers may differ in their fourth digit. No law sees a line that stands askew, a heading of
another model or a cause that is named wrongly; a reader does.

    EOMGEN_GOLDEN=1 python -m pytest -q tests/test_golden_readings.py     writes them anew: read what has changed
"""

from __future__ import annotations

import math
import os
import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from slow_run import sampled

from eomgen.cli import main
from eomgen.model import load
from eomgen.scene import SceneNumbers, drawing_of, scene_of_system
from eomgen.study import StateInNumbers, study_of

pytestmark = pytest.mark.slow  # a minute of CPU: verbs with their proofs and pictures
HOME = Path(__file__).parent / "golden" / "readings"
MODELS = Path(__file__).parent.parent / "models"
GOLDEN = sorted(HOME.glob("*.txt"))
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w])")
OF_THE_MACHINE = re.compile(
    r"\d+ steps, \d+ evaluations|Digits that hold at\s+the end: \d+|^(?:certificate|  ok ).*\n?", re.M
)
PLACES = 6  # of a path: so many places of it are kept


def rounded(values: Any) -> str:
    """Numbers to four digits; what is nothing beside the largest of them is 0."""
    flat = np.atleast_1d(np.asarray(values, dtype=float)).ravel()
    least = 1e-6 * max((abs(x) for x in flat if math.isfinite(x)), default=1.0)
    return " ".join("0" if abs(x) < least else f"{x:.4g}" for x in flat)


def places(path: Any) -> str:
    """Some of the places of a path, its ends among them."""
    rows = np.asarray(path, dtype=float)
    kept = np.unique(np.linspace(0, len(rows) - 1, min(PLACES, len(rows))).astype(int)) if len(rows) else []
    return f"{len(rows)} at " + ", ".join(f"({rounded(rows[k])})" for k in kept)


def panels(figure: Any) -> Iterator[str]:
    """What stands in the panels of a figure, a line each."""
    for number, axes in enumerate(figure.axes):
        yield f"panel {number}: {axes.get_title()!r}, {axes.get_xlabel()!r}, {axes.get_ylabel()!r}"
        yield f"  window {rounded(axes.get_xlim())} | {rounded(axes.get_ylim())}"
        for line in axes.lines:
            yield f"  line {line.get_label()!r} {line.get_linestyle()} {places(np.column_stack(line.get_data()[:2]))}"
        for patch in axes.patches:
            yield f"  area {places(patch.get_path().vertices)}"
        for letters in axes.texts:
            beside = f" of {rounded(letters.xy)}" if hasattr(letters, "xy") else ""
            yield f"  letters {letters.get_text()!r} at {rounded(letters.get_position())}{beside}"
        for many in axes.collections:
            for path in many.get_paths():
                yield f"  many {places(path.vertices)}"


def strokes(model: str) -> Iterator[str]:
    """What is drawn of a model at its start, with dimensions, a line each."""
    system = study_of(load(MODELS / f"{model}.toml")).system
    scene = scene_of_system(system)
    drawing = drawing_of(SceneNumbers.at(scene, StateInNumbers.at_start(system)), dimensions=True)
    for stroke in drawing.strokes:
        path = stroke.path[0]
        yield f"{stroke.role} of {stroke.of!r}: {places(path.reshape(-1, path.shape[-1]))}"
    for letter in drawing.letters:
        yield f"{letter.role} {letter.text!r} of {letter.of!r} at {rounded(letter.at[0])}"


def reading(command: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """What a command prints, and what its pictures show."""
    if command.startswith("strokes "):
        return "\n".join(strokes(command.split()[1])) + "\n"
    from matplotlib.figure import Figure

    drawn: list[str] = []
    saved = Figure.savefig

    def kept(figure: Any, *args: Any, **options: Any) -> None:
        saved(figure, *args, **options)
        drawn.extend(panels(figure))

    monkeypatch.setattr(Figure, "savefig", kept)
    monkeypatch.chdir(folder)
    words = [word.replace("MODELS", str(MODELS)) for word in shlex.split(command)]
    result = CliRunner().invoke(main, words)
    said = [f"exit {result.exit_code}", result.stdout, result.stderr, *written(folder), *drawn]
    return (
        re.sub(OF_THE_MACHINE, "#", "\n".join(filter(None, map(str.rstrip, said)))).replace(str(MODELS), "MODELS")
        + "\n"
    )


def written(folder: Path) -> Iterator[str]:
    """The text of each file that a command has written; of a page what stands outside its scripts and pictures."""
    for path in sorted(folder.rglob("*")):
        if path.suffix in (".md", ".tex", ".csv", ".json", ".toml", ".urdf", ".html"):
            text = path.read_text(encoding="utf-8")
            if path.suffix == ".html":
                text = re.sub(r"<(script|style|svg|template)\b.*?</\1>", "", text, flags=re.S)
                text = re.sub(r"\s*\n\s*", "\n", re.sub(r"<[^>]*>", " ", text))
            yield f"-- {path.name}\n{text}"


def differences(found: str, right: str) -> Iterator[str]:
    """Lines whose words differ, or a number in its fourth digit."""
    a, b = found.splitlines(), right.splitlines()
    if len(a) != len(b):
        yield f"{len(a)} lines, not {len(b)}"
    for x, y in zip(a, b, strict=False):
        numbers = zip(map(float, NUMBER.findall(x)), map(float, NUMBER.findall(y)), strict=False)
        same = NUMBER.sub("#", x) == NUMBER.sub("#", y)
        if not same or not all(math.isclose(p, q, rel_tol=2e-3, abs_tol=1e-9) for p, q in numbers):
            yield f"{x}   instead of   {y}"


@sampled(2)
@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_what_is_read_is_the_golden_one(path, tmp_path, monkeypatch):
    """tests/golden/readings: read it, and write it anew where a change is meant"""
    command, _, right = path.read_text(encoding="utf-8").partition("\n")
    found = reading(command, tmp_path, monkeypatch)
    if os.environ.get("EOMGEN_GOLDEN"):
        path.write_text(f"{command}\n{found}", encoding="utf-8")
        return
    assert not list(differences(found, right))
