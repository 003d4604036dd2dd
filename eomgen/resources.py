"""Time, memory and threads of a process: the time limit that a user sets, pauses of the cycle collector.

The clock only ends what takes too long: hot loops ask it by `check_patience`; what cannot ask, a loop of a library, is
stopped from a thread a little later.
"""

from __future__ import annotations

import ctypes
import gc
import math
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import field
from itertools import pairwise
from threading import Lock

from eomgen.errors import EomgenError
from eomgen.frozen import dataclass


class OutOfPatience(EomgenError):
    """The time limit that a user set is exceeded."""


class PatienceEnded(Exception):
    """Ends all work inside `patience`.

    No EomgenError: where one way fails another is tried, but not when the time is over.
    """


LATE = 1.0  # s, after which what does not ask is stopped; half of it where the patience is short
SOON = 0.05  # s, after which what was importing is looked at again


@dataclass
class _Clock:
    """A time limit.

    Args:
        end: on the monotonic clock [s].
        activities: the activities under way, the outermost first.
        done: the finished ones.
        kept: what remains of the work.
        closed: set when nothing is to be stopped any more; thrown: True if something was stopped from outside.
    """

    seconds: float
    end: float
    activities: list[str] = field(default_factory=list)
    done: list[str] = field(default_factory=list)
    kept: str = "nothing is kept"
    closed: threading.Event = field(default_factory=threading.Event)
    thrown: bool = False
    lock: threading.Lock = field(default_factory=threading.Lock)

    def end_now(self) -> None:
        """Make the next check find the time limit passed."""
        self.end = -math.inf

    def error(self) -> OutOfPatience:
        """The error that says what was done, what was given up, and how to go on."""
        given_up = ", ".join(self.activities[-2:]) or "the work"
        done = [f"{what} ({n} times)" if n > 1 else what for what, n in Counter(self.done).items()]
        before = f" (done before: {', '.join(done[-4:])})" if done else ""
        what = f"given up after {self.seconds:g} s, {self.kept}: {given_up}{before}"
        return OutOfPatience(what, fix="ask for less, or wait longer: --patience SECONDS, --patience none")


_CLOCK: ContextVar[_Clock | None] = ContextVar("patience", default=None)


def check_patience() -> None:
    """Raise an error if the time limit has passed; slow loops call this in each turn.

    Raises:
        PatienceEnded: it has.
    """
    clock = _CLOCK.get()
    if clock is not None and time.monotonic() > clock.end:
        raise PatienceEnded


def time_left() -> float | None:
    """Seconds that are left; None without a time limit."""
    clock = _CLOCK.get()
    return None if clock is None or clock.end == math.inf else max(0.0, clock.end - time.monotonic())


def keep_what_there_is() -> None:
    """Ends the time limit, so that what was found can be reported in full: nothing more is sought."""
    clock = _CLOCK.get()
    if clock is not None:
        with clock.lock:
            clock.end = math.inf
            clock.closed.set()
            if clock.thrown:
                _throw(threading.get_ident(), None)


def another_stretch(kept: str) -> None:
    """Restarts the time limit, for work whose finished steps remain: the next step may take the whole time again.

    Args:
        kept: what there is now, for the message that the rest was given up.
    """
    clock = _CLOCK.get()
    if clock is not None:
        with clock.lock:
            clock.closed.set()
            if clock.thrown:
                _throw(threading.get_ident(), None)
            clock.closed, clock.thrown = threading.Event(), False
            clock.end, clock.kept = time.monotonic() + clock.seconds, kept
        _watch(clock)


@contextmanager
def doing(what: str) -> Iterator[None]:
    """Names the activity inside, for the message that it was given up."""
    clock = _CLOCK.get()
    if clock is None:
        yield
        return
    clock.activities.append(what)
    over = False
    try:
        yield
        clock.done.append(what)
    except PatienceEnded:
        over = True
        raise
    finally:
        if not over:
            clock.activities.pop()


