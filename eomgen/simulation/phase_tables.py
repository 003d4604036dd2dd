"""PhaseModels -> the tables by which C knows them: a configuration as a number, what forces must satisfy in it.

The structures are those of `phases.c`, field by field.
"""

from __future__ import annotations

import ctypes
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from eomgen.codegen import Address, RightHandSide
from eomgen.errors import DerivationError
from eomgen.mechanics.kinematics import ContactMode
from eomgen.model import Contact, JointFriction, Model, Table
from eomgen.simulation.compiled_steps import CompiledSteps
from eomgen.simulation.constraint_drift import RankLookout
from eomgen.simulation.contacts import Configuration, EventFunction, Signal
from eomgen.simulation.event_location import Events, EventSearch
from eomgen.simulation.integrator import Stepping
from eomgen.simulation.many_runs import MOST_AT_ONCE, SIZE, MarchFunction, compiled_functions, function_at
from eomgen.simulation.phase_model import PhaseModel, Values
from eomgen.simulation.phase_models import PhaseModels
from eomgen.simulation.singular import NEARNESS

INT, REAL, AT, BITS = ctypes.c_int, ctypes.c_double, ctypes.c_void_p, ctypes.c_ulonglong
MODES, MOST_CONTACTS, MOST_ENDED, MOST_EVENTS = 9, 16, 32, 64  # as of phases.c
RAN_OUT, LEFT, NEEDS_PHASE, NEEDS_SLIDES = range(4)  # of what phases.c answers
BEGINS = 1  # a stage of a motion there
REFUSED, UNDETERMINED, OUTSIDE = 1, 2, 3  # why a phase is not run there
_PUSHES, _GROWS, _HOLDS, _STAYS = range(4)
KINDS = {"ends": 0, "turns": 1, "closes": 2, "stops": 3, "slips": 4}
UNITS = {"force": 0, "rate": 1, "gap": 2}
REBOUNDS = 3


def _fields(kind: Any, names: str) -> list[tuple[str, Any]]:
    return [(name, kind) for name in names.split()]


class ContactTable(ctypes.Structure):
    _fields_ = _fields(INT, "unilateral has_law dry both_ways has_size of_joint rebounds rough rows")


class KnownTable(ctypes.Structure):
    _fields_ = (*_fields(AT, "functions constants"), *_fields(SIZE, "n generation"))


class PhaseTable(ctypes.Structure):
    _fields_ = (
        *_fields(BITS, "code"),
        *_fields(SIZE, "is_refused"),
        *_fields(AT, "march places"),
        *_fields(MarchFunction, "more judged"),
        *_fields(AT, "more_places is_force tests bounds gaps"),
        *_fields(SIZE, "coordinates n_more n_signals n_forces n_accelerations n_tests"),
        ("known", KnownTable),
    )


class SlidesTable(ctypes.Structure):
    _fields_ = (
        *_fields(BITS, "apart"),
        *_fields(SIZE, "n count"),
        ("f", MarchFunction),
        *_fields(AT, "places contacts"),
        ("known", KnownTable),
    )


class ReleasedTable(ctypes.Structure):
    _fields_ = (
        *_fields(SIZE, "n coordinates speeds held rows endings"),
        *_fields(AT, "places rate_places contacts first_rows rebounding"),
        *_fields(SIZE, "n_rebounding"),
        *_fields(MarchFunction, "gaps matrices energy rates restitutions"),
        ("known", KnownTable),
    )


class DoneTable(ctypes.Structure):
    _fields_ = (
        *_fields(BITS, "code"),
        *_fields(SIZE, "steps evaluations rows tracks hit approached touching"),
        ("bound", ctypes.c_long),
        *_fields(REAL, "start end limit loss"),
    )


class Machine(ctypes.Structure):
    _fields_ = (
        *_fields(SIZE, "n_contacts n_values n_phases n_slides any_dry alone rubs"),
        *_fields(AT, "contacts phases slides released is_rate p"),
        *_fields(SIZE, "generation"),
        *_fields(REAL, "end t limit phase_t"),
        *_fields(AT, "values begun after x work impulses e"),
        *_fields(
            SIZE, "by_gauss stage hasty n_ended most_steps steps evaluations taken events passed most_passed is_logged"
        ),
        ("before", BITS),
        ("ended", BITS * MOST_ENDED),
        *_fields(BITS, "together needed"),
        ("bound", ctypes.c_long),
        *_fields(AT, "now instants stops"),
        *_fields(SIZE, "n_instants next n_stops"),
        ("sampled", AT),
        *_fields(SIZE, "hit approached touching"),
        *_fields(REAL, "loss next_limit"),
        ("own", DoneTable),
        *_fields(AT, "last done numbers rows tracks"),
        *_fields(SIZE, "n_done most_done n_rows most_rows n_tracks most_tracks rows_of_phase tracks_of_phase"),
        *_fields(AT, "out columns"),
        *_fields(SIZE, "n_columns"),
        *_fields(AT, "told of_run"),
    )


