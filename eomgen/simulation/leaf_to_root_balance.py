"""Equations of bodies -> an order in which they give the unknowns: body by body from the leaves inwards.

A body on which few enough reactions are still unknown gives these from its own rows; what loops leave is solved as one.

    A_gk rho_k = b_g - A_gl rho_l      rows g of one body, columns k still open there, l known already
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from eomgen.records import dataclass
from eomgen.symbolic.numeric.tolerances import RANK_NEARBY


@dataclass(frozen=True)
class BodyBalance:
    """Rows that give columns, once `known` columns are.

    Args:
        rows, columns, known: indices.
    """

    rows: np.ndarray
    columns: np.ndarray
    known: np.ndarray


def steps_of(A: np.ndarray, stands: np.ndarray, groups: Iterable[Sequence[int]]) -> tuple[BodyBalance, ...]:
    """The order for matrices of one pattern.

    Args:
        A: one of them, rows x columns, which says what blocks are regular.
        stands: where entries can be, rows x columns.
        groups: the rows of each body.
    """
    left, open_ = [np.array(group) for group in groups], np.ones(A.shape[1], dtype=bool)
    steps: list[BodyBalance] = []
    while (k := next((k for k, group in enumerate(left) if _gives(A, stands, group, open_)), None)) is not None:
        steps.append(_step(stands, left.pop(k), open_))
        open_[steps[-1].columns] = False
    core = np.concatenate([np.zeros(0, dtype=int), *left])
    return (*steps, BodyBalance(core, np.flatnonzero(open_), np.flatnonzero(stands[core].any(axis=0) & ~open_)))


def _gives(A: np.ndarray, stands: np.ndarray, group: np.ndarray, open_: np.ndarray) -> bool:
    """Whether the rows determine what is open in them."""
    columns = np.flatnonzero(stands[group].any(axis=0) & open_)
    if not 0 < len(columns) <= len(group):
        return False
    block = A[np.ix_(group, columns)]
    return bool(_regular(np.asarray(np.linalg.qr(block, mode="r"))[None], block[None])[0])


def _step(stands: np.ndarray, rows: np.ndarray, open_: np.ndarray) -> BodyBalance:
    touched = stands[rows].any(axis=0)
    return BodyBalance(rows, np.flatnonzero(touched & open_), np.flatnonzero(touched & ~open_))


def balanced_from_leaves(A: np.ndarray, b: np.ndarray, steps: Iterable[BodyBalance]) -> tuple[np.ndarray, np.ndarray]:
    """(rho, whether every block was regular) of m systems A rho = b."""
    rho, regular = np.zeros((len(A), A.shape[2])), np.ones(len(A), dtype=bool)
    for step in steps:
        block = A[:, step.rows][:, :, step.columns]
        right = b[:, step.rows] - (A[:, step.rows][:, :, step.known] @ rho[:, step.known, None])[:, :, 0]
        R = np.asarray(np.linalg.qr(np.concatenate([block, right[:, :, None]], axis=2), mode="r"))
        size = len(step.columns)
        regular &= _regular(R, block)
        upper = np.where(regular[:, None, None], R[:, :size, :size], np.eye(size))
        rho[:, step.columns] = np.linalg.solve(upper, R[:, :size, size:])[:, :, 0]
    return rho, regular


def _regular(R: np.ndarray, block: np.ndarray) -> np.ndarray:
    """Of each system whether no column follows from those before it."""
    size = block.shape[2]
    pivots = np.abs(np.diagonal(R[:, :size, :size], axis1=1, axis2=2))
    if pivots.shape[1] < size:
        return np.zeros(len(R), dtype=bool)
    found: np.ndarray = (pivots > RANK_NEARBY * np.linalg.norm(block, axis=1)).all(axis=1)
    return found
