"""Linear equations in the prime field: whether one follows from others, exactly."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.symbolic.numeric.evaluation import PRIME


def follows(rows: Sequence[Sequence[int]], row: Sequence[int]) -> bool:
    """Whether the row is a combination of the others, modulo the prime."""
    left = list(row)
    for pivot, k in _echelon(rows):
        _take_out(left, pivot, k)
    return not any(x % PRIME for x in left)


def _echelon(rows: Sequence[Sequence[int]]) -> list[tuple[list[int], int]]:
    """(row with 1 at its pivot, place of the pivot), each without the pivots before it."""
    found: list[tuple[list[int], int]] = []
    for row in rows:
        left = [x % PRIME for x in row]
        for pivot, k in found:
            _take_out(left, pivot, k)
        k = next((k for k, x in enumerate(left) if x), -1)
        if k >= 0:
            inverse = pow(left[k], -1, PRIME)
            found.append(([x * inverse % PRIME for x in left], k))
    return found


def _take_out(row: list[int], pivot: Sequence[int], k: int) -> None:
    """row - row[k] * pivot, in place."""
    factor = row[k]
    if factor:
        row[:] = [(x - factor * y) % PRIME for x, y in zip(row, pivot, strict=True)]
