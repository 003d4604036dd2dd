"""Linear systems of numbers -> solutions, where rows and columns have units of their own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.symbolic.numeric import tolerances

SWEEPS = 8  # of scaling; each takes the square root of what is left


def independent(J: np.ndarray, *, smallest: float) -> bool:
    """True if no row of J is a combination of the others."""
    return rank(J, smallest=smallest) == len(J)


def rank(A: np.ndarray, *, smallest: float = tolerances.RANK) -> int:
    """Number of singular values of the scaled A above `smallest`."""
    return int(np.linalg.matrix_rank(balanced(A)[0], tol=smallest)) if A.size else 0


def lengths_of(A: np.ndarray, axis: int | None = None, *, keepdims: bool = False) -> np.ndarray:
    """Euclidean lengths of the columns (axis 0), of the rows (axis 1) or of all together: |2^e a| = 2^e |a|.

    Whatever their size: no square is beyond doubles, where numpy's norm of 1e200 is infinite and of 1e-200 is 0.
    """
    _, powers = np.frexp(np.max(np.abs(A), axis=axis, keepdims=True, initial=0.0))
    found: np.ndarray = np.ldexp(np.linalg.norm(np.ldexp(A, -powers), axis=axis, keepdims=True), powers)
    return found if keepdims else np.squeeze(found, axis=axis)


def of_one_length(A: np.ndarray) -> np.ndarray:
    """The rows brought to length 1; those that are rounding are 0."""
    brought: np.ndarray = A / divisor(lengths_of(A, 1, keepdims=True))
    return brought


def divisor(lengths: np.ndarray) -> np.ndarray:
    """The lengths of rows, to divide these by; infinite of rows that are rounding."""
    return np.where(lengths > tolerances.ROUNDING * np.max(lengths, initial=0.0), lengths, np.inf)


def without_noise(A: np.ndarray, share: float, axis: int | None = None) -> np.ndarray:
    """The matrix; entries below that share of the largest, or with axis 1 of the largest in their row, are 0."""
    sizes = abs(A)
    return np.where(sizes > share * np.max(sizes, axis=axis, keepdims=True, initial=0.0), A, 0.0)


def closed_entries(A: np.ndarray) -> np.ndarray:
    """The entries of rows of 50 digits at a place that Newton's method closed; those that are only left of 0 are 0.

    Such a place is known to 28 digits: an entry that vanishes there is 1e-28, and a rank by scaled columns would count
    it. Rows whose entries all are left of 0 are 0 too.
    """
    return without_rounding(without_noise(A, tolerances.ELIMINATED_AT_50, axis=1))


def without_rounding(A: np.ndarray) -> np.ndarray:
    """The matrix; rows that are rounding are 0."""
    return np.where(np.any(of_one_length(A), axis=1, keepdims=True), A, 0.0)


def weighted(M: np.ndarray, J: np.ndarray) -> np.ndarray:
    """M + mean(M_ii) J^T J, rows of J of one length: where J a is given it weighs a alike; M may be 0 along J."""
    rows = of_one_length(J)
    found: np.ndarray = M + np.trace(M) / max(len(M), 1) * rows.T @ rows
    return found


def independent_rows(A: np.ndarray, smallest: float) -> list[int]:
    """The rows that do not follow from those before them: what these leave of a row is more than `smallest` of it."""
    found, Q = [], np.zeros((0, A.shape[1]))
    for i, row in enumerate(of_one_length(A)):
        left = row - Q.T @ (Q @ row)
        left = left - Q.T @ (Q @ left)  # once more, for what rounding left
        size = float(np.linalg.norm(left))
        if size > smallest * float(np.linalg.norm(row)):
            Q = np.vstack([Q, left / size])
            found.append(i)
    return found


def sparse_rank(rows: Sequence[Mapping[int, Any]]) -> int:
    """Number of independent rows {column: number of 50 digits}."""
    left = [dict(row) for row in rows]
    rank = 0
    while left:
        row = max(left, key=lambda line: max(map(abs, line.values()), default=0))
        left.remove(row)
        column = max(row, key=lambda k: abs(row[k]), default=None)
        if column is None or abs(row[column]) < tolerances.ZERO_AT_50:
            break
        rank += 1
        for other in left:
            if column in other:
                factor = other.pop(column) / row[column]
                for k, x in row.items():
                    if k != column:
                        other[k] = other.get(k, 0) - factor * x
    return rank


def follows_in_digits(rows: Sequence[Sequence[Any]], row: Sequence[Any]) -> bool:
    """True if a row of numbers of 50 digits is a combination of others (`arithmetic.follows` in the reals)."""
    others = [_of_size_one(each) for each in rows]
    return sparse_rank([*others, _of_size_one(row)]) == sparse_rank(others)


def _of_size_one(row: Sequence[Any]) -> dict[int, Any]:
    """The row over its largest entry; {} of one that is rounding."""
    largest = max(map(abs, row), default=0)
    return {k: x / largest for k, x in enumerate(row)} if largest > tolerances.ZERO_AT_50 else {}


def scaled_condition(M: np.ndarray) -> float:
    """Condition number (1-norm) of M_ij / sqrt(M_ii M_jj): that of a mass matrix whatever its coordinates' units."""
    scale = _roots(abs(np.diagonal(M)))
    return float(np.linalg.cond(M / np.outer(scale, scale), 1))


def balanced(A: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(D A E, D, E) with the largest entry of every row and column of D A E near 1.

    Source: D. Ruiz, A scaling algorithm to equilibrate both rows and columns norms, RAL-TR-2001-034.
    """
    rows, columns = np.ones(A.shape[0]), np.ones(A.shape[1])
    for _ in range(SWEEPS):
        size = abs(A * rows[:, None] * columns)
        rows = rows / _roots(size.max(axis=1, initial=0))
        columns = columns / _roots(size.max(axis=0, initial=0))
    return A * rows[:, None] * columns, rows, columns


def _roots(sizes: np.ndarray) -> np.ndarray:
    """Square roots; 1 for what is zero."""
    return np.sqrt(np.where(sizes > 0, sizes, 1))
