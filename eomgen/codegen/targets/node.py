"""What targets that are ECMAScript modules share: their head, their test, and how node runs them beside us.

A module exports `constants(p)`, `evaluate(t, x, p, c, inputs)` and the role's function.
"""

from __future__ import annotations

import base64
import json
import shutil
from collections.abc import Callable, Mapping, Sequence

from eomgen.codegen.lowered import one_line
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import (
    RHS,
    Called,
    Description,
    Emitted,
    FileContent,
    Functions,
    Many,
    Role,
    Single,
    Target,
    called_by,
    functions_by,
    header,
)
from eomgen.codegen.targets.beside import doubles, many_beside
from eomgen.errors import ToolMissing

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

_SERVER = """
const { readSync, writeSync } = require("node:fs");
function take(count) {
    const bytes = Buffer.alloc(8*count);
    for (let at = 0; at < bytes.length;) {
        const n = readSync(0, bytes, at, bytes.length - at);
        if (n === 0) process.exit(0);
        at += n;
    }
    return new Float64Array(bytes.buffer, 0, count);
}
async function serve() {
    const text = Buffer.from(take(take(1)[0]).buffer).toString("latin1").trimEnd();
    const { constants, evaluate } = await import("data:text/javascript;base64," + text);
    const [states, accelerations, parameters, inputs, outputs] = take(5);
    for (;;) {
        const [n, given] = take(2), p = take(parameters), c = constants(p), all = new Float64Array(n*outputs);
        const moving = 1 + states + accelerations, width = moving + (given ? inputs : 0), rows = take(n*width);
        for (let i = 0; i < n; i++) {
            const row = rows.subarray(i*width, (i + 1)*width), x = row.subarray(1, 1 + states);
            const a = accelerations ? [row.subarray(1 + states, moving)] : [];
            all.set(evaluate(row[0], x, ...a, p, c, given ? row.subarray(moving) : null), i*outputs);
        }
        const bytes = new Uint8Array(all.buffer);
        for (let at = 0; at < bytes.length;) at += writeSync(1, bytes, at);
    }
}
serve();
"""


def many_of_module(text: str, program: Program) -> Many:
    """The function of a module that exports `constants` and `evaluate`.

    Raises:
        ToolMissing: there is no node.
        RunFailed: when called: node does not take the text.
    """
    node = shutil.which("node")
    if node is None:
        raise ToolMissing("there is no node to run JavaScript", mend="install node, or choose another target")
    coded = base64.b64encode(text.encode())
    coded += b" " * (-len(coded) % 8)
    return many_beside("node", [node, "-e", _SERVER], program, doubles([len(coded) // 8]) + coded)


def node_target(
    name: str,
    language: str,
    text: Callable[..., str],
    written: Callable[[str, Program, Description], dict[str, FileContent]],
    use: tuple[str, ...],
    alone: Callable[[Mapping[str, FileContent], str], str] | None = None,
    single: Callable[[Mapping[str, FileContent]], dict[str, FileContent]] | None = None,
) -> Target:
    """A language whose files are ECMAScript modules: STEM_ROLE.mjs, what it needs beside it, and its test.

    Args:
        text: of a program in the language.
        written: (stem, program, what is told of it) -> {path: content}, STEM_ROLE.mjs the first of them.
        use: how it is imported, and what runs its tests.
        alone: (files, STEM_ROLE) -> the module as it needs no file beside it; None where it never does.
        single: the files in doubles -> in single precision, where there are such.
    """

    def module(files: Mapping[str, FileContent], main: str) -> str:
        return alone(files, main) if alone else str(files[f"{main}.mjs"])

    def files(stem: str, emitted: Sequence[Emitted]) -> dict[str, FileContent]:
        return {
            path: content
            for program, told in emitted
            for path, content in _module_files(written(stem, program, told), stem, program, told).items()
        }

    def functions(program: Program) -> Functions:
        made = written("eomgen", program, Description("", "", {}))
        return functions_by(many_of_module(module(made, RHS.main("eomgen")), program))

    def run(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role) -> Called:
        return called_by(many_of_module(module(texts, role.main(stem)), program))

    return Target(name, language, text, files, use, functions, run, single=single and Single(single, run))


def _module_files(
    made: dict[str, FileContent], stem: str, program: Program, told: Description
) -> dict[str, FileContent]:
    """The module with its head, what stands beside it, and its test, which `node --test` finds."""
    role, main = told.role, told.role.main(stem)
    head = "\n".join(f"// {one_line(line)}".rstrip() for line in header(program, told))
    listed = {
        "x": [x.name for x in program.states],
        "p": list(program.symbols.parameters),
        "inputs": list(program.symbols.inputs),
    }
    loaded = str(made[f"{main}.mjs"])
    named = "\n".join(f"    {key}: {json.dumps(names)}," for key, names in listed.items())
    text = f"{head}\n\nexport const names = {{\n{named}\n}};\n\n{loaded}"
    tested = _TEST.format(
        main=main,
        role=role.name,
        result=role.result,
        where="" if role is RHS else f".{role.name}",
        a="v.a, " if program.accelerations else "",
    )
    return made | {f"{main}.mjs": text, f"{main}.test.mjs": tested}
