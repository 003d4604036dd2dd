"""Chunks of runs -> their rows, in this process, in a pool of processes here, or by any executor with `submit`.

The distribution is the executor's: what is asked of one is `submit(function, *arguments)`, and of its futures
`result()` and `add_done_callback`, or else `done()`. A chunk whose worker dies is given out again, at last run by run.
"""

from __future__ import annotations

import contextlib
import os
import queue
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from dataclasses import field
from typing import Any

from eomgen.errors import RunFailed
from eomgen.records import dataclass
from eomgen.sweeps.kernel import FAILED, Payload, SampleRow, rows_of_runs

A_CHUNK = 0.5  # s of work in one: long beside what giving it out costs, short beside what a kill loses
MOST_IN_ONE = 2000  # runs
AHEAD = 3  # chunks given out for each worker
TRIES = 3  # of a chunk whose worker died
UNKNOWN_WORKERS = 16  # of an executor that does not say
LOOK = 1.0  # s between two looks after the parent, or after futures that tell nobody

Chunk = tuple[int, int]
"""The runs from the first up to the last, which is not among them."""


@dataclass
class ChunkSizes:
    """How many runs go into a chunk, by how long the last ones took."""

    runs: int = 1

    def took(self, runs: int, seconds: float) -> None:
        """Another chunk is done: the next ones are at most twice as large."""
        wanted = int(A_CHUNK * runs / max(seconds, time.get_clock_info("perf_counter").resolution))
        self.runs = max(1, min(wanted, 2 * max(runs, self.runs), MOST_IN_ONE))


def in_chunks(stretches: Iterable[Chunk], sizes: ChunkSizes) -> Iterator[Chunk]:
    """The runs of some stretches, as many in each chunk as is right when it is asked for."""
    for first, last in stretches:
        while first < last:
            end = min(last, first + sizes.runs)
            yield first, end
            first = end


def timed_rows(payload: Payload, first: int, last: int) -> tuple[float, list[SampleRow]]:
    """(seconds, rows) of a chunk, where it is run."""
    begun = time.perf_counter()
    rows = rows_of_runs(payload, first, last)
    return time.perf_counter() - begun, rows


def rows_here(payload: Payload, stretches: Iterable[Chunk]) -> Iterator[list[SampleRow]]:
    """The rows of every chunk, in this process."""
    sizes = ChunkSizes()
    for first, last in in_chunks(stretches, sizes):
        seconds, rows = timed_rows(payload, first, last)
        sizes.took(last - first, seconds)
        yield rows


@dataclass
class Pool:
    """Processes here, or an executor of the user's.

    Args:
        workers: how many processes; of the user's executor what it has, as far as anybody knows.
        executor: of the user; None: processes here.
    """

    workers: int
    executor: Any = None
    _own: ProcessPoolExecutor | None = None

    def submit(self, *task: Any) -> Any:
        """A future of a task."""
        if self.executor is not None:
            return self.executor.submit(*task)
        if self._own is None:
            self._own = ProcessPoolExecutor(self.workers, initializer=end_with_parent, initargs=(os.getpid(),))
        return self._own.submit(*task)

    def renew(self) -> None:
        """New processes after one of them died.

        Raises:
            RunFailed: the executor is the user's.
        """
        if self.executor is not None:
            raise RunFailed("the executor broke: a worker of it died", mend="what is done is kept: start again")
        if self._own is not None:
            self._own.shutdown(wait=False, cancel_futures=True)
        self._own = None

    def close(self) -> None:
        """Ends the processes here; the user's executor stays."""
        if self._own is not None:
            self._own.shutdown(wait=True, cancel_futures=True)
        self._own = None


def end_with_parent(parent: int) -> None:
    """A process of the pool ends when its parent is gone: nobody would take what it finds."""

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(LOOK)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@dataclass
class _Out:
    """What is given out.

    Args:
        waiting: chunks that are to be given out again.
        tries: how often a chunk's worker died.
    """

    done: queue.SimpleQueue[Any] = field(default_factory=queue.SimpleQueue)
    futures: dict[Any, Chunk] = field(default_factory=dict)
    waiting: deque[Chunk] = field(default_factory=deque)
    tries: dict[Chunk, int] = field(default_factory=dict)

    def next_future(self) -> Any:
        """The next that is done."""
        while True:
            with contextlib.suppress(queue.Empty):
                return self.done.get(timeout=LOOK)
            for future in list(self.futures):
                if not hasattr(future, "add_done_callback") and future.done():
                    return future


def rows_by(
    pool: Pool, payload: Payload, stretches: Iterable[Chunk], seeds: Callable[[int], int]
) -> Iterator[list[SampleRow]]:
    """The rows of every chunk as they come, by a pool.

    Args:
        seeds: of a run, for the row of one that no worker survives.
    """
    sizes, out = ChunkSizes(), _Out()
    fresh = in_chunks(stretches, sizes)
    while True:
        _give_out(pool, payload, out, fresh)
        if not out.futures:
            return
        future = out.next_future()
        chunk = out.futures.pop(future, None)
        if chunk is None:
            continue  # of a pool that broke
        try:
            seconds, rows = future.result()
        except BrokenExecutor:
            yield from _after_death(pool, out, chunk, seeds)
            continue
        sizes.took(len(rows), seconds)
        yield rows


def _give_out(pool: Pool, payload: Payload, out: _Out, fresh: Iterator[Chunk]) -> None:
    """As many chunks as keep all workers busy; after a death those that were out, one at a time."""
    while len(out.futures) < (1 if out.waiting else AHEAD * pool.workers):
        chunk = out.waiting.popleft() if out.waiting else next(fresh, None)
        if chunk is None:
            return
        try:
            future = pool.submit(timed_rows, payload, *chunk)
        except BrokenExecutor:
            out.waiting.appendleft(chunk)
            out.waiting.extend(out.futures.values())
            out.futures.clear()
            pool.renew()
            continue
        out.futures[future] = chunk
        if hasattr(future, "add_done_callback"):
            future.add_done_callback(out.done.put)


def _after_death(pool: Pool, out: _Out, chunk: Chunk, seeds: Callable[[int], int]) -> Iterator[list[SampleRow]]:
    """The pool is new, and what was out is given out again; a run that no worker survives is a row that says so."""
    lost = [chunk, *out.futures.values()]
    alone = len(lost) == 1
    out.futures.clear()
    pool.renew()
    if not alone:  # any of them may be the one that kills
        out.waiting.extend(lost)
        return
    out.tries[chunk] = out.tries.get(chunk, 0) + 1
    first, last = chunk
    if out.tries[chunk] < TRIES:
        out.waiting.append(chunk)
    elif last - first > 1:
        middle = (first + last) // 2
        out.waiting.extend(((first, middle), (middle, last)))
    else:
        yield [(first, seeds(first), FAILED, f"the process that ran it died {TRIES} times")]
