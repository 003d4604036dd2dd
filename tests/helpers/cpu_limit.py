"""An end to what takes too long, in seconds of this process's own time: a busy machine changes nothing."""

from __future__ import annotations

import gc
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

T = TypeVar("T")


class TooLong(BaseException):
    """Not an Exception: nothing that guards against those holds it up."""


@contextmanager
def cpu_limit(seconds: float) -> Iterator[None]:
    """Raises TooLong where the body takes more CPU than that; without POSIX timers it takes what it takes."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def end(number: int, frame: object) -> None:
        raise TooLong(f"more than {seconds} s of CPU")

    before = signal.signal(signal.SIGPROF, end)
    signal.setitimer(signal.ITIMER_PROF, seconds, 0.2)  # again and again: a destructor may swallow the first
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def within_cpu(seconds: float, work: Callable[[], T]) -> T:
    """The result of `work`; TooLong where it takes more CPU than that twice in a row.

    The first try may pay for what is not its own: imports, or a collection of all that earlier tests left.
    """
    try:
        with cpu_limit(seconds):
            return work()
    except TooLong:
        gc.collect()
        with cpu_limit(seconds):
            return work()
