"""PhaseModels -> C: an integrator of its own for a model whose contacts change, NAME_run.c and NAME_run.h.

All phases that there may be are written, each by the formulas that a run has compiled; `march.c` and `phases.c` go
through them as they do here. What these leave to Python stops the program, which says so. It carries its own test: the
instants and the last state of eomgen's own run.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from importlib import resources
from itertools import product
from typing import Any

import numpy as np

from eomgen.codegen import Program, hidden_in_c
from eomgen.errors import DerivationError, UsageError
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import ContactMode
from eomgen.model import Contact, Model, Table
from eomgen.simulation.contacts import Configuration
from eomgen.simulation.many_runs import march_text
from eomgen.simulation.phase_change import plain_configuration
from eomgen.simulation.phase_model import PhaseModel
from eomgen.simulation.phase_models import PhaseModels
from eomgen.simulation.phase_tables import (
    MOST_CONTACTS,
    MOST_EVENTS,
    REFUSED,
    UNDETERMINED,
    bound_of,
    code_of,
    contact_numbers,
    impact_rules,
    is_decidable,
    is_force,
    tests_of,
)
from eomgen.simulation.result import Impact
from eomgen.simulation.singular import NEARNESS

MOST_PHASES = 128  # that are written
AT_ONCE = 64  # steps in a call
PART = "eomgen_part"  # the name of a function before it has its own


def _modes(contact: Contact) -> list[ContactMode]:
    """The modes that a contact may have."""
    pushes = (1, -1) if contact.holds_both_ways else (1,)
    if contact.dry:
        found = [ContactMode(sense=0), *(ContactMode(sense=s, push=push) for s in (1, -1) for push in pushes)]
    else:
        found = [ContactMode(push=push) for push in pushes]
    return [*found, ContactMode(closed=False)] if contact.unilateral else found


@dataclass
class _Text:
    """Text that grows: functions, tables and the lines that set a run up."""

    stem: str
    functions: list[str] = field(default_factory=list)
    makers: list[str] = field(default_factory=list)
    tables: list[str] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)
    known: dict[str, str] = field(default_factory=dict)
    constants: int = 0
    outputs: int = 1

    def function(self, at: str, program: Program) -> None:
        """A function at a place of the run."""
        text, constants = hidden_in_c(program, PART)
        if text not in self.known:
            self.known[text] = stem = f"{self.stem}_f{len(self.known)}"
            self.functions.append(text.replace(PART, stem))
        stem = self.known[text]
        self.lines.append(f"NAME_function(o, {len(self.makers)}, &{at}, {stem}_evaluate, {self.constants});")
        self.makers.append(f"{stem}_constants")
        self.constants += constants
        self.outputs = max(self.outputs, len(program.outputs))

    def since(self, at: str, first: int) -> None:
        """The functions since the first, which new parameters find."""
        self.lines.append(f"{at}.functions = o->functions + {first}, {at}.constants = NAME_makers + {first};")
        self.lines.append(f"{at}.n = {len(self.makers) - first};")

    def table(self, name: str, values: Sequence[Any], kind: str = "int") -> str:
        """A table of numbers; its name."""
        listed = ", ".join(str(int(x)) for x in values) or "0"
        self.tables.append(f"static const {kind} NAME_{name}[] = {{{listed}}};")
        return f"NAME_{name}"


@dataclass(frozen=True)
class PhaseIntegrator:
    """An integrator of its own for a model whose contacts change.

    Args:
        models: the phases, whose functions need no compiler (target "numpy").
        stem: NAME.
        states: the order of the states in `x` and in rows.
        start, values: of the states and parameters in its program, None where one is missing.
        rtol: the default there.
        tested: (instants of the changes, last instant, last state by name) of eomgen's own run; None: there is none.
    """

    models: PhaseModels
    stem: str
    states: tuple[str, ...]
    start: Sequence[float] | None
    values: Sequence[float] | None
    rtol: float
    tested: tuple[Sequence[float], float, Mapping[str, float]] | None

    @functools.cached_property
    def names(self) -> list[str]:
        return [contact.name for contact in self.models.model.contacts]

    @staticmethod
    def refuse(model: Model) -> None:
        """Refuses a model whose phases are not all decided by formulas of their states.

        Raises:
            UsageError: what is not, by its name.
        """
        fix = "take eomgen simulate"
        if model.on_paths:
            names = ", ".join(f"'{name}'" for name in model.on_paths)
            raise UsageError(f"no integrator for what changes its equations: {names}, on paths of pieces", fix=fix)
        for contact in model.contacts:
            rubs = contact.unilateral and contact.mu is not None
            why = {
                "slides on a surface in any direction": contact.surface,
                "rubs in its impacts": rubs and (contact.restitution is not None or model.impact is not None),
            }
            for what in (what for what, is_so in why.items() if is_so):
                raise UsageError(f"no integrator for {contact.words}, which {what}", fix=fix)
        if len(model.contacts) > MOST_CONTACTS or math.prod(len(_modes(c)) for c in model.contacts) > MOST_PHASES:
            raise UsageError(f"no integrator for {len(model.contacts)} contacts: too many phases", fix=fix)

    @staticmethod
    def decides(model: Model, impact: Impact) -> bool:
        """True if it goes on through an impact; else it ends there."""
        _, alone, rubs = impact_rules(model)
        return not (rubs or (alone and "," in impact.contact))

    def files(self) -> dict[str, str]:
        """NAME_run.h and NAME_run.c.

        Raises:
            UsageError: as of `refuse`; or a phase is not decided by formulas.
        """
        self.refuse(self.models.model)
        text, places = _Text(self.stem), _Places()
        phases = self._phases(text, places)
        n_slides = self._slides(text, places)
        held = self._released(text, places)
        further = dict.fromkeys(
            name for phase in phases if phase is not None for name in (*phase.coordinates, *phase.shown, *phase.states)
        )
        columns = (*self.states, *(name for name in further if name not in self.states))
        self._machine(text, places, columns)
        words = self._words(text, len(places.names), phases, columns, (n_slides, held))
        defined = [f"#define NAME_{name} {value}" for name, value in words.items()]
        parts = [
            f'#include "{self.stem}_run.h"',
            "\n".join(["#define MOST_AT_ONCE " + str(AT_ONCE), f"#define RTOL {self.rtol!r}"]),
            re.sub(r"#define MOST_AT_ONCE .*\n", "", march_text(phases=True)),
            "\n\n".join(text.functions),
            "\n".join([*defined, *text.tables, *self._named_tables(columns), *_makers(text)]),
            resources.files("eomgen.simulation").joinpath("phases_run.c").read_text("utf-8"),
            "\n".join(["static void NAME_set(struct own *o)", "{", *(f"    {line}" for line in text.lines), "}"]),
            self._self_test(columns),
        ]
        whole = _named("\n\n".join(part.strip() for part in parts) + "\n", self.stem)
        return {f"{self.stem}_run.h": self._header(words), f"{self.stem}_run.c": whole}

    def _header(self, words: Mapping[str, str]) -> str:
        text = resources.files("eomgen.simulation").joinpath("phases_run.h").read_text("utf-8")
        numbers = {name: words[name] for name in ("CONTACTS", "STATES", "MEMORY", "ROOM")}
        for name, value in numbers.items():
            text = text.replace(f"@{name}@", value)
        return _named(text, self.stem).replace("@UPPER@", self.stem.upper())

    @functools.cached_property
    def _declared(self) -> System:
        """The system whose states are those of rows.

        Raises:
            UsageError: with no contacts open, or all of them, there are other states.
        """
        model = self.models.model
        for away in ((), self.models.ends):
            try:
                system = self.models.of(plain_configuration(model, {}, away)).declared
            except DerivationError:  # nothing can hold it
                continue
            if tuple(x.name for x in system.symbols.x) == self.states:
                return system
        what = f"no integrator for '{model.name}': its contacts change its coordinates"
        raise UsageError(what, fix="coordinates that are free of the contacts")

    # -- phases ---------------------------------------------------------------------------------------

    def _phases(self, text: _Text, places: _Places) -> list[PhaseModel | None]:
        contacts = self.models.model.contacts
        found: list[PhaseModel | None] = []
        for k, modes in enumerate(product(*map(_modes, contacts))):
            configuration = Configuration(Table(dict(zip(self.names, modes, strict=True))))
            code, at = code_of(modes), f"o->phases[{k}]"
            text.lines.append(f"{at}.code = {code}ull, {at}.m = o->marches + {k};")
            try:
                phase = self.models.of(configuration)
                refused = UNDETERMINED if phase.watch.undetermined is not None else 0
            except DerivationError:
                phase, refused = None, REFUSED
            if phase is None or refused:
                text.lines.append(f"{at}.is_refused = {refused};")
                found.append(None)
                continue
            if not is_decidable(phase):
                what = "a reaction of its contacts has no formula that holds at all states"
                raise UsageError(f"no integrator for '{self.models.model.name}': {what}", fix="take eomgen simulate")
            self._phase(text, places, k, phase)
            found.append(phase)
        return found

    def _phase(self, text: _Text, places: _Places, k: int, phase: PhaseModel) -> None:
        """Functions and tables of one phase, as of `CompiledPhases`."""
        at, march, first, graph = f"o->phases[{k}]", f"o->marches[{k}]", len(text.makers), phase.equations
        signals = phase.watch.signals
        values = (*(s.value for s in signals if s.value is not None), *graph.forcing, *graph.symbols.a)
        text.function(f"{at}.judged", phase.functions.function(values).program)
        lacking = [i for i, q in enumerate(phase.coordinates) if f"{q}'" not in phase.moving]
        if lacking:
            rates = phase.system.scope.rates
            text.function(f"{at}.more", phase.functions.kinematic(tuple(rates[i] for i in lacking)).program)
        text.function(f"{march}.rate", phase.functions.rhs.program)
        for field_, function in _watched(phase):
            text.function(f"{march}.{field_}", function)
        text.since(f"{at}.known", first)
        tables: dict[str, Sequence[Any]] = {
            "places": [places.of(name) for name in phase.moving],
            "more_places": [places.of(f"{phase.coordinates[i]}'") for i in lacking],
            "is_force": [is_force(s) for s in signals],
            "gaps": _gaps(phase, self.names),
        }
        for name, numbers in tables.items():
            text.lines.append(f"{at}.{name} = {text.table(f'{name}_{k}', numbers)};")
        tests, bounds = tests_of(phase, self.names), [bound_of(b, phase.contacts) for b in phase.bounds]
        listed = ", ".join(f"{{{', '.join(map(str, test))}}}" for test in tests) or "{0}"
        text.tables.append(f"static const struct test NAME_tests_{k}[] = {{{listed}}};")
        listed = ", ".join(f"{{{', '.join(map(str, bound))}}}" for bound in bounds) or "{0}"
        text.tables.append(f"static const struct bound NAME_bounds_{k}[] = {{{listed}}};")
        sizes = {
            "coordinates": len(phase.coordinates), "n_more": len(lacking), "n_signals": len(signals),
            "n_forces": len(graph.forcing), "n_accelerations": len(graph.symbols.a), "n_tests": len(tests),
        }  # fmt: skip
        text.lines += [f"{at}.{name} = {value};" for name, value in sizes.items()]
        text.lines.append(f"{at}.tests = NAME_tests_{k}, {at}.bounds = NAME_bounds_{k};")
        text.lines += [f"{march}.{name} = {value};" for name, value in _sizes(phase).items()]
        text.lines.append(f"{march}.near = {NEARNESS[0]!r};")
        quaternions = [place for four in phase.functions.rhs.unit_quaternions for place in four]
        if quaternions:
            text.lines.append(f"{march}.spheres = {text.table(f'spheres_{k}', quaternions)};")

    def _slides(self, text: _Text, places: _Places) -> int:
        """The sliding velocities for each set of open contacts; how many there are."""
        model, ending = self.models.model, [k for k, c in enumerate(self.models.model.contacts) if c.unilateral]
        if not any(contact.dry for contact in model.contacts):
            return 0
        for number, away in enumerate(product((False, True), repeat=len(ending))):
            open_ = {ending[i] for i, is_open in enumerate(away) if is_open}
            modes = {name: ContactMode(closed=k not in open_) for k, name in enumerate(self.names)}
            slides, at = self.models.slides(Configuration(Table(modes))), f"o->slides[{number}]"
            states = [x.name for x in slides.system.symbols.x]
            first = len(text.makers)
            text.function(f"{at}.f", slides.velocities.program)
            text.since(f"{at}.known", first)
            text.lines.append(f"{at}.apart = {sum(1 << k for k in open_)}ull, {at}.n = {len(states)};")
            text.lines.append(f"{at}.count = {len(slides.contacts)};")
            table = text.table(f"slide_places_{number}", [places.of(name) for name in states])
            sliding = text.table(f"sliding_{number}", [self.names.index(c.name) for c in slides.contacts])
            text.lines.append(f"{at}.places = {table}, {at}.contacts = {sliding};")
        return 1 << len(ending)

    def _released(self, text: _Text, places: _Places) -> int:
        """The model without the contacts that can end; how many rows of constraints it has."""
        free, at, first = self.models.without_contacts, "o->released", len(text.makers)
        if any(row is None for rows in free.rows.values() for row in [rows[0].gap]):
            raise UsageError("no integrator for strings whose slack is integrated", fix="take eomgen simulate")
        symbols = free.system.symbols
        for name, function in free.functions().items():
            text.function(f"{at}.{name}", function.program)
        text.since(f"{at}.known", first)
        counts = [len(rows) for rows in free.rows.values()]
        tables: dict[str, Sequence[Any]] = {
            "places": [places.of(x.name) for x in symbols.x],
            "rate_places": [places.of(f"{q.name}'") for q in symbols.q],
            "contacts": [self.names.index(name) for name in free.contacts],
            "first_rows": np.cumsum([0, *counts])[:-1].tolist(),
            "rebounding": [self.names.index(name) for name in free.rebounding],
        }
        for name, numbers in tables.items():
            text.lines.append(f"{at}.{name} = {text.table(f'free_{name}', numbers)};")
        held = len(free.system.constraints.closing)
        sizes = {
            "n": len(symbols.x), "coordinates": len(symbols.q), "speeds": len(symbols.u), "held": held,
            "rows": sum(counts), "endings": len(free.contacts), "n_rebounding": len(free.rebounding),
        }  # fmt: skip
        text.lines += [f"{at}.{name} = {value};" for name, value in sizes.items()]
        whole = len(symbols.u) + held + len(free.contacts)
        struck = (len(symbols.u) + held + sum(counts) + 1) * (len(symbols.u) + 1) + whole * (whole + 8)
        text.outputs = max(text.outputs, struck)
        return held

    def _machine(self, text: _Text, places: _Places, shown: Sequence[str]) -> None:
        """The contacts, how their impacts are decided, and the rates of all coordinates at the start."""
        model, free = self.models.model, self.models.without_contacts
        system, first = self._declared, len(text.makers)
        rates = Program.of(tuple(system.scope.rates), system.symbols, inputs=system.inputs)
        text.function("o->begun", rates)
        text.since("o->known", first)
        text.table("rates_of", [places.of(f"{q.name}'") for q in system.symbols.q])
        rough = {contact.name for contact in free.rough}
        listed = ", ".join(
            f"{{{', '.join(str(int(x)) for x in contact_numbers(contact, rough, free.rows))}}}"
            for contact in model.contacts
        )
        text.tables.append(f"static const struct contact NAME_kinds[] = {{{listed}}};")
        dry, alone, rubs = impact_rules(model)
        text.lines.append("o->k.contacts = NAME_kinds;")
        text.lines.append(f"o->k.any_dry = {int(dry)}, o->k.alone = {int(alone)}, o->k.rubs = {int(rubs)};")
        text.lines.append("o->k.is_rate = NAME_is_rate;")
        text.table("columns_of", [places.of(name) for name in shown])
        text.table("columns", [shown.index(name) if name in shown else -1 for name in places.names])
        text.table("is_rate", [name.endswith("'") for name in places.names])

    def _words(
        self, text: _Text, width: int, phases: Sequence[PhaseModel | None], columns: Sequence[str], of: tuple[int, int]
    ) -> dict[str, str]:
        """The sizes of all arrays.

        Args:
            of: how many sliding velocities there are, and rows of constraints without contacts.
        """
        n_slides, held = of
        made = [phase for phase in phases if phase is not None]
        if not made:
            raise UsageError("no integrator: none of its phases is determined", fix="take eomgen simulate")
        rows = max(_sizes(phase).get("n_rows", 0) + _sizes(phase).get("n_determinants", 0) for phase in made)
        march_work = max(_work(phase) for phase in made)
        most = max(len(phase.moving) for phase in made)
        memory = 80 * width + 72 * AT_ONCE + AT_ONCE * width + 20 * MOST_EVENTS + 200 * len(phases)
        work = text.outputs + 2 * width
        memory += march_work + work + text.constants + 3 * len(text.makers) + 60 * n_slides + 2000
        closed = plain_configuration(self.models.model, {}, ())
        words = {
            "PHASES": len(phases), "SLIDES": n_slides, "FUNCTIONS": len(text.makers), "CONSTANTS": text.constants,
            "WIDTH": width, "CONTACTS": len(self.names), "HELD": held, "ROWS": rows, "MARCH_WORK": march_work,
            "WORK": work, "PIVOTS": 4 * width + 64, "ROOM": len(columns) + most, "MEMORY": memory,
            "CLOSED": f"{code_of([closed.modes[name] for name in self.names])}ull",
        }  # fmt: skip
        symbols = next(iter(made)).system.symbols
        words |= {"STATES": len(columns), "PARAMETERS": len(symbols.parameters)}
        words["COORDINATES"] = len(self._declared.symbols.q)
        start = [*(self.start or [0.0] * len(self.states)), *[0.0] * (len(columns) - len(self.states))]
        values = [*(self.values or [math.nan] * len(symbols.parameters)), 0.0]
        return {name: str(value) for name, value in words.items()} | {
            "START": _numbers(start),
            "VALUES": _numbers(values),
        }

    def _named_tables(self, columns: Sequence[str]) -> list[str]:
        parameters = [*self.models.model.parameters, ""]
        main = [
            f"static const char *const NAME_states[] = {_quoted(columns)};",
            f"static const char *const NAME_parameters[] = {_quoted(parameters)};",
            f"static const char *const NAME_contacts[] = {_quoted(self.names)};",
        ]
        return ["#ifdef NAME_MAIN", *main, "#endif"]

    def _self_test(self, columns: Sequence[str]) -> str:
        """A program that compares with eomgen's own run; "" where there is none."""
        if self.tested is None or self.start is None or self.values is None:
            return ""
        instants, end, last = self.tested
        text = resources.files("eomgen.simulation").joinpath("phases_test.c").read_text("utf-8")
        words = {"INSTANTS": _numbers([*instants, 0.0]), "COUNT": str(len(instants)), "END": repr(float(end))}
        for name, value in (words | {"LAST": _numbers([last.get(name, 0.0) for name in columns])}).items():
            text = text.replace(f"@{name}@", value)
        return text


