"""Program -> Python: straight-line scalars by `math` for one state, the same lines by numpy for many."""

from __future__ import annotations

import keyword
import textwrap
from collections.abc import Mapping
from typing import Any

from eomgen.codegen.lowering import Statements
from eomgen.codegen.program import Program
from eomgen.codegen.statements import CHANGED, INDICES, INT, PLACES, READ, ROOM, Language
from eomgen.codegen.targets.base import Called, FileContent, Functions, Role, Target, by_cases
from eomgen.codegen.targets.python_files import called_each, executed, python_form

PYTHON = Language(
    reserved=frozenset(keyword.kwlist) | frozenset(keyword.softkwlist),
    functions={},
    defined={},
    words={"not": "not ", "nan": "math.nan", "given": "inputs is not None"},
    let="{declared} = {value}",
    put="{place} = {value}",
    call="{function}({arguments})",
    back="return {value}",
    arrays=dict.fromkeys((CHANGED, ROOM), "{name} = [0.0]*({size})") | {PLACES: "{name} = [0]*({size})"},
    tables={INT: "{name} = {value}", INDICES: "{name} = {values}", READ: "{name} = {values}"},
    loop=("for {name} in range({first}, {last}):", ""),
    down=("for {name} in range({last} - 1, {first} - 1, -1):", ""),
    branch=("if {condition}:", "else:", ""),
    function=("def {declared}({arguments}):", ""),
    out=("def {name}({arguments}):\n    {out} = [0.0]*{size}", "    return {out}"),
    remark="# {text}",
)
SCALARS = {
    **{name: f"math.{name}" for name in "sqrt sin cos asin acos atan sinh cosh tanh exp log atan2 pow".split()},
    "abs": "abs",
    **by_cases(
        "lambda {arguments}: {value}",
        "{value} if {condition} else {otherwise}",
        number="{value}.0",
        words={"nan": "a + b", "||": "or"},
    ),
}
ARRAYS = {
    **{name: f"np.{name}" for name in "sqrt sin cos sinh cosh tanh exp log abs sign".split()},
    **{"asin": "np.arcsin", "acos": "np.arccos", "atan": "np.arctan", "atan2": "np.arctan2", "pow": "np.float_power"},
    "min": "np.minimum",
    "max": "np.maximum",
    **by_cases(
        "lambda {arguments}: {value}",
        "np.where({condition}, {value}, {otherwise})",
        number="{value}.0",
        words={"nan": "np.nan"},
        only=("less", "less_equal", "select"),
    ),
}

_EACH = '''

def _each(solve):
    """A solve at many states: lists of which some entries are arrays; all are given back."""
    def solve_each(*lists):
        entries = np.broadcast_arrays(*(value for values in lists for value in values))
        states = np.stack(entries, axis=-1).reshape(-1, len(entries))
        whole = [all(np.asarray(value).dtype.kind == "i" for value in values) for values in lists]
        for state, row in zip(states, states.tolist()):
            parts, start = [], 0
            for values, counts in zip(lists, whole):
                part = row[start : start + len(values)]
                parts.append([int(value) for value in part] if counts else part)
                start += len(values)
            solve(*parts)
            state[:] = [value for part in parts for value in part]
        start = 0
        for values, counts in zip(lists, whole):
            found = states.T[start : start + len(values)]
            values[:] = found.astype(int) if counts else found
            start += len(values)

    return solve_each

'''

