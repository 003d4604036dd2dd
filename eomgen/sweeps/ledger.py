"""The ledger of a sweep: a row for each run that is done, once and for ever, in a file that sqlite reads.

One process writes it, by transactions: whoever is killed at whatever instant leaves whole rows behind.
"""

from __future__ import annotations

import math
import sqlite3
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from eomgen.errors import UsageError, WriteFailed
from eomgen.records import dataclass
from eomgen.sweeps.kernel import SampleRow
from eomgen.sweeps.plan import FIXED, SweepPlan

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
        """Its rows; out of a pickle comes a ledger in memory."""
        return {"connection": self.connection.serialize(), "plan": self.plan}

    def __setstate__(self, state: dict[str, Any]) -> None:
        connection = sqlite3.connect(":memory:")
        connection.deserialize(state["connection"])
        self.__dict__.update(state | {"connection": connection})

    def add(self, rows: Sequence[SampleRow]) -> int:
        """How many of them are new; a run that is there stays as it is."""
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
        """How many runs are done."""
        return int(self.connection.execute("SELECT COUNT(*) FROM runs").fetchone()[0])

    def statuses(self) -> dict[str, int]:
        """How many ended in which way."""
        return dict(self.connection.execute("SELECT status, COUNT(*) FROM runs GROUP BY status ORDER BY status"))

    def messages(self, few: int) -> list[tuple[int, str, str]]:
        """(run, status, message) of the first with a message."""
        asked = "SELECT run, status, message FROM runs WHERE message <> '' ORDER BY run LIMIT ?"
        return list(self.connection.execute(asked, (few,)))

    def summary(self, column: int) -> tuple[int, float | None, float | None, float | None]:
        """(how many have a value, the least, the mean, the largest) of a column."""
        name = _quoted(_distinct(self.plan.columns)[column])
        asked = f"SELECT COUNT({name}), MIN({name}), AVG({name}), MAX({name}) FROM runs"
        found: tuple[int, float | None, float | None, float | None] = self.connection.execute(asked).fetchone()
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
        """Critical values: (number, what stays, the name, its value, what is left, message)."""
        with self.connection:
            self.connection.executemany("INSERT OR IGNORE INTO critical VALUES (?, ?, ?, ?, ?, ?)", rows)

    def critical(self) -> list[SampleRow]:
        """The critical values that were found."""
        return list(self.connection.execute("SELECT * FROM critical ORDER BY number"))

    def settle(self) -> None:
        """All that is done stands in the one file; what is beside it while rows are added is gone."""
        with suppress(sqlite3.OperationalError):  # somebody else reads it: whoever is the last does it
            self.connection.execute("PRAGMA journal_mode=DELETE")

    def close(self) -> None:
        """No more rows."""
        self.connection.close()


def _stored(row: SampleRow) -> SampleRow:
    return tuple(None if isinstance(x, float) and math.isnan(x) else x for x in row)


def ledger_at(path: Path | None, plan: SweepPlan) -> SweepLedger:
    """The ledger in a file, begun where there is none; None: in memory.

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
            f"the ledger '{path}' cannot be written: {error}", mend="name a folder that can be written to"
        ) from error
    except sqlite3.DatabaseError as error:
        raise UsageError(f"'{path}' is no ledger of a sweep: {error}", mend="begin in another folder") from error
    if found != plan.hash:
        connection.close()
        raise UsageError(f"'{path}' is the ledger of another plan", mend="give -o another folder")
    return SweepLedger(connection, plan)


def _distinct(names: Sequence[str]) -> list[str]:
    """For sqlite, which takes M for m: the second of two alike gets a number."""
    found: list[str] = []
    for name in names:
        shown, k = name, 2
        while shown.lower() in {other.lower() for other in found}:
            shown, k = f"{name} #{k}", k + 1
        found.append(shown)
    return found


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'
