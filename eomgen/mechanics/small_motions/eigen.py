"""Matrices of small motions -> eigenvalues and eigenvectors in numbers, and how many eigenvalues are 0.

A_0 x = lambda B_0 x,   A_0 = [F, E; -K, -C],   B_0 = [1, 0; 0, M]
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.mechanics.small_motions.field import Entries
from eomgen.mechanics.small_motions.forms import floats
from eomgen.mechanics.small_motions.polynomial import Polynomial
from eomgen.mechanics.small_motions.reduction import LinearEquations
from eomgen.symbolic.expression.graph import Node
from eomgen.symbolic.numeric import dense
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import (
    COEFFICIENT_AT_50,
    NEARLY_SINGULAR,
    RANK,
    ROUNDING,
    SAME_EIGENVALUE,
    WIDE_SPECTRUM,
)

MOST_BY_DIGITS = 30  # rows of a matrix whose eigenvalues are sought with more digits
DIGITS = 40


def eigenpairs(A: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(lambda, v) of A v = lambda v, the small ones as exact as the large ones."""
    values, vectors = np.linalg.eig(A)
    if not _is_wide(values):
        return values, vectors
    from mpmath import mp

    with mp.workdps(DIGITS):
        E, V = mp.eig(mp.matrix(A.tolist()))
        return np.array([complex(x) for x in E]), _as_floats(V, complex)


def squares_of(M: np.ndarray, K: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(w^2, v) of K v = w^2 M v, both symmetric: A y = w^2 y of A = L^-1 K L^-T, M = L L^T, v = L^-T y."""
    M, K = (M + M.T) / 2, (K + K.T) / 2
    lower = np.linalg.cholesky(M)
    A = np.linalg.solve(lower, np.linalg.solve(lower, K).T)
    squares, vectors = np.linalg.eigh((A + A.T) / 2)
    if not _is_wide(squares):
        return squares, np.linalg.solve(lower.T, vectors)
    from mpmath import mp

    with mp.workdps(DIGITS):
        L = mp.inverse(mp.cholesky(mp.matrix(M.tolist())))
        E, V = mp.eigsy(L * mp.matrix(K.tolist()) * L.T)
        return np.array([float(x) for x in E]), _as_floats(L.T * V, float)


def _is_wide(values: np.ndarray) -> bool:
    sizes = abs(values)
    return 1 < len(values) <= MOST_BY_DIGITS and sizes.min() < WIDE_SPECTRUM * sizes.max()


def _as_floats(A: Any, kind: type) -> np.ndarray:
    """The columns, each with the largest entry of size 1."""
    found = np.array([[kind(A[i, j]) for j in range(A.cols)] for i in range(A.rows)])
    return np.asarray(found / abs(found).max(axis=0))


# -- zeros ---------------------------------------------------------------------------------------------------------


def count_of_zeros(e: LinearEquations, polynomial: Polynomial | None, trial: Mapping[Node, Any]) -> int:
    """How many eigenvalues are 0.

    Args:
        polynomial: p(s), where it is known exactly.
        trial: values of the parameters, with 50 digits.
    """
    found = None if polynomial is None else _of_polynomial(e, polynomial, trial)
    return _by_rank(*_pencil(e)) if found is None else found


def _of_polynomial(e: LinearEquations, polynomial: Polynomial, trial: Mapping[Node, Any]) -> int | None:
    """The power of s that p(s) holds as a factor; None where nothing but 0 is left, in which no size can be seen."""
    A, B = _pencil(e)
    largest = abs(np.linalg.eigvals(np.linalg.solve(B, A))).max(initial=0)
    if not largest:
        return None
    unit = fifty_digits().number(1) * float(largest)
    sizes = [abs(c) * unit**k for k, c in enumerate(evaluate(polynomial.coefficients, trial, fifty_digits()))]
    return next((k for k, x in enumerate(sizes) if x > COEFFICIENT_AT_50 * sizes[-1]), None)


def _pencil(e: LinearEquations) -> tuple[np.ndarray, np.ndarray]:
    """(A_0, B_0)"""
    n, m = len(e.coordinates), len(e.speeds)
    M = floats(e.M)  # a light mass counts too
    C, K = (_without_rounding(x, m) for x in (e.C, e.K))
    F, E = (_without_rounding(x, n) for x in (e.F, e.E))
    return np.block([[F, E], [-K, -C]]), np.block([[np.eye(n), np.zeros((n, m))], [np.zeros((m, n)), M]])


def _without_rounding(A: Entries, rows: int) -> np.ndarray:
    found = floats(A) if rows else np.zeros((0, 0))
    return dense.without_noise(found, ROUNDING)


def _by_rank(A: np.ndarray, B: np.ndarray) -> int:
    """The number of chains A x_1 = 0, A x_2 = B x_1, ... that are independent."""
    n, found = len(A), 0
    for k in range(1, n + 1):
        chain = np.kron(np.eye(k), A) - np.kron(np.eye(k, k=1), B)
        missing = k * n - dense.rank(chain, smallest=RANK)
        if missing <= found:
            break
        found = missing
    return found


# -- eigenvalues that are one --------------------------------------------------------------------------------------


def merged(values: np.ndarray) -> np.ndarray:
    """The eigenvalues, those that rounding has drawn apart from one place of the imaginary axis put back on it."""
    values = values.copy()
    for group in _groups(values):
        mean = values[group].mean()
        if len(group) > 1 and abs(mean.real) <= SAME_EIGENVALUE**1.5 * abs(mean):
            values[group] = 1j * values[group].imag
    return values


def _groups(values: Sequence[complex] | np.ndarray) -> list[list[int]]:
    groups: list[list[int]] = []
    for k in np.argsort(np.imag(values), kind="stable"):
        near = [g for g in groups if abs(values[g[-1]] - values[k]) <= SAME_EIGENVALUE * abs(values[k])]
        near[0].append(int(k)) if near else groups.append([int(k)])
    return groups


def defective(e: LinearEquations, values: Sequence[complex]) -> bool:
    """Whether an eigenvalue of the imaginary axis has fewer modes than it counts for."""
    A, B = _pencil(e)
    for group in _groups(values):
        x = 1j * np.mean([values[k].imag for k in group])
        if len(group) > 1 and x.imag > 0 and not any(values[k].real for k in group):
            whole = np.block([[A, x.imag * B], [-x.imag * B, A]])  # of real and imaginary parts
            if len(whole) - dense.rank(whole, smallest=NEARLY_SINGULAR) < 2 * len(group):
                return True
    return False


def drifting(e: LinearEquations, zeros: int) -> np.ndarray | None:
    """The displacements that grow like t: x = x_2 + t x_1 with A x_1 = 0, A x_2 = B x_1; None where there are none.

    A x_2 = B x_1 has a solution where L^T B x_1 = 0, L^T A = 0: with x_1 = N c, A N = 0, that is (L^T B N) c = 0.

    Args:
        zeros: how many eigenvalues are 0.
    """
    A, B = _pencil(e)
    nullity = len(A) - dense.rank(A, smallest=RANK)
    if not 0 < nullity < zeros:
        return None
    U, _, V = np.linalg.svd(A)
    L, N = U[:, -nullity:], V[-nullity:].T
    x = N @ np.linalg.svd(L.T @ B @ N)[2][-1]
    return np.asarray(x[: len(e.coordinates)])