_MODULE = '''\
import math

import numpy as np

{kernels}{each}
def _written({names_of_ops}):
    """The functions in the arithmetic of the functions given."""

{functions}

_constants, _evaluate = _written({scalars})
_constants_of_arrays, _evaluate_arrays = _written({arrays})


def {main}(t, x, {a}p, inputs=None):
    """{result} at one state: a list of {outputs}; inputs None: the model's own."""
    x, p = [float(value) for value in {all_x}], [float(value) for value in p]
    inputs = None if inputs is None else [float(value) for value in inputs]
    return evaluate(float(t), x, p, constants(p), inputs)


def {others}_many(t, x, {a}p, inputs=None):
    """{result} at n states: t n, x n x {states}, {a_size}p {parameters}, inputs None or n x {inputs} -> \
n x {outputs}."""
    x, p = np.asarray({beside}, dtype=float), [float(value) for value in p]
    return evaluate_many(np.asarray(t, dtype=float), x, p, inputs)


def constants(p):
    """What the parameters alone determine."""
    try:
        return _constants(p)
    except (ValueError, ArithmeticError):
        with np.errstate(all="ignore"):
            return [float(value) for value in _constants_of_arrays([np.float64(value) for value in p])]


def evaluate(t, x, p, c, inputs):
    """{result} at one state, all lists of floats; outside a function's domain nan, as in C."""
    try:
        return _evaluate(t, x, {states_of_x}p, c, inputs)
    except (ValueError, ArithmeticError):
        given = None if inputs is None else [inputs]
        return evaluate_many(np.array([t]), np.array([x]), p, given)[0].tolist()


def evaluate_many(t, x, p, inputs):
    """{result} at n states."""
    with np.errstate(all="ignore"):
        p = list(np.transpose(p))
        rows = None if inputs is None else np.asarray(inputs, dtype=float).T
        {result} = _evaluate_arrays(t, x.T, {rows_of_x}p, _constants_of_arrays(p), rows)
        return np.stack([np.broadcast_to(value, t.shape) for value in {result}], axis=-1) if {result} else \
np.empty((len(t), 0))
'''


def _body(made: Statements) -> dict[str, str]:
    """The functions by the arithmetic that they are given, and the two arithmetics."""
    ops = sorted(made.ops & SCALARS.keys())
    kernels = [*map(PYTHON.holds, made.tables), *("\n\n" + "\n".join(PYTHON.defines(f)) for f in made.kernels)]
    bodies = "\n\n".join("\n".join(PYTHON.defines(f)) for f in made.bodies)
    return {
        "kernels": "".join(f"{each}\n" for each in kernels),
        "each": _EACH if any(name.startswith("solve") for name in made.called) else "\n",
        "names_of_ops": ", ".join([*ops, *made.called]),
        "functions": textwrap.indent(f"{bodies}\n\nreturn constants, evaluate\n", "    "),
        "scalars": ", ".join([*(SCALARS[op] for op in ops), *made.called]),
        "arrays": ", ".join([*(ARRAYS[op] for op in ops), *map(_of_arrays, made.called)]),
    }


def _of_arrays(kernel: str) -> str:
    return f"_each({kernel})" if kernel.startswith("solve") else f"np.vectorize({kernel}, otypes=[float])"


FORM = python_form(
    PYTHON,
    "{main}",
    _MODULE,
    {
        "states_of_x": ("x[{states}:], ", ""),
        "rows_of_x": ("x.T[{states}:], ", ""),
        "all_x": ("[*x, *a]", "x"),
        "a_size": ("a n x {accelerations}, ", ""),
        "beside": ("np.hstack([x, a])", "x"),
    },
    body=_body,
)


def numpy_functions(program: Program) -> Functions:
    """The program's text, made functions."""
    space = executed(FORM.text(program, "eomgen"), "<eomgen program>")
    import numpy as np

    constants, evaluate, many = space["constants"], space["evaluate"], space["evaluate_many"]

    def constants_of(p: Any) -> tuple[list[float], Any]:
        values = np.asarray(p, dtype=float).tolist()
        return values, constants(values)

    def one(t: float, x: Any, known: tuple[list[float], Any], inputs: Any) -> Any:
        given = None if inputs is None else [float(value) for value in inputs]
        return np.array(evaluate(float(t), [float(value) for value in x], *known, given), dtype=float)

    return Functions(constants_of, one, many)


def run(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role) -> Called:
    """NAME_rhs of the file, executed."""
    return called_each(str(texts[FORM.path_of(program, stem, role)]), program, role.main(stem), "numpy")


USE = ("from {stem}_rhs import {stem}_rhs", "python -m pytest")
TARGET = Target("numpy", "Python with numpy", FORM.text, FORM.files, USE, numpy_functions, run)
