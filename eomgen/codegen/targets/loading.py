"""Compiled functions behind ctypes, and languages that run in a process of their own."""

from __future__ import annotations

import ctypes
import re
import subprocess
import threading
import weakref
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from eomgen.codegen.build import Compiler, function_of, library
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import (
    Called,
    Emitted,
    FileContent,
    FileForm,
    Functions,
    Many,
    Role,
    Single,
    SingleWords,
    Target,
    called_by,
    functions_by,
)
from eomgen.errors import RunFailed

# -------- library call ----------------------------------------------------------------------------------------
# A compiled function of many instants behind ctypes: what every compiled language but C shares.
#
#     void eomgen_many(size_t n, const double *t, const double *x, const double *p, const double *inputs, double *out)
#
# x has a after it in each row, where a is an argument; inputs NULL: the model's own.


ENTRY = "eomgen_many"
INCLUDED = re.compile(r'#include "(.+)"\n')


def many_of(text: str, program: Program, by: Compiler, *, quickly: bool = False, real: Any = np.float64) -> Many:
    """The function, compiled; `real` is the type of its numbers.

    Raises:
        ToolMissing, RunFailed: as of `library`.
    """
    made, outputs = library(text, quickly=quickly, by=by), len(program.outputs)
    function = function_of(made, ENTRY, by)
    function.argtypes, function.restype = [ctypes.c_size_t, *[ctypes.c_void_p] * 5], None

    def many(t: np.ndarray, x: np.ndarray, p: np.ndarray, inputs: np.ndarray | None) -> np.ndarray:
        out: np.ndarray = np.empty((len(t), outputs), dtype=real)
        t, x, p = (np.ascontiguousarray(part, dtype=real) for part in (t, x, p))
        given: np.ndarray | None = None if inputs is None else np.ascontiguousarray(inputs, dtype=real)
        function(
            len(t), t.ctypes.data, x.ctypes.data, p.ctypes.data, None if given is None else given.ctypes.data,
            out.ctypes.data,
        )  # fmt: skip
        return out

    return many


def compiled_target(
    name: str, language: str, form: FileForm, use: tuple[str, ...], *, entry: str, size: str, by: Compiler,
    single: SingleWords, files: Callable[[str, Sequence[Emitted]], dict[str, FileContent]] | None = None,
    load: Callable[[Program], Functions] | None = None,
) -> Target:  # fmt: skip
    """A language whose texts become libraries.

    Args:
        use, files, load: as of Target; without files those of the form, loaded by the function above.
        entry: a {text} with the function above, by the words of the form.
        size: pattern of the number of constants in the text.
        by: its compiler.
        single: its words in single precision.
    """

    def many(text: str, program: Program, stem: str, role: Role, **how: Any) -> Many:
        found = re.search(size, text)
        assert found is not None
        words = form.words(program, stem, role) | {"entry": ENTRY, "size": found[1], "text": text}
        whole, real = entry.format(**words), how.get("real", np.float64)
        return many_of(whole if real is np.float64 else single.text(whole), program, by, **how)

    def loaded(program: Program) -> Functions:
        return functions_by(many(form.text(program, "eomgen"), program, "eomgen", Role.RHS))

    def run(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role, **how: Any) -> Called:
        text = INCLUDED.sub(lambda found: str(texts[found[1]]), str(texts[form.path_of(program, stem, role)]))
        return called_by(many(text, program, stem, role, quickly=True, **how))

    in_single = Single(single.files, partial(run, real=np.float32))
    return Target(name, language, form.text, files or form.files, use, load or loaded, run, single=in_single)


# -------- other processes -------------------------------------------------------------------------------------
# A language that runs in a process of its own: states go there as doubles, results come back.
#
# First go the sizes (states, accelerations, parameters, inputs, outputs); then, again and again, (n, whether inputs
# are given), p, and n rows of t, x, a and the inputs; back come n rows of outputs.


class _Process:
    """One process; safe to call from several threads."""

    def __init__(self, language: str, command: Sequence[str], first: bytes, program: Program) -> None:
        symbols, self._outputs, self._language = program.symbols, len(program.outputs), language
        self._lock = threading.Lock()
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        weakref.finalize(self, _ended, self._process)
        sizes = (len(program.states), len(program.accelerations), len(symbols.parameters), len(symbols.inputs))
        self._send(first + doubles([*sizes, self._outputs]))

    def results(self, t: np.ndarray, x: np.ndarray, p: np.ndarray, inputs: np.ndarray | None) -> np.ndarray:
        """The outputs at n states."""
        rows = np.hstack([np.asarray(t, dtype=float)[:, None], x, *([] if inputs is None else [inputs])])
        with self._lock:
            self._send(doubles([len(rows), float(inputs is not None)]) + doubles(p) + doubles(rows))
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
        raise RunFailed(
            f"{self._language} could not run the emitted code: " + (lines[-1] if lines else "it ended"),
            fix="take --target numpy, or see what is installed: eomgen doctor",
        )


def _ended(process: subprocess.Popen[bytes]) -> None:
    """The process with its streams closed."""
    process.kill()
    process.communicate()


def doubles(values: Any) -> bytes:
    """Numbers as they go through the pipe."""
    return np.ascontiguousarray(values, dtype=float).tobytes()


def many_beside(language: str, command: Sequence[str], program: Program, first: bytes = b"") -> Many:
    """The function that a process serves.

    Args:
        language: its name in messages.
        first: bytes that it reads before the sizes.
    Raises:
        RunFailed: when called: it does not take the text.
    """
    return _Process(language, command, first, program).results
