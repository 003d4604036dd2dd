"""Sparse linear equations over the graph: solved by elimination, dependent unknowns and left-over rows kept.

A pivot must not vanish where the equations hold. Whether an entry does is read off its value at one generic state,
the shadow, which is carried through the elimination beside the expressions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from eomgen.symbolic.graph import Node, Scalar, is_zero

Row = dict[int, Scalar]
Values = Callable[[Sequence[Scalar]], list[Any]]


@dataclass(frozen=True)
class Solution:
    """x of  A x = b,  as far as the rows determine it.

    Args:
        constants: of each unknown that was solved for, x_j = constant - sum of coefficient * x_free.
        shares: the coefficients of the free unknowns, {} where x_j is determined.
        free: the unknowns that stay free: as many as the equations leave undetermined.
        left: right sides of the rows in which no unknown is left: they must vanish.
    """

    constants: dict[int, Scalar]
    shares: dict[int, dict[int, Scalar]]
    free: tuple[int, ...]
    left: tuple[Scalar, ...]

    def determined(self, j: int) -> bool:
        """Whether unknown j has one value only."""
        return j in self.constants and not self.shares[j]


@dataclass
class _Line:
    """One row under elimination: its entries, their shadows, and its right side."""

    entries: Row
    shadow: dict[int, Any]
    right: Scalar


def solved(
    rows: Sequence[Mapping[int, Scalar]], right: Sequence[Scalar], unknowns: int, values: Values,
    *, simple: Callable[[Scalar], int] | None = None, tolerance: float = 1e-20, last: Sequence[int] = (),
) -> Solution:  # fmt: skip
    """The solution of sparse linear equations, sum over j of rows[i][j] x_j = right[i].

    Pivots are plain numbers where there are any, of those the ones that fill in least (Markowitz).

    Args:
        unknowns: how many x there are.
        values: the values of scalars at one generic state, in an arithmetic of many digits.
        simple: a rank of scalars as pivots, 0 the best (None: numbers 0, all else 1).
        tolerance: of shadows against the largest of their row, below which an entry is zero.
        last: unknowns that are taken as pivots only where there is no other.
    """
    lines = _lines(rows, right, values, tolerance)
    simple, late = simple or _number_first, frozenset(last)
    order: list[tuple[int, _Line]] = []
    while (found := _pivot(lines, simple, late)) is not None:
        line, j = found
        lines.remove(line)
        order.append((j, line))
        for other in lines:
            if j in other.entries:
                _subtract(other, line, j, tolerance)
    free = tuple(j for j in range(unknowns) if j not in {pivot for pivot, _ in order})
    constants, shares = _substituted(order, free, tolerance)
    return Solution(constants, shares, free, tuple(line.right for line in lines))


def _lines(rows: Sequence[Mapping[int, Scalar]], right: Sequence[Scalar], values: Values, tolerance: float) -> list[_Line]:
    flat = [entry for row in rows for entry in row.values()]
    shadows = iter(values(flat))
    lines = []
    for row, b in zip(rows, right, strict=True):
        shadow = {j: next(shadows) for j in row}
        largest = max((abs(x) for x in shadow.values()), default=0)
        kept = {j: x for j, x in row.items() if not is_zero(x) and abs(shadow[j]) > tolerance * largest}
        lines.append(_Line(kept, {j: shadow[j] for j in kept}, b))
    return lines


def _number_first(a: Scalar) -> int:
    return 1 if type(a) is Node else 0


def _pivot(lines: list[_Line], simple: Callable[[Scalar], int], late: frozenset[int]) -> tuple[_Line, int] | None:
    """The entry by which the next unknown is eliminated."""
    many: dict[int, int] = {}
    for line in lines:
        for j in line.entries:
            many[j] = many.get(j, 0) + 1
    best, found = None, None
    for line in lines:
        for j, entry in line.entries.items():
            rank = (j in late, simple(entry), (len(line.entries) - 1) * (many[j] - 1))
            if best is None or rank < best:
                best, found = rank, (line, j)
                if rank == (False, 0, 0):
                    return found
    return found


def _subtract(other: _Line, line: _Line, j: int, tolerance: float) -> None:
    """other - factor * line, so that unknown j leaves it."""
    factor = _quotient(other.entries.pop(j), line.entries[j])
    shadow = other.shadow.pop(j) / line.shadow[j]
    other.right = other.right - factor * line.right
    for k, entry in line.entries.items():
        if k == j:
            continue
        before = abs(other.shadow.get(k, 0))
        value = other.shadow.get(k, 0) - shadow * line.shadow[k]
        if abs(value) > tolerance * max(before, abs(shadow * line.shadow[k])):
            other.entries[k] = other.entries.get(k, 0) - factor * entry
            other.shadow[k] = value
        else:
            other.entries.pop(k, None)
            other.shadow.pop(k, None)


def _substituted(
    order: list[tuple[int, _Line]], free: tuple[int, ...], tolerance: float
) -> tuple[dict[int, Scalar], dict[int, dict[int, Scalar]]]:
    """Back substitution: every pivot by the free unknowns alone."""
    constants: dict[int, Scalar] = {}
    shares: dict[int, dict[int, Scalar]] = {}
    shadows: dict[int, dict[int, Any]] = {}
    for j, line in reversed(order):
        right = line.right
        share: dict[int, Scalar] = {}
        shadow: dict[int, Any] = {}
        sizes: dict[int, Any] = {}
        for k, entry in line.entries.items():
            if k == j:
                continue
            if k in constants:
                right = right - entry * constants[k]
                for f, coefficient in shares[k].items():
                    _add(share, shadow, sizes, f, -entry * coefficient, -line.shadow[k] * shadows[k][f])
            else:
                _add(share, shadow, sizes, k, entry, line.shadow[k])
        pivot = line.entries[j]
        constants[j] = _quotient(right, pivot)
        kept = [f for f in share if abs(shadow[f]) > tolerance * sizes[f]]
        shares[j] = {f: _quotient(share[f], pivot) for f in kept}
        shadows[j] = {f: shadow[f] / line.shadow[j] for f in kept}
    return constants, shares


def _add(share: Row, shadow: dict[int, Any], sizes: dict[int, Any], f: int, entry: Scalar, value: Any) -> None:
    share[f] = share[f] + entry if f in share else entry
    shadow[f] = shadow.get(f, 0) + value
    sizes[f] = max(sizes.get(f, 0), abs(value))


def _quotient(a: Scalar, b: Scalar) -> Scalar:
    if type(b) is int and b in (1, -1):
        return a if b == 1 else -a
    from eomgen.symbolic.functions import over

    return over(a, b)
