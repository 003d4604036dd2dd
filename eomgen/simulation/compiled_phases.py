"""PhaseModels -> their phases one after the other in C: Python makes what is asked for, and decides what is left to it.

`phases.c` marches through a phase, finds the event that ends it, decides what the contacts do from there on (impacts
included) and begins the next. It knows a phase by the modes of its contacts; the first time it needs one, or the
sliding velocities beside open contacts, it asks. A phase in which something happens that it has no functions for, or
that is not decided there, is left to `motion.passed`:

    a singular position, a stiff motion, constraints that stay open; several contacts that close at once by Poisson's
    law or one after the other, impacts with friction or with dependent impulses, contacts on surfaces, paths of pieces,
    strings whose slack is integrated, several joints with static friction at rest
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from functools import partial
from typing import Protocol

import numpy as np

from eomgen.codegen import in_c
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.impacts import Jump
from eomgen.model import Table
from eomgen.resources import PatienceEnded, check_patience, keep_what_there_is
from eomgen.simulation.contacts import Configuration
from eomgen.simulation.event_location import Crossing
from eomgen.simulation.integrator import Run, Stepping, StepStates, reached_words
from eomgen.simulation.many_runs import MOST_AT_ONCE, machine
from eomgen.simulation.phase_change import PhaseStart, by_gauss
from eomgen.simulation.phase_model import PhaseModel, Values
from eomgen.simulation.phase_models import PhaseModels
from eomgen.simulation.phase_run import PhaseRun
from eomgen.simulation.phase_tables import (
    BEGINS,
    LEFT,
    MOST_CONTACTS,
    MOST_ENDED,
    NEEDS_PHASE,
    NEEDS_SLIDES,
    RAN_OUT,
    DoneTable,
    ManyTable,
    PhaseTable,
    TablesInC,
    code_of,
    modes_of,
)
from eomgen.simulation.result import Impact, RunStatus

MOST_PASSED = 1000  # phases of one of many runs; one with more is run alone
AT_ONCE = 20_000  # steps in a call
MOST_SAMPLED = 4_000_000  # numbers of the states at the requested instants of one phase


class ThroughPhases(Protocol):
    """End of a run, and the instants at which its states are wanted."""

    @property
    def end(self) -> float: ...

    @property
    def instants(self) -> np.ndarray | None: ...


def is_in_phases(models: PhaseModels, how: Stepping) -> bool:
    """True if phases of the model can follow one another in C, as far as model and method decide."""
    model = models.model
    if not (model.has_phases and how.is_in_marches) or how.most_phases is not None or models.rates is not None:
        return False
    if model.on_paths or len(model.contacts) > MOST_CONTACTS or any(contact.surface for contact in model.contacts):
        return False
    return models.target in (None, "c") and not models.is_fed


@dataclass(frozen=True)
class BorrowedPhases:
    """The phases of a model in C, lent to one run at a time: others have their own.

    Args:
        free: those that nobody has; None among them: there are none in C.
        made: those of this run.
    """

    free: list[CompiledPhases | None]
    made: CompiledPhases | None

    def __enter__(self) -> CompiledPhases | None:
        return self.made

    def __exit__(self, *_: object) -> None:
        self.free.append(self.made)


def compiled_phases(models: PhaseModels, how: Stepping) -> BorrowedPhases:
    """The phases of a model in C; None where the model, the method or the machine does not allow it."""
    if not is_in_phases(models, how):
        return BorrowedPhases([], None)
    first = models
    while first.origin is not None:
        first = first.origin
    key = how.method, how.rtol, how.atol, how.most_steps, how.stabilization, how.breakpoints, how.keeps
    free: list[CompiledPhases | None] = first.known["in C"].setdefault(key, [])
    if not free:
        try:
            made = in_c(lambda: CompiledPhases(models, how), "phases follow one another in Python, slower")
        except DerivationError:
            made = None
        return BorrowedPhases(free, made)
    lent = free.pop()
    return BorrowedPhases(free, None if lent is None else lent.at(models))


@dataclass(frozen=True)
class CompiledRuns:
    """Results of many runs, as of `MarchedRuns`.

    Args:
        x: runs x instants x columns.
        is_done: True for each run that came to its end without a question.
        steps: the number that each took.
    """

    x: np.ndarray
    is_done: np.ndarray
    steps: np.ndarray


class CompiledPhases:
    """The phases of a model in C, for one run at a time.

    Args:
        models: the phases, at the values of the parameters of the next run.
        how: the integrator's options, with the tolerances of one step.
        columns: the only coordinates, speeds and states that phases may have; None: any.
    """

    def __init__(self, models: PhaseModels, how: Stepping, columns: tuple[str, ...] | None = None) -> None:
        self.how, self.columns = how, columns
        self._run, self._runs = machine()
        self._tables = TablesInC(models, how, columns)
        self._decisions = _Decisions(self._tables)

    def at(self, models: PhaseModels) -> CompiledPhases:
        """Itself for the next run, at other values of the parameters."""
        self._decisions.at(models)
        return self

    # -- many runs --------------------------------------------------------------------------------------

    def with_names(self, names: Iterable[str]) -> None:
        """Gives names their places, in this order."""
        for name in names:
            self._tables.place(name)

    def values(self, columns: Mapping[str, np.ndarray], runs: int) -> np.ndarray:
        """Values of many runs, each in its place, runs x values, by name."""
        found = np.zeros((runs, self._tables.width))
        for name, column in columns.items():
            found[:, self._tables.place(name)] = column
        return found

    def runs(
        self,
        starts: tuple[np.ndarray, np.ndarray, Configuration],
        instants: np.ndarray,
        end: float,
        found: CompiledRuns,
        piece: tuple[int, int],
        stop: threading.Event,
    ) -> None:
        """The runs from one number up to another, from t = 0 on.

        Args:
            starts: values (runs x values), parameters (runs x parameters), and how the contacts are at the start.
        """
        tables, (values, p, before) = self._tables, starts
        m = tables.machine
        columns = np.full(self._tables.width, -1, dtype=np.int32)
        for k, name in enumerate(self.columns or ()):
            columns[self._tables.place(name)] = k
        tables.sample(instants)
        m.columns, m.n_columns = columns.ctypes.data, found.x.shape[2]
        m.end, m.is_logged, m.most_passed, m.most_steps = end, 0, MOST_PASSED, self.how.most_steps
        many = ManyTable(next=piece[0], last=piece[1], parameters=p.shape[1], before=self._decisions.code(before))
        many.values, many.p, many.x = values.ctypes.data, p.ctypes.data, found.x.ctypes.data
        many.is_done, many.steps = found.is_done.ctypes.data, found.steps.ctypes.data
        tables.size()
        while not stop.is_set():
            answer = self._runs(ctypes.byref(m), ctypes.byref(many), AT_ONCE)
            if answer == RAN_OUT:
                return
            if answer in (NEEDS_PHASE, NEEDS_SLIDES):
                tables.p[:] = p[many.next]  # the values at which what is made is first evaluated
                self._decisions.make(answer, always=True)

    # -- one run ----------------------------------------------------------------------------------------

    def through(self, here: PhaseStart, plan: ThroughPhases, ended: Collection[Configuration]) -> Iterator[PhaseRun]:
        """The phases from a start on; after the last nothing follows where the end is reached, else others go on.

        Args:
            ended: the configurations that ended at this instant.
        """
        if plan.instants is None or not self._begun(here, plan.end, plan.instants, ended):
            return
        m, results = self._tables.machine, _Results(self._decisions, here)
        while True:
            found = self._run(ctypes.byref(m), MOST_AT_ONCE * 20)
            for each in results.taken():
                yield each
                if each.after is None:
                    return
            if found == LEFT:
                return
            if found in (NEEDS_PHASE, NEEDS_SLIDES) and not self._decisions.make(found, always=False):
                return
            try:
                check_patience()
            except (PatienceEnded, KeyboardInterrupt) as stop:
                cut = results.cut(stop) if self.how.keeps else None
                if cut is None:
                    raise
                yield cut
                return

    def _begun(self, here: PhaseStart, end: float, instants: np.ndarray, ended: Collection[Configuration]) -> bool:
        tables, code = self._tables, self._decisions.code
        m, n = tables.machine, tables.width
        if len(ended) > MOST_ENDED or n * len(instants) > MOST_SAMPLED:
            return False
        tables.sample(instants)
        m.next = int(np.searchsorted(instants, here.t, side="left"))
        tables.values[:] = 0
        for name, value in here.values.items():
            k = tables.places.get(name)
            if k is not None:
                tables.values[k] = value
        m.t, m.end, m.limit, m.stage, m.is_logged = here.t, end, here.limit or 0.0, BEGINS, 1
        m.n_done = m.n_rows = m.n_tracks = m.hasty = m.by_gauss = 0
        m.most_passed, m.passed, m.most_steps = 1 << 40, 0, self.how.most_steps
        for k, configuration in enumerate(ended):
            m.ended[k] = code(configuration)
        m.n_ended, number = len(ended), code(here.configuration)
        entry = next((entry for entry in tables.entries if entry.code == number), None)
        if entry is None:
            if not tables.models.comes_again(here.configuration, "asked for"):
                return False
            tables.add_phase(number, here.configuration, here.t, here.values)
            return self._begun(here, end, instants, ended)  # its names have places now
        m.now = ctypes.addressof(entry)
        tables.size()
        return not entry.is_refused


# -------- decisions -----------------------------------------------------------------------------------------------
# What C asks for in the middle of a motion -> its tables: a configuration is a number there.


class _Decisions:
    """Decisions that C leaves to Python, and the tables made for it.

    Args:
        tables: of the model.
    """

    def __init__(self, tables: TablesInC) -> None:
        self.tables = tables
        self._known: dict[int, Configuration] = {}
        self._phases: dict[int, tuple[PhaseModel, int]] = {}

    def at(self, models: PhaseModels) -> None:
        """Takes other values of the parameters."""
        if models is not self.tables.models:
            self._phases = {}
        self.tables.at(models)

    def code(self, configuration: Configuration) -> int:
        """The number of a configuration."""
        return code_of([configuration.modes[name] for name in self.tables.names])

    def phase(self, code: int) -> tuple[PhaseModel, int]:
        """(a phase, the length of its rows)."""
        if code not in self._phases:
            phase = self.tables.models.of(self.configuration(code))
            self._phases[code] = phase, len(phase.moving) + 1
        return self._phases[code]

    def configuration(self, code: int) -> Configuration:
        """The configuration of a number."""
        if code not in self._known:
            modes = dict(zip(self.tables.names, modes_of(code, len(self.tables.names)), strict=True))
            self._known[code] = Configuration(Table(modes))
        return self._known[code]

    def make(self, what: int, *, always: bool) -> bool:
        """True if the phase or the sliding velocities that C needs are made; False: it is not worth a compiler yet.

        Args:
            always: it is made all the same.
        """
        tables, m = self.tables, self.tables.machine
        needed = int(m.needed)
        if what == NEEDS_SLIDES:
            tables.add_slides(needed)
            return True
        values = tables.named(tables.after.tolist())
        if m.by_gauss:
            needed = self._by_gauss(needed, m.t, values)
        if all(entry.code != needed for entry in tables.entries):
            if not (always or tables.models.comes_again(self.configuration(needed), "asked for")):
                return False
            tables.add_phase(needed, self.configuration(needed), m.t, values)
        return True

    def _by_gauss(self, first: int, t: float, values: Values) -> int:
        """The number of the configuration in which joints at rest go on, where all of them stick in the first."""
        models, near = self.tables.models, self.configuration(first)
        resting = [c for c in models.model.contacts if c.size is not None and near.modes[c.name].sense == 0]
        found = by_gauss(models, t, values, near, resting)
        return code_of([found[0][name] for name in self.tables.names]) if found else first


# -------- results -------------------------------------------------------------------------------------------------
# What C gives -> PhaseRuns: the phases that are over, one after the other, and the rows of the one that is not.


class _Results:
    """The phases that C gives.

    Args:
        decisions: which phase a number is.
        here: the start of the first of them.
    """

    def __init__(self, decisions: _Decisions, here: PhaseStart) -> None:
        self._decisions, self._here = decisions, here
        self._tables, self._pending = decisions.tables, _Pending()

    def taken(self) -> Iterator[PhaseRun]:
        """The phases that are over; what is given of the one that is not is kept."""
        tables, pending = self._tables, self._pending
        m, row, track = tables.machine, 0, 0
        rows, tracks = tables.rows[: m.n_rows].copy(), tables.tracks[: m.n_tracks].copy()
        numbers = tables.numbers[: m.n_done].tolist()
        for k in range(m.n_done):
            done = tables.done[k]
            phase, width = self._decisions.phase(done.code)
            last_row, last_track = (width * int(given) for given in (done.rows, done.tracks))
            last_row, last_track = row + last_row - len(pending.rows), track + last_track - len(pending.tracks)
            own = pending.with_(rows[row:last_row], tracks[track:last_track])
            row, track = last_row, last_track
            pending.clear()
            found = self._phase_run((phase, width), k, own, numbers)
            yield found
            if found.after is None:
                return
            self._here = found.after
        pending.add(rows[row:], tracks[track:])
        m.n_done = m.n_rows = m.n_tracks = 0

    def _phase_run(self, of: tuple[PhaseModel, int], k: int, own: _Pending, numbers: Sequence[list[float]]) -> PhaseRun:
        """One phase that is over, by its place among those that are given, with its rows and steps.

        Args:
            of: it, and the length of a row.
        """
        (phase, width), done, n = of, self._tables.done[k], self._tables.width
        rows, tracks = own.in_rows_of(width)
        last = np.array(numbers[k][n : n + width - 1])
        track = StepStates([tracks[:, 0]], [tracks[:, 1:]], 1, int(done.steps), len(tracks))
        end, bound, after, crossing = done.end, None, None, None
        status: RunStatus = "finished"
        message = ""
        is_last = done.bound < 0 and not end < self._tables.machine.end
        if done.bound >= 0:
            bound, status, message = phase.bounds[done.bound], "event", f"Stopped by an event at t = {end:.6g} s."
            crossing = Crossing(int(done.bound), end, last)
        message = message or reached_words(end)
        run = Run(
            rows[:, 0], rows[:, 1:], end, last, status, message, int(done.steps), int(done.evaluations), crossing,
            (track,),
        )  # fmt: skip
        if not is_last:
            after = self._next(k, numbers, partial(phase.values, end, last))
        return PhaseRun(self._here, phase, run, bound, after)

    def _next(self, k: int, numbers: Sequence[list[float]], before: Callable[[], Values]) -> PhaseStart:
        """The start of the phase after one that is over.

        Args:
            k: its place among those that are given.
            before: gives the values at its end.
        """
        tables, m = self._tables, self._tables.machine
        done = tables.done[k]
        if k + 1 < len(numbers):
            values, code = numbers[k + 1][: tables.width], int(tables.done[k + 1].code)
        else:
            values = (tables.values if m.stage == BEGINS else tables.begins).tolist()
            code = int(PhaseTable.from_address(m.now).code)
        named = tables.named(values)
        impact = self._impact(done, numbers[k][2 * tables.width :], before(), named) if done.hit else None
        return PhaseStart(done.end, named, self._decisions.configuration(code), impact, done.limit or None)

    def _impact(self, done: DoneTable, impulses: list[float], before: Values, after: Values) -> Impact:
        free, names = self._tables.models.without_contacts, self._tables.names
        approached = [name for k, name in enumerate(names) if done.approached >> k & 1]
        touching = [name for name in free.contacts if done.touching >> names.index(name) & 1]
        named = {name: impulses[names.index(name)] for name in touching}
        u = np.array([after.get(speed.name, 0.0) for speed in free.system.symbols.u])
        jump = Jump(u, {name: np.array([x]) for name, x in named.items()}, np.array(impulses[len(names) :]))
        impulses_of_joints = free.of_joints(done.end, before, jump)
        named |= free.named_held(impulses[len(names) :])
        return Impact(done.end, ", ".join(approached), named | impulses_of_joints, done.loss)

    def cut(self, stop: BaseException) -> PhaseRun | None:
        """The part of a phase that there is where it was stopped on its way; None where no step was taken."""
        if not len(self._pending.tracks):
            return None
        phase = self._tables.models.of(self._here.configuration)
        rows, tracks = self._pending.in_rows_of(len(phase.moving) + 1)
        t, last = float(tracks[-1, 0]), tracks[-1, 1:]
        if rows[-1, 0] < t:
            rows = np.vstack([rows, tracks[-1]])
        status: RunStatus = "interrupted"
        message = f"Interrupted at t = {t:.6g} s."
        if isinstance(stop, PatienceEnded):
            keep_what_there_is()
            steps = len(tracks) - 1
            why = f"the time to wait (--patience) is over after {steps} steps"
            status, message = "out of patience", f"Gave up at t = {t:.6g} s: {why}."
        track = StepStates([tracks[:, 0]], [tracks[:, 1:]], 1, len(tracks) - 1, len(tracks))
        run = Run(rows[:, 0], rows[:, 1:], t, last, status, message, len(tracks) - 1, 0, None, (track,))
        return PhaseRun(self._here, phase, run, None, None)


@dataclass
class _Pending:
    """Rows and steps of a phase that is not over."""

    rows: np.ndarray = field(default_factory=lambda: np.zeros(0))
    tracks: np.ndarray = field(default_factory=lambda: np.zeros(0))

    def add(self, rows: np.ndarray, tracks: np.ndarray) -> None:
        self.rows, self.tracks = np.concatenate([self.rows, rows]), np.concatenate([self.tracks, tracks])

    def with_(self, rows: np.ndarray, tracks: np.ndarray) -> _Pending:
        if not len(self.rows) and not len(self.tracks):
            return _Pending(rows, tracks)
        return _Pending(np.concatenate([self.rows, rows]), np.concatenate([self.tracks, tracks]))

    def in_rows_of(self, width: int) -> tuple[np.ndarray, np.ndarray]:
        """(rows, steps), each n x width."""
        return self.rows.reshape(-1, width), self.tracks.reshape(-1, width)

    def clear(self) -> None:
        self.rows = self.tracks = np.zeros(0)
