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
from typing import Any, Protocol

import numpy as np

from eomgen.codegen import Address, RightHandSide, in_c
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.impacts import Jump
from eomgen.mechanics.kinematics import ContactMode
from eomgen.model import Table
from eomgen.resources import PatienceEnded, check_patience, keep_what_there_is
from eomgen.simulation.compiled_steps import CompiledSteps
from eomgen.simulation.constraint_drift import RankLookout
from eomgen.simulation.contacts import Configuration
from eomgen.simulation.event_location import Crossing, Events, EventSearch
from eomgen.simulation.integrator import Run, Stepping, StepStates, reached_words
from eomgen.simulation.many_runs import MOST_AT_ONCE, compiled_functions, function_at, machine
from eomgen.simulation.phase_change import PhaseStart, by_gauss
from eomgen.simulation.phase_model import PhaseModel, Values
from eomgen.simulation.phase_models import PhaseModels
from eomgen.simulation.phase_run import PhaseRun
from eomgen.simulation.phase_tables import (
    AT,
    BEGINS,
    LEFT,
    MOST_CONTACTS,
    MOST_ENDED,
    NEEDS_PHASE,
    NEEDS_SLIDES,
    OUTSIDE,
    RAN_OUT,
    REFUSED,
    UNDETERMINED,
    ContactTable,
    DoneTable,
    KnownTable,
    Machine,
    ManyTable,
    PhaseTable,
    ReleasedTable,
    SlidesTable,
    bound_of,
    code_of,
    contact_numbers,
    fits,
    is_force,
    modes_of,
    tests_of,
)
from eomgen.simulation.result import Impact, RunStatus
from eomgen.simulation.singular import NEARNESS