class ManyTable(ctypes.Structure):
    _fields_ = (
        *_fields(SIZE, "next last is_begun parameters"),
        ("start", REAL),
        ("before", BITS),
        *_fields(AT, "values p x is_done steps"),
    )


# -------- modes ---------------------------------------------------------------------------------------------------
# A configuration as a number: one digit to the base 9 for each contact, 0 where it is open.

_SENSES = (None, 0, 1, -1)


def code_of(modes: Sequence[ContactMode]) -> int:
    """The number of a configuration."""
    digits = [1 + 2 * _SENSES.index(mode.sense) + (mode.push < 0) if mode.closed else 0 for mode in modes]
    return sum(digit * MODES**k for k, digit in enumerate(digits))


def modes_of(code: int, count: int) -> list[ContactMode]:
    """The modes of a configuration."""
    digits = [code // MODES**k % MODES for k in range(count)]
    return [ContactMode(True, _SENSES[(d - 1) // 2], 1 if d % 2 else -1) if d else ContactMode(False) for d in digits]


# -------- what is asked for ---------------------------------------------------------------------------------------


def fits(phase: PhaseModel) -> bool:
    """True if all that decides on the beginning and the end of a phase is a function in C."""
    return phase.functions.rhs.target == "c" and is_decidable(phase)


def is_decidable(phase: PhaseModel) -> bool:
    """True if all that decides on the beginning and the end of a phase is a formula of its state."""
    if phase.loose or phase.fed is not None or phase.edges or not phase.speeds or len(phase.bounds) > MOST_EVENTS:
        return False
    signals = all(s.value is not None and s.column not in phase.signals.with_rank for s in phase.watch.signals)
    bounds = all(b.kind in KINDS and not b.row for b in phase.bounds)
    return signals and bounds and all(what.is_watched for what in phase.undetermined)


def tests_of(phase: PhaseModel, names: Sequence[str]) -> list[tuple[int, ...]]:
    """Conditions on forces and accelerations, as `phase_change.agrees`, by the places of its signals."""
    at = {(s.owner, s.what): k for k, s in enumerate(phase.watch.signals)}
    found: list[tuple[int, ...]] = []
    for contact in phase.contacts:
        mode, name, c = phase.watch.mode(contact), contact.name, names.index(contact.name)
        if not mode.closed:
            found.append((c, _GROWS, 0, 1, at[name, "gap''"], 0, 0))
            continue
        if contact.unilateral or mode.sense != 0:
            pushing = [k for (owner, what), k in at.items() if owner == name and what[0] == "N"]
            found += [(c, _PUSHES, 0, mode.push, k, 0, 0) for k in pushing]
        if mode.sense == 0:
            found.append((c, _HOLDS, 0, 1, at[name, "grip"], at.get((name, "N"), -1), at[name, "hold"]))
            found.append((c, _STAYS, 0, 1, at[name, "slide'"], 0, 0))
        elif mode.sense is not None:
            found.append((c, _GROWS, 1, mode.sense, at[name, "slide'"], 0, 0))
    return found


def is_force(signal: Signal) -> bool:
    """True if a signal counts among the forces by whose size others are judged."""
    return signal.what[0] in "Nhg" and signal.what[:3] != "gap"


def bound_of(bound: EventFunction, contacts: Sequence[Contact]) -> tuple[int, int, int]:
    """(its contact, its kind, the kind of its rounding error)."""
    c = next(k for k, contact in enumerate(contacts) if contact.name == bound.owner)
    rebounds = bound.kind == "closes" and contacts[c].restitution is not None
    return c, KINDS[bound.kind], REBOUNDS if rebounds else UNITS[bound.unit]


def contact_numbers(
    contact: Contact, rough: Collection[str], rows: Mapping[str, Sequence[Any]]
) -> tuple[int | bool, ...]:
    """A contact as `struct contact` of phases.c has it."""
    law = contact.friction
    of_joint = 1 + (law.static is not None) if isinstance(law, JointFriction) else 0
    return (
        contact.unilateral, law is not None, contact.dry, contact.holds_both_ways, contact.size is not None, of_joint,
        contact.restitution is not None, contact.name in rough, len(rows.get(contact.name, ())),
    )  # fmt: skip


# -------- tables --------------------------------------------------------------------------------------------------
# PhaseModels -> the tables of phases.c: the model without contacts, phases and sliding velocities as they are needed.


MOST_VALUES = 8  # names for each contact, more than coordinates, speeds and states: its displacements where it ended
MOST_DONE = 256  # phases that are given at once
ROOM = 1 << 16  # numbers of rows and of tracks that are given at once, beside those of one march


def impact_rules(model: Model) -> tuple[bool, bool, bool]:
    """(a contact is dry, C decides impacts of single contacts alone, it decides none: a joint rubs by its force)."""
    rules = model.impact
    alone = rules is not None and (rules.order == "sequential" or rules.law not in (None, "newton"))
    laws = (law for b in model.bodies.values() if b.joint is not None for _, _, law in b.joint.frictions)
    return any(contact.dry for contact in model.contacts), alone, any(law.coulomb is not None for law in laws)


class TablesInC:
    """The tables of phases.c for a model, and all that they point at.

    Args:
        models: the phases, at the values of the parameters of the next run.
        how: the integrator's options, with the tolerances of one step.
        columns: the only coordinates, speeds and states that phases may have; None: any.
    """

    def __init__(self, models: PhaseModels, how: Stepping, columns: tuple[str, ...] | None = None) -> None:
        self.models, self.how, self.columns = models, how, columns
        model = models.model
        self.names = [contact.name for contact in model.contacts]
        self.entries: list[PhaseTable] = []
        self.places: dict[str, int] = {}
        self._kept: list[Any] = []
        self._largest = 1  # length of a state, of all phases
        self._slides: list[SlidesTable] = []
        self._work_of = 0
        count = len(model.coordinates) * 2 + len(model.speeds) + len(model.states)
        self.width = n = count + MOST_VALUES * (len(model.contacts) + 1)
        m = self.machine = Machine(n_contacts=len(self.names), n_values=n, most_done=MOST_DONE)
        self._is_rate = np.zeros(n, dtype=np.int32)
        self.values, self.begins, self.after = np.zeros(n), np.zeros(n), np.zeros(n)
        m.is_rate, m.values = self._put(self._is_rate), self._put(self.values)
        m.begun, m.after = self._put(self.begins), self._put(self.after)
        m.x, m.last = self._put(np.zeros(n)), self._put(np.zeros(n))
        m.any_dry, m.alone, m.rubs = impact_rules(model)
        self.p = np.array(models.p, dtype=float)
        m.p, m.generation = self._put(self.p), 1
        held = self._release()
        self.done = (DoneTable * MOST_DONE)()
        self.numbers = np.zeros((MOST_DONE, n * 2 + len(self.names) + held))
        m.done, m.numbers = ctypes.addressof(self.done), self._put(self.numbers)
        self._instants, self._sampled = np.zeros(0), np.zeros(0)
        self._work, self.rows, self.tracks = np.zeros(0), np.zeros(0), np.zeros(0)
        breakpoints = np.array(how.breakpoints, dtype=float)
        m.stops, m.n_stops = self._put(breakpoints), len(breakpoints)
        self.size()

    def at(self, models: PhaseModels) -> None:
        """Takes other values of the parameters."""
        self.models = models
        if not np.array_equal(self.p, models.p):
            self.p[:] = models.p
            self.machine.generation += 1
        self.machine.p = self.p.ctypes.data

    def sample(self, instants: np.ndarray) -> None:
        """Takes the instants at which states are wanted."""
        self._instants = np.ascontiguousarray(instants, dtype=float)
        self.machine.instants, self.machine.n_instants = self._instants.ctypes.data, len(instants)

    def named(self, values: Iterable[float]) -> dict[str, float]:
        """Values in their places, by name."""
        return dict(zip(self.places, values, strict=False))

    def place(self, name: str) -> int:
        """Place of a name among the values; that of the last where there is no more."""
        found = self.places.setdefault(name, len(self.places))
        if found < self.width:
            self._is_rate[found] = name.endswith("'")
        return min(found, self.width - 1)

    def add_phase(self, code: int, configuration: Configuration, t: float, values: Values) -> None:
        """Adds a phase, or that it is not run in C."""
        entry = PhaseTable(code=code)
        try:
            phase = self.models.of(configuration)
            if phase.watch.undetermined is not None:
                entry.is_refused = UNDETERMINED
            elif not (fits(phase) and self._fill(entry, phase, t, phase.state(values))):
                entry.is_refused = OUTSIDE
        except DerivationError:
            entry.is_refused = REFUSED
        self.entries.append(entry)
        table = (AT * len(self.entries))(*map(ctypes.addressof, self.entries))
        self._kept.append(table)
        self.machine.phases, self.machine.n_phases = ctypes.addressof(table), len(self.entries)
        self.size()

    def add_slides(self, apart: int) -> None:
        """Adds the sliding velocities where these contacts are open."""
        away = [name for k, name in enumerate(self.names) if apart >> k & 1]
        modes = {name: ContactMode(closed=name not in away) for name in self.names}
        slides = self.models.slides(Configuration(Table(modes)))
        names = [x.name for x in slides.system.symbols.x]
        entry = SlidesTable(apart=apart, n=len(names), count=len(slides.contacts))
        entry.places = self._ints([self.place(name) for name in names])
        entry.contacts = self._ints([self.names.index(contact.name) for contact in slides.contacts])
        self._functions(entry, entry.known, {"f": slides.velocities})
        self._slides.append(entry)
        table = (AT * len(self._slides))(*map(ctypes.addressof, self._slides))
        self._kept.append(table)
        self.machine.slides, self.machine.n_slides = ctypes.addressof(table), len(self._slides)
        self.size()

    def size(self) -> None:
        """Arrays as large as the phases known so far need them."""
        m = self.machine
        samples, row = len(self._instants), self._largest + 1
        self._work = _longer(self._work, self._work_of + self._struck + 2 * self.width)
        self._sampled = _longer(self._sampled, self._largest * (samples + 1))
        self.rows = _longer(self.rows, ROOM + row * (samples + 8))
        self.tracks = _longer(self.tracks, ROOM + row * (MOST_AT_ONCE + 8))
        m.work, m.sampled = self._work.ctypes.data, self._sampled.ctypes.data
        m.rows, m.most_rows = self.rows.ctypes.data, len(self.rows)
        m.tracks, m.most_tracks = self.tracks.ctypes.data, len(self.tracks)

    def _release(self) -> int:
        """The model without the contacts that can end; how many rows of constraints it has."""
        free = self.models.without_contacts
        system, symbols = free.system, free.system.symbols
        names = [x.name for x in symbols.x]
        ending = [self.names.index(name) for name in free.contacts]
        counts = [len(rows) for rows in free.rows.values()]
        first = np.cumsum([0, *counts])[:-1]
        rough = {contact.name for contact in free.rough}
        listed = [ContactTable(*contact_numbers(c, rough, free.rows)) for c in self.models.model.contacts]
        contacts = (ContactTable * len(listed))(*listed)
        rebounding = [self.names.index(name) for name in free.rebounding]
        r = ReleasedTable(
            n=len(names), coordinates=len(symbols.q), speeds=len(symbols.u), held=len(system.constraints.closing),
            rows=sum(counts), endings=len(ending), n_rebounding=len(rebounding),
        )  # fmt: skip
        r.places = self._ints([self.place(name) for name in names])
        r.rate_places = self._ints([self.place(f"{q.name}'") for q in symbols.q])
        r.contacts, r.first_rows, r.rebounding = self._ints(ending), self._ints(first), self._ints(rebounding)
        self._functions(r, r.known, free.functions())
        self.machine.released, self.machine.contacts = ctypes.addressof(r), ctypes.addressof(contacts)
        self.machine.impulses = self._put(np.zeros(len(listed) + int(r.held)))
        self.machine.e = self._put(np.zeros(len(listed)))
        self._kept += [r, contacts]
        whole = int(r.speeds + r.held) + len(ending)
        self._struck = (int(r.speeds + r.held + r.rows) + 1) * (int(r.speeds) + 1) + whole * (whole + 8)
        return int(r.held)

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
        entry.places = self._ints([self.place(name) for name in phase.moving])
        entry.more_places = self._ints([self.place(f"{phase.coordinates[k]}'") for k in lacking])
        entry.is_force = self._ints([is_force(s) for s in signals])
        entry.coordinates, entry.n_more, entry.n_signals = len(phase.coordinates), len(lacking), len(signals)
        entry.n_forces, entry.n_accelerations = len(graph.forcing), len(graph.symbols.a)
        tests = tests_of(phase, self.names)
        entry.tests, entry.n_tests = self._ints([x for test in tests for x in test]), len(tests)
        entry.bounds = self._ints([x for b in phase.bounds for x in bound_of(b, self.models.model.contacts)])
        at = {(s.owner, s.what): k for k, s in enumerate(signals)}
        entry.gaps = self._ints([at.get((name, "gap'"), -1) for name in self.names])
        self._largest = max(self._largest, int(steps.struct.n))
        return len(self.places) <= self.width

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

    def _functions(
        self, entry: Any, known: KnownTable, functions: Mapping[str, RightHandSide], steps: CompiledSteps | None = None
    ) -> None:
        """Puts functions into fields of a structure, and all of them where new parameters find them."""
        made = compiled_functions(tuple(functions.values()))
        placed: list[tuple[int, Address]] = []
        for name, make in zip(functions, made, strict=True):
            address = make(self.p)
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

    def _ints(self, values: Sequence[Any] | np.ndarray) -> int:
        return self._put(np.array(values, dtype=np.int32))

    def _put(self, array: np.ndarray) -> int:
        self._kept.append(array)
        return int(array.ctypes.data)


def _longer(array: np.ndarray, size: int) -> np.ndarray:
    """An array of at least so many numbers, beginning with its own."""
    return array if len(array) >= size else np.concatenate([array, np.zeros(size - len(array))])
