"""Program -> an ECMAScript module: `rhs(t, x, p, inputs)`, `reactions(t, x, p, inputs)`, `inverse(t, x, a, p, inputs)`.

With it comes a test over the test vectors, run by `node --test`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace

from eomgen.codegen.lowered import CHANGED, INDICES, INT, PLACES, READ, REAL, ROOM, Language
from eomgen.codegen.lowering import lowered
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import (
    RHS,
    Called,
    Description,
    Emitted,
    FileContent,
    Functions,
    Role,
    Target,
    called_by,
    functions_by,
    header,
)
from eomgen.codegen.targets.node import many_of_module

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
    defined={
        "less": "const less = (a, b) => a < b ? 1 : a >= b ? 0 : NaN;",
        "less_equal": "const less_equal = (a, b) => a <= b ? 1 : a > b ? 0 : NaN;",
        "select": "const select = (given, a, b) => given === 0 ? b : given === given ? a : given;",
    },
    words={"not": "!", "nan": "NaN", "given": "inputs !== null"},
    kinds=dict.fromkeys(("", REAL, INT, READ, CHANGED, INDICES, PLACES), "{name}"),
    at="{array}[{index}]",
    let="const {declared} = {value};",
    put="{place} = {value};",
    call="{function}({arguments});",
    back="return {value};",
    arrays=dict.fromkeys(
        (CHANGED, ROOM, PLACES), "const {name} = new Array({size}).fill(0);"
    ),  # cheaper than typed ones
    tables={INT: "const {name} = {value};", INDICES: "const {name} = {values};", READ: "const {name} = {values};"},
    listed=("[", "]"),
    loop=("for (let {name} = {first}; {name} < {last}; {name}++) {{", "}"),
    down=("for (let {name} = {last} - 1; {name} >= {first}; {name}--) {{", "}"),
    branch=("if ({condition}) {{", "} else {", "}"),
    function=("function {declared}({arguments}) {{", "}"),
    out=(f"export {_OUT}", "    return {out};\n}"),
    remark="// {text}",
    longest=2000,  # V8 leaves longer functions unoptimized
)

_CALLER = """\
/** {result}: {count} numbers; inputs null: the model's own. */
export function {role}(t, x, {a}p, inputs = null) {{
    return evaluate(t, x, {a}p, constants(p), inputs);
}}
"""

_TEST = """\
// Held against the answers in test_vectors.json: node --test
import assert from "node:assert/strict";
import {{ readFileSync }} from "node:fs";
import {{ test }} from "node:test";
import {{ {role} }} from "./{main}.mjs";

const told = JSON.parse(readFileSync(new URL("test_vectors.json", import.meta.url), "utf8"));

test("{main} gives the values of its test vectors", () => {{
    for (const [place, v] of told{where}.vectors.entries()) {{
        const found = {role}(v.t, v.x, {a}v.p, v.inputs);
        assert.equal(found.length, v.{result}.length);
        const largest = Math.max(1, ...v.{result}.map(Math.abs));
        v.{result}.forEach((right, k) => assert.ok(
            right === null ? Number.isNaN(found[k]) : Math.abs(found[k] - right) <= v.tolerance*largest,
            `vector ${{place}}: {result}[${{k}}] is ${{found[k]}}, not ${{right}}`,
        ));
    }}
}});
"""


def javascript_text(program: Program, stem: str = "", role: Role = RHS) -> str:
    """A module that exports the role's function, `constants(p)` and `evaluate(t, x, p, c, inputs)`.

    A module has its own names, so the stem is not in them.
    """
    a = "a, " if program.accelerations else ""
    caller = _CALLER.format(result=role.result, role=role.name, a=a, count=len(program.outputs))
    return f"{_functions(program, JAVASCRIPT, role)}\n\n{caller}"


def javascript_expression(program: Program) -> str:
    """An object of the functions `constants` and `evaluate`, for scripts that are no modules."""
    text = _functions(program, replace(JAVASCRIPT, out=(_OUT, JAVASCRIPT.out[1])), RHS)
    return f"(() => {{\n{text}\nreturn {{ constants, evaluate }};\n}})()"


def _functions(program: Program, language: Language, role: Role) -> str:
    return "\n\n".join(lowered(program, language, role.result).texts(language))


def javascript_files(stem: str, emitted: Sequence[Emitted]) -> dict[str, FileContent]:
    """NAME_rhs.mjs and NAME_rhs.test.mjs, which `node --test` finds."""
    return {name: text for each in emitted for name, text in _files(stem, *each).items()}


def _files(stem: str, program: Program, description: Description) -> dict[str, str]:
    role, main = description.role, description.role.main(stem)
    head = "\n".join(f"// {JAVASCRIPT.harmless(line)}".rstrip() for line in header(program, description))
    listed = {
        "x": [x.name for x in program.states],
        "p": list(program.symbols.parameters),
        "inputs": list(program.symbols.inputs),
    }
    named = "\n".join(f"    {key}: {json.dumps(names)}," for key, names in listed.items())
    text = f"{head}\n\nexport const names = {{\n{named}\n}};\n\n{javascript_text(program, stem, role)}"
    tested = _TEST.format(
        main=main,
        role=role.name,
        result=role.result,
        where="" if role is RHS else f".{role.name}",
        a="v.a, " if program.accelerations else "",
    )
    return {f"{main}.mjs": text, f"{main}.test.mjs": tested}


def javascript_functions(program: Program) -> Functions:
    """The program run by node."""
    return functions_by(many_of_module(javascript_text(program), program))


def run(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role) -> Called:
    """The function of the file, run by node."""
    return called_by(many_of_module(str(texts[f"{role.main(stem)}.mjs"]), program))


TARGET = Target(
    "javascript",
    "an ECMAScript module, for browsers and node",
    javascript_text,
    javascript_files,
    ('import {{ rhs }} from "./{stem}_rhs.mjs";', "node --test"),
    javascript_functions,
    run,
)
