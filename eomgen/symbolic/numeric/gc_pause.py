"""A rest for the cycle collector while graphs grow."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

SELDOM = (1_000_000, 50, 100)  # objects made between two looks at the youngest; looks between two at the older


@contextmanager
def growing() -> Iterator[None]:
    """Expressions are made, and all of them stay: to look for cycles among them takes longer than to make them.

    Python's own counting of references goes on; what hangs in a ring is found later, among what is old: to look at once
    through all that was made took a tenth of a command.
    """
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
            if not gc.get_freeze_count():  # else somebody keeps objects of his own apart
                gc.freeze()  # what is young
                gc.unfreeze()  # is old
            gc.enable()


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
