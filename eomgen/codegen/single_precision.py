"""C in doubles -> the same in single precision: types, numbers and functions; and how near it comes."""

from __future__ import annotations

import ctypes
import random
import re
from collections.abc import Sequence
from dataclasses import replace

from eomgen.codegen.build import function_of, library
from eomgen.codegen.program import Program
from eomgen.codegen.rhs import compiled
from eomgen.codegen.targets.base import TestVector
from eomgen.symbolic.expression.functions import NAMES
from eomgen.symbolic.numeric.tolerances import SINGLE, SINGLE_ROUNDING

TRIES = 16  # states around one, by which it is measured what rounding does
GROWN = 8  # times what the arguments' rounding does: that of all operations
_KEPT = re.compile(r'/\*.*?\*/|"(?:\\.|[^"\\])*"', re.DOTALL)
_FUNCTIONS = "|".join(sorted({*NAMES, "pow", "fabs", "fmin", "fmax"} - {"abs", "sign", "min", "max"}))
_CALLED = re.compile(rf"\b({_FUNCTIONS})(?=\()")
_NUMBER = re.compile(r"(?<![\w.])(\d+\.\d*(?:e[+-]?\d+)?|\d+e[+-]?\d+|\.\d+(?:e[+-]?\d+)?)(?![\w.])")


def single_text(text: str) -> str:
    """A text of C in single precision; remarks and strings stay as they are."""
    found, at = [], 0
    for kept in _KEPT.finditer(text):
        found += [_single(text[at : kept.start()]), kept.group()]
        at = kept.end()
    return "".join([*found, _single(text[at:])])


def _single(code: str) -> str:
    code = re.sub(r"\bdouble\b", "float", code).replace("DBL_EPSILON", "FLT_EPSILON")
    return _NUMBER.sub(r"\1f", _CALLED.sub(r"\1f", code))


def single_vectors(program: Program, vectors: Sequence[TestVector]) -> tuple[TestVector, ...]:
    """The vectors with the tolerances of single precision, measured at states that rounding cannot tell apart."""
    rhs, rng = compiled(program, "numpy"), random.Random(1)

    def beside(values: Sequence[float]) -> list[float]:
        return [x * (1 + rng.choice((-1, 1)) * SINGLE_ROUNDING) for x in values]

    def measured(v: TestVector) -> TestVector:
        size = max([1.0, *(abs(y) for y in v.result if y == y)])
        far = 0.0
        for _ in range(TRIES):
            found = rhs(v.t, beside([*v.x, *v.a]), beside(v.p), beside(v.inputs or ()))
            far = max([far, *(abs(a - b) for a, b in zip(found, v.result, strict=True) if a == a and b == b)])
        return replace(v, tolerance=float(SINGLE + GROWN * far / size))

    return tuple(map(measured, vectors))


def single_error(text: str, function: str, program: Program, vectors: Sequence[TestVector]) -> float:
    """The largest error of a text in single precision against its tolerance, at all vectors; run here.

    Raises:
        RunFailed, ToolMissing: as of `library`.
    """
    called, outputs = function_of(library(text, quickly=True), function), len(program.outputs)
    called.argtypes = [ctypes.c_float, *[ctypes.POINTER(ctypes.c_float)] * (5 if program.accelerations else 4)]
    called.restype = None
    worst = 0.0
    for v in vectors:
        arrays = [(ctypes.c_float * max(len(y), 1))(*y) for y in ((v.x, v.a, v.p) if v.a else (v.x, v.p))]
        acting = None if v.inputs is None else (ctypes.c_float * max(len(v.inputs), 1))(*v.inputs)
        found = (ctypes.c_float * max(outputs, 1))()
        called(v.t, *arrays, acting, found)
        size = max([1.0, *(abs(y) for y in v.result if y == y)])
        for a, b in zip(found, v.result, strict=False):
            if b == b:
                worst = max(worst, abs(a - b) / size / v.tolerance if a == a else float("inf"))
    return worst
