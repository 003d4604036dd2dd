"""M, F -> a with M a = F, written out: the factors of M and of J M^-1 J^T, their zeros left out.

M, F -> a with M a = F, written out: M = L^T D L on the graph, without an inverse.

Eliminating leaves first leaves a tree's zeros where they are (Featherstone, Rigid Body Dynamics
Algorithms, 2008, section 6.5): joints on different branches never meet.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.symbolic.expression import Scalar, is_zero, over


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
                fix="give every body that moves a mass, and every one that turns a moment of inertia",
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


# -------- sparsity --------------------------------------------------------------------------------------------
# M, J -> Zeros: which entries of the factors of M and of J take part in a solve.
#
# M = L D L^T has entries of L where M has them and where elimination fills them in; L^-1 J^T has entries in a row
# where J has them and, along the partners, in all columns that they reach. Source: Davis, Direct Methods for Sparse
# Linear Systems (2006), chapters 3 and 4.


MatrixRow = Sequence[Scalar]
PlaceLists = tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class Zeros:
    """Places of the factors' entries that are not zero.

    Args:
        partners: of each column j of L the rows i > j.
        reach: of each row of J the columns of its row of L^-1 J^T.
    """

    partners: PlaceLists
    reach: PlaceLists

    @cached_property
    def rows(self) -> PlaceLists:
        """The rows of J that reach each column."""
        return tuple(tuple(m for m, row in enumerate(self.reach) if j in row) for j in range(len(self.partners)))

    @cached_property
    def later(self) -> PlaceLists:
        """The later rows to which elimination joins each row of J in the factor of J M^-1 J^T."""
        found = [0] * len(self.reach)
        for rows in self.rows:
            mask = mask_of(rows)
            for m in rows:
                found[m] |= _above(mask, m)
        return _filled(found, []).partners

    @property
    def operations(self) -> int:
        """Number of operations of M = L D L^T, L^-1 J^T, J M^-1 J^T and its factors, and of a solution."""
        degrees = [len(partners) for partners in self.partners]
        factor = sum(d * d + 2 * d for d in degrees)
        border = sum(2 * degrees[j] + 5 for row in self.reach for j in row)
        multipliers = sum(len(rows) * (len(rows) + 2) for rows in self.rows)
        multipliers += sum(d * d + 2 * d + 2 for d in map(len, self.later))
        return factor + border + multipliers + self.more

    @property
    def more(self) -> int:
        """Number of operations of a solution by the factors; with rows of J of two, and of what the first leaves."""
        degrees, touched = [len(partners) for partners in self.partners], sum(map(len, self.reach))
        once = sum(4 * d + 2 for d in degrees) + sum(4 * len(later) + 1 for later in self.later) + 4 * touched
        left = sum(4 * d + 2 for d in degrees) + 4 * touched
        return 2 * once + left if self.reach else once

    @classmethod
    def of(cls, M: Sequence[MatrixRow], J: Sequence[MatrixRow]) -> Zeros:
        """Places of the entries that are not zero in the factors of M, eliminated in row order, and in L^-1 J^T.

        Args:
            M: symmetric, n x n; structural zeros are the number 0.
            J: k x n.
        """
        return _filled(_later(M), _touched(J))

    @classmethod
    def with_constraints(cls, M: Sequence[MatrixRow], J: Sequence[MatrixRow]) -> Zeros:
        """The same of M + J^T W J with any diagonal W."""
        later, touched = _later(M), _touched(J)
        for row in touched:
            for j in members(row):
                later[j] |= _above(row, j)
        return _filled(later, touched)


def mask_of(places: Iterable[int]) -> int:
    """A set of places as the bits of a number: united and counted at once."""
    return sum(1 << i for i in places)


def members(mask: int) -> list[int]:
    """The places in a mask, in their order."""
    return [i for i, bit in enumerate(reversed(f"{mask:b}")) if bit == "1"]


def _above(mask: int, j: int) -> int:
    return mask >> (j + 1) << (j + 1)


def _later(M: Sequence[MatrixRow]) -> list[int]:
    n = len(M)
    return [mask_of(i for i in range(j + 1, n) if not is_zero(M[j][i])) for j in range(n)]


def _touched(J: Sequence[MatrixRow]) -> list[int]:
    return [mask_of(i for i, x in enumerate(row) if not is_zero(x)) for row in J]


def _filled(later: list[int], reach: list[int]) -> Zeros:
    """Eliminating column j joins its partners to one another; a row that has j has its partners too."""
    for j, partners in enumerate(later):
        for i in members(partners):
            later[i] |= _above(partners, i)
        reach = [row | partners if row >> j & 1 else row for row in reach]
    return Zeros(tuple(tuple(members(mask)) for mask in later), tuple(tuple(members(mask)) for mask in reach))
