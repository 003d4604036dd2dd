"""Chunks of runs -> their rows, in any process.

They are made in this process, in a pool of processes here, or by any executor with `submit`.

An executor needs `submit(function, *arguments)`, and its futures `result()` and `add_done_callback`, or else `done()`.
A chunk whose worker dies is given out again, at last run by run.
"""

from __future__ import annotations

import contextlib
import json
import math
import os
import queue
import sqlite3
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import field, replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

from eomgen.errors import EomgenError, RunFailed, UsageError, WriteFailed
from eomgen.frozen import dataclass
from eomgen.mechanics.instant import Quantities
from eomgen.model import Model, Output, OutputSource, Requests, Valued
from eomgen.pipeline import simulator
from eomgen.questions import solve
from eomgen.resources import PatienceEnded
from eomgen.runs import Simulator
from eomgen.sensitivities import slope_in_si
from eomgen.simulation import Trajectory
from eomgen.sweeps.design import FIXED, SweepPlan, plan_of

A_CHUNK = 0.5  # s of work in one: long compared with the cost of giving it out, short compared with the loss by a kill
MOST_IN_ONE = 2000  # runs
AHEAD = 3  # chunks given out for each worker
TRIES = 3  # of a chunk whose worker died
UNKNOWN_WORKERS = 16  # of an executor that does not say
LOOK = 1.0  # s between two looks after the parent, or after futures without a callback

Chunk = tuple[int, int]
"""The runs from the first up to the last, which is not among them."""


@dataclass
class ChunkSizes:
    """Number of runs in a chunk, by the time that the last ones took."""

    runs: int = 1

    def took(self, runs: int, seconds: float) -> None:
        """Takes the time of a chunk into account: the next ones are at most twice as large."""
        wanted = int(A_CHUNK * runs / max(seconds, time.get_clock_info("perf_counter").resolution))
        self.runs = max(1, min(wanted, 2 * max(runs, self.runs), MOST_IN_ONE))


def in_chunks(stretches: Iterable[Chunk], sizes: ChunkSizes) -> Iterator[Chunk]:
    """Runs of some stretches, in chunks of the size that is right when each is requested."""
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
        workers: number of processes; for the user's executor its own number, as far as it is known.
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
            raise RunFailed("the executor broke: a worker of it died", fix="finished runs are saved: start again")
        if self._own is not None:
            self._own.shutdown(wait=False, cancel_futures=True)
        self._own = None

    def close(self) -> None:
        """Ends the processes here; the user's executor stays."""
        if self._own is not None:
            self._own.shutdown(wait=True, cancel_futures=True)
        self._own = None


def end_with_parent(parent: int) -> None:
    """Ends a process of the pool when its parent is gone: its results would be lost."""

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(LOOK)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@dataclass
class _Out:
    """Chunks that are given out to workers.

    Args:
        waiting: chunks that are to be given out again.
        tries: how often a chunk's worker died.
    """

    done: queue.SimpleQueue[Any] = field(default_factory=queue.SimpleQueue)
    futures: dict[Any, Chunk] = field(default_factory=dict)
    waiting: deque[Chunk] = field(default_factory=deque)
    tries: dict[Chunk, int] = field(default_factory=dict)

    def next_future(self) -> Any:
        """Next future that is done."""
        while True:
            with contextlib.suppress(queue.Empty):
                return self.done.get(timeout=LOOK)
            for future in list(self.futures):
                if not hasattr(future, "add_done_callback") and future.done():
                    return future


