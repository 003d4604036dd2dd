"""Test vectors -> a C main that compares: 0 where every vector agrees, 1 where one does not."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import Vector

_MAIN = """\
#ifdef EOMGEN_SELFTEST
#include <stdio.h>

static const struct {{ double t, x[{x}], p[{p}], inputs[{inputs}], dx[{dx}], tolerance; int given; }} vectors[] = {{
{rows}
}};

int main(void)
{{
    int wrong = 0;
    for (size_t i = 0; i < sizeof vectors/sizeof *vectors; i++) {{
        double dx[{dx}], largest = 1;
        {stem}_rhs(vectors[i].t, vectors[i].x, vectors[i].p, vectors[i].given ? vectors[i].inputs : NULL, dx);
        for (int j = 0; j < {outputs}; j++)
            if (fabs(vectors[i].dx[j]) > largest) largest = fabs(vectors[i].dx[j]);
        for (int j = 0; j < {outputs}; j++)
            if (!(fabs(dx[j] - vectors[i].dx[j]) <= vectors[i].tolerance*largest)) {{
                fprintf(stderr, "vector %d: dx[%d] is %.17g, not %.17g\\n", (int)i, j, dx[j], vectors[i].dx[j]);
                wrong = 1;
            }}
    }}
    return wrong;
}}
#endif
"""


def self_test(program: Program, stem: str, vectors: Sequence[Vector]) -> str:
    """The main, or nothing where there are no vectors."""
    if not vectors:
        return ""
    sizes = {
        "x": len(program.states),
        "p": len(program.symbols.parameters),
        "inputs": len(program.symbols.inputs),
        "dx": len(program.outputs),
    }
    return _MAIN.format(
        rows=",\n".join(f"    {_row(vector)}" for vector in vectors),
        stem=stem,
        outputs=sizes["dx"],
        **{name: max(size, 1) for name, size in sizes.items()},
    )


def _row(vector: Vector) -> str:
    arrays = (vector.x, vector.p, vector.inputs or (), vector.dx)
    x, p, inputs, dx = ("{" + (", ".join(map(repr, array)) or "0") + "}" for array in arrays)
    return f"{{{vector.t!r}, {x}, {p}, {inputs}, {dx}, {vector.tolerance!r}, {int(vector.inputs is not None)}}}"
