"""Every language's own test, in its own idiom and by its strictest compiler, over trees, loops, contacts and pieces."""

from __future__ import annotations

import math
import os
import re
import subprocess
from functools import cache
from pathlib import Path

import pytest
from hand_made import PUSHED, symbols
from tools import language, tool

import eomgen
from eomgen import files
from eomgen.codegen import build
from eomgen.codegen.files import texts_of
from eomgen.codegen.program import program_of
from eomgen.codegen.targets import ALL, cpp, fortran
from eomgen.codegen.targets.base import Description
from eomgen.codegen.vectors import vectors

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
# a tree; a loop with inverse dynamics; friction at rest and sliding; ties that depend on one another
SAMPLE = {"cart_pole": (), "four_bar": ("alpha",), "rough_incline": None, "bricard": None}
WARNINGS = ["-Wall", "-Wextra", "-pedantic", "-Werror"]


def ran(folder: Path, *commands: list[str]) -> str:
    """What the commands say, "" where all of them end well."""
    for command in commands:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return f"{' '.join(command)}\n{done.stdout}\n{done.stderr}"
    return ""


def by_cpp(folder: Path) -> str:
    compiler = cpp.COMPILER.command()
    return "".join(
        ran(folder, [*compiler, "-std=c++17", *WARNINGS, test.name, "-o", "run_test"], ["./run_test"])
        for test in sorted(folder.glob("*_test.cpp"))
    )


def by_c(folder: Path) -> str:
    return "".join(
        ran(
            folder,
            [*build.C.command(), "-std=c99", *WARNINGS, "-DEOMGEN_SELFTEST", c.name, "-o", "run_test", "-lm"],
            ["./run_test"],
        )
        for c in sorted(folder.glob("*.c"))
    )


def by_rust(folder: Path) -> str:
    crate = next(folder.glob("*_rhs"))
    os.environ.setdefault("CARGO_TARGET_DIR", str(folder.parent / "cargo"))
    lint = [[tool("cargo"), "clippy", "-q", "--all-targets", "--", "-D", "warnings"]]
    return ran(crate, [tool("cargo"), "test", "-q", "--offline"], *lint)


def by_fortran(folder: Path) -> str:
    compiler = [*fortran.COMPILER.command(), "-std=f2008", "-Wall", "-Werror"]
    return "".join(
        ran(folder, [*compiler, test.name.replace("_test", ""), test.name, "-o", "run_test"], ["./run_test"])
        for test in sorted(folder.glob("*_test.f90"))
    )


def by_javascript(folder: Path) -> str:
    return ran(folder, [tool("node"), "--test"])


OWN_TESTS = {"c": by_c, "cpp": by_cpp, "rust": by_rust, "fortran": by_fortran, "javascript": by_javascript}
each_own_test = pytest.mark.parametrize("target", [pytest.param(name, marks=language(name)) for name in OWN_TESTS])


@cache
def emitted(name: str):
    """What is written of a model, with its test vectors."""
    if name == "roots":
        return roots()
    model = eomgen.loads(PUSHED) if name == "pushed" else eomgen.load(MODELS / f"{name}.toml")
    actuated = SAMPLE.get(name)
    return eomgen.generate(model, ("c",), name=name, actuated=actuated).emitted


def roots():
    """min(sqrt(y), x) beside x + y: the first has no value where y < 0."""
    s = symbols("x y")
    (x, y), g = s.q, s.graph
    program = program_of([g.call("min", g.sqrt(y), x), x + y, g.call("max", x, g.sqrt(y)), 3], s)
    return ((program, Description("Roots", "by hand", {}, vectors(program))),)


def written(folder: Path, target: str, name: str) -> Path:
    files.write_all(folder / name, texts_of(name, emitted(name), targets=[target]))
    return folder / name


@each_own_test
def test_the_language_s_own_test_agrees_with_the_symbols(target, tmp_path):
    """Compiled without a warning, every vector of every function: samples of inputs and nan among them."""
    vectors_told = [v for name in ("roots", "rough_incline") for _, told in emitted(name) for v in told.vectors]
    assert any(math.isnan(value) for v in vectors_told for value in v.result)
    assert any(not any(v.x[len(v.x) // 2 :]) for v in vectors_told)  # at rest
    said = {name: OWN_TESTS[target](written(tmp_path, target, name)) for name in (*SAMPLE, "pushed", "roots")}
    assert not any(said.values()), "\n".join(said.values())


@each_own_test
def test_the_language_s_own_test_notices_a_wrong_sign(target, tmp_path):
    """The sign of one sum in the right-hand side turned: the test fails, and not because it cannot be read."""
    folder = written(tmp_path, target, "four_bar")
    source = next(path for path in sorted(folder.rglob("*rhs*")) if path.is_file() and is_source(path))
    text = source.read_text()
    at = text.index("v20")
    turned, count = re.subn(r"(v\d+.* = .*[\w)\]]) \+ (?=[\w(])", r"\1 - ", text[at:], count=1)
    assert count == 1
    source.write_text(text[:at] + turned)
    said = OWN_TESTS[target](folder)
    assert said and " not " in said, said


def is_source(path: Path) -> bool:
    return "test" not in path.name and path.suffix not in (".h", ".toml", ".lock", ".md")


def test_every_language_has_its_own_test():
    """Nobody is left out: what has none says in its head that it is not run here."""
    silent = {target.name for target in ALL} - OWN_TESTS.keys()
    assert silent == {"numpy"}
