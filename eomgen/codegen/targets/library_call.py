"""A compiled function of many instants behind ctypes: what every compiled language but C shares.

    void eomgen_many(size_t n, const double *t, const double *x, const double *p, const double *inputs, double *out)

x has a after it in each row, where a is an argument; inputs NULL: the model's own.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.codegen.build import Compiler, function_of, library
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import (
    RHS,
    Called,
    Emitted,
    FileContent,
    Functions,
    Many,
    Role,
    Single,
    Target,
    called_by,
    functions_by,
)
from eomgen.codegen.targets.in_single import SingleWords

ENTRY = "eomgen_many"


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
    name: str,
    language: str,
    text: Callable[[Program, str, Role], str],
    files: Callable[[str, Sequence[Emitted]], dict[str, FileContent]],
    use: tuple[str, ...],
    *,
    source: str,
    called: Callable[[str, Program, str, Role], str],
    by: Compiler,
    single: SingleWords,
) -> Target:
    """A language whose texts become libraries.

    Args:
        text, files, use: as of Target.
        source: the path of a function's text among its files, with {main}, {stem} and {role}.
        called: (text, program, stem, role) -> it with the function above.
        by: what compiles it.
        single: its words in single precision.
    """

    def load(program: Program) -> Functions:
        whole = called(text(program, "eomgen", RHS), program, "eomgen", RHS)
        return functions_by(many_of(whole, program, by))

    def run(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role) -> Called:
        path = source.format(main=role.main(stem), stem=stem, role=role.name)
        return called_by(many_of(called(str(texts[path]), program, stem, role), program, by, quickly=True))

    def run_single(texts: Mapping[str, FileContent], program: Program, stem: str, role: Role) -> Called:
        path = source.format(main=role.main(stem), stem=stem, role=role.name)
        whole = single.text(called(str(texts[path]), program, stem, role))
        return called_by(many_of(whole, program, by, quickly=True, real=np.float32))

    return Target(name, language, text, files, use, load, run, single=Single(single.files, run_single))


def sizes(program: Program, role: Role, stem: str) -> dict[str, object]:
    """What stands in templates: names, and how many there are of each."""
    given = len(program.accelerations)
    return {
        "main": role.main(stem),
        "stem": stem,
        "role": role.name,
        "result": role.result,
        "states": len(program.states),
        "accelerations": given,
        "moving": len(program.moving),
        "parameters": len(program.symbols.parameters),
        "inputs": len(program.symbols.inputs),
        "outputs": len(program.outputs),
        "entry": ENTRY,
    }
