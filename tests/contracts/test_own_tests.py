"""Every language's own test, in its own idiom and by its strictest compiler, over trees, loops, contacts and pieces."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest
from hand_made import PUSHED, symbols
from tools import marked, tool

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
    compiler = [*cpp.COMPILER.command(), "-std=c++17", *WARNINGS]
    found = sorted(folder.rglob("*_test.cpp"))
    return "".join(ran(x.parent, [*compiler, x.name, "-o", "run_test"], ["./run_test"]) for x in found)


def by_c(folder: Path) -> str:
    compiler = [*build.C.command(), "-std=c99", *WARNINGS, "-DEOMGEN_SELFTEST"]
    found = sorted(folder.rglob("*.c"))
    return "".join(ran(x.parent, [*compiler, x.name, "-o", "run_test", "-lm"], ["./run_test"]) for x in found)


def by_rust(folder: Path) -> str:
    os.environ.setdefault("CARGO_TARGET_DIR", str(folder / "target"))
    lint = [tool("cargo"), "clippy", "-q", "--all-targets", "--", "-D", "warnings"]
    found = sorted(folder.rglob("Cargo.toml"))
    return "".join(ran(x.parent, [tool("cargo"), "test", "-q", "--offline"], lint) for x in found)


def by_fortran(folder: Path) -> str:
    compiler, found = (
        [*fortran.COMPILER.command(), "-std=f2008", "-Wall", "-Werror"],
        sorted(folder.rglob("*_test.f90")),
    )
    return "".join(
        ran(x.parent, [*compiler, x.name.replace("_test", ""), x.name, "-o", "run_test"], ["./run_test"]) for x in found
    )


def by_javascript(folder: Path) -> str:
    return ran(folder, [tool("node"), "--test"])


def by_octave(folder: Path) -> str:
    words = [f"cd('{test.parent}'); {test.stem}" for test in sorted(folder.rglob("*_test.m"))]
    return ran(folder, [tool("octave-cli"), "-q", "--norc", "--eval", "; ".join(words)])


def by_pytest(folder: Path) -> str:
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", ".", "-c", os.devnull]
    return ran(folder, [*command, *map(str, sorted(folder.rglob("test_*.py")))])


OWN_TESTS = {
    **{"c": by_c, "cpp": by_cpp, "rust": by_rust, "fortran": by_fortran, "javascript": by_javascript},
    **{"matlab": by_octave, **dict.fromkeys(("numpy", "jax", "casadi", "numba", "fmu"), by_pytest)},
}
LONG_TO_COMPILE = {"jax": ("bricard",), "numba": ("bricard", "four_bar", "cart_pole")}  # models that these do without
each_own_test = marked(OWN_TESTS)


@cache
def emitted(name: str):
    """What is written of a model, with its test vectors."""
    if name == "roots":
        return roots()
    model = eomgen.loads(PUSHED) if name == "pushed" else eomgen.load(MODELS / f"{name}.toml")
    actuated = SAMPLE.get(name)
    return eomgen.generate(model, ("c",), name=name, actuated=actuated, jacobian=name == "cart_pole").emitted


def roots():
    """min(sqrt(y), x) beside x + y: the first has no value where y < 0."""
    s = symbols("x y")
    (x, y), g = s.q, s.graph
    program = program_of([g.call("min", g.sqrt(y), x), x + y, g.call("max", x, g.sqrt(y)), 3], s)
    return ((program, Description("Roots", "by hand", {}, vectors(program))),)


def written(folder: Path, target: str, name: str, most: int | None = None) -> Path:
    files.write_all(folder / name, texts_of(name, emitted(name)[:most], targets=[target]))
    return folder / name


@each_own_test
def test_the_language_s_own_test_agrees_with_the_symbols(target, tmp_path):
    """Compiled without a warning, every vector of every function: samples of inputs and nan among them."""
    vectors_told = [v for name in ("roots", "rough_incline") for _, told in emitted(name) for v in told.vectors]
    assert any(math.isnan(value) for v in vectors_told for value in v.result)
    assert any(not any(v.x[len(v.x) // 2 :]) for v in vectors_told)  # at rest
    names = [name for name in (*SAMPLE, "pushed", "roots") if name not in LONG_TO_COMPILE.get(target, ())]
    for name in names:
        written(tmp_path, target, name)
    assert OWN_TESTS[target](tmp_path) == ""


@marked(name for name in OWN_TESTS if name != "fmu")
def test_the_language_s_own_test_notices_a_wrong_sign(target, tmp_path):
    """The sign of one sum in the right-hand side turned: the test fails, and not because it cannot be read."""
    folder = written(tmp_path, target, "four_bar", most=1)
    source = next(path for path in sorted(folder.rglob("*")) if is_source(path))
    text = source.read_text()
    at = text.index("v20")
    turned, count = re.subn(r"(v\d+.* = .*[\w)\]]) \+ (?=[\w(])", r"\1 - ", text[at:], count=1)
    assert count == 1
    source.write_text(text[:at] + turned)
    said = OWN_TESTS[target](folder)
    assert said and " not " in said, said


@marked(["fmu"])
def test_an_fmu_with_other_rates_than_its_vectors_is_noticed(target, tmp_path):
    """One digit of one rate in the vectors turned: its test fails."""
    path = written(tmp_path, target, "cart_pole") / "test_vectors.json"
    told = json.loads(path.read_text())
    told["vectors"][0]["dx"][2] += 1e-9
    path.write_text(json.dumps(told))
    assert "test_the_rates_and_outputs_are_those" in OWN_TESTS[target](path.parent)


def is_source(path: Path) -> bool:
    """Whether it is the text of the right-hand side."""
    if not path.is_file() or "test" in path.name or path.suffix in (".h", ".toml", ".lock", ".md", ".json"):
        return False
    return path.stem in ("four_bar_rhs", "rhs", *(f"four_bar_{x}" for x in ("jax", "casadi", "numba")))


def test_every_language_has_its_own_test():
    """Nobody is left out: what has none says in its head that it is not run here."""
    silent = {target.name for target in ALL} - OWN_TESTS.keys()
    assert silent == {"julia"}
    texts = texts_of("cart_pole", emitted("cart_pole"), targets=["julia"])
    assert all("Not run where it was made" in texts[name] for name in ("cart_pole_rhs.jl", "README.md"))
