"""Common parts of targets that are Python modules: their head, their test, and their run in this process."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from eomgen.codegen.program import Program
from eomgen.codegen.statements import Language
from eomgen.codegen.targets.base import (
    Called,
    FileContent,
    FileForm,
    Functions,
    Role,
    Single,
    SingleWords,
    Target,
    functions_by,
)
from eomgen.errors import ToolMissing
from eomgen.symbolic.numeric import tolerances

_TEST = '''\
"""Held against the answers in test_vectors.json: python -m pytest"""

import json
import pathlib

import numpy as np
from {module} import {main}


def test_{main}_gives_the_values_of_its_test_vectors():
    expected = json.loads((pathlib.Path(__file__).parent / "test_vectors.json").read_text(encoding="utf-8"))
    for v in expected{of_role}["vectors"]:
        found = np.asarray({main}(v["t"], v["x"], {a_of_v}v["p"], v["inputs"]), dtype=float).ravel()
        right = np.array(v["{result}"], dtype=float)  # null: not a number
        assert found.shape == right.shape
        known = right == right
        assert np.isnan(found[~known]).all()
        largest = max([1.0, *abs(right[known])])
        assert (abs(found[known] - right[known]) <= v["tolerance"]*largest).all(), (found, right)
'''


def python_form(
    language: Language, named: str, module: str, given: Mapping[str, tuple[str, str]], **words: Any
) -> FileForm:
    """The form of a language that is Python: NAMED.py, a module, and its test."""
    return FileForm(
        language,
        module,
        f"{named}.py",
        f"test_{named}.py",
        '"""{head}\n"""\n\n{text}',
        reported=lambda line: line.replace("\\", "/").replace('"""', "'''"),
        given={**given, "a_of_v": ('v["a"], ', "")},
        test=_TEST.replace("{module}", named),
        **words,
    )


def python_target(
    name: str, language: str, form: FileForm, use: tuple[str, ...], single: SingleWords | None = None
) -> Target:
    """A language that is a Python package: STEM_NAME.py of the right-hand side, STEM_ROLE_NAME.py, and their tests.

    Args:
        name: of the package, too.
        language: in words.
        use: its import, and the command that runs its tests.
        single: its words in single precision, where there are such.
    """

    def functions(program: Program) -> Functions:
        return functions_each(executed(form.text(program, "eomgen"), f"eomgen_{name}", name)["eomgen_rhs"], program)

    def run(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role) -> Called:
        return called_each(str(texts[form.path_of(program, stem, role)]), program, role.main(stem), name)

    in_single = Single(single.files, run) if single else None
    return Target(name, language, form.text, form.files, use, functions, run, single=in_single)


def executed(text: str, name: str, package: str = "") -> dict[str, Any]:
    """Names that a module defines; its text is our own, from the graph.

    Raises:
        ToolMissing: the package that it needs is not there.
    """
    space: dict[str, Any] = {"__name__": name}
    try:
        exec(compile(text, name, "exec"), space)
    except ImportError as error:
        raise ToolMissing(
            f"{package or name} cannot be imported: {error}", fix="pip install 'eomgen[languages]', or another target"
        ) from None
    return space


def functions_each(function: Callable[..., Any], program: Program) -> Functions:
    """A function of one state, (t, x, [a,] p, inputs or None), as those of a program."""
    n = len(program.states)

    def many(t: np.ndarray, x: np.ndarray, p: np.ndarray, inputs: np.ndarray | None) -> np.ndarray:
        found = np.empty((len(t), len(program.outputs)))
        for i, (instant, state) in enumerate(zip(t, x, strict=True)):
            given = (state[:n], state[n:]) if program.accelerations else (state,)
            found[i] = np.asarray(function(instant, *given, p, None if inputs is None else inputs[i])).ravel()
        return found

    return functions_by(many)


def called_each(text: str, program: Program, main: str, package: str) -> Called:
    """The same of the file that others get, at one state."""
    function = executed(text, main, package)[main]

    def called(t: float, x: Any, a: Any, p: Any, inputs: Any) -> Any:
        given = (np.array(x, dtype=float), np.array(a, dtype=float))[: 1 + bool(program.accelerations)]
        acting = None if inputs is None else np.array(inputs, dtype=float)
        return np.asarray(function(t, *given, np.array(p, dtype=float), acting), dtype=float).ravel().tolist()

    return called