def rows_by(
    pool: Pool, payload: Payload, stretches: Iterable[Chunk], seeds: Callable[[int], int]
) -> Iterator[list[SampleRow]]:
    """Rows of every chunk as they are finished, by a pool.

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
    """Gives out as many chunks as keep all workers busy; after a death those that were out, one at a time."""
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
    """Makes a new pool, which gets the chunks that were out; a run that kills every worker becomes a failed row."""
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


# -------- kernel ----------------------------------------------------------------------------------------------
# SweepPlan, numbers of runs -> their rows. It runs in any process, and knows nothing of the other runs.


FAILED = "failed"
WITHOUT_MOTION = "computed"
CUT: dict[str, type[BaseException]] = {"interrupted": KeyboardInterrupt, "out of patience": PatienceEnded}
SampleRow = tuple[Any, ...]
"""run, seed, status, message, values set, values requested; None where there is no value"""


@dataclass(frozen=True)
class SweepKernel:
    """The runs of a plan, one after the other; derived and compiled once.

    Args:
        plan: of them.
    """

    plan: SweepPlan

    def rows(self, first: int, last: int) -> list[SampleRow]:
        """The rows of the runs from `first` up to `last`."""
        seeds, values = self.plan.runs.runs(first, last)
        found = []
        for run, seed, set_ in zip(range(first, last), seeds, values.tolist(), strict=True):
            status, message, requested = self.requested(dict(zip(self.plan.runs.names, set_, strict=True)))
            found.append((run, seed, status, message, *set_, *requested))
        return found

    def requested(self, set_: Mapping[str, float]) -> tuple[str, str, list[float | None]]:
        """(status, message, requested values) of a run; an error becomes its message."""
        reported: dict[str, float | None] = dict.fromkeys(self.plan.requested)
        status, messages = WITHOUT_MOTION, list[str]()
        for part in (self._in_motion_reported, self._without_motion, self._slopes_reported):
            try:
                status = part(set_, reported, messages) or status
            except (EomgenError, ArithmeticError, ValueError) as error:
                status, messages = FAILED, [*messages, _sentence(error)]
        return status, "; ".join(messages), [finite(x) for x in reported.values()]

    def _in_motion_reported(
        self, set_: Mapping[str, float], reported: dict[str, float | None], messages: list[str]
    ) -> str:
        """Status of the motion of a run; its requested values are added to `reported`."""
        if not self._in_motion:
            return ""
        run = self.motion(set_)
        if run.status in CUT:  # no row: the same command makes it then
            raise CUT[run.status]
        if not run.ok:
            messages.append(run.message)
            return run.status
        for text, output in self._in_motion.items():
            found = run.ask(output)
            reported[text] = found.value if isinstance(found.value, float) else None
            messages += [f"{text}: {found.message}"] if found.message else []
        return run.status

    def motion(self, set_: Mapping[str, float], samples: int = 2, columns: Sequence[str] = ()) -> Trajectory:
        """One run from these values [SI]."""
        parameters, start = self._parted(set_)
        return self._simulator(self.plan.how.time, parameters, start, samples, columns)

    def valued(self, set_: Mapping[str, float]) -> Model:
        """The model at these values [SI]."""
        parameters, start = self._parted(set_)
        return Valued.of(self.plan.model, parameters, start).model

    def _parted(self, set_: Mapping[str, float]) -> tuple[dict[str, float], dict[str, float]]:
        names = self.plan.model.parameters
        parameters = {name: x for name, x in set_.items() if name in names}
        return parameters, {name: x for name, x in set_.items() if name not in names}

    def _without_motion(self, set_: Mapping[str, float], reported: dict[str, float | None], messages: list[str]) -> str:
        """Status of the requests that need no motion, answered as by `solve`; values are added to `reported`."""
        if not self._solved:
            return ""
        requested = list(self._solved)
        outputs = {f"asked{k}": replace(self._solved[text], unit=None) for k, text in enumerate(requested)}
        answers = dict(zip(requested, solve(self.valued(set_).requesting(outputs)).values(), strict=True))
        for text, answer in answers.items():
            reported[text] = answer.value
            messages += [f"{text}: {answer.message}"] if answer.value is None else []
        return ""

    def _slopes_reported(
        self, set_: Mapping[str, float], reported: dict[str, float | None], messages: list[str]
    ) -> str:
        """Status of the requested derivatives, by the equations themselves; values are added to `reported`."""
        if not self.plan.slopes:
            return ""
        model = self.valued(set_)
        for text, pair in self.plan.slopes.items():
            found, message = slope_in_si(model, *pair, self.plan.how.time)
            reported[text] = found
            messages += [f"{text}: {message}"] if message else []
        return ""

    @cached_property
    def _simulator(self) -> Simulator:
        how = self.plan.how
        model = self.plan.model.requesting({})
        return simulator(model, rtol=how.rtol, atol=how.atol, method=how.method)

    @cached_property
    def _outputs(self) -> dict[bool, dict[str, Output]]:
        """{False: outputs that need the motion, True: those that are solved without it}, by the text of the request."""
        texts = (text for text in self.plan.requested if text not in self.plan.slopes)
        found: dict[bool, dict[str, Output]] = {False: {}, True: {}}
        for text in texts:
            output = Requests(self.plan.model).output(text)
            found[is_without_motion(output)][text] = output
        return found

    @property
    def _in_motion(self) -> dict[str, Output]:
        return self._outputs[False]

    @property
    def _solved(self) -> dict[str, Output]:
        return self._outputs[True]


def is_without_motion(output: Output) -> bool:
    """True if `solve` answers it: at rest, from another start, of the linearized system."""
    small = OutputSource.SMALL_MOTIONS
    return output.rests or output.from_ is not None or Quantities.requested_by(output.value, small)


def _sentence(error: Exception) -> str:
    if isinstance(error, EomgenError):
        return f"{error.what}; {error.fix}" if error.fix else error.what
    return f"{type(error).__name__}: {error}"


def finite(x: float | None) -> float | None:
    """A number; None where it has no value."""
    return x if x is not None and math.isfinite(x) else None


# -- in any process ------------------------------------------------------------------------------------------

Payload = tuple[str, Any]
"""(the plan as JSON, the model that was made in Python or None): data for another process"""


def payload_of(plan: SweepPlan) -> Payload:
    """Data that another process needs to run a part of a plan."""
    return json.dumps(plan.as_dict(), sort_keys=True), plan.made


def rows_of_runs(payload: Payload, first: int, last: int) -> list[SampleRow]:
    """The rows of some runs, in this process."""
    return _kernel(*payload).rows(first, last)


def value_of_run(payload: Payload, set_: Mapping[str, float], text: str) -> float | None:
    """Value of one requested expression at some values [SI]."""
    kernel = _kernel(*payload)
    _, _, requested = kernel.requested(set_)
    return finite(requested[kernel.plan.requested.index(text)])


@lru_cache(maxsize=2)
def _kernel(reported: str, made: Any) -> SweepKernel:
    return SweepKernel(plan_of(json.loads(reported), made))


# -------- progress --------------------------------------------------------------------------------------------
# How far a sweep is, on a terminal: rate and time left by tqdm, where it is installed.


@contextmanager
def progress_of(runs: int, done: int) -> Iterator[Callable[[int], object]]:
    """Function that is called with the number of runs of each finished chunk, and shows the progress."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield lambda more: None
        return
    try:
        from tqdm import tqdm
    except ImportError:
        yield lambda more: None
        return
    with tqdm(total=runs, initial=done, unit=" runs", file=sys.stderr) as bar:
        yield bar.update


