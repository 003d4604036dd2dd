"""How independent the closing rows are along a motion: where they come to depend on one another, it may branch."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from eomgen.symbolic.numeric.dense import divisor

SHARE = 0.1  # of a row's part in the combination that vanishes, above which its tie is named


@dataclass(frozen=True)
class ConstraintRank:
    """The closing rows J of a system.

    Args:
        rows: (t n, x n x states) -> J, n x (k nu).
        ties: the tie of each row, k.
        rank: how many rows are independent at almost every state.
    """

    rows: Callable[[np.ndarray, np.ndarray], np.ndarray]
    ties: tuple[str, ...]
    rank: int

    def __call__(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """The singular value of J that vanishes where the rank falls, each row against its greatest length, n x 1."""
        return np.linalg.svd(self._scaled(t, x), compute_uv=False)[:, self.rank - 1 : self.rank]

    def words(self, t: np.ndarray, x: np.ndarray) -> str:
        """Which ties depend on one another at the worst of the states."""
        J = self._scaled(t, x)
        worst = int(np.argmin(np.linalg.svd(J, compute_uv=False)[:, self.rank - 1]))
        shares = np.abs(np.linalg.svd(J[worst])[0][:, self.rank - 1])
        names = dict.fromkeys(tie for tie, share in zip(self.ties, shares, strict=True) if share > SHARE)
        listed = ", ".join(f"'{name}'" for name in names)
        return f"{listed} {'does' if len(names) == 1 else 'do'} not determine the motion"

    def least(self, t: np.ndarray, x: np.ndarray, lengths: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
        """(the same singular value at n states, n x 1, the greatest lengths of the rows, which it is against).

        Args:
            lengths: the greatest so far, k x 1.
        """
        J = self.J(t, x)
        greatest: np.ndarray = np.maximum(lengths, _lengths(J))
        return np.linalg.svd(J / divisor(greatest), compute_uv=False)[:, self.rank - 1 : self.rank], greatest

    def J(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """J at n states, n x k x nu; 0 where it has no value."""
        values = self.rows(t, x)
        known = np.isfinite(values)
        return (values if known.all() else np.where(known, values, 0.0)).reshape(len(t), len(self.ties), -1)

    def _scaled(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        J = self.J(t, x)
        return J / divisor(_lengths(J))


def _lengths(J: np.ndarray) -> np.ndarray:
    found: np.ndarray = np.sqrt(np.einsum("nkj,nkj->nk", J, J)).max(axis=0, initial=0.0)[:, None]
    return found