@dataclass
class _Places:
    """The places of names among the values of a motion."""

    names: list[str] = field(default_factory=list)

    def of(self, name: str) -> int:
        if name not in self.names:
            self.names.append(name)
        return self.names.index(name)


def _gaps(phase: PhaseModel, names: Sequence[str]) -> list[int]:
    at = {(s.owner, s.what): k for k, s in enumerate(phase.watch.signals)}
    return [at.get((name, "gap'"), -1) for name in names]


def _watched(phase: PhaseModel) -> Iterator[tuple[str, Program]]:
    """The functions that a march watches, by their fields."""
    projection, nearness = phase.projection, phase.nearness
    if projection is not None:
        yield "gaps", projection.gaps.program
        for name, rows in (("places", projection.positions), ("rates", projection.speeds)):
            if rows is not None:
                yield f"{name}.f", rows.function.program
    measured = phase.signals.measured(()) if phase.bounds else None
    if measured is not None:
        yield "events", measured.function.program
    if nearness is not None and nearness.determinants is not None:
        determinants: Any = nearness.determinants
        yield "determinants", determinants.function.program
    if nearness is not None and nearness.rows is not None:
        rows_: Any = nearness.rows.rows
        yield "ties", rows_.function.program


def _sizes(phase: PhaseModel) -> dict[str, int]:
    """The numbers of a march."""
    projection, nearness = phase.projection, phase.nearness
    found = {"n": len(phase.moving), "n_events": len(phase.bounds)}
    quaternions = phase.functions.rhs.unit_quaternions
    found |= {"n_spheres": len(quaternions)} if quaternions else {}
    if projection is not None:
        found |= {"holds": 1, "placed": projection.placed, "n_gaps": len(projection.gaps.program.outputs)}
        found |= {"coordinates": projection.coordinates, "speeds": projection.size - projection.coordinates}
        for name, rows in (("places", projection.positions), ("rates", projection.speeds)):
            found |= {} if rows is None else {f"{name}.k": rows.k, f"{name}.n": rows.n}
    if nearness is not None:
        found |= {"is_near_watched": 1}
        if nearness.determinants is not None:
            determinants: Any = nearness.determinants
            found["n_determinants"] = len(determinants.function.program.outputs)
        if nearness.rows is not None:
            of_rows: Any = nearness.rows.rows
            n_rows = len(nearness.rows.constraints)
            found |= {"n_rows": n_rows, "rank": nearness.rows.rank}
            found["n_columns"] = len(of_rows.function.program.outputs) // n_rows
    return found