@contextmanager
def patience(seconds: float | None) -> Iterator[Callable[[], None]]:
    """Limits the time of what is done inside; None: no limit. It gives what ends that time at once, from any thread.

    Raises:
        OutOfPatience: it did not come to its end.
    """
    if seconds is None:
        yield lambda: None
        return
    clock = _Clock(seconds, time.monotonic() + seconds)
    token = _CLOCK.set(clock)
    _watch(clock)
    try:
        yield clock.end_now
    except PatienceEnded:
        raise clock.error() from None
    finally:
        _CLOCK.reset(token)
        with clock.lock:
            clock.closed.set()
            if clock.thrown:  # and not yet caught, perhaps
                _throw(threading.get_ident(), None)


def _watch(clock: _Clock) -> None:
    requested = (clock, clock.closed, threading.get_ident())
    threading.Thread(target=_stop_late, args=requested, daemon=True).start()


def _stop_late(clock: _Clock, closed: threading.Event, thread: int) -> None:
    """Raises PatienceEnded in a thread that does not check the time, and again where a library catches it."""
    wait = clock.seconds + LATE * min(max(0.5, clock.seconds / 5), 1.0)
    while not closed.wait(wait):
        with clock.lock:
            importing = _imports(thread)
            if not importing and not closed.is_set():
                clock.thrown = True
                _throw(thread, PatienceEnded)
        wait = SOON if importing else LATE


def _imports(thread: int) -> bool:
    """True if a thread is importing: stopped there it would leave half a module behind for all that comes after."""
    frame = sys._current_frames().get(thread)
    while frame is not None:
        if frame.f_code.co_filename == "<frozen importlib._bootstrap>":
            return True
        frame = frame.f_back
    return False


def _throw(thread: int, error: type[Exception] | None) -> None:
    """Raises an exception in another thread between two of its instructions; None: withdraws one."""
    thrown = None if error is None else ctypes.py_object(error)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), thrown)


# -------- gc pause --------------------------------------------------------------------------------------------
# Pauses of the cycle collector while graphs grow.


SELDOM = (1_000_000, 50, 100)  # objects made between two looks at the youngest; looks between two at the older


class _Rests:
    """Number of pauses under way in all threads, and the collector's state before the first one."""

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
    """Pauses the cycle collector while expressions are made that all stay: the search for cycles would take longer.

    Python's own counting of references goes on. New objects stay in the youngest generation and are examined when the
    collector runs again: moved to the oldest they would not count as new there, and unused cycles would pile up. Where
    several threads pause it at once, the last one to end enables it.
    """
    _RESTS.begin()
    try:
        yield
    finally:
        _RESTS.end()


def seldom_from_now_on() -> None:
    """Makes the cycle collector run rarely, for one command in a process of its own."""
    gc.set_threshold(*SELDOM)


@contextmanager
def seldom() -> Iterator[None]:
    """Makes the cycle collector run rarely during one command; afterwards it runs as before."""
    was = gc.get_threshold()
    seldom_from_now_on()
    try:
        yield
    finally:
        gc.set_threshold(*was)


def pieces_of(count: int, parts: int) -> list[tuple[int, int]]:
    """(first, last + 1) of each part of `count` indices, which are divided evenly: lengths differ by 1 at most."""
    parts = max(1, parts)
    return list(pairwise(count * k // parts for k in range(parts + 1)))


def in_threads(work: Sequence[Callable[[threading.Event], None]], check: Callable[[], None]) -> None:
    """Each piece of work in a thread of its own; if `check`, called now and then, raises, their event is set."""
    from concurrent.futures import ThreadPoolExecutor, wait

    stop = threading.Event()
    with ThreadPoolExecutor(len(work)) as pool:
        begun = [pool.submit(each, stop) for each in work]
        try:
            while not all(each.done() for each in begun):
                check()
                wait(begun, timeout=0.05)
        except BaseException:
            stop.set()
            raise
        for each in begun:
            each.result()
