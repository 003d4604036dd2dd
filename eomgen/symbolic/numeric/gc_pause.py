"""A rest for the cycle collector while graphs grow."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock

SELDOM = (1_000_000, 50, 100)  # objects made between two looks at the youngest; looks between two at the older


class _Rests:
    """How many rests are under way, in whatever threads, and whether the collector worked before the first."""

    def __init__(self) -> None:
        self.lock, self.number, self.worked = Lock(), 0, False

    def begin(self) -> None:
        with self.lock:
            if not self.number:
                self.worked = gc.isenabled()
                gc.disable()
            self.number += 1

    def end(self) -> None:
        with self.lock:
            self.number -= 1
            if not self.number and self.worked:
                gc.enable()


_RESTS = _Rests()


@contextmanager
def growing() -> Iterator[None]:
    """Expressions are made, and all of them stay: to look for cycles among them takes longer than to make them.

    Python's own counting of references goes on. What was made stays young, and is looked at when the collector wakes:
    put among what is old it would never count as new there, and rings that callers drop would pile up for ever. Where
    threads rest at once the last to end wakes the collector.
    """
    _RESTS.begin()
    try:
        yield
    finally:
        _RESTS.end()


def seldom_from_now_on() -> None:
    """One command in a process of its own: cycles are looked for, but not after every 700 objects."""
    gc.set_threshold(*SELDOM)


@contextmanager
def seldom() -> Iterator[None]:
    """One command; afterwards as before, which looks at once at all that is left, where that was oftener."""
    was = gc.get_threshold()
    seldom_from_now_on()
    try:
        yield
    finally:
        gc.set_threshold(*was)
