"""Program -> C over vectors: the text of the C target with a vector where it has a number, one run or state a lane.

Programs that solve by kernels, or read samples, branch on numbers; they are run one lane wide, by the C target's text.
"""

from __future__ import annotations

import platform
from dataclasses import replace
from functools import cache
from importlib import resources
from pathlib import Path

from eomgen.codegen import build
from eomgen.codegen.expressions import ATOM, RankedText, ranked_number
from eomgen.codegen.lowered import CHANGED, READ, REAL, ROOM, Language
from eomgen.codegen.lowering import lowered
from eomgen.codegen.program import Program
from eomgen.codegen.targets.c import C, c_text
from eomgen.symbolic.expression.functions import NAMES
from eomgen.symbolic.expression.graph import Number

WIDTH = 8  # lanes
_EXTENSIONS = {"avx512f": "-mavx512f", "avx512dq": "-mavx512dq", "avx2": "-mavx2", "fma": "-mfma"}
_NAMED = {"abs": "fabs", **{name: name for name in (*NAMES, "pow", "less", "less_equal", "select") if name != "abs"}}


def _broadcast(a: Number) -> RankedText:
    return f"L({ranked_number(a)[0]})", ATOM


LANES: Language = replace(
    C,
    reserved=C.reserved | {"L", "R", "LANES", "LANE", "REAL", "MASK", "SIZE", "LARGER", "CHOSEN", "INLINE"},
    functions={
        op: f"lanes_{name}({', '.join(f'{{{k}}}' for k in range(_arguments))})"
        for op, name in _NAMED.items()
        for _arguments in (3 if op == "select" else 2 if op in ("pow", "less", "less_equal") else NAMES[op],)
    },
    defined={},
    kinds={**C.kinds, REAL: "REAL {name}", READ: "const REAL *{name}", CHANGED: "REAL *{name}"},
    arrays={CHANGED: "REAL {name}[{size}] = {{{{0}}}};", ROOM: "REAL {name}[{size}];"},
    out=("static void {name}({arguments}, REAL *{out})\n{{", "}"),
    number=_broadcast,
)


@cache
def text_of(name: str) -> str:
    """One of the fixed texts that lie beside this package's modules."""
    return resources.files("eomgen.codegen").joinpath(name).read_text(encoding="utf-8")


def lanes_text(program: Program) -> tuple[int, str]:
    """(lanes, eomgen_constants and eomgen_evaluate over vectors of so many)."""
    made = lowered(program, LANES, "dx", "eomgen_")
    if made.kernels:
        return 1, f"{text_of('one_lane.c')}\n{c_text(program, 'eomgen')}"
    return WIDTH, "\n\n".join([f"#define LANES {WIDTH}\n{text_of('lanes.c')}", *made.texts(LANES)])


def constants_of(program: Program) -> int:
    """How many numbers the parameters determine."""
    return lowered(program, C, "dx", "eomgen_").constants


@cache
def vector_compiler() -> build.Compiler:
    """The C compiler, told which vectors this machine has."""
    flags = [flag for name, flag in _EXTENSIONS.items() if name in _processor()]
    wide = ["-mprefer-vector-width=512"] if "-mavx512f" in flags and "clang" not in build.C.command()[0] else []
    more = (*flags, *wide, "-fno-math-errno", "-ffp-contract=fast", "-Wno-psabi")
    return replace(build.C, flags=(*build.C.flags, *more))


def _processor() -> frozenset[str]:
    """What the processor says that it can do; nothing where it does not say so."""
    if platform.machine() not in ("x86_64", "AMD64"):
        return frozenset()
    try:
        told = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return frozenset()
    lines = [line for line in told.splitlines() if line.startswith("flags")]
    return frozenset(lines[0].split()) if lines else frozenset()
