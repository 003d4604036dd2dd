"""How near single precision comes: the tolerances of its vectors, measured, and the errors of a text that is run."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from eomgen.codegen.program import Program
from eomgen.codegen.rhs import compiled
from eomgen.codegen.targets.base import Called, TestVector
from eomgen.symbolic.numeric.tolerances import SINGLE, SINGLE_ROUNDING

TRIES = 16  # states around one, by which it is measured what rounding does
GROWN = 8  # times what the arguments' rounding does: that of all operations


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
        x, a, p, result = map(_in_range, (v.x, v.a, v.p, v.result))
        inputs = None if v.inputs is None else _in_range(v.inputs)
        return replace(v, x=x, a=a, p=p, inputs=inputs, result=result, tolerance=float(SINGLE + GROWN * far / size))

    return tuple(map(measured, vectors))


def _in_range(values: Sequence[float]) -> tuple[float, ...]:
    """Numbers, 0 where single precision has none so small: compilers warn of such a one."""
    return tuple(0.0 if abs(x) < np.finfo(np.float32).tiny else x for x in values)


def single_error(called: Called, vectors: Sequence[TestVector]) -> float:
    """The largest error of a text in single precision against its tolerance, at all vectors.

    Args:
        called: the text, run.
    """
    worst = 0.0
    for v in vectors:
        size = max([1.0, *(abs(y) for y in v.result if y == y)])
        for a, b in zip(called(v.t, v.x, v.a, v.p, v.inputs), v.result, strict=True):
            if b == b:
                worst = max(worst, abs(a - b) / size / v.tolerance if a == a else float("inf"))
    return worst
