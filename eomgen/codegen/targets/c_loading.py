"""A compiled program behind ctypes, with as little Python a call as can be."""

from __future__ import annotations

import ctypes
import threading
from typing import Any

import numpy as np

from eomgen.codegen.build import function_of
from eomgen.codegen.program import Program
from eomgen.codegen.targets.base import Address, Functions
from eomgen.frozen import dataclass

_ADDRESS = ctypes.c_void_p


class _Buffers(threading.local):
    """Arrays that the compiled function reads and writes; every thread has its own."""

    def __init__(self, states: int, outputs: int) -> None:
        self.x, self.dx = np.zeros(states), np.zeros(outputs)
        self.x_at, self.dx_at = self.x.ctypes.data, self.dx.ctypes.data


@dataclass(frozen=True)
class _Constants:
    """Parameters and the constants that they determine, with their addresses."""

    p: np.ndarray
    c: np.ndarray
    p_at: int
    c_at: int


def functions_of(library: ctypes.CDLL, program: Program, stem: str, constants: int) -> Functions:
    """The functions of `c_text` as Python's; the number of constants is that of its layout."""
    states, given, outputs = len(program.states), len(program.accelerations), len(program.outputs)
    arrays = 6 if given else 5
    make, evaluate, many = (function_of(library, f"{stem}_{what}") for what in ("constants", "evaluate", "many"))
    make.argtypes, make.restype = [_ADDRESS] * 2, None
    evaluate.argtypes, evaluate.restype = [ctypes.c_double, *[_ADDRESS] * arrays], None
    many.argtypes, many.restype = [ctypes.c_size_t, *[_ADDRESS] * arrays], None
    buffers = _Buffers(states + given, outputs)
    after = states * ctypes.sizeof(ctypes.c_double)  # a stands after x

    def constants_of(p: np.ndarray) -> _Constants:
        p, c = np.array(p, dtype=float), np.zeros(constants)
        make(p.ctypes.data, c.ctypes.data)
        return _Constants(p, c, p.ctypes.data, c.ctypes.data)

    def one(t: float, x: Any, known: _Constants, inputs: Any) -> np.ndarray:
        own = buffers
        own.x[:] = x
        acting = None if inputs is None else np.array(inputs, dtype=float)
        at = None if acting is None else acting.ctypes.data
        if given:
            evaluate(t, own.x_at, own.x_at + after, known.p_at, known.c_at, at, own.dx_at)
        else:
            evaluate(t, own.x_at, known.p_at, known.c_at, at, own.dx_at)
        return own.dx.copy()

    def all_of(t: np.ndarray, x: np.ndarray, p: np.ndarray, inputs: np.ndarray | None) -> np.ndarray:
        dx = np.empty((len(t), outputs))
        at = None if inputs is None else inputs.ctypes.data
        parts = [np.ascontiguousarray(part) for part in np.hsplit(x, [states])] if given else [x]
        many(len(t), t.ctypes.data, *(part.ctypes.data for part in parts), p.ctypes.data, at, dx.ctypes.data)
        return dx

    def address(known: _Constants) -> Address:
        entry, making = (ctypes.cast(function, _ADDRESS).value or 0 for function in (evaluate, make))
        return Address(entry, known.p_at, known.c_at, making, (library, known))

    return Functions(constants_of, one, all_of, None if given else address)
