"""Program -> Python compiled by numba when it is first called: `NAME_rhs(t, x, p, inputs=None)`, an array."""

from __future__ import annotations

from dataclasses import replace

from eomgen.codegen.statements import CHANGED, INDICES, PLACES, READ, ROOM
from eomgen.codegen.targets.base import CASES, by_cases
from eomgen.codegen.targets.numpy import PYTHON
from eomgen.codegen.targets.python_files import python_form, python_target

MATH = "sqrt sin cos asin acos atan sinh cosh tanh exp log atan2 pow".split()
NUMBA = replace(
    PYTHON,
    functions={
        **{op: f"math.{op}({{0}})" for op in MATH},
        **{op: f"math.{op}({{0}}, {{1}})" for op in ("atan2", "pow")},
        "abs": "math.fabs({0})",
        **{
            op: f"own_{op}({', '.join(f'{{{k}}}' for k in range(len(case[0].split(','))))})"
            for op, case in CASES.items()
        },
    },
    defined=by_cases(
        "@_compiled\ndef own_{name}({arguments}):\n    return {value}\n\n",
        "{value} if {condition} else {otherwise}",
        number="{value}.0",
        words={"nan": "math.nan", "||": "or"},
    ),
    arrays=dict.fromkeys((CHANGED, ROOM), "{name} = np.zeros({size})")
    | {PLACES: "{name} = np.zeros({size}, dtype=np.int64)"},
    tables={**PYTHON.tables, INDICES: "{name} = np.array({values})", READ: "{name} = np.array({values})"},
    function=("\n\n@_compiled\ndef {declared}({arguments}):", ""),
    out=("\n\n@_compiled\ndef {name}({arguments}):\n    {out} = np.zeros({size})", "    return {out}"),
)

_TEXT = '''\
import math

import numpy as np
from numba import njit

_compiled = njit(error_model="numpy")  # 1/0 is inf, as in C
{functions}


@_compiled
def _one(t, x, {a}p, inputs):
    return evaluate(t, x, {a}p, constants(p), inputs)


def {main}(t, x, {a}p, inputs=None):
    """{result}: an array of {outputs}; inputs None: the model's own."""
    x, {a}p = np.asarray(x, dtype=np.float64), {a_array}np.asarray(p, dtype=np.float64)
    return _one(float(t), x, {a}p, None if inputs is None else np.asarray(inputs, dtype=np.float64))
'''


FORM = python_form(
    NUMBA,
    "{others}_numba",
    _TEXT,
    {"a_array": ("np.asarray(a, dtype=np.float64), ", "")},
    body=lambda made: {"functions": "\n".join(made.texts(NUMBA))},
)
USE = ("from {stem}_numba import {stem}_rhs", "python -m pytest")
TARGET = python_target("numba", "Python compiled by numba", FORM, USE)