def _work(phase: PhaseModel) -> int:
    """Size of the work of a march, as of `CompiledSteps`."""
    sizes, projection = _sizes(phase), phase.projection
    near = max(sizes.get("n_determinants", 0), sizes.get("n_rows", 0) * sizes.get("n_columns", 0))
    own = 0
    if projection is not None:
        rows = [each for each in (projection.positions, projection.speeds) if each is not None]
        n, k = max(each.n for each in rows), max(each.k for each in rows)
        moves = projection.size
        own = sizes["n_gaps"] + 2 * sizes["n"] + k + 2 * moves + 2 * n + 2 * (n * n + k * n) + moves * n
        own += n * k + k * k + 2 * k
    return max(near, own) + 1


def _makers(text: _Text) -> list[str]:
    return [f"static void (*NAME_makers[])(const double *, double *) = {{{', '.join(text.makers)}}};"]


def _named(text: str, stem: str) -> str:
    """A fixed text, about this model."""
    text = re.sub(r"\bNAME_(?!MAIN\b|RUN_SELFTEST\b)([A-Z_]+)\b", rf"{stem.upper()}_\1", text)
    return re.sub(r"\bNAME_", f"{stem}_", text)


def _numbers(values: Sequence[float]) -> str:
    return "{" + ", ".join("NAN" if math.isnan(x) else repr(float(x)) for x in values) + "}"


def _quoted(names: Sequence[str]) -> str:
    return "{" + ", ".join('"' + name.replace("\\", "\\\\").replace('"', '\\"') + '"' for name in names) + "}"
