"""Every notebook runs from its first cell to its last, and what a cell ends in can be shown typeset."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Any

import matplotlib
import pytest

pytestmark = pytest.mark.slow

NOTEBOOKS = sorted((Path(__file__).parent.parent / "notebooks").glob("*.py"))


def cells(text: str) -> list[str]:
    """The code cells of a percent script."""
    parts = text.split("\n# %%")[1:]
    return [part.partition("\n")[2] for part in parts if not part.startswith(" [markdown]")]


def shown(cell: str, namespace: dict[str, Any]) -> Any:
    """Runs a cell and gives the value of the expression that it ends in, or None."""
    tree = ast.parse(cell)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), namespace)
    return None if last is None else eval(compile(ast.Expression(last.value), "cell", "eval"), namespace)


def is_rich(value: Any) -> bool:
    """Whether a notebook shows more than the repr, or the repr is all there is to show."""
    ours = type(value).__module__.split(".")[0] == "eomgen"
    methods = ("_repr_mimebundle_", "_repr_latex_", "_repr_html_", "_repr_markdown_", "_repr_png_")
    return not ours or any(getattr(value, method, None) is not None for method in methods)


def test_there_are_notebooks():
    """notebooks/ is not empty."""
    assert NOTEBOOKS


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_shows_its_results(path, tmp_path, monkeypatch):
    """Cell after cell without an exception; the assertions in them hold; our results have a rich display."""
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    namespace: dict[str, Any] = {"__name__": "__main__", "__file__": str(path)}
    for cell in cells(path.read_text()):
        assert is_rich(shown(cell, namespace)), cell
