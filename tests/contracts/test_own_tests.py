"""Every language's own test, in its own idiom and by its strictest compiler, over trees, loops, contacts and pieces."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
import sys
from functools import cache
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from hand_made import PUSHED, symbols
from slow_run import ALL as ALL_MODELS
from slow_run import beside, sampled
from tools import marked, tool

import eomgen
from eomgen import files
from eomgen.codegen import build
from eomgen.codegen.program import RESERVED, Program
from eomgen.codegen.rhs import target_named
from eomgen.codegen.statements import Language
from eomgen.codegen.targets import ALL, cpp, fortran, wasm
from eomgen.codegen.targets.base import Description
from eomgen.codegen.written_files import texts_of, vectors

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
# a tree; a loop with inverse dynamics; friction at rest and sliding; constraints that depend on one another
SAMPLE = {"cart_pole": (), "four_bar": ("alpha",), "rough_incline": None, "four_cranks": None, "bricard": None}
SLOPES = ("cart_pole", "bricard" if ALL_MODELS else "four_bar")
REGRESSORS = ("cart_pole", "four_bar")
# names that nobody reserves, letters that no language takes, and what only looks alike
STANDING = """
lambda' θ Θ ω_1 theta_dot' global nonlocal quote import using macro sum product len print range max kind present std
core Vec String u8 bool real Real i j e E I inf nan jnp jax ca np casadi test check vectors main found right largest
tolerance a b k m n d f g h self Self None fn type end class function lambda block exports bytes read
"""
WARNINGS = ["-Wall", "-Wextra", "-pedantic", "-Wconversion", "-Wshadow", "-Werror"]


def ran(folder: Path, *commands: list[str]) -> str:
    """What the commands say, "" where all of them end well."""
    for command in commands:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return f"{' '.join(command)}\n{done.stdout}\n{done.stderr}"
    return ""


def by_cpp(folder: Path) -> str:
    compiler = [*cpp.COMPILER.command(), "-std=c++17", "-O2", *WARNINGS]  # what is not set is seen when optimized
    found = sorted(folder.rglob("*_test.cpp"))
    return "".join(ran(x.parent, [*compiler, x.name, "-o", "run_test"], ["./run_test"]) for x in found)


def by_c(folder: Path) -> str:
    promoted = [] if "clang" in build.C.command()[0] or "zig" in " ".join(build.C.command()) else ["-Wdouble-promotion"]
    compiler = [*build.C.command(), "-std=c99", *WARNINGS, *promoted, "-DEOMGEN_SELFTEST"]  # clang's NAN is a float
    found = sorted(folder.rglob("*.c"))
    return "".join(ran(x.parent, [*compiler, x.name, "-o", "run_test", "-lm"], ["./run_test"]) for x in found)


def by_rust(folder: Path) -> str:
    os.environ.setdefault("CARGO_TARGET_DIR", str(folder / "target"))
    lint = [tool("cargo"), "clippy", "-q", "--all-targets", "--", "-D", "warnings"]
    found = sorted(folder.rglob("Cargo.toml"))
    return "".join(ran(x.parent, [tool("cargo"), "test", "-q", "--offline"], lint) for x in found)


def by_fortran(folder: Path) -> str:
    compiler, found = (
        [*fortran.COMPILER.command(), "-std=f2008", "-Wall", "-Wextra", "-Wno-compare-reals", "-Werror"],
        sorted(folder.rglob("*_test.f90")),
    )
    return "".join(
        ran(x.parent, [*compiler, x.name.replace("_test", ""), x.name, "-o", "run_test"], ["./run_test"]) for x in found
    )


def by_javascript(folder: Path) -> str:
    return ran(folder, [tool("node"), "--test"])


def by_wasm(folder: Path) -> str:
    """Made anew of its C, as its README says, and tested."""
    compiler = [*wasm.COMPILER.command(), *wasm.FLAGS, "-O2", *WARNINGS]
    found = sorted(folder.rglob("*.c"))
    made = "".join(ran(x.parent, [*compiler, x.name, "-o", f"{x.stem}.wasm"]) for x in found)
    return made or by_javascript(folder)


def by_octave(folder: Path) -> str:
    words = [f"cd('{test.parent}'); {test.stem}" for test in sorted(folder.rglob("*_test.m"))]
    return ran(folder, [tool("octave-cli"), "-q", "--norc", "--eval", "; ".join(words)])


def by_julia(folder: Path) -> str:
    """Nothing here runs Julia: its grammar reads it, and rules of ours carry it out."""
    from julia_by_tree import by_julia_s_grammar

    return by_julia_s_grammar(folder)


def by_pytest(folder: Path) -> str:
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", ".", "-c", os.devnull]
    return ran(folder, [*command, *map(str, sorted(folder.rglob("test_*.py")))])


OWN_TESTS = {
    **{"c": by_c, "cpp": by_cpp, "rust": by_rust, "fortran": by_fortran, "javascript": by_javascript},
    **{"wasm": by_wasm, "julia": by_julia},
    **{"matlab": by_octave, **dict.fromkeys(("numpy", "jax", "casadi", "numba", "fmu"), by_pytest)},
}
LEFT_OUT = {
    "jax": ("bricard", "four_cranks", *(() if ALL_MODELS else ("words",))),
    "numba": ("bricard", "four_cranks", "four_bar", "cart_pole", "words"),
    "fmu": ("words",),  # more results than states: no system, and an FMU is one
}  # models that these do without
each_own_test = marked(OWN_TESTS)


@cache
def emitted(name: str):
    """What is written of a model, with its test vectors."""
    if name in ("roots", "words"):
        return roots() if name == "roots" else words()
    model = eomgen.loads(PUSHED) if name == "pushed" else eomgen.load(MODELS / f"{name}.toml")
    reported = {"actuated": SAMPLE.get(name), "jacobian": name in SLOPES, "regressor": name in REGRESSORS}
    return eomgen.generate(model, ("c",), name=name, **reported).emitted


def roots():
    """min(sqrt(y), x) beside x + y: the first has no value where y < 0."""
    s = symbols("x y")
    (x, y), g = s.q, s.graph
    program = Program.of([g.call("min", g.sqrt(y), x), x + y, g.call("max", x, g.sqrt(y)), 3], s)
    return ((program, Description("Roots", "by hand", {}, vectors(program))),)


def words():
    """Every word of every language, and what stands in their texts, as a name; every function beside them."""
    modules = [import_module(f"eomgen.codegen.targets.{target.name}") for target in ALL]
    tables = [x for module in modules for x in vars(module).values() if isinstance(x, Language)]
    taken = {word for table in tables for word in table.reserved} | RESERVED | {*STANDING.split()}
    names = sorted(taken - {"t"})  # the time, in every model
    s = symbols(" ".join(names[:10]), " ".join(names[20:]), " ".join(names[10:20]))
    g, known = s.graph, [*s.q, *s.parameters.values(), *s.inputs.values()]
    outputs = [a + k * b for k, (a, b) in enumerate(zip(known, reversed(known), strict=True), start=2)]
    x, y, *_ = s.q
    outputs += [g.call(op, x * y) for op in "sin atan sinh tanh exp abs sign sqrt asin".split()]
    outputs += [g.call(op, x, y) for op in "atan2 min max less less_equal".split()] + [(2 + x * x) ** y]
    program = Program.of(outputs, s, inputs={name: k * s.t for k, name in enumerate(s.inputs)})
    return ((program, Description("Words", "by hand", {}, vectors(program))),)


def written(folder: Path, target: str, name: str, most: int | None = None) -> Path:
    files.write_all(folder / name, texts_of(name, emitted(name)[:most], targets=[target]))
    return folder / name


@each_own_test
def test_the_language_s_own_test_agrees_with_the_symbols(target, tmp_path):
    """Compiled without a warning, every vector of every function: samples of inputs and nan among them.

    Slow: compilers of others at their strictest, rustc and clippy, LLVM of numba, a wasm of zig's.
    """
    vectors_reported = [
        v for name in ("roots", "rough_incline") for _, reported in emitted(name) for v in reported.vectors
    ]
    assert any(math.isnan(value) for v in vectors_reported for value in v.result)
    assert any(not any(v.x[len(v.x) // 2 :]) for v in vectors_reported)  # at rest
    names = [name for name in (*SAMPLE, "pushed", "roots", "words") if name not in LEFT_OUT.get(target, ())]
    if "four_cranks" in names and not ALL_MODELS:  # of two with rows that depend on one another the smaller
        names.remove("bricard")
    if not ALL_MODELS:  # a tree is a part of what the others are
        names = [name for name in names if name not in ("cart_pole", "pushed")] or names
    for name in names:
        written(tmp_path, target, name)
    assert OWN_TESTS[target](tmp_path) == ""


@marked(("fortran", "matlab", "c"))
def test_a_model_whose_name_is_longer_than_a_language_takes_has_code(target, tmp_path):
    """63 letters with what stands after the name: files and functions are called by the first 48 of it."""
    made = eomgen.generate(MODELS / "simple_pendulum.toml", (target,), name="p" * 60, jacobian=True)
    files.write_all(tmp_path, made.texts)
    assert OWN_TESTS[target](tmp_path) == "" and made.certify().ok


STICKS = """
eomgen = 1
space = "plane"
parameters = { m = 1, g = 9.81 }
coordinates = { x = { speed = 0.3 } }
bodies.block = { shape = { kind = "particle", mass = "m" }, joint = { kind = "placed", at = ["x", 0] } }
constraints.floor = { kind = "support", point = "block.center", normal = [0, 1], friction = 0.3 }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
"""


@marked(("fmu",))
def test_the_own_test_of_what_comes_to_stick_simulates_as_far_as_it_slides(target, tmp_path):
    """A block that stands after 0.10 s: a solver without events cannot go on, and the test is of what comes before."""
    files.write_all(tmp_path, eomgen.generate(eomgen.loads(STICKS), (target,), name="sticks").texts)
    assert OWN_TESTS[target](tmp_path) == ""
    assert "(0.2, 0.1, 0.05, 0.02)" in next(tmp_path.glob("test_*.py")).read_text()
    files.write_all(tmp_path / "two", eomgen.generate(MODELS / "cart_pole.toml", (target,), name="cart").texts)
    assert "(0.2,)" in next((tmp_path / "two").glob("test_*.py")).read_text()


STANDS = """
eomgen = 1
space = "plane"
parameters = { q = 100, L = 2 }
bodies.beam.points = { A = [0, 0], B = ["2*L", 0] }
forces.q = { kind = "force", point = "beam.B", force = [0, "-q"] }
constraints.A = { kind = "clamp", point = "beam.A" }
outputs.M = "reaction_couple(A)"
"""


@marked(("c", "cpp", "fortran", "numpy"))
def test_what_does_not_move_has_code_whose_own_test_compiles(target, tmp_path):
    """No state, no rate: strictest compilers take loops over nothing."""
    files.write_all(tmp_path, eomgen.generate(eomgen.loads(STANDS), (target,), name="stands").texts)
    assert OWN_TESTS[target](tmp_path) == ""


@sampled(3)
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


@sampled(3)
@marked(target.name for target in ALL if target.single is not None)
def test_single_precision_passes_its_own_test_by_measured_tolerances(target, tmp_path):
    """Friction, samples of inputs: within a few 1e-6, and not by doubles: some number is 1e-9 away."""
    for model in (MODELS / "rough_incline.toml", *beside(eomgen.loads(PUSHED))):
        name = model.stem if isinstance(model, Path) else "pushed"
        made = eomgen.generate(model, (target,), name=name, float32=True)
        files.write_all(tmp_path / name, made.texts)
        run, (program, reported) = target_named(target).single.run, made.motion
        called, far = run(made.texts, program, name, reported.role), 0.0
        for v in reported.vectors:
            found = np.array(called(v.t, v.x, v.a, v.p, v.inputs))
            far = max(far, np.nanmax(np.abs(found - v.result)) / max(1.0, np.nanmax(np.abs(v.result))))
        assert (1e-9 < far or name == "pushed") and far < 1e-5
    assert OWN_TESTS[target](tmp_path) == ""


@marked(["c", "fortran", "rust", "javascript"])
def test_thousands_of_names_and_results_pass_the_language_s_own_test(target, tmp_path):
    """1200 results of 1200 parameters: more than a statement of Fortran holds, or a constant of Rust."""
    s = symbols("x", " ".join(f"k{i}" for i in range(1200)))
    program = Program.of([k * s.q[0] for k in s.parameters.values()], s)
    reported = Description("Many", "by hand", {}, vectors(program, count=1))
    files.write_all(tmp_path, texts_of("many", [(program, reported)], targets=[target]))
    assert OWN_TESTS[target](tmp_path) == ""


@marked(["fmu"])
def test_an_fmu_with_other_rates_than_its_vectors_is_noticed(target, tmp_path):
    """One digit of one rate in the vectors turned: its test fails."""
    path = written(tmp_path, target, "cart_pole") / "test_vectors.json"
    reported = json.loads(path.read_text())
    reported["vectors"][0]["dx"][2] += 1e-9
    path.write_text(json.dumps(reported))
    assert "test_the_rates_and_outputs_are_those" in OWN_TESTS[target](path.parent)


def is_source(path: Path) -> bool:
    """Whether it is the text of the right-hand side."""
    if not path.is_file() or "test" in path.name or path.suffix in (".h", ".toml", ".lock", ".md", ".json"):
        return False
    return path.stem in ("four_bar_rhs", "rhs", *(f"four_bar_{x}" for x in ("jax", "casadi", "numba")))


def test_every_language_has_its_own_test():
    """Nobody is left out; what its language does not run says so in its head."""
    assert {target.name for target in ALL} == OWN_TESTS.keys()
    texts = texts_of("cart_pole", emitted("cart_pole"), targets=["julia"])
    assert all("Not run where it was made" in texts[name] for name in ("cart_pole_rhs.jl", "README.md"))


def test_a_function_without_right_answers_says_why_in_its_file_and_beside_its_vectors():
    """Slopes where redundant constraints open have no single value: no test vector can hold them, and that is said."""
    found = eomgen.generate(MODELS / "four_cranks.toml", ("c",), name="cranks", jacobian=True)
    texts = found.texts
    given = json.loads(texts["test_vectors.json"])
    answers = {"rhs": given, **{name: given[name] for name in ("matrices", "jacobian")}}
    for name, own in answers.items():
        assert bool(own["vectors"]) != bool(own.get("untested"))
        assert bool(own["vectors"]) == ("EOMGEN_SELFTEST" in texts[f"cranks_{name}.c"])
        assert bool(own["vectors"]) != ("No test vectors: " in texts[f"cranks_{name}.h"])
    assert not answers["jacobian"]["vectors"]
    assert any(note.startswith("test vectors of the jacobian: at no state") for note in found.notes)
    assert "Not here: test vectors of the jacobian" in texts["README.md"]
