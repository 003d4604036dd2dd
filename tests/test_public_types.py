"""The public names as a stranger's type checker sees them, and what they take for a model."""

from __future__ import annotations

import ast
import inspect
import os
import subprocess
import sys
from pathlib import Path

import pytest

import eomgen

ROOT = Path(eomgen.__file__).parent
REQUIRED = {
    "reaction": "reaction_y(A)",
    "time": 1.0,
    "target": "numpy",
    "equation": "T = 0",
    "data": {},
    "number": 1,
}  # of arguments without a default

SCRIPT = """
import eomgen

reveal_type(eomgen.derive(eomgen.load("x")))
reveal_type(eomgen.derive("x").certify())
reveal_type(eomgen.simulate("x", time=1.0))
"""
REVEALED = ("eomgen.equations.Equations", "eomgen.proof.check.Certificate", "eomgen.simulation.result.Trajectory")


def of_a_model() -> list[str]:
    """The public functions whose first argument is a model."""
    functions = [name for name in eomgen.__all__ if inspect.isfunction(getattr(eomgen, name))]
    return [name for name in functions if next(iter(inspect.signature(getattr(eomgen, name)).parameters)) == "model"]


def test_the_stub_says_of_every_public_name_where_it_is():
    """__init__.pyi, for type checkers, and the table of __init__.py, at run time, are the same."""
    reported = {}
    for node in ast.parse((ROOT / "__init__.pyi").read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ImportFrom):
            reported |= {alias.asname: str(node.module) for alias in node.names}
    assert set(reported) == set(eomgen.__all__)
    for name, home in reported.items():
        there = getattr(sys.modules.get(str(home)) or __import__(str(home), fromlist=[name]), name)
        assert there is getattr(eomgen, name)


def test_the_package_ships_its_types():
    assert (ROOT / "py.typed").is_file()


@pytest.mark.parametrize("name", of_a_model())
def test_every_function_of_a_model_takes_a_path_to_one(name):
    """It reads the file at the path: one that is not there is told as `load` tells it."""
    function = getattr(eomgen, name)
    needed = [p.name for p in inspect.signature(function).parameters.values() if p.default is p.empty][1:]
    for path in ("nowhere.toml", Path("nowhere.toml")):
        with pytest.raises(eomgen.ModelError, match="cannot be read"):
            function(path, **{key: REQUIRED[key] for key in needed})


def test_the_functions_of_a_model_are_found():
    assert {"derive", "simulate", "solve", "statics", "kinematics", "inertia", "linearize"} <= set(of_a_model())


@pytest.mark.slow
def test_a_script_under_strict_mypy_sees_the_classes(tmp_path):
    """reveal_type(eomgen.derive(eomgen.load("x"))) is Equations, not Any.

    Slow: mypy reads the whole package, the first time; then it knows what did not change.
    """
    pytest.importorskip("mypy")
    (tmp_path / "script.py").write_text(SCRIPT, encoding="utf-8")
    kept = f"--cache-dir={ROOT.parent / '.mypy_cache' / 'script'}"
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", kept, "script.py"]
    found = subprocess.run(
        command, cwd=tmp_path, env={**os.environ, "MYPYPATH": str(ROOT.parent)}, capture_output=True, text=True
    )
    for revealed in REVEALED:
        assert f'"{revealed}"' in found.stdout, found.stdout + found.stderr
