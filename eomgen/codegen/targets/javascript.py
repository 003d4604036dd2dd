"""Program -> an ECMAScript module: `rhs(t, x, p, inputs)`, `reactions(t, x, p, inputs)`, `inverse(t, x, a, p, inputs)`.

With it comes a test over the test vectors, run by `node --test`.
"""

from __future__ import annotations

from dataclasses import replace

from eomgen.codegen.program import Program
from eomgen.codegen.statements import CHANGED, INDICES, INT, PLACES, READ, ROOM, Language
from eomgen.codegen.targets.base import by_cases
from eomgen.codegen.targets.node import node_form, node_target

_OUT = "function {name}({arguments}, {out} = new Float64Array({size})) {{"
JAVASCRIPT = Language(
    reserved=frozenset(
        "arguments await break case catch class const continue debugger default delete do else enum eval export "
        "extends false finally for function if implements import in instanceof interface let new null package private "
        "protected public return static super switch this throw true try typeof undefined var void while with yield "
        "Array Float64Array Infinity Math NaN".split()
    ),
    functions={
        **{op: f"Math.{op}({{0}})" for op in "sqrt sin cos asin acos atan sinh cosh tanh exp log abs sign".split()},
        **{op: f"Math.{op}({{0}}, {{1}})" for op in "atan2 pow min max".split()},
    },
    defined=by_cases(
        "const {name} = ({arguments}) => {value};",
        words={"nan": "NaN", "given == 0": "given === 0", "given == given": "given === given"},
        only=("less", "less_equal", "select"),
    ),
    words={"not": "!", "nan": "NaN", "given": "inputs !== null"},
    let="const {declared} = {value};",
    arrays={
        **dict.fromkeys(
            (CHANGED, PLACES), "const {name} = {name}_of_{of};\nfor (let i = 0; i < {size}; i++) {name}[i] = 0;"
        ),
        ROOM: "const {name} = {name}_of_{of};",
    },
    kept="const {name}_of_{of} = new Float64Array({size});",  # cheaper than one a call
    tables={INT: "const {name} = {value};", INDICES: "const {name} = {values};", READ: "const {name} = {values};"},
    loop=("for (let {name} = {first}; {name} < {last}; {name}++) {{", "}"),
    down=("for (let {name} = {last} - 1; {name} >= {first}; {name}--) {{", "}"),
    function=("function {declared}({arguments}) {{", "}"),
    out=(f"export {_OUT}", "    return {out};\n}"),
    longest=2000,  # V8 leaves longer functions unoptimized
)

_MODULE = """\
{functions}

/** {result}: {outputs} numbers; inputs null: the model's own. */
export function {role}(t, x, {a}p, inputs = null) {{
    return evaluate(t, x, {a}p, constants(p), inputs);
}}
"""
FORM = node_form(JAVASCRIPT, _MODULE)


def javascript_expression(program: Program) -> str:
    """An object of the functions `constants` and `evaluate`, for scripts that are no modules."""
    inside = replace(JAVASCRIPT, out=(_OUT, JAVASCRIPT.out[1]))
    whole = "(() => {{\n{functions}\nreturn {{ constants, evaluate }};\n}})()"
    return replace(FORM, language=inside, module=whole).text(program)


USE = ('import {{ rhs }} from "./{stem}_rhs.mjs";', "node --test")
TARGET = node_target("javascript", "an ECMAScript module, for browsers and node", FORM, USE)
