"""M, F -> a with M a = F, written out: M = L^T D L on the graph, without an inverse.

Eliminating leaves first leaves a tree's zeros where they are (Featherstone, Rigid Body Dynamics
Algorithms, 2008, section 6.5): joints on different branches never meet.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from eomgen.errors import DerivationError
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.solve.sparsity import MatrixRow, mask_of, members


def factor_solution(M: Sequence[MatrixRow], F: MatrixRow) -> tuple[Scalar, ...]:
    """The accelerations a of M a = F, as expressions.

    M = L^T D L,  L^T z = F,  a = L^-1 D^-1 z

    Args:
        M: symmetric and positive definite, n x n; structural zeros are the number 0.
        F: n.
    Raises:
        DerivationError: a pivot is the number 0: some coordinate moves no mass.
    """
    rows: list[list[Any]] = [list(row) for row in M]
    z: list[Any] = list(F)
    pivots = elimination_order(M)
    for k in pivots:
        if is_zero(rows[k][k]):
            raise DerivationError(
                f"the mass matrix is singular: row {k + 1} has no inertia left",
                mend="give every body that moves a mass, and every one that turns a moment of inertia",
            )
        _eliminate(rows, z, k, _partners(rows, k, pivots))
    a: list[Any] = [0] * len(z)
    for k in reversed(pivots):
        value = z[k]
        for i in _partners(rows, k, pivots):
            value = value - rows[k][i] * a[i]
        a[k] = value
    return tuple(a)


def elimination_order(M: Sequence[MatrixRow]) -> list[int]:
    """Pivots with the fewest partners first (in a tree: leaves), of equal ones the last: least fill."""
    return [k for k, _ in _eliminations(M)]


def operation_count(M: Sequence[MatrixRow]) -> int:
    """About how many operations `factor_solution` takes, from the zeros of M alone.

    Sum over pivots with d partners: d quotients, d (d + 1) in the matrix, 4 d + 1 in the right side.
    """
    return sum(d * (d + 1) + 5 * d + 1 for _, d in _eliminations(M))


def _eliminate(rows: list[list[Any]], z: list[Any], k: int, partners: list[int]) -> None:
    """One step: row k becomes row k of L, the rest of the matrix its Schur complement, z[k] the k-th of D^-1 z."""
    d = rows[k][k]
    factors = [over(rows[k][i], d) for i in partners]
    for i, factor in zip(partners, factors, strict=True):
        for j in partners:
            if j <= i:
                rows[i][j] = rows[j][i] = rows[i][j] - factor * rows[k][j]
        z[i] = z[i] - factor * z[k]
    for i, factor in zip(partners, factors, strict=True):
        rows[k][i] = factor
    z[k] = over(z[k], d)


def _partners(rows: Sequence[MatrixRow], k: int, pivots: list[int]) -> list[int]:
    """The columns of row k that are not zero and not yet eliminated when k is the pivot."""
    return [i for i in pivots[pivots.index(k) + 1 :] if not is_zero(rows[k][i])]


def _eliminations(M: Sequence[MatrixRow]) -> list[tuple[int, int]]:
    """(pivot, number of its partners) in the order of elimination."""
    n = len(M)
    neighbours = [mask_of(i for i in range(n) if i != k and not is_zero(M[k][i])) for k in range(n)]
    remaining = list(range(n))
    chosen = []
    while remaining:
        k = min(remaining, key=lambda i: (neighbours[i].bit_count(), -i))
        remaining.remove(k)
        chosen.append((k, neighbours[k].bit_count()))
        for i in members(neighbours[k]):
            neighbours[i] = (neighbours[i] | neighbours[k]) & ~mask_of((i, k))
    return chosen
