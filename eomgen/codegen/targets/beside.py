"""A language that runs in a process beside us: states go there as doubles, results come back.

First go the sizes (states, accelerations, parameters, inputs, outputs); then, again and again, (n, whether inputs are
given), p, and n rows of t, x, a and the inputs; back come n rows of outputs.
"""

from __future__ import annotations

import subprocess
import threading
import weakref
from collections.abc import Sequence
from typing import Any

import numpy as np

from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import Many
from eomgen.errors import RunFailed


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
            mend="take --target numpy, or see what is installed: eomgen doctor",
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
        language: as it is told.
        first: what it reads before the sizes.
    Raises:
        RunFailed: when called: it does not take the text.
    """
    return _Process(language, command, first, program).results
