"""Bytes -> the same in fewer for gzip, which sees 32 KB back: what stood farther away is said by where it stood.

Source: Bentley and McIlroy, Data compression using long common strings (1999).
"""

from __future__ import annotations

from collections.abc import Iterator

BLOCK = 12  # bytes that are looked up
LEAST = 24  # bytes that are worth a copy
NEAR = 30_000  # bytes back: gzip finds it there


def with_far_copies(content: bytes) -> bytes:
    """The length of the copies; of each the new bytes before it, how far back it lies, its length; then all new bytes.

    Numbers have seven bits a byte, the lowest first; `page.js` reads it.
    """
    copies, new, done = bytearray(), bytearray(), 0
    for at, back, length in _copies(content):
        new += content[done:at]
        for number in (at - done, back, length):
            copies += _seven_bits(number)
        done = at + length
    return _seven_bits(len(copies)) + bytes(copies) + bytes(new) + content[done:]


def _copies(content: bytes) -> Iterator[tuple[int, int, int]]:
    """(where, how far back, length) of what repeats something far, in order."""
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
    """How many bytes from a on are those from b on."""
    length, step = BLOCK, 4096
    while step:
        end = length + step
        if b + end <= len(content) and content[a + length : a + end] == content[b + length : b + end]:
            length = end
        else:
            step //= 2
    return length


def _seven_bits(number: int) -> bytes:
    found = bytearray()
    while number > 127:
        found.append(number & 127 | 128)
        number >>= 7
    return bytes((*found, number))
