"""The notebooks as they are kept: what their scripts give, small, the same wherever they are made."""

from __future__ import annotations

import json
import re
import sys
from copy import deepcopy
from functools import cache
from pathlib import Path
from typing import Any

import nbformat
import pytest
from slow_run import sampled

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "notebooks"))

import build  # noqa: E402  the command that makes them

pytestmark = pytest.mark.slow

SCRIPTS = build.scripts()
LARGEST = 400_000  # bytes of a notebook


@cache
def kept(script: Path) -> dict[str, Any]:
    """The notebook beside a script."""
    return json.loads(script.with_suffix(".ipynb").read_text(encoding="utf-8"))


def test_each_script_has_its_notebook_and_the_page_names_it():
    """Seven, numbered; notebooks/README.md has a line for each."""
    assert [script.name[0] for script in SCRIPTS] == list("1234567")
    assert sorted(build.HERE.glob("*.ipynb")) == [script.with_suffix(".ipynb") for script in SCRIPTS]
    named = re.findall(r"\]\((\w+\.ipynb)\)", (build.HERE / "README.md").read_text(encoding="utf-8"))
    assert named == [f"{script.stem}.ipynb" for script in SCRIPTS]


@sampled(2)
@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_notebook_is_what_its_script_gives(script):
    """Every cell runs, its assertions hold, and sources, texts and numbers are those of the notebook that is kept."""
    assert not list(build.differences(kept(script), build.notebook_of(script))), "python notebooks/build.py"


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_notebook_shows_all_on_a_code_host(script):
    """It is valid and small; nothing in it tells of a machine; each result is shown as more than an object's name."""
    nbformat.validate(kept(script))
    text = script.with_suffix(".ipynb").read_text(encoding="utf-8")
    assert len(text) < LARGEST
    assert not re.search(r"/(?:tmp|home|root|opt|usr)/|\bat 0x[0-9a-f]+", re.sub(r'"image/png": "[^"]*"', "", text))
    outputs = [build.told(output) for cell in kept(script)["cells"] for output in cell.get("outputs", ())]
    assert outputs and not [output for output in outputs if "text/html" in output]
    plain = [output["text/plain"] for output in outputs if output.keys() == {"text/plain"}]
    assert not [text for text in plain if text.startswith("<")]


def test_the_first_derives_simulates_and_shows_a_motion_in_ten_cells():
    """Equations of motion, a run and a moving picture."""
    cells = kept(SCRIPTS[0])["cells"]
    code = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    assert len(cells) == 10 and all(call in code for call in ("eomgen.derive(", "eomgen.simulate(", ".animate("))


def test_what_differs_between_two_notebooks_is_named():
    """A source, a word, a number, an output that is not there, a picture; not the last digits of a number."""
    first = kept(SCRIPTS[0])

    def changed(change: Any) -> list[str]:
        other = deepcopy(first)
        change(other["cells"])
        return list(build.differences(first, other))

    def replaced(old: str, new: str) -> Any:
        def change(cells: list[Any]) -> None:
            told = cells[3]["outputs"][0]["data"]["text/markdown"]
            assert any(old in line for line in told)
            told[:] = [line.replace(old, new) for line in told]

        return change

    assert not changed(lambda cells: None)
    assert not changed(replaced("9.81", "9.8100000001"))
    assert changed(replaced("9.81", "9.82")) == ["cell-4: another text/markdown"]
    assert changed(replaced("sin", "cos")) == ["cell-4: another text/markdown"]
    assert changed(lambda cells: cells[1]["source"].pop()) == ["cell-2: another source"]
    assert changed(lambda cells: cells.pop()) == ["cell-10: another source"]
    assert changed(lambda cells: cells[7]["outputs"].clear()) == ["cell-8: outputs of other kinds"]
    assert changed(lambda cells: cells[8]["outputs"][0]["data"].pop("image/png")) == ["cell-9: outputs of other kinds"]
