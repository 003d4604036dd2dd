"""Program -> a Julia module NAME_rhs: `rhs(t, x, p, inputs=Float64[])`, over any real numbers.

With it comes a test over the test vectors. No Julia runs here: the text is written to the same rules as the others',
and nobody has run it; its head says so.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from eomgen.codegen.lowered import CHANGED, INDICES, INT, PLACES, READ, REAL, ROOM, Language
from eomgen.codegen.lowering import lowered
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import (
    RHS,
    Description,
    Functions,
    Role,
    Target,
    files_of_each,
    header,
    vector_lines,
)
from eomgen.codegen.targets.library_call import sizes
from eomgen.errors import ToolMissing

NOT_RUN = "Not run where it was made: no Julia was there."
JULIA = Language(
    reserved=frozenset(
        "abstract baremodule begin break catch const continue do else elseif end export false finally for function "
        "global if import in isa let local macro module mutable primitive quote return struct true try type using "
        "where while im pi ans eps zeros eltype promote_type Base Core Main NaN Inf Float64 Int x_names p_names "
        "input_names".split()
    ),
    functions={
        **{op: f"within({op}, {{0}})" for op in "sin cos sqrt asin acos log".split()},
        "atan2": "atan({0}, {1})",
        "pow": "power({0}, {1})",
    },
    defined={
        "less": "less(a, b) = a < b ? one(a) : a >= b ? zero(a) : a + b",
        "less_equal": "less_equal(a, b) = a <= b ? one(a) : a > b ? zero(a) : a + b",
        "select": "select(given, a, b) = given == 0 ? b : given == given ? a : given",
        "pow": "power(a, b) = a < 0 && b != round(b) ? oftype(a, NaN) : a^b",
    },
    words={"not": "!", "nan": "NaN", "given": "!isempty(inputs)"},
    kinds=dict.fromkeys(("", REAL, INT, READ, CHANGED, INDICES, PLACES), "{name}"),
    at="{array}[{index}]",
    index="{index} + 1",
    first=1,
    let="{declared} = {value}",
    put="{place} = {value}",
    call="{function}({arguments})",
    back="return {value}",
    leave="return",
    arrays=dict.fromkeys((CHANGED, ROOM), "{name} = zeros(Real, {size})") | {PLACES: "{name} = zeros(Int, {size})"},
    tables={INT: "const {name} = {value}", INDICES: "const {name} = {values}", READ: "const {name} = {values}"},
    listed=("[", "]"),
    loop=("for {name} in {first}:({last} - 1)", "end"),
    down=("for {name} in ({last} - 1):-1:{first}", "end"),
    branch=("if {condition}", "else", "end"),
    function=("function {declared}({arguments})", "end"),
    out=("function {name}({arguments})\n    {out} = zeros(Real, {size})", "    return {out}\nend"),
    remark="# {text}",
    harmless=lambda text: " ".join(text.replace("#=", "# =").replace("=#", "= #").split("\n")),
)

_MODULE = """\
module {main}
# {not_run}

export {role}

{names}

# f where it has a value, else nan: Julia's own end in an error there
function within(f, a)
    try
        return f(a)
    catch error
        error isa DomainError || rethrow()
        return oftype(float(a), NaN)
    end
end

{functions}

\"\"\"
    {role}(t, x, {a}p, inputs=Float64[])

{result}: a vector of {outputs}; without inputs the model's own act. For OrdinaryDiffEq: (x, p, t) -> {role}(t, x, p).
\"\"\"
{role}(t, x, {a}p, inputs=Float64[]) = identity.(evaluate(t, x, {a}p, constants(p), inputs))

end
"""

_TEST = """\
# Held against its test vectors: julia {main}_test.jl. {not_run}
include("{main}.jl")
using .{main}
using Test

function check(t, x, {a}p, inputs, right, tolerance)
    found = {main}.{role}(t, x, {a}p, inputs)
    largest = maximum(abs, filter(!isnan, right); init=1.0)
    @test length(found) == length(right)
    for (a, b) in zip(found, right)
        @test isnan(b) ? isnan(a) : abs(a - b) <= tolerance*largest
    end
end

@testset "{main}" begin
{lines}
end
"""


def julia_text(program: Program, stem: str, role: Role = RHS, remarks: Mapping[str, str] | None = None) -> str:
    """The module of a program."""
    made, symbols = lowered(program, JULIA, role.result, remarks=remarks), program.symbols
    listed = {"x_names": [x.name for x in program.states], "p_names": symbols.parameters, "input_names": symbols.inputs}
    return _MODULE.format(
        **sizes(program, role, stem),
        not_run=NOT_RUN,
        names="\n".join(f"const {key} = String[{', '.join(map(_quoted, names))}]" for key, names in listed.items()),
        functions="\n\n".join(made.texts(JULIA)),
        a="a, " if program.accelerations else "",
    )


def _quoted(name: str) -> str:
    return json.dumps(name, ensure_ascii=False).replace("$", "\\$")


def _files(stem: str, program: Program, told: Description) -> dict[str, str]:
    """NAME_rhs.jl and NAME_rhs_test.jl."""
    main, a = told.role.main(stem), "{a}, " if program.accelerations else ""
    head = "\n".join(f"# {JULIA.harmless(line)}".rstrip() for line in header(program, told))
    call = f"    check({{t}}, {{x}}, {a}{{p}}, {{inputs}}, {{result}}, {{tolerance}})"
    lines = vector_lines(told.vectors, call, _listed, _number, ("Float64[]", "{}"))
    words = sizes(program, told.role, stem) | {
        "not_run": NOT_RUN,
        "a": a.replace("{a}", "a"),
        "lines": "\n".join(lines),
    }
    files = {f"{main}.jl": f"{head}\n{julia_text(program, stem, told.role, told.remarks)}"}
    return files | ({f"{main}_test.jl": _TEST.format(**words)} if told.vectors else {})


def _number(value: float) -> str:
    return "NaN" if value != value else repr(value)


def _listed(values: Sequence[float]) -> str:
    return f"Float64[{', '.join(map(_number, values))}]"


def functions(program: Program) -> Functions:
    """None: nothing here runs Julia.

    Raises:
        ToolMissing: always.
    """
    raise ToolMissing(
        "nothing here runs Julia", mend="choose another target; the code of this one is written all the same"
    )


USE = (NOT_RUN, 'include("{stem}_rhs.jl"); using .{stem}_rhs', "julia {stem}_rhs_test.jl")
TARGET = Target("julia", "a Julia module (not run here)", julia_text, files_of_each(_files), USE, functions)
