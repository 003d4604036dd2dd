"""The seam of languages: a table of words runs every program, whole or cut, and passes the same vectors."""

from __future__ import annotations

import json
import math
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hand_made import PUSHED, cart_pole, pendulum, spring_row, symbols, tied_pendulum
from slow_run import ALL, sampled
from tools import marked, needs, tool

import eomgen
from eomgen.codegen.lowering import statements
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import RightHandSide, target_named
from eomgen.codegen.targets.base import Role
from eomgen.codegen.targets.c import C
from eomgen.codegen.targets.javascript import JAVASCRIPT
from eomgen.codegen.targets.numpy import PYTHON
from eomgen.codegen.written_files import vectors

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parents[2] / "models"
CUT = replace(JAVASCRIPT, longest=30)  # into parts, also what is short


def javascript(program: Program) -> str:
    """A module that reads states from its input and writes the outputs, one line of JSON a state."""
    made = statements(program, CUT, "dx")
    lines = [JAVASCRIPT.defined[op] for op in sorted(made.ops & JAVASCRIPT.defined.keys())]
    lines += map(JAVASCRIPT.holds, made.tables)
    for function in (*made.kernels, *made.bodies):
        lines += JAVASCRIPT.defines(function)
    given = "v.t, v.x, v.p, constants(v.p), v.inputs"
    lines.append(f"for (const v of {{states}}) console.log(JSON.stringify(Array.from(evaluate({given}))));")
    return "\n".join(lines)


def every_operation() -> Program:
    """Every function and choice that the graph has, at arguments of all signs: some of them have no value there."""
    s = symbols("x y")
    g, (x, y) = s.graph, s.q
    ops = "sqrt sin cos asin acos atan sinh cosh tanh exp log abs sign".split()
    made = [g.call(op, x * y) for op in ops] + [g.call(op, x, y) for op in "atan2 min max less less_equal".split()]
    made += [(2 + x * x) ** y, g.select(g.call("less", x, y), x, 1 / y), g.call("min", g.sqrt(x), y)]
    return Program.of(made, s)


PROGRAMS = {
    "every operation": every_operation,
    "pendulum": lambda: Program.right_hand_side(pendulum()),
    "inputs": lambda: Program.right_hand_side(cart_pole(F=0)),
    "a loop": lambda: Program.right_hand_side(spring_row(20)),
    "a constraint": lambda: Program.right_hand_side(tied_pendulum()),
    "a constraint said three times": lambda: Program.right_hand_side(tied_pendulum(3)),
    "closed loops": lambda: eomgen.derive(eomgen.load(MODELS / "four_bar.toml")).program,
    "samples": lambda: eomgen.derive(eomgen.loads(PUSHED)).program,
}


@needs("node")
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_language_is_a_table_of_words(name, tmp_path):
    """|emitted(x) - vector| <= tolerance cut into many parts; nan where there is no value."""
    program = PROGRAMS[name]()
    found = vectors(program)
    states = [{"t": v.t, "x": v.x, "p": v.p, "inputs": v.inputs} for v in found]
    path = tmp_path / "program.mjs"
    path.write_text(javascript(program).replace("{states}", json.dumps(states)))
    ran = subprocess.run([tool("node"), str(path)], capture_output=True, text=True, check=True)
    for v, line in zip(found, ran.stdout.splitlines(), strict=True):
        row = [math.nan if value is None else value for value in json.loads(line)]
        largest = max([1.0, *(abs(value) for value in v.result if value == value)])
        assert row == pytest.approx(v.result, rel=0, abs=v.tolerance * largest, nan_ok=True)


@pytest.mark.parametrize("language", [C, PYTHON, JAVASCRIPT], ids=["c", "numpy", "javascript"])
@pytest.mark.parametrize("longest", [None, 30])
def test_a_program_calls_what_comes_before_it_and_names_what_it_reads(language, longest):
    """Functions stand before those that call them, and every table is read, in parts or whole."""
    program = Program.right_hand_side(tied_pendulum(3))
    made = statements(program, replace(language, longest=longest), "dx")
    texts = ["\n".join(language.defines(f)) for f in (*made.kernels, *made.bodies)]
    names = [f.name for f in (*made.kernels, *made.bodies)]
    for k, text in enumerate(texts):
        assert not [later for later in names[k + 1 :] if f"{later}(" in text]
    assert all(any(table.name in text for text in texts) for table in made.tables)


@sampled(3)
@marked(("cpp", "rust", "fortran", "matlab", "numba", "c"))
@pytest.mark.parametrize("name", ["inputs", "a constraint", "closed loops"])
def test_every_language_runs_a_program_that_is_cut_into_parts(target, name, monkeypatch):
    """Functions of at most 12 operations, that leave what others read in an array: the same vectors."""
    if target == "numba" and name != "closed loops" and not ALL:
        pytest.skip("it compiles for ten seconds: of the slow run")
    monkeypatch.setattr("eomgen.codegen.lowering.LENGTH", 12)

    def cut(program, language, *more):
        return statements(program, replace(language, longest=1), *more)

    monkeypatch.setattr("eomgen.codegen.targets.base.statements", cut)
    program = PROGRAMS[name]()
    assert name != "closed loops" or "part1(" in target_named(target).text(program, "eomgen", Role.RHS)
    function = RightHandSide.of(program, target)
    for v in vectors(program):
        largest, found = max([1.0, *(abs(y) for y in v.result if y == y)]), function(v.t, v.x, v.p, v.inputs or ())
        assert found == pytest.approx(v.result, rel=0, abs=v.tolerance * largest, nan_ok=True)


OWN_SOLVE = """
def solve(M, J, f, g):
    n, k = len(f), len(g)
    M, J = np.triu(np.reshape(M, (n, n))), np.reshape(J, (k, n))
    whole = np.block([[M + np.triu(M, 1).T, -J.T], [J, np.zeros((k, k))]])
    found = np.linalg.lstsq(whole, [*f, *g], rcond=None)[0]
    f[:], g[:] = found[:n], found[n:]
"""


def test_a_language_may_solve_in_its_own_way():
    """Where loops with pivots are not a language's way its own solve is called, and no kernel is written."""
    program = Program.right_hand_side(tied_pendulum(3))
    language = replace(PYTHON, defined={"solve": OWN_SOLVE})
    made = statements(program, language, "dx")
    assert made.kernels == made.tables == () and "solve" in made.ops
    space = {"np": np}
    exec("\n".join([OWN_SOLVE, *(line for f in made.bodies for line in language.defines(f))]), space)
    for v in vectors(program):
        found = space["evaluate"](v.t, v.x, v.p, space["constants"](v.p), None)
        assert found == pytest.approx(v.result, rel=1e-11, abs=1e-11)
