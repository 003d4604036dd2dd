"""Right-hand side in C -> an integrator for it: NAME_run.h, NAME_run.c, and a program that writes a motion as CSV."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from eomgen.codegen.lowering import lowered
from eomgen.codegen.program import Program
from eomgen.codegen.spheres import spheres_of
from eomgen.codegen.targets.c import C
from eomgen.codegen.targets.c_lanes import text_of

SAFETY, SMALLEST, LARGEST = 0.9, 0.2, 10.0  # factors between two step sizes

_HEADER = """\
#ifndef {upper}_RUN_H
#define {upper}_RUN_H

#include "{stem}_rhs.h"

/* A motion on its way; t and x are where it is. As many may run at once as one likes. */
typedef struct {{
    double t, h, rtol, atol, t_old;
    double x[{n}], f[{n}], x_old[{n}], f_old[{n}], x_new[{n}], K[16*{n}], F[7*{n}], c[{constants}];
    const double *p;
    size_t steps;
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


RUN_USE = "cc -O2 -D{stem}_MAIN {stem}_run.c {stem}_rhs.c -lm -o {stem}_run && ./{stem}_run --time=10 > motion.csv"
"""how the program is made and run"""


def integrator_files(
    stem: str, program: Program, start: Sequence[float] | None, values: Sequence[float] | None, rtol: float
) -> dict[str, str]:
    """The files beside NAME_rhs.c and NAME_rhs.h.

    Args:
        start, values: of the states and parameters in `main`, None where one is missing.
        rtol: there, where nobody says another.
    """
    n, constants = len(program.states), max(lowered(program, C, "dx", f"{stem}_").constants, 1)
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
    spheres = spheres_of(program)
    for places in spheres:
        squares = " + ".join(f"x[{k}]*x[{k}]" for k in places)
        lines += ["    {", f"        double norm = sqrt({squares});", "        if (norm > 0)"]
        lines += [f"            {', '.join(f'x[{k}] /= norm' for k in places)};", "    }"]
    lines += [] if spheres else ["    (void)x;"]
    return "\n".join([*lines, f"    return {int(bool(spheres))};", "}"])


def _listed(values: Sequence[float]) -> str:
    return "{" + ", ".join("NAN" if math.isnan(x) else repr(float(x)) for x in values) + "}"


def _quoted(names: Sequence[str]) -> str:
    return "{" + ", ".join('"' + name.replace("\\", "\\\\").replace('"', '\\"') + '"' for name in names) + "}"
