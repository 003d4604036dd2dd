"""Programs that some tests run: without one they are skipped by its name, but on CI, where that is a failure.

EOMGEN_REQUIRE says what must be there: a list of languages and programs ("cpp,rust,chromium"), or 1: all.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
from collections.abc import Iterable

import pytest

from eomgen.codegen import build
from eomgen.codegen.targets import ALL, cpp, fortran, rust, wasm

REQUESTED = "all" if os.environ.get("CI") else os.environ.get("EOMGEN_REQUIRE", "")
REQUIRED = None if REQUESTED in ("1", "all") else frozenset(REQUESTED.replace(",", " ").split())  # None: all
NAMES = {"chromium": ("chromium", "chromium-browser", "google-chrome")}
COMPILERS = {"c": build.C, "cpp": cpp.COMPILER, "rust": rust.COMPILER, "fortran": fortran.COMPILER}
COMPILERS |= {"wasm": wasm.COMPILER}
NEEDS = {  # of a language the programs and packages (with a dot before them) that run it and its own test
    "c": (),
    "cpp": (),
    "rust": ("cargo",),
    "fortran": (),
    "javascript": ("node",),
    "wasm": ("node",),
    "matlab": ("octave-cli",),
    "jax": (".jax",),
    "casadi": (".casadi",),
    "numba": (".numba",),
    "fmu": (".fmpy",),
    "julia": (".tree_sitter", ".tree_sitter_julia"),
}
SLOW = ("wasm", "matlab", "jax", "casadi", "numba", "fmu")  # to start, or to compile: they take part in few tests


def found(name: str) -> str | None:
    """Where a program is, or a package that begins with a dot; None where it is not."""
    if name.startswith("."):
        return name if importlib.util.find_spec(name[1:]) else None
    return next(filter(None, map(shutil.which, NAMES.get(name, (name,)))), None)


def tool(name: str) -> str:
    """Where a program is; the test fails where it is not."""
    path = found(name)
    if path is None:
        pytest.fail(f"there is no {name} on this machine")
    return path


def needs(*names: str, what: str = "") -> pytest.MarkDecorator:
    """The mark of a test that runs these programs.

    Args:
        what: the language that they are needed for, as EOMGEN_REQUIRE has it.
    """
    missing = [name for name in names if found(name) is None]
    required = REQUIRED is None or not REQUIRED.isdisjoint({*names, what})
    return pytest.mark.skipif(bool(missing) and not required, reason=f"not on this machine: {', '.join(missing)}")


def language(name: str) -> pytest.MarkDecorator:
    """The mark of a test that runs a language."""
    of = COMPILERS.get(name)
    missing = [f"a compiler of {of.language}"] if of is not None and build.compiler(of) is None else []
    return needs(*missing, *NEEDS.get(name, ()), what=name)


def marked(names: Iterable[str]) -> pytest.MarkDecorator:
    """The test runs for each of these languages."""
    return pytest.mark.parametrize("target", [pytest.param(name, marks=language(name)) for name in names])


RUN_HERE = [target.name for target in ALL if target.run is not None]
each_target = marked(name for name in RUN_HERE if name not in SLOW)
every_target = marked(name for name in RUN_HERE if name != "fmu")  # which runs as C does
