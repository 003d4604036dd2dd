"""C over vectors, C with an integrator of its own, and C behind ctypes.

Program -> C over vectors: the text of the C target with a vector where it has a number, one run or state a lane.

Programs that solve by kernels, or read samples, branch on numbers; they are run one lane wide, by the C target's text.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

from eomgen.codegen import build
from eomgen.codegen.lowering import statements
from eomgen.codegen.program import Program
from eomgen.codegen.statements import ATOM, CHANGED, READ, REAL, ROOM, Language, RankedText, ranked_number
from eomgen.codegen.targets.c import C, c_text
from eomgen.symbolic.expression import NAMES, Number

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
    """One of the fixed texts that are files of this package."""
    from importlib import resources

    return resources.files("eomgen.codegen").joinpath(name).read_text(encoding="utf-8")


def lanes_text(program: Program) -> tuple[int, str]:
    """(lanes, eomgen_constants and eomgen_evaluate over vectors of so many)."""
    made = statements(program, LANES, "dx", "eomgen_")
    if made.kernels:
        return 1, f"{text_of('one_lane.c')}\n{c_text(program, 'eomgen')}"
    return WIDTH, "\n\n".join([f"#define LANES {WIDTH}\n{text_of('lanes.c')}", *made.texts(LANES)])


def constants_of(program: Program) -> int:
    """Number of the constants that the parameters determine."""
    return statements(program, C, "dx", "eomgen_").constants


@cache
def vector_compiler() -> build.Compiler:
    """The C compiler for vectors of this machine's; products are added to unrounded."""
    usual = build.of_this_machine()
    wide = ["-mprefer-vector-width=512"] if "-mavx512f" in usual.flags and "clang" not in build.C.command()[0] else []
    return replace(usual, flags=(*usual.flags, *wide, "-ffp-contract=fast", "-Wno-psabi"))


# -------- c integrator ----------------------------------------------------------------------------------------
# Right-hand side in C -> an integrator for it: NAME_run.h, NAME_run.c, and a program that writes a motion as CSV.


SAFETY, SMALLEST, LARGEST = 0.9, 0.2, 10.0  # factors between two step sizes

_HEADER = """\
#ifndef {upper}_RUN_H
#define {upper}_RUN_H

#include "{stem}_rhs.h"

/* A motion on its way; t and x are where it is. As many may run at once as one likes. */
typedef struct {{
    double t, h, rtol, atol, t_old;
    double x[{n}], f[{n}], x_old[{n}], f_old[{n}], x_new[{n}], K[16*{n}], F[7*{n}], c[{constants}];
    double x_piece[{n}], x_next[{n}]; /* the ends of a piece of the last step */
    const double *p;
    size_t steps, pieces, piece;
    int is_dense;
}} {stem}_run;

/* The start; p must stay where it is. */
void {stem}_begin({stem}_run *run, double t, const double *x, const double *p, double rtol, double atol);

/* One step, not beyond the end: 1; 0 where the step size goes to zero. */
int {stem}_step({stem}_run *run, double end);

/* x at an instant of the last step. */
void {stem}_at({stem}_run *run, double t, double *x);

#endif
"""


RUN_TEST = "cc -O2 -D{stem}_RUN_SELFTEST {stem}_run.c {stem}_rhs.c -lm -o {stem}_test && ./{stem}_test"
RUN_USE = "cc -O2 -D{stem}_MAIN {stem}_run.c {stem}_rhs.c -lm -o {stem}_run && ./{stem}_run --time=10 > motion.csv"
"""how the program is made and run"""


def integrator_files(
    stem: str, program: Program, start: Sequence[float] | None, values: Sequence[float] | None, rtol: float
) -> dict[str, str]:
    """The files in addition to NAME_rhs.c and NAME_rhs.h.

    Args:
        start, values: of the states and parameters in `main`, None where one is missing.
        rtol: the default there.
    """
    n, constants = len(program.states), max(statements(program, C, "dx", f"{stem}_").constants, 1)
    states = [x.name for x in program.states]
    parameters = list(program.symbols.parameters)
    defined = {
        "LARGEST_GROWTH": repr(LARGEST),
        "SMALLEST_GROWTH": repr(SMALLEST),
        "SAFETY": repr(SAFETY),
        "EPSILON": "DBL_EPSILON",
        "RTOL": repr(rtol),
        f"{stem}_START": _listed(start or [0.0] * n),
        f"{stem}_VALUES": _listed([*(values or [math.nan] * len(parameters)), 0.0]),
    }
    names = [
        f"static const char *const {stem}_states[] = {_quoted(states)};",
        f"static const char *const {stem}_parameters[] = {_quoted([*parameters, ''])};",
    ]
    main = ["#ifdef NAME_MAIN", *names, "#endif"]
    parts = [
        f'#include <float.h>\n#include <math.h>\n#include "{stem}_run.h"',
        "\n".join(f"#define {name} {value}" for name, value in defined.items()),
        text_of("dop853.c"),
        text_of("dop853_pieces.c"),
        _hold(stem, program),
        _named(text_of("integrator.c"), stem),
        _named("\n".join(main) + text_of("integrator_main.c"), stem),
    ]
    header = _HEADER.format(stem=stem, upper=stem.upper(), n=n, constants=constants)
    return {f"{stem}_run.h": header, f"{stem}_run.c": "\n\n".join(part.strip() for part in parts) + "\n"}


def _named(text: str, stem: str) -> str:
    """A fixed text, about this model."""
    text = re.sub(r"\bNAME_(STATES|PARAMETERS)\b", rf"{stem.upper()}_\1", text)
    return re.sub(r"\bNAME_", f"{stem}_", text)


def _hold(stem: str, program: Program) -> str:
    """Quaternions back to norm 1; whether there are any."""
    lines = [f"static int {stem}_hold(double *x)", "{"]
    unit_quaternions = program.unit_quaternions
    for places in unit_quaternions:
        squares = " + ".join(f"x[{k}]*x[{k}]" for k in places)
        lines += ["    {", f"        double norm = sqrt({squares});", "        if (norm > 0)"]
        lines += [f"            {', '.join(f'x[{k}] /= norm' for k in places)};", "    }"]
    lines += [] if unit_quaternions else ["    (void)x;"]
    return "\n".join([*lines, f"    return {int(bool(unit_quaternions))};", "}"])


def _listed(values: Sequence[float]) -> str:
    return "{" + ", ".join("NAN" if math.isnan(x) else repr(float(x)) for x in values) + "}"


def _quoted(names: Sequence[str]) -> str:
    return "{" + ", ".join('"' + name.replace("\\", "\\\\").replace('"', '\\"') + '"' for name in names) + "}"