# -------- branch free -----------------------------------------------------------------------------------------
# The Solve of a program where loops with pivots cannot run: matrices, for languages that trace their functions.
#
# A = M + J^T J with rows and columns of one size, S = J A^-1 J^T + ease, then what is left is solved for once more,
# and again: where rows follow from others their multipliers share the force, and a is right all the same. Each round
# takes (s/(s + ease))^POWER of what is left along an eigenvector of J A^-1 J^T, s its eigenvalue: nearly nothing of
# rows that follow from others but for rounding or an open gap, nearly all of a row that is barely one of its own.


ROUNDS = 6  # after each (POWER*ease/s) of lam is left
POWER = 3

FACTORS = f'''
def solve_factors(M, J, L, weight, mobility, Y, S, order):
    """What any f, g are solved by, into the list L (upper triangle of M)."""
    k, n = len(weight), len(mobility)
    rows = [[M[min(i, j)*n + max(i, j)] for j in range(n)] for i in range(n)]
    mean = sum((rows[i][i] for i in range(n)), 0.0)/n
    d = [1/sqrt(_where_positive(rows[i][i], rows[i][i], mean)) for i in range(n)]
    J = [[J[m*n + i]*d[i] for i in range(n)] for m in range(k)]
    sizes = [1/sqrt(sum((x*x for x in row), {tolerances.TINIEST!r})) for row in J]
    J = _matrix([[x*size for x in row] for row, size in zip(J, sizes)], k, n)
    M = _matrix([[rows[i][j]*d[i]*d[j] for j in range(n)] for i in range(n)], n, n)
    A = _factors(M + J.T @ J)
    L[:] = M, J, A, _factors(J @ _solved(A, J.T) + {tolerances.DEPENDENT_EASE!r}*_one(k)), d, sizes


'''
BY = f'''
def solve_by(M, J, L, weight, mobility, Y, S, order, f, g):
    """f, g become a, lam of M a - J^T lam = f, J a = g; of dependent rows lam is the least."""
    n, k, (M, J, A, S, d, sizes) = len(f), len(g), L
    right, gap = _matrix([[x*y] for x, y in zip(f, d)], n, 1), _matrix([[x*y] for x, y in zip(g, sizes)], k, 1)
    a, lam = 0*right, 0*gap
    for _ in range({ROUNDS}):
        left, open_ = right - M @ a + J.T @ lam, gap - J @ a
        more = _solved(A, left + J.T @ open_)
        pull = open_ - J @ more
        for _ in range({POWER - 1}):
            pull = pull - {tolerances.DEPENDENT_EASE!r}*_solved(S, pull)
        pull = _solved(S, pull)
        a, lam = a + more + _solved(A, J.T @ pull), lam + pull + open_
    f[:] = [a[i, 0]*d[i] for i in range(n)]
    g[:] = [lam[m, 0]*sizes[m] for m in range(k)]


'''
WHOLE = '''
def solve(M, J, f, g):
    """f, g become a, lam."""
    kept = [], g, f, [], [], []
    solve_factors(M, J, *kept)
    solve_by(M, J, *kept, f, g)


'''
PLAIN = '''
def solve_plain(M, f):
    """f becomes a of M a = f (upper triangle of M), M its factors."""
    n = len(f)
    M[:] = [_factors(_matrix([[M[min(i, j)*n + max(i, j)] for j in range(n)] for i in range(n)], n, n))]
    solve_plain_by(M, f)


'''
PLAIN_BY = '''
def solve_plain_by(M, f):
    """The same of another f, by the factors."""
    a = _solved(M[0], _matrix([[x] for x in f], len(f), 1))
    f[:] = [a[i, 0] for i in range(len(f))]


'''
SOLVERS = {
    **{"solve": FACTORS + BY + WHOLE, "solve_factors": FACTORS, "solve_by": BY},
    **{"solve_plain": PLAIN + PLAIN_BY, "solve_plain_by": ""},
}
"""What stands for each of the kernels that solve."""
