"""Runge-Kutta's tableau, a compiled right-hand side -> one trial step, all its stages in C."""

from __future__ import annotations

import ctypes
import functools
from dataclasses import dataclass
from typing import Any

import numpy as np

from eomgen.codegen.build import function_of, library

TEXT = """#include <stddef.h>

typedef void (*rate)(double t, const double *x, const double *p, const double *c, const double *inputs, double *dx);

/* K[i] = f(t + C[i] h, x + h sum_j A[i][j] K[j]), 0 < i < stages; x_new = x + h sum_j B[j] K[j], K[stages] = f there */
void trial(rate f, size_t n, size_t stages, const double *A, const double *B, const double *C, const double *p,
           const double *c, double t, double h, const double *x, double *x_new, double *K)
{
    for (size_t i = 1; i <= stages; i++) {
        const double *a = i < stages ? A + i*stages : B;
        for (size_t k = 0; k < n; k++) {
            double sum = 0;
            for (size_t j = 0; j < i; j++)
                sum += a[j]*K[j*n + k];
            x_new[k] = x[k] + h*sum;
        }
        f(t + (i < stages ? C[i] : 1)*h, x_new, p, c, NULL, K + i*n);
    }
}
"""


@dataclass(frozen=True)
class Address:
    """Where a compiled right-hand side and its constants lie; `kept` keeps them there.

    Args:
        evaluate: of the function (t, x, p, c, inputs, dx).
        p, c: of its parameters and of what they determine.
    """

    evaluate: int
    p: int
    c: int
    kept: Any


@functools.cache
def _function() -> Any:
    function = function_of(library(TEXT), "trial")
    address, size, real = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_double
    function.argtypes = [address, size, size, *[address] * 5, real, real, *[address] * 3]
    function.restype = None
    return function


class Trial:
    """(t, h, x) -> x after the step h; the rates of all stages are left in K, whose first is there before.

    Args:
        at: the right-hand side.
        A, B, C: the tableau, s x s (columns of zeros may be left out), s, s.
        K: s + 1 x n.
    Raises:
        RunFailed, ToolMissing: as of `library`.
    """

    def __init__(self, at: Address, A: np.ndarray, B: np.ndarray, C: np.ndarray, K: np.ndarray) -> None:
        stages, n = len(K) - 1, K.shape[1]
        whole = np.zeros((stages, stages))
        whole[:, : A.shape[1]] = A
        self._tableau = [whole, *(np.array(part, dtype=float) for part in (B, C))]
        self._at, self._K, self._begin, self._end = at, K, np.zeros(n), np.zeros(n)
        self._function = _function()
        tableau = (part.ctypes.data for part in self._tableau)
        self._fixed = at.evaluate, n, stages, *tableau, at.p, at.c
        self._arrays = self._begin.ctypes.data, self._end.ctypes.data, K.ctypes.data

    def __call__(self, t: float, h: float, x: np.ndarray) -> np.ndarray:
        self._begin[:] = x
        self._function(*self._fixed, t, h, *self._arrays)
        return self._end.copy()
