"""In a notebook: a model in a cell, and what each result shows of itself, in a real IPython shell."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import RichOutput, capture_output

import eomgen

MODELS = Path(__file__).parent.parent / "models"
CELL = """%%eomgen pendulum
space = "plane"
parameters = { m = { value = 2, unit = "kg" }, l = { value = 1, unit = "m" }, g = { value = 9.81, unit = "m/s^2" } }
coordinates = { theta = { start = 30, unit = "deg" } }
[bodies.arm]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "theta - pi/2" }
[forces]
weight = { kind = "gravity", acceleration = [0, "-g"] }
[outputs]
T = "kinetic_energy()"
"""


@pytest.fixture(scope="module")
def shell() -> Iterator[InteractiveShell]:
    made = InteractiveShell()
    made.run_cell("%load_ext eomgen")
    yield made
    made.history_manager.end_session()


def run(shell: InteractiveShell, cell: str) -> tuple[bool, str, list[RichOutput]]:
    """(whether it ran, what was printed, what was shown)."""
    with capture_output() as captured:
        done = shell.run_cell(cell)
    return done.success, captured.stdout + captured.stderr, captured.outputs


def forms(shell: InteractiveShell, value: object) -> dict[str, object]:
    """{form: content} of what a notebook shows of a value."""
    return shell.display_formatter.format(value)[0]


def test_a_model_stands_in_a_cell(shell):
    """It gets the name behind %%eomgen, is the result of the cell, and shows its picture."""
    done, printed, _ = run(shell, CELL)
    assert (done and printed.strip().startswith("Out")) or done
    model = shell.user_ns["pendulum"]
    assert isinstance(model, eomgen.Model) and (model.name, list(model.coordinates)) == ("pendulum", ["theta"])
    assert run(shell, "2*pendulum.exact_parameters()['m']")[0] and shell.user_ns["_"] == 4
    assert run(shell, CELL.replace("%%eomgen pendulum", "%%eomgen"))[0] and shell.user_ns["model"] == model.altered(
        name="model"
    )


def test_the_first_line_of_a_file_may_stand_there_too(shell):
    """`eomgen = 1` below %%eomgen."""
    assert run(shell, CELL.replace("pendulum\n", "again\neomgen = 1\n"))[0]
    assert shell.user_ns["again"].coordinates == shell.user_ns["pendulum"].coordinates


def test_problems_have_the_lines_of_the_cell(shell):
    """An unknown name in the sixth line; no traceback, and the name is not bound."""
    done, printed, _ = run(shell, CELL.replace("pendulum", "wrong").replace('mass = "m"', 'mass = "mm"'))
    assert not done and "<cell>:6:33: unknown name 'mm'" in printed and "Traceback" not in printed
    assert "fix: did you mean 'm'?" in printed and "wrong" not in shell.user_ns


def test_a_name_that_is_none_is_refused(shell):
    """%%eomgen my model."""
    done, printed, _ = run(shell, CELL.replace("%%eomgen pendulum", "%%eomgen my model"))
    assert not done and "'my model' is no name for a model" in printed


SHOWN = {
    "verdict": ('eomgen.verify(pendulum, "T = m*l^2*theta\'^2/6")', "text/html"),
    "model": ("pendulum", "image/png"),
    "picture of a model": ("pendulum.picture", "image/png"),
    "equations": ("eomgen.derive(pendulum)", "text/latex"),
    "answers": ("eomgen.solve(pendulum)", "text/markdown"),
    "reactions": ("eomgen.reactions(pendulum)", "text/markdown"),
    "statics": ("eomgen.statics(beam)", "text/markdown"),
}
RUNS = {
    "run": ("eomgen.simulate(pendulum, time=1)", "text/html"),
    "picture of a run": ("eomgen.simulate(pendulum, time=1).picture", "image/png"),
    "moving picture of a model": ("eomgen.animate(pendulum, time=1)", "text/html"),
    "page": ("eomgen.play(pendulum, time=1)", "text/html"),
    "report": ("eomgen.report(pendulum, time=1, certify=False)", "text/html"),
    "study": ("eomgen.sweep(pendulum, over={'m': [1, 2]}, ask='max(theta)', time=1)", "text/markdown"),
}


def shows(shell: InteractiveShell, expression: str, form: str) -> None:
    done, printed, _ = run(shell, f"import eomgen; shown = {expression}")
    assert done, printed
    found = forms(shell, shell.user_ns["shown"])
    assert form in found and len(found[form]) > 20


@pytest.mark.parametrize("what", SHOWN)
def test_what_is_found_shows_itself(shell, what):
    """In the richest form that it has."""
    run(shell, CELL)
    shell.user_ns["beam"] = eomgen.load(MODELS / "cantilever.toml")
    shows(shell, *SHOWN[what])


@pytest.mark.slow
@pytest.mark.parametrize("what", RUNS)
def test_what_moves_shows_itself(shell, what):
    """Runs, pages, reports and studies: compiled once."""
    run(shell, CELL)
    shows(shell, *RUNS[what])


@pytest.mark.slow
def test_a_study_shows_what_came_of_its_runs(shell):
    """Two runs; least, mean and largest of what was asked."""
    run(shell, CELL)
    found = eomgen.sweep(shell.user_ns["pendulum"], over={"m": [1, 2]}, ask="max(theta)", time=1)
    text = forms(shell, found)["text/markdown"]
    assert "2 runs: 2 finished" in text and "largest" in text and "max(theta)" in text