# -------- ledger ----------------------------------------------------------------------------------------------
# The ledger of a sweep: a row for each run that is done, once and for ever, in a file that sqlite reads.
#
# One process writes it, by transactions: a process that is killed leaves whole rows behind.


AT_ONCE = 10_000  # rows that are read at once


@dataclass(frozen=True)
class SweepLedger:
    """The rows that are done.

    Args:
        connection: to the file, or to memory.
        plan: whose runs they are.
    """

    connection: sqlite3.Connection
    plan: SweepPlan

    def __getstate__(self) -> dict[str, Any]:
        """Pickled state: its rows; unpickled it is a ledger in memory."""
        return {"connection": self.connection.serialize(), "plan": self.plan}

    def __setstate__(self, state: dict[str, Any]) -> None:
        connection = sqlite3.connect(":memory:")
        connection.deserialize(state["connection"])
        self.__dict__.update(state | {"connection": connection})

    def add(self, rows: Sequence[SampleRow]) -> int:
        """Adds rows and gives the number of new ones; a run that is there stays as it is."""
        marks = ", ".join("?" * len(self.plan.columns))
        before = self.connection.total_changes
        with self.connection:
            self.connection.executemany(f"INSERT OR IGNORE INTO runs VALUES ({marks})", map(_stored, rows))
        return self.connection.total_changes - before

    def missing(self, first: int, last: int) -> list[tuple[int, int]]:
        """The stretches of runs from `first` up to `last` that are not done."""
        done = {
            run for (run,) in self.connection.execute("SELECT run FROM runs WHERE run >= ? AND run < ?", (first, last))
        }
        if not done:
            return [(first, last)]
        found: list[tuple[int, int]] = []
        for run in range(first, last):
            if run in done:
                continue
            if found and found[-1][1] == run:
                found[-1] = (found[-1][0], run + 1)
            else:
                found.append((run, run + 1))
        return found

    @property
    def count(self) -> int:
        """Number of runs that are done."""
        return int(self.connection.execute("SELECT COUNT(*) FROM runs").fetchone()[0])

    def statuses(self) -> dict[str, int]:
        """Number of runs by status."""
        return dict(self.connection.execute("SELECT status, COUNT(*) FROM runs GROUP BY status ORDER BY status"))

    def messages(self, few: int) -> list[tuple[int, str, str]]:
        """(run, status, message) of the first with a message."""
        requested = "SELECT run, status, message FROM runs WHERE message <> '' ORDER BY run LIMIT ?"
        return list(self.connection.execute(requested, (few,)))

    def summary(self, column: int) -> tuple[int, float | None, float | None, float | None]:
        """(how many have a value, the least, the mean, the largest) of a column."""
        name = _quoted(_distinct(self.plan.columns)[column])
        requested = f"SELECT COUNT({name}), MIN({name}), AVG({name}), MAX({name}) FROM runs"
        found: tuple[int, float | None, float | None, float | None] = self.connection.execute(requested).fetchone()
        return found

    def row(self, run: int) -> SampleRow | None:
        """One of them; None while it is not done."""
        found: SampleRow | None = self.connection.execute("SELECT * FROM runs WHERE run = ?", (run,)).fetchone()
        return found

    def rows(self) -> Iterator[SampleRow]:
        """All, by their numbers."""
        reader = self.connection.cursor()
        reader.arraysize = AT_ONCE
        reader.execute("SELECT * FROM runs ORDER BY run")
        while some := reader.fetchmany():
            yield from some

    def add_critical(self, rows: Iterable[SampleRow]) -> None:
        """Critical values: (number, values that stay, the name, its value, the residual, message)."""
        with self.connection:
            self.connection.executemany("INSERT OR IGNORE INTO critical VALUES (?, ?, ?, ?, ?, ?)", rows)

    def critical(self) -> list[SampleRow]:
        """The critical values that were found."""
        return list(self.connection.execute("SELECT * FROM critical ORDER BY number"))

    def settle(self) -> None:
        """Moves all rows into the one file; the files next to it, which exist while rows are added, are removed."""
        with suppress(sqlite3.OperationalError):  # another process reads it: the last one does it
            self.connection.execute("PRAGMA journal_mode=DELETE")

    def close(self) -> None:
        """No more rows."""
        self.connection.close()


