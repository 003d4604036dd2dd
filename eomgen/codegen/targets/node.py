"""Common parts of targets that are ECMAScript modules: their head, their test, and their run by node.

A module exports `constants(p)`, `evaluate(t, x, p, c, inputs)` and the role's function.
"""

from __future__ import annotations

import base64
import json
import shutil
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from eomgen.codegen.program import Program
from eomgen.codegen.statements import Language, one_line
from eomgen.codegen.targets.base import (
    Called,
    Emitted,
    FileContent,
    FileForm,
    Functions,
    Many,
    Role,
    Single,
    Target,
    called_by,
    functions_by,
)
from eomgen.codegen.targets.loading import doubles, many_beside
from eomgen.errors import ToolMissing

_TEST = """\
// Held against the answers in test_vectors.json: node --test
import assert from "node:assert/strict";
import {{ readFileSync }} from "node:fs";
import {{ test }} from "node:test";
import {{ {role} }} from "./{main}.mjs";

const expected = JSON.parse(readFileSync(new URL("test_vectors.json", import.meta.url), "utf8"));

test("{main} gives the values of its test vectors", () => {{
    for (const [place, v] of expected{of_role}.vectors.entries()) {{
        const found = {role}(v.t, v.x, {a_of_v}v.p, v.inputs);
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
        raise ToolMissing("there is no node to run JavaScript", fix="install node, or choose another target")
    coded = base64.b64encode(text.encode())
    coded += b" " * (-len(coded) % 8)
    return many_beside("node", [node, "-e", _SERVER], program, doubles([len(coded) // 8]) + coded)


def node_form(language: Language, module: str, **words: Any) -> FileForm:
    """The form of an ECMAScript module: STEM_ROLE.mjs, and its test, which `node --test` finds."""
    return FileForm(
        language,
        module,
        "{main}.mjs",
        "{main}.test.mjs",
        "{head}\n\nexport const names = {{\n{names}\n}};\n\n{text}",
        reported=lambda line: f"// {one_line(line)}".rstrip(),
        given={"a_of_v": ("v.a, ", "")},
        keys=("x", "p", "inputs"),
        named="    {key}: [{names}],",
        quoted=json.dumps,
        test=_TEST,
        **words,
    )


FilesBeside = Callable[[str, Program, Role, "Mapping[str, str] | None"], dict[str, FileContent]]
"""(stem, program, role, remarks) -> files that a module needs."""


def node_target(
    name: str,
    language: str,
    form: FileForm,
    use: tuple[str, ...],
    *,
    text: Callable[..., str] | None = None,
    beside: FilesBeside = lambda *_: {},
    alone: Callable[[Mapping[str, FileContent], str], str] = lambda files, main: str(files[f"{main}.mjs"]),
    single: Callable[[Mapping[str, FileContent]], dict[str, FileContent]] | None = None,
) -> Target:
    """A language whose files are ECMAScript modules.

    Args:
        use: its import, and the command that runs its tests.
        text: of a program in the language, where that is not the module.
        beside: the files that the module needs.
        alone: (files, STEM_ROLE) -> the module as it needs no other file.
        single: the files in doubles -> in single precision, where there are such.
    """

    def files(stem: str, emitted: Sequence[Emitted]) -> dict[str, FileContent]:
        further = (beside(stem, program, reported.role, reported.remarks) for program, reported in emitted)
        return form.files(stem, emitted) | {path: content for each in further for path, content in each.items()}

    def functions(program: Program) -> Functions:
        main = Role.RHS.main("eomgen")
        made = {f"{main}.mjs": form.text(program, "eomgen"), **beside("eomgen", program, Role.RHS, None)}
        return functions_by(many_of_module(alone(made, main), program))

    def run(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role) -> Called:
        return called_by(many_of_module(alone(texts, role.main(stem)), program))

    return Target(name, language, text or form.text, files, use, functions, run, single=single and Single(single, run))
