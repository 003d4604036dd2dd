"""Numbers and bytes in few bytes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from eomgen.files import json_text
from eomgen.frozen import dataclass

# -------- columns ---------------------------------------------------------------------------------------------
# Columns of numbers -> few bytes: whole multiples of a power of ten, of these the differences that are shortest.
#
# A motion is smooth: of its k-th differences little is left, which gzip makes short. `player/columns.mjs` reads it.


MOST_DIFFERENCES = 8  # each may double the largest number: 10^12 stays whole in a double
SEVEN_BITS = 7 * np.arange(9)
Hole = tuple[int, int, str]  # first row, how many, what stands there


@dataclass(frozen=True)
class PackedColumns:
    """Columns of equal length.

    Args:
        rows: their length.
        columns: (power of ten whose multiples they are, how often differences were taken, rows without a number).
        content: the differences one column after the other: zigzag, seven bits a byte, the lowest first.
    """

    rows: int
    columns: tuple[tuple[int, int, tuple[Hole, ...]], ...]
    content: bytes

    def head(self, **more: Any) -> dict[str, Any]:
        """Description of the columns that a page gets with their content."""
        return {"rows": self.rows, "columns": self.columns, **more}


def packed_columns(columns: Iterable[np.ndarray], digits: int) -> PackedColumns:
    """Columns with so many digits of the largest number in each; nan and inf stay.

    Args:
        columns: each of the same length n.
        digits: at most 12.
    """
    reported, content, rows = [], [], 0
    for column in columns:
        rows = len(column)
        finite = np.isfinite(column)
        largest = float(np.max(np.abs(column), where=finite, initial=0.0))
        power = max(int(np.floor(np.log10(largest))) + 1 - digits, -300) if largest > 0 else 0
        whole = np.rint(np.where(finite, column, 0.0) / 10.0**power).astype(np.int64)
        for first, count, _ in (holes := tuple(_holes(column))):
            whole[first : first + count] = whole[first - 1] if first else 0
        tried = [whole]
        for _ in range(MOST_DIFFERENCES):
            tried.append(np.diff(tried[-1], prepend=0))
        order = min(range(len(tried)), key=lambda k: float(np.log2(1.0 + np.abs(tried[k])).sum()))
        reported.append((power, order, holes))
        content.append(_seven_bits(tried[order]))
    return PackedColumns(rows, tuple(reported), b"".join(content))


def table_bytes(columns: Mapping[str, np.ndarray], digits: int) -> bytes:
    """A table of named columns as a page offers it: a line of JSON, then the numbers."""
    packed = packed_columns(columns.values(), digits)
    return json_text(packed.head(names=tuple(columns)), separators=(",", ":")).encode() + b"\n" + packed.content


def _holes(column: np.ndarray) -> Iterable[Hole]:
    """Intervals of a column without numbers, and the word that stands there: (first row, length, "nan" or "inf")."""
    words = np.where(np.isnan(column), "nan", np.where(column > 0, "inf", "-inf"))
    open_ = np.where(np.isfinite(column), "", words)
    ends = np.flatnonzero(np.append(open_[1:] != open_[:-1], True)) if len(column) else ()
    first = 0
    for last in map(int, ends):
        if open_[first]:
            yield first, last + 1 - first, str(open_[first])
        first = last + 1


def _seven_bits(values: np.ndarray) -> bytes:
    """Whole numbers, each in as many bytes as it takes; the highest bit says that one follows."""
    zigzag = np.where(values < 0, -2 * values - 1, 2 * values)[:, None]
    left = zigzag >> SEVEN_BITS
    more = np.concatenate([left[:, 1:] > 0, np.zeros((len(values), 1), dtype=bool)], axis=1)
    used = np.concatenate([np.ones((len(values), 1), dtype=bool), left[:, 1:] > 0], axis=1)
    found: bytes = ((left & 127) | np.where(more, 128, 0)).astype(np.uint8)[used].tobytes()
    return found


# -------- far copies ------------------------------------------------------------------------------------------
# Bytes -> the same in fewer for gzip, which sees 32 KB back: what stood farther away is said by where it stood.
#
# Source: Bentley and McIlroy, Data compression using long common strings (1999).


BLOCK = 12  # bytes that are looked up
LEAST = 24  # bytes from which a copy is shorter
NEAR = 30_000  # bytes back: gzip finds it there


def with_far_copies(content: bytes) -> bytes:
    """The length of the copies; of each the new bytes before it, how far back it lies, its length; then all new bytes.

    Numbers have seven bits a byte, the lowest first; `page.js` reads it.
    """
    copies, new, done = bytearray(), bytearray(), 0
    for at, back, length in _copies(content):
        new += content[done:at]
        for number in (at - done, back, length):
            copies += _length_in_sevens(number)
        done = at + length
    return _length_in_sevens(len(copies)) + bytes(copies) + bytes(new) + content[done:]


def _copies(content: bytes) -> Iterator[tuple[int, int, int]]:
    """(place, distance back, length) of repetitions of earlier bytes, in order."""
    seen: dict[bytes, int] = {}
    at = done = known = 0
    while at <= len(content) - BLOCK:
        while known + BLOCK <= at:
            seen[content[known : known + BLOCK]] = known
            known += BLOCK
        before = seen.get(content[at : at + BLOCK], at)
        if at - before > NEAR:
            more = _alike(content, before, at)
            less = 0
            while at - less > done and before > less and content[at - less - 1] == content[before - less - 1]:
                less += 1
            if more + less >= LEAST:
                yield at - less, at - before, more + less
                at = done = at + more
                continue
        at += 1


def _alike(content: bytes, a: int, b: int) -> int:
    """Number of bytes from a on that are equal to those from b on."""
    length, step = BLOCK, 4096
    while step:
        end = length + step
        if b + end <= len(content) and content[a + length : a + end] == content[b + length : b + end]:
            length = end
        else:
            step //= 2
    return length


def _length_in_sevens(number: int) -> bytes:
    found = bytearray()
    while number > 127:
        found.append(number & 127 | 128)
        number >>= 7
    return bytes((*found, number))
