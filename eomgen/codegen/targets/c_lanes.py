"""Program -> C over vectors: the text of the C target with a vector where it has a number, one run or state a lane.

Programs that solve by kernels, or read samples, branch on numbers; they are run one lane wide, by the C target's text.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from eomgen.codegen import build
from eomgen.codegen.expressions import ATOM, RankedText, ranked_number
from eomgen.codegen.lowered import CHANGED, READ, REAL, ROOM, Language
from eomgen.codegen.lowering import lowered
from eomgen.codegen.program import Program
from eomgen.codegen.targets.c import C, c_text
from eomgen.symbolic.expression.functions import NAMES
from eomgen.symbolic.expression.graph import Number

WIDTH = 8  # lanes
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
    from importlib import resources

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
    """The C compiler for vectors of this machine's; products are added to unrounded."""
    usual = build.of_this_machine()
    wide = ["-mprefer-vector-width=512"] if "-mavx512f" in usual.flags and "clang" not in build.C.command()[0] else []
    return replace(usual, flags=(*usual.flags, *wide, "-ffp-contract=fast", "-Wno-psabi"))
