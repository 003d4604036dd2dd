"""The text of an ECMAScript module -> its function, run by node beside us."""

from __future__ import annotations

import base64
import shutil

from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import Many
from eomgen.codegen.targets.beside import doubles, many_beside
from eomgen.errors import ToolMissing

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
