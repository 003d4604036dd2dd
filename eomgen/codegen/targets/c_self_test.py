"""Test vectors -> a C main that compares: 0 where every vector agrees, 1 where one does not."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import Role, TestVector

_MAIN = """\
#include <stdio.h>

static const struct {{ double t, x[{x}],{a} p[{p}], inputs[{inputs}], {result}[{size}], tolerance; int given; }} \
vectors[] = {{
{rows}
}};

int main(void)
{{
    int wrong = 0;
    for (size_t i = 0; i < sizeof vectors/sizeof *vectors; i++) {{
        double {result}[{size}], largest = 1;
        {main}(vectors[i].t, vectors[i].x,{given} vectors[i].p, vectors[i].given ? vectors[i].inputs : NULL, {result});
        for (int j = 0; j < {outputs}; j++)
            if (fabs(vectors[i].{result}[j]) > largest) largest = fabs(vectors[i].{result}[j]);
        for (int j = 0; j < {outputs}; j++)
            if (isnan(vectors[i].{result}[j]) ? !isnan({result}[j])
                : !(fabs({result}[j] - vectors[i].{result}[j]) <= vectors[i].tolerance*largest)) {{
                fprintf(stderr, "vector %d: {result}[%d] is %.17g, not %.17g\\n", (int)i, j, \
{result}[j], vectors[i].{result}[j]);
                wrong = 1;
            }}
    }}
    return wrong;
}}
"""


def self_test(
    program: Program, function: str, vectors: Sequence[TestVector], role: Role, *, guard: str = "EOMGEN_SELFTEST"
) -> str:
    """The main, or nothing where there are no vectors.

    Args:
        function: as it is called.
        guard: the main is there only where this is defined; "" always.
    """
    if not vectors:
        return ""
    sizes = {
        "x": len(program.states),
        "p": len(program.symbols.parameters),
        "inputs": len(program.symbols.inputs),
        "size": len(program.outputs),
    }
    a = len(program.accelerations)
    text = _MAIN.format(
        a=f" a[{a}]," if a else "",
        given=" vectors[i].a," if a else "",
        rows=",\n".join(f"    {_row(vector)}" for vector in vectors),
        main=function,
        result=role.result,
        outputs=sizes["size"],
        **{name: max(size, 1) for name, size in sizes.items()},
    )
    return f"#ifdef {guard}\n{text}#endif\n" if guard else text


def _number(value: float) -> str:
    return "NAN" if value != value else repr(value)


def _row(vector: TestVector) -> str:
    arrays = (vector.x, *([vector.a] if vector.a else []), vector.p, vector.inputs or (), vector.result)
    listed = ", ".join("{" + (", ".join(map(_number, array)) or "0") + "}" for array in arrays)
    return f"{{{vector.t!r}, {listed}, {vector.tolerance!r}, {int(vector.inputs is not None)}}}"