MOST_VALUES = (
    8  # names for each contact, more than coordinates, speeds and states: its displacements where it has ended
)
MOST_DONE = 256  # phases that are given at once
ROOM = 1 << 16  # numbers of rows and of tracks that are given at once, beside those of one march
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
        self.models, self.how, self.columns = models, how, columns
        self._run, self._runs = machine()
        model = models.model
        self.contacts = model.contacts
        self.names = [contact.name for contact in self.contacts]
        self._kept: list[Any] = []
        self._entries: list[PhaseTable] = []
        self._steps: dict[int, CompiledSteps] = {}
        self._slides: list[SlidesTable] = []
        self._places: dict[str, int] = {}
        count = len(model.coordinates) * 2 + len(model.speeds) + len(model.states)
        self.width = n = count + MOST_VALUES * (len(model.contacts) + 1)
        self._known: dict[int, Configuration] = {}
        self._phases: dict[int, tuple[PhaseModel, int]] = {}
        self._work_of = 0
        m = self._m = Machine(n_contacts=len(self.contacts), n_values=n, most_done=MOST_DONE)
        self._is_rate = np.zeros(n, dtype=np.int32)
        self._values = np.zeros(n)
        m.is_rate, m.values = self._put(self._is_rate), self._put(self._values)
        self._begins, self._after = np.zeros(n), np.zeros(n)
        m.begun, m.after = self._put(self._begins), self._put(self._after)
        m.x, m.last = self._put(np.zeros(n)), self._put(np.zeros(n))
        m.any_dry = any(contact.dry for contact in self.contacts)
        rules = model.impact
        m.alone = rules is not None and (rules.order == "sequential" or rules.law not in (None, "newton"))
        frictions = (law for b in model.bodies.values() if b.joint is not None for _, _, law in b.joint.frictions)
        m.rubs = any(law.coulomb is not None for law in frictions)
        self._p = np.array(models.p, dtype=float)
        m.p, m.generation = self._put(self._p), 1
        self._release()
        self._count = n * 2 + len(self.contacts) + int(self._released.held)
        self._done = (DoneTable * MOST_DONE)()
        self._numbers = np.zeros((MOST_DONE, self._count))
        m.done, m.numbers = ctypes.addressof(self._done), self._put(self._numbers)
        self._instants, self._sampled = np.zeros(0), np.zeros(0)
        self._work, self._rows, self._tracks = np.zeros(0), np.zeros(0), np.zeros(0)
        self._breakpoints = np.array(how.breakpoints, dtype=float)
        m.stops, m.n_stops = self._put(self._breakpoints), len(self._breakpoints)
        self._sized()

    # -- what C asks for --------------------------------------------------------------------------

    def at(self, models: PhaseModels) -> CompiledPhases:
        """Itself for the next run, at other values of the parameters."""
        if models is not self.models:
            self.models, self._phases = models, {}
        if not np.array_equal(self._p, models.p):
            self._p[:] = models.p
            self._m.generation += 1
        self._m.p = self._p.ctypes.data
        return self

    def _release(self) -> None:
        """The model without the contacts that can end."""
        free = self.models.without_contacts
        system, symbols = free.system, free.system.symbols
        names = [x.name for x in symbols.x]
        ending = [self.names.index(name) for name in free.contacts]
        counts = [len(rows) for rows in free.rows.values()]
        first = np.cumsum([0, *counts])[:-1]
        rough = {contact.name for contact in free.rough}
        contacts = (ContactTable * len(self.contacts))(
            *(ContactTable(*contact_numbers(c, rough, free.rows)) for c in self.contacts)
        )
        rebounding = [self.names.index(name) for name in free.rebounding]
        r = self._released = ReleasedTable(
            n=len(names), coordinates=len(symbols.q), speeds=len(symbols.u), held=len(system.constraints.closing),
            rows=sum(counts), endings=len(ending), n_rebounding=len(rebounding),
        )  # fmt: skip
        r.places = self._ints([self._place(name) for name in names])
        r.rate_places = self._ints([self._place(f"{q.name}'") for q in symbols.q])
        r.contacts, r.first_rows, r.rebounding = self._ints(ending), self._ints(first), self._ints(rebounding)
        self._functions(r, r.known, free.functions())
        self._m.released, self._m.contacts = ctypes.addressof(r), ctypes.addressof(contacts)
        self._m.impulses = self._put(np.zeros(len(self.contacts) + int(r.held)))
        self._m.e = self._put(np.zeros(len(self.contacts)))
        self._kept += [r, contacts]
        whole = int(r.speeds + r.held) + len(ending)
        self._struck = (int(r.speeds + r.held + r.rows) + 1) * (int(r.speeds) + 1) + whole * (whole + 8)

    def _add_phase(self, code: int, configuration: Configuration, t: float, values: Values) -> None:
        entry = PhaseTable(code=code)
        try:
            phase = self.models.of(configuration)
            if phase.watch.undetermined is not None:
                entry.is_refused = UNDETERMINED
            elif not (fits(phase) and self._fill(entry, phase, t, phase.state(values))):
                entry.is_refused = OUTSIDE
        except DerivationError:
            entry.is_refused = REFUSED
        self._entries.append(entry)
        table = (AT * len(self._entries))(*map(ctypes.addressof, self._entries))
        self._kept.append(table)
        self._m.phases, self._m.n_phases = ctypes.addressof(table), len(self._entries)
        self._sized()

    def _fill(self, entry: PhaseTable, phase: PhaseModel, t: float, x: np.ndarray) -> bool:
        """Functions and tables of a phase; False where not all of them are in C."""
        if self.columns is not None and not {*phase.coordinates, *phase.shown, *phase.states} <= {*self.columns}:
            return False
        graph, signals = phase.equations, phase.watch.signals
        values = (*(s.value for s in signals if s.value is not None), *graph.forcing, *graph.symbols.a)
        rates = phase.system.scope.rates
        lacking = [k for k, q in enumerate(phase.coordinates) if f"{q}'" not in phase.moving]
        more = phase.functions.kinematic(tuple(rates[k] for k in lacking)) if lacking else None
        steps = self._march(phase, t, x)
        if steps.struct.is_blind:
            return False
        entry.march = ctypes.addressof(steps.struct)
        functions = {"judged": phase.functions.function(values)} | ({"more": more} if more is not None else {})
        self._functions(entry, entry.known, functions, steps)
        entry.places = self._ints([self._place(name) for name in phase.moving])
        entry.more_places = self._ints([self._place(f"{phase.coordinates[k]}'") for k in lacking])
        entry.is_force = self._ints([is_force(s) for s in signals])
        entry.coordinates, entry.n_more, entry.n_signals = len(phase.coordinates), len(lacking), len(signals)
        entry.n_forces, entry.n_accelerations = len(graph.forcing), len(graph.symbols.a)
        tests = tests_of(phase, self.names)
        entry.tests, entry.n_tests = self._ints([x for test in tests for x in test]), len(tests)
        entry.bounds = self._ints([x for b in phase.bounds for x in bound_of(b, self.contacts)])
        at = {(s.owner, s.what): k for k, s in enumerate(signals)}
        entry.gaps = self._ints([at.get((name, "gap'"), -1) for name in self.names])
        self._steps[int(entry.code)] = steps
        return len(self._places) <= self.width

    def _march(self, phase: PhaseModel, t: float, x: np.ndarray) -> CompiledSteps:
        """The march of a phase, with what ends it."""
        search = None
        if phase.bounds:
            floors = np.zeros(len(phase.bounds))
            events = Events(phase.signals.watched, floors, measured=phase.signals.measured(()))
            search = EventSearch(events, t, x)
        nearness = phase.nearness
        lookout = None if nearness is None else RankLookout(nearness, NEARNESS[0], t, x)
        watched = (self.how.hold(phase.functions.rhs.unit_quaternions, phase.projection), search, lookout)
        rate = phase.functions.rhs.at(np.array(self.models.p))  # with constants of its own
        return CompiledSteps(
            rate, (t, t + 1), x, how=self.how, instants=None, watched=watched, slope=lambda: phase.slope
        )

    def _add_slides(self, apart: int) -> None:
        away = [name for k, name in enumerate(self.names) if apart >> k & 1]
        modes = {name: ContactMode(closed=name not in away) for name in self.names}
        slides = self.models.slides(Configuration(Table(modes)))
        names = [x.name for x in slides.system.symbols.x]
        entry = SlidesTable(apart=apart, n=len(names), count=len(slides.contacts))
        entry.places = self._ints([self._place(name) for name in names])
        entry.contacts = self._ints([self.names.index(contact.name) for contact in slides.contacts])
        self._functions(entry, entry.known, {"f": slides.velocities})
        self._slides.append(entry)
        table = (AT * len(self._slides))(*map(ctypes.addressof, self._slides))
        self._kept.append(table)
        self._m.slides, self._m.n_slides = ctypes.addressof(table), len(self._slides)
        self._sized()

    def _functions(
        self, entry: Any, known: KnownTable, functions: Mapping[str, RightHandSide], steps: CompiledSteps | None = None
    ) -> None:
        """Puts functions into fields of a structure, and all of them where new parameters find them."""
        made = compiled_functions(tuple(functions.values()))
        placed: list[tuple[int, Address]] = []
        for name, make in zip(functions, made, strict=True):
            address = make(self._p)
            setattr(entry, name, function_at(address))
            placed.append((ctypes.addressof(entry) + getattr(type(entry), name).offset, address))
        if steps is not None:
            first = ctypes.addressof(steps.struct)
            placed += [(first + offset, address) for offset, address in steps.placed]
        known.functions = self._put(np.array([at for at, _ in placed], dtype=np.uintp))
        known.constants = self._put(np.array([address.constants for _, address in placed], dtype=np.uintp))
        known.n = len(placed)
        self._work_of = max(self._work_of, *(len(f.program.outputs) for f in functions.values()))
        self._kept += [entry, steps, *(address for _, address in placed)]

    def _place(self, name: str) -> int:
        found = self._places.setdefault(name, len(self._places))
        if found < self.width:
            self._is_rate[found] = name.endswith("'")
        return min(found, self.width - 1)

    def _sized(self) -> None:
        """Arrays as large as the phases known so far need them."""
        m = self._m
        n = max((steps.struct.n for steps in self._steps.values()), default=1)
        work = self._work_of + self._struck + 2 * self.width
        for name, size in (("work", work), ("sampled", n * (len(self._instants) + 1))):
            if len(getattr(self, f"_{name}")) < size:
                setattr(self, f"_{name}", np.zeros(size))
            setattr(m, name, getattr(self, f"_{name}").ctypes.data)
        row = n + 1
        for name, most in (("rows", len(self._instants) + 8), ("tracks", MOST_AT_ONCE + 8)):
            size = ROOM + row * most
            if len(getattr(self, f"_{name}")) < size:  # what was given has been taken
                kept = getattr(self, f"_{name}")
                setattr(self, f"_{name}", np.concatenate([kept, np.zeros(size - len(kept))]))
            setattr(m, name, getattr(self, f"_{name}").ctypes.data)
            setattr(m, f"most_{name}", len(getattr(self, f"_{name}")))

    def _ints(self, values: Sequence[Any] | np.ndarray) -> int:
        return self._put(np.array(values, dtype=np.int32))

    def _put(self, array: np.ndarray) -> int:
        self._kept.append(array)
        return int(array.ctypes.data)

    # -- many runs --------------------------------------------------------------------------------------

    def with_names(self, names: Iterable[str]) -> None:
        """Gives names their places, in this order."""
        for name in names:
            self._place(name)

    def values(self, columns: Mapping[str, np.ndarray], runs: int) -> np.ndarray:
        """Values of many runs, each in its place, runs x values, by name."""
        found = np.zeros((runs, self.width))
        for name, column in columns.items():
            found[:, self._place(name)] = column
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
        m, (values, p, before) = self._m, starts
        columns = np.full(self.width, -1, dtype=np.int32)
        for k, name in enumerate(self.columns or ()):
            columns[self._place(name)] = k
        self._instants = np.ascontiguousarray(instants, dtype=float)
        m.instants, m.n_instants, m.columns, m.n_columns = (
            self._instants.ctypes.data, len(instants), columns.ctypes.data, found.x.shape[2],
        )  # fmt: skip
        m.end, m.is_logged, m.most_passed, m.most_steps = end, 0, MOST_PASSED, self.how.most_steps
        many = ManyTable(next=piece[0], last=piece[1], parameters=p.shape[1], before=self._code(before))
        many.values, many.p, many.x = values.ctypes.data, p.ctypes.data, found.x.ctypes.data
        many.is_done, many.steps = found.is_done.ctypes.data, found.steps.ctypes.data
        self._sized()
        while not stop.is_set():
            answer = self._runs(ctypes.byref(m), ctypes.byref(many), AT_ONCE)
            if answer == RAN_OUT:
                return
            if answer in (NEEDS_PHASE, NEEDS_SLIDES):
                self._p[:] = p[many.next]  # the values at which what is made is first evaluated
                self._make(int(m.needed), answer)

    # -- one run ----------------------------------------------------------------------------------------

    def through(self, here: PhaseStart, plan: ThroughPhases, ended: Collection[Configuration]) -> Iterator[PhaseRun]:
        """The phases from a start on; after the last nothing follows where the end is reached, else others go on.


        Args:
            ended: the configurations that ended at this instant.
        """
        m = self._m
        if plan.instants is None or not self._begun(here, plan.end, plan.instants, ended):
            return
        pending = _Pending()
        while True:
            found = self._run(ctypes.byref(m), MOST_AT_ONCE * 20)
            for each in self._taken(here, pending):
                yield each
                if each.after is None:
                    return
                here = each.after
            if found == LEFT:
                return
            if found in (NEEDS_PHASE, NEEDS_SLIDES):
                self._make(int(m.needed), found)
            try:
                check_patience()
            except (PatienceEnded, KeyboardInterrupt) as stop:
                cut = None if not (self.how.keeps and len(pending.tracks)) else self._cut(here, pending, stop)
                if cut is None:
                    raise
                yield cut
                return

    def _begun(self, here: PhaseStart, end: float, instants: np.ndarray, ended: Collection[Configuration]) -> bool:
        m, n = self._m, self.width
        if len(ended) > MOST_ENDED or n * len(instants) > MOST_SAMPLED:
            return False
        self._instants = np.ascontiguousarray(instants, dtype=float)
        m.instants, m.n_instants = self._instants.ctypes.data, len(instants)
        m.next = int(np.searchsorted(self._instants, here.t, side="left"))
        self._values[:] = 0
        for name, value in here.values.items():
            k = self._places.get(name)
            if k is not None:
                self._values[k] = value
        m.t, m.end, m.limit, m.stage, m.is_logged = here.t, end, here.limit or 0.0, BEGINS, 1
        m.n_done = m.n_rows = m.n_tracks = m.hasty = m.by_gauss = 0
        m.most_passed, m.passed, m.most_steps = 1 << 40, 0, self.how.most_steps
        for k, configuration in enumerate(ended):
            m.ended[k] = self._code(configuration)
        m.n_ended = len(ended)
        code = self._code(here.configuration)
        entry = next((entry for entry in self._entries if entry.code == code), None)
        if entry is None:
            self._add_phase(code, here.configuration, here.t, here.values)
            return self._begun(here, end, instants, ended)  # its names have places now
        m.now = ctypes.addressof(entry)
        self._sized()
        return not entry.is_refused

    def _code(self, configuration: Configuration) -> int:
        return code_of([configuration.modes[name] for name in self.names])

    def _phase(self, code: int) -> tuple[PhaseModel, int]:
        """(a phase, the length of its rows)."""
        if code not in self._phases:
            phase = self.models.of(self._configuration(code))
            self._phases[code] = phase, len(phase.moving) + 1
        return self._phases[code]

    def _configuration(self, code: int) -> Configuration:
        if code not in self._known:
            modes = dict(zip(self.names, modes_of(code, len(self.names)), strict=True))
            self._known[code] = Configuration(Table(modes))
        return self._known[code]

    def _make(self, needed: int, what: int) -> None:
        """The phase or the sliding velocities that C needs."""
        if what == NEEDS_SLIDES:
            self._add_slides(needed)
        else:
            values = dict(zip(self._places, self._after.tolist(), strict=False))
            if self._m.by_gauss:
                needed = self._by_gauss(needed, values)
            if all(entry.code != needed for entry in self._entries):
                self._add_phase(needed, self._configuration(needed), self._m.t, values)

    def _by_gauss(self, first: int, values: Values) -> int:
        """The number of the configuration in which joints at rest go on, where all of them stick in the first."""
        near = self._configuration(first)
        resting = [c for c in self.contacts if c.size is not None and near.modes[c.name].sense == 0]
        found = by_gauss(self.models, self._m.t, values, near, resting)
        return code_of([found[0][name] for name in self.names]) if found else first

    def _taken(self, here: PhaseStart, pending: _Pending) -> Iterator[PhaseRun]:
        """The phases that are given, and what is given of the one that is not over."""
        m, row, track = self._m, 0, 0
        rows, tracks = self._rows[: m.n_rows].copy(), self._tracks[: m.n_tracks].copy()
        numbers = self._numbers[: m.n_done].tolist()
        for k in range(m.n_done):
            done = self._done[k]
            phase, width = self._phase(done.code)
            last_row, last_track = (width * int(given) for given in (done.rows, done.tracks))
            last_row, last_track = row + last_row - len(pending.rows), track + last_track - len(pending.tracks)
            own = pending.with_(rows[row:last_row], tracks[track:last_track])
            row, track = last_row, last_track
            pending.clear()
            following = numbers[k + 1] if k + 1 < m.n_done else None
            found = self._phase_run(here, (phase, width), done, own, numbers[k], following)
            yield found
            if found.after is None:
                return
            here = found.after
        pending.add(rows[row:], tracks[track:])
        m.n_done = m.n_rows = m.n_tracks = 0

    def _phase_run(
        self, here: PhaseStart, of: tuple[PhaseModel, int], done: DoneTable, own: _Pending, numbers: list[float],
        following: list[float] | None,
    ) -> PhaseRun:  # fmt: skip
        phase, width = of
        rows, tracks = own.rows.reshape(-1, width), own.tracks.reshape(-1, width)
        last = np.array(numbers[self.width : self.width + width - 1])
        track = StepStates([tracks[:, 0]], [tracks[:, 1:]], 1, int(done.steps), len(tracks))
        end, bound, after, crossing = done.end, None, None, None
        status: RunStatus = "finished"
        message = ""
        is_last = done.bound < 0 and not end < self._m.end
        if done.bound >= 0:
            bound, status, message = phase.bounds[done.bound], "event", f"Stopped by an event at t = {end:.6g} s."
            crossing = Crossing(int(done.bound), end, last)
        message = message or reached_words(end)
        run = Run(
            rows[:, 0], rows[:, 1:], end, last, status, message, int(done.steps), int(done.evaluations), crossing,
            (track,),
        )  # fmt: skip
        if not is_last:
            after = self._next(done, numbers, following, partial(phase.values, end, last))
        return PhaseRun(here, phase, run, bound, after)

    def _next(
        self, done: DoneTable, numbers: list[float], following: list[float] | None, before: Callable[[], Values]
    ) -> PhaseStart:
        """The start of the phase after one that is over.

        Args:
            before: gives the values at its end.
        """
        m = self._m
        if following is not None:
            values = following[: self.width]
            code = int(self._done_after(done).code)
        else:
            values = (self._values if m.stage == BEGINS else self._begins).tolist()
            code = int(PhaseTable.from_address(m.now).code)
        named = dict(zip(self._places, values, strict=False))
        impact = self._impact(done, numbers[2 * self.width :], before(), named) if done.hit else None
        return PhaseStart(done.end, named, self._configuration(code), impact, done.limit or None)

    def _done_after(self, done: DoneTable) -> DoneTable:
        k = (ctypes.addressof(done) - ctypes.addressof(self._done)) // ctypes.sizeof(DoneTable)
        return self._done[k + 1]

    def _impact(self, done: DoneTable, impulses: list[float], before: Values, after: Values) -> Impact:
        free, n = self.models.without_contacts, len(self.names)
        approached = [name for k, name in enumerate(self.names) if done.approached >> k & 1]
        touching = [name for name in free.contacts if done.touching >> self.names.index(name) & 1]
        named = {name: impulses[self.names.index(name)] for name in touching}
        u = np.array([after.get(speed.name, 0.0) for speed in free.system.symbols.u])
        jump = Jump(u, {name: np.array([x]) for name, x in named.items()}, np.array(impulses[n:]))
        impulses_of_joints = free.of_joints(done.end, before, jump)
        named |= free.named_held(impulses[n:])
        return Impact(done.end, ", ".join(approached), named | impulses_of_joints, done.loss)

    def _cut(self, here: PhaseStart, pending: _Pending, stop: BaseException) -> PhaseRun:
        """The part of a phase that there is where it was stopped on its way."""
        phase = self.models.of(here.configuration)
        width = len(phase.moving) + 1
        rows, tracks = pending.rows.reshape(-1, width), pending.tracks.reshape(-1, width)
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
        return PhaseRun(here, phase, run, None, None)


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

    def clear(self) -> None:
        self.rows = self.tracks = np.zeros(0)
