"""The text of an ECMAScript module -> its functions, run by node beside us: states go there, results come back."""

from __future__ import annotations

import base64
import shutil
import subprocess
import threading
import weakref
from typing import Any

import numpy as np

from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import Functions
from eomgen.errors import RunFailed, ToolMissing

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
        for (let i = 0; i < n; i++) {
            const [t] = take(1), x = take(states), a = accelerations ? [take(accelerations)] : [];
            all.set(evaluate(t, x, ...a, p, c, given ? take(inputs) : null), i*outputs);
        }
        const bytes = new Uint8Array(all.buffer);
        for (let at = 0; at < bytes.length;) at += writeSync(1, bytes, at);
    }
}
serve();
"""


class _Module:
    """One module in a node process of its own; safe to call from several threads."""

    def __init__(self, text: str, program: Program) -> None:
        node = shutil.which("node")
        if node is None:
            raise ToolMissing("there is no node to run JavaScript", mend="install node, or choose another target")
        symbols, self._outputs = program.symbols, len(program.outputs)
        self._lock = threading.Lock()
        self._process = subprocess.Popen(
            [node, "-e", _SERVER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        weakref.finalize(self, _ended, self._process)
        coded = base64.b64encode(text.encode())
        coded += b" " * (-len(coded) % 8)
        sizes = (len(program.states), len(program.accelerations), len(symbols.parameters), len(symbols.inputs))
        self._send(_doubles([len(coded) // 8]) + coded + _doubles([*sizes, self._outputs]))

    def results(self, p: np.ndarray, rows: np.ndarray, given: bool) -> np.ndarray:
        """The outputs at n states; rows of t, x, a, and inputs where they are given."""
        with self._lock:
            self._send(_doubles([len(rows), float(given)]) + _doubles(p) + _doubles(rows))
            size = 8 * len(rows) * self._outputs
            assert self._process.stdout is not None
            back = self._process.stdout.read(size) if size else b""
            if len(back) < size:
                self._failed()
        return np.frombuffer(back).reshape(len(rows), self._outputs).copy()

    def _send(self, data: bytes) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(data)
            self._process.stdin.flush()
        except BrokenPipeError:
            self._failed()

    def _failed(self) -> None:
        assert self._process.stderr is not None
        lines = self._process.stderr.read().decode(errors="replace").strip().splitlines()
        raise RunFailed("node could not run the emitted code: " + (lines[-1] if lines else "it ended"))


def _ended(process: subprocess.Popen[bytes]) -> None:
    """The process with its streams closed."""
    process.kill()
    process.communicate()


def _doubles(values: Any) -> bytes:
    return np.ascontiguousarray(values, dtype=float).tobytes()


def module_functions(text: str, program: Program) -> Functions:
    """The functions of a module that exports `constants` and `evaluate`.

    Raises:
        ToolMissing: there is no node.
        RunFailed: node does not take the text.
    """
    module = _Module(text, program)

    def many(t: Any, x: Any, p: Any, inputs: Any) -> np.ndarray:
        rows = [np.asarray(t, dtype=float)[:, None], x, *([] if inputs is None else [inputs])]
        return module.results(p, np.hstack(rows), inputs is not None)

    def one(t: float, x: Any, p: Any, inputs: Any) -> np.ndarray:
        row = np.array([[t, *x, *(() if inputs is None else inputs)]], dtype=float)
        found: np.ndarray = module.results(p, row, inputs is not None)[0]
        return found

    return Functions(lambda p: np.array(p, dtype=float), one, many)
