"""Program -> the power series of its motion, compiled, and the order to which they go."""

from __future__ import annotations

import ctypes
import math
from typing import Any

from eomgen.codegen.build import function_of, library
from eomgen.codegen.lowering import lowered
from eomgen.codegen.program import Program
from eomgen.codegen.targets.c import C
from eomgen.codegen.targets.c_lanes import vector_compiler
from eomgen.codegen.taylor import series_text, without_series
from eomgen.records import dataclass

LEAST, MOST = 3, 20  # orders: the highest is what 1e-16 asks for
ALONE = 24.0  # products beside its sums that a coefficient takes where one motion is followed: measured at equal error


@dataclass(frozen=True)
class Series:
    """Compiled functions of the series of a motion.

    Args:
        address: of that which gives the coefficients; along: of that which gives x and x' by them.
        size: the first works in so many numbers.
        kept: what keeps it there.
    """

    address: int
    along: int
    size: int
    kept: Any


def series_of(program: Program, order: int) -> Series | None:
    """The series of a program in C, up to an order; None of what has none.

    Raises:
        RunFailed, ToolMissing: as of `library`.
    """
    if without_series(program):
        return None
    text, size = series_text(program, C, order)
    made = lowered(program, C, "dx", "eomgen_")
    kernels = made.texts(C)[: -len(made.bodies)]
    found = library("\n".join(["#include <math.h>\n#include <string.h>", *kernels, text]), by=vector_compiler())
    functions = (function_of(found, f"eomgen_{name}") for name in ("series", "along"))
    series, along = (ctypes.cast(each, ctypes.c_void_p).value or 0 for each in functions)
    return Series(series, along, size, found)


def order_for(rtol: float, beside: float = 0.0) -> int:
    """The order that costs least at a relative tolerance: 1 + p, p (p + beside) exp(-ln(rtol)/p) least.

    A step goes as far as exp(ln(rtol)/p), and takes p^2 products in its sums, and beside them p times so much as
    `beside` of them: then 1/p + 1/(p + beside) = -ln(rtol)/p^2, where nothing is beside them p = -ln(rtol)/2.

    Source: Jorba & Zou, Experimental Mathematics 14 (2005), 99-117.
    """
    digits = -math.log(rtol)
    least = (digits - beside + math.hypot(digits - beside, math.sqrt(8 * beside * digits))) / 4
    return min(MOST, max(LEAST, math.ceil(1 + least)))
