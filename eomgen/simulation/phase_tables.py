"""A phase, as C knows it: its structures, a configuration as a number, and what forces must satisfy in it.

The structures are those of `phases.c`, field by field.
"""

from __future__ import annotations

import ctypes
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from eomgen.mechanics.kinematics import ContactMode
from eomgen.model import Contact, JointFriction
from eomgen.simulation.contacts import EventFunction, Signal
from eomgen.simulation.many_runs import SIZE, MarchFunction
from eomgen.simulation.phase_model import PhaseModel

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
