"""Program -> a Julia module NAME_rhs: `rhs(t, x, p, inputs=Float64[])`, over any real numbers.

With it comes a test over the test vectors. No Julia runs here: the text is written to the same rules as the others',
and it has not been run by Julia; its head says so.
"""

from __future__ import annotations

from eomgen.codegen.program import Program
from eomgen.codegen.statements import CHANGED, INDICES, INT, PLACES, READ, ROOM, Language
from eomgen.codegen.targets.base import FileForm, Functions, Target, by_cases, in_quotes
from eomgen.errors import ToolMissing

NOT_RUN = "Not run where it was made: no Julia was there."
JULIA = Language(
    reserved=frozenset(
        "abstract baremodule begin break catch const continue do else elseif end export false finally for function "
        "global if import in isa let local macro module mutable primitive public quote return struct true try type "
        "using where while im pi ans eps zeros eltype promote_type Base Core Main NaN Inf Float64 Int x_names p_names "
        "input_names".split()
    ),
    functions={
        **{op: f"within({op}, {{0}})" for op in "sin cos sqrt asin acos log".split()},
        "atan2": "atan({0}, {1})",
        "pow": "power({0}, {1})",
    },
    defined={
        **by_cases(
            "{name}({arguments}) = {value}",
            number="oftype(a, {value})",
            words={"nan": "a + b"},
            only=("less", "less_equal", "select"),
        ),
        "pow": "power(a, b) = a < 0 && b != round(b) ? oftype(a, NaN) : a^b",
    },
    words={"not": "!", "nan": "NaN", "given": "!isempty(inputs)"},
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


FORM = FileForm(
    JULIA,
    _MODULE,
    "{main}.jl",
    "{main}_test.jl",
    fixed={"not_run": NOT_RUN},
    named="const {key} = String[{names}]",
    quoted=lambda name: in_quotes(name).replace("$", "\\$"),
    test=_TEST,
    listed=("Float64[", "]"),
    acting=("Float64[]", "{}"),
)


def functions(program: Program) -> Functions:
    """None: nothing here runs Julia.

    Raises:
        ToolMissing: always.
    """
    raise ToolMissing(
        "nothing here runs Julia", fix="choose another target; the code of this one is written all the same"
    )


USE = (NOT_RUN, 'include("{stem}_rhs.jl"); using .{stem}_rhs', "julia {stem}_rhs_test.jl")
TARGET = Target("julia", "a Julia module (not run here)", FORM.text, FORM.files, USE, functions)