def _stored(row: SampleRow) -> SampleRow:
    return tuple(None if isinstance(x, float) and math.isnan(x) else x for x in row)


def ledger_at(path: Path | None, plan: SweepPlan) -> SweepLedger:
    """Ledger in a file, which is created where there is none; None: in memory.

    Raises:
        UsageError: it is of another plan, or no ledger.
        WriteFailed: it cannot be written.
    """
    try:
        connection = sqlite3.connect(":memory:" if path is None else path, timeout=60)
        connection.execute("PRAGMA journal_mode=WAL")
        connection.execute("PRAGMA synchronous=NORMAL")
        names = _distinct(plan.columns)
        kinds = ["INTEGER PRIMARY KEY", "INTEGER", "TEXT", "TEXT", *["REAL"] * (len(names) - len(FIXED))]
        columns = ", ".join(f"{_quoted(name)} {kind}" for name, kind in zip(names, kinds, strict=True))
        with connection:
            connection.execute("CREATE TABLE IF NOT EXISTS plan (hash TEXT PRIMARY KEY)")
            connection.execute(f"CREATE TABLE IF NOT EXISTS runs ({columns})")
            connection.execute(
                "CREATE TABLE IF NOT EXISTS critical (number INTEGER PRIMARY KEY, at TEXT, name TEXT, value REAL, "
                "left REAL, message TEXT)"
            )
            connection.execute(
                "INSERT OR IGNORE INTO plan SELECT ? WHERE NOT EXISTS (SELECT 1 FROM plan)", (plan.hash,)
            )
        (found,) = connection.execute("SELECT hash FROM plan").fetchone()
    except sqlite3.OperationalError as error:
        raise WriteFailed(
            f"the ledger '{path}' cannot be written: {error}", fix="name a folder that can be written to"
        ) from error
    except sqlite3.DatabaseError as error:
        raise UsageError(f"'{path}' is no ledger of a sweep: {error}", fix="begin in another folder") from error
    if found != plan.hash:
        connection.close()
        raise UsageError(f"'{path}' is the ledger of another plan", fix="give -o another folder")
    return SweepLedger(connection, plan)


def _distinct(names: Sequence[str]) -> list[str]:
    """Column names for sqlite, which takes M for m: the second of two equal ones gets a number."""
    found: list[str] = []
    for name in names:
        shown, k = name, 2
        while shown.lower() in {other.lower() for other in found}:
            shown, k = f"{name} #{k}", k + 1
        found.append(shown)
    return found


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'
