"""M, J -> Zeros: which entries of the factors of M and of J take part in a solve.

M = L D L^T has entries of L where M has them and where elimination fills them in; L^-1 J^T has entries
in a row where J has them and, along the partners, in all columns that they reach.
Source: Davis, Direct Methods for Sparse Linear Systems (2006), chapters 3 and 4.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

from eomgen.records import dataclass
from eomgen.symbolic.expression.graph import Scalar, is_zero

MatrixRow = Sequence[Scalar]
PlaceLists = tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class Zeros:
    """Where the factors are not zero.

    Args:
        partners: of each column j of L the rows i > j.
        reach: of each row of J the columns of its row of L^-1 J^T.
    """

    partners: PlaceLists
    reach: PlaceLists

    @cached_property
    def rows(self) -> PlaceLists:
        """Of each column the rows of J that reach it."""
        return tuple(tuple(m for m, row in enumerate(self.reach) if j in row) for j in range(len(self.partners)))

    @cached_property
    def later(self) -> PlaceLists:
        """Of each row of J, in the factor of J M^-1 J^T, the later rows that elimination joins it to."""
        found = [0] * len(self.reach)
        for rows in self.rows:
            mask = mask_of(rows)
            for m in rows:
                found[m] |= _above(mask, m)
        return _filled(found, []).partners

    @property
    def operations(self) -> int:
        """Of M = L D L^T, L^-1 J^T and J M^-1 J^T, of that one factored, and of a solution."""
        degrees = [len(partners) for partners in self.partners]
        factor = sum(d * d + 2 * d for d in degrees)
        border = sum(2 * degrees[j] + 5 for row in self.reach for j in row)
        multipliers = sum(len(rows) * (len(rows) + 2) for rows in self.rows)
        multipliers += sum(d * d + 2 * d + 2 for d in map(len, self.later))
        return factor + border + multipliers + self.more

    @property
    def more(self) -> int:
        """Of a solution by the factors; with rows of J of two, and of what the first leaves."""
        degrees, touched = [len(partners) for partners in self.partners], sum(map(len, self.reach))
        once = sum(4 * d + 2 for d in degrees) + sum(4 * len(later) + 1 for later in self.later) + 4 * touched
        left = sum(4 * d + 2 for d in degrees) + 4 * touched
        return 2 * once + left if self.reach else once


def zeros_of(M: Sequence[MatrixRow], J: Sequence[MatrixRow]) -> Zeros:
    """Where the factors of M, eliminated in the order of its rows, and L^-1 J^T are not zero.

    Args:
        M: symmetric, n x n; structural zeros are the number 0.
        J: k x n.
    """
    return _filled(_later(M), _touched(J))


def zeros_with_ties(M: Sequence[MatrixRow], J: Sequence[MatrixRow]) -> Zeros:
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
