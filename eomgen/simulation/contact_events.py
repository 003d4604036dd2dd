"""System, configuration of its contacts -> ContactEvents: what the contacts say, and the functions that end a phase.

Each function is positive while the configuration holds:

    closed, and can end:   N                 sticks:   mu |N| - |F|, F what holds it
    slides:                push N            open:     the gap, of a string the integral of its rate
    slides:                sense v           on a piece of a path:   the way to each of its ends
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, Literal

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.balance_solution import Indeterminate
from eomgen.mechanics.bodies.contact_modes import ContactMode
from eomgen.mechanics.constraints.freedom import redundant_rows
from eomgen.mechanics.constraints.ties import Row, rows_of_tie
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.reactions.reactions import Reactions, reactions_of
from eomgen.model.contacts import Contact
from eomgen.records import dataclass
from eomgen.simulation.configuration import Configuration
from eomgen.symbolic.expression.functions import function, sqrt
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.rational import Fraction

STOPPED = Fraction(1, 10**7)  # on a surface [m/s]


@dataclass(frozen=True)
class Signal:
    """One function of the state.

    Args:
        owner: the contact.
        what: "N", of a string also "N2", ...; "hold", the force that lets it stick; "mu"; "slide", "slide'"; "gap",
            "gap'", "gap''".
        value: over the phase's symbols, accelerations and multipliers; of a gap without a formula None.
        column: of what follows from the balance of the bodies, its name among their reactions.
    """

    owner: str
    what: str
    value: Scalar | None
    column: str = ""


@dataclass(frozen=True)
class EventFunction:
    """A function that must stay positive.

    Args:
        owner: the contact, or the body on a path.
        kind: what its end means: "ends", "turns" (N changes its sign), "closes", "stops", "slips", "piece".
        value: over the phase's symbols, accelerations and multipliers; of a gap without a formula None.
        unit: what it measures.
        step: to which piece of a path its end leads.
        row: of a string with several tensions, the row that goes slack alone; else 0.
    """

    owner: str
    kind: str
    value: Scalar | None
    unit: Literal["force", "rate", "gap"]
    step: int = 0
    row: int = 0


@dataclass(frozen=True)
class ContactEvents:
    """What the contacts of one phase say, as functions of its symbols.

    Args:
        configuration: of the contacts.
        contacts: of this phase.
        lengths: of the piece on which each body on a path is: what is before it, and its length, where more follows.
        system: motion, loads and ties.
    """

    configuration: Configuration
    contacts: tuple[Contact, ...]
    lengths: Mapping[str, tuple[bool, Scalar | None]]
    system: System

    @cached_property
    def reactions(self) -> Reactions:
        """Every reaction of joints and ties; open contacts have none."""
        return reactions_of(self.system)

    @cached_property
    def signals(self) -> tuple[Signal, ...]:
        found: list[Signal] = []
        for contact in self.contacts:
            if not self.mode(contact).closed:
                found += self._of_open(contact)
            elif self.undetermined is None:
                found += self._of_closed(contact)
        return tuple(found)

    @cached_property
    def undetermined(self) -> Indeterminate | None:
        """Why the forces at the closed contacts do not follow from the balance; None where they do."""
        try:
            for contact in self.contacts:
                if self.mode(contact).closed:
                    self._of_closed(contact)
        except Indeterminate as error:
            return error
        return None

    @cached_property
    def bounds(self) -> tuple[EventFunction, ...]:
        found: list[EventFunction] = []
        for contact in self.contacts:
            if self.mode(contact).closed and self.undetermined is not None:
                continue  # at rest: nothing is watched
            signals = {s.what: s.value for s in self.signals if s.owner == contact.name}
            found += self._bounds(contact, signals)
        return (*found, *self._ends_of_pieces)

    @cached_property
    def loose(self) -> tuple[str, ...]:
        """The open strings whose slack no formula gives: it is integrated."""
        apart = (contact for contact in self.contacts if not self.mode(contact).closed)
        return tuple(contact.name for contact in apart if self._of_open(contact)[0].value is None)

    def contact(self, name: str) -> Contact:
        return next(contact for contact in self.contacts if contact.name == name)

    def mode(self, contact: Contact) -> ContactMode:
        return self.configuration.modes[contact.name]

    def _bounds(self, contact: Contact, signals: Mapping[str, Any]) -> list[EventFunction]:
        name, mode = contact.name, self.mode(contact)
        if not mode.closed:
            return [EventFunction(name, "closes", signals["gap"], "gap")]
        found = []
        if contact.unilateral:
            tensions = [value for what, value in signals.items() if what[0] == "N"]
            several = len(tensions) > 1
            found += [EventFunction(name, "ends", x, "force", row=k * several) for k, x in enumerate(tensions, start=1)]
        elif mode.sense != 0 and not contact.round:
            found.append(EventFunction(name, "turns", mode.push * signals["N"], "force"))
        if mode.sense == 0:
            grip = signals["mu"] * _size(signals["N"])
            found.append(EventFunction(name, "slips", grip - _size(signals["hold"]), "force"))
        elif mode.sense is not None:
            found.append(EventFunction(name, "stops", mode.sense * signals["slide"] - stopped_below(contact), "rate"))
        return found

    @property
    def _ends_of_pieces(self) -> list[EventFunction]:
        """The way left to both ends of each path's piece; the first and the last piece go on."""
        found = []
        for body, (more_before, length) in self.lengths.items():
            s = self.system.motion.link(body).s[0]
            found += [EventFunction(body, "piece", s, "gap", -1)] if more_before else []
            found += [EventFunction(body, "piece", length - s, "gap", 1)] if length is not None else []
        return found

    def _of_open(self, contact: Contact) -> list[Signal]:
        row, scope = rows_of_tie(self.system.motion, contact.name)[0], self.system.scope
        gap, rate = row.gap, row.velocity if row.gap is None else scope.time_derivative((row.gap,))[0]
        return [
            Signal(contact.name, "gap", gap),
            Signal(contact.name, "gap'", rate),
            Signal(contact.name, "gap''", scope.with_accelerations((rate,))[0]),
        ]

    def _of_closed(self, contact: Contact) -> list[Signal]:
        name = contact.name
        normals = enumerate(self._normals(contact), start=1)
        found = [Signal(name, f"N{k}" if k > 1 else "N", value, column) for k, (value, column) in normals]
        if contact.mu is None:
            return found
        v, scope = sliding_velocity(self.system, contact), self.system.scope
        found += [Signal(name, "slide", v), Signal(name, "slide'", scope.with_accelerations((v,))[0])]
        if self.mode(contact).sense == 0:
            found += [Signal(name, "mu", scope.value(contact.mu)), Signal(name, "hold", *self._holding(name))]
        return found

    def _holding(self, name: str) -> tuple[Scalar, str]:
        """What lets a contact stick, as of `_reaction`; on a surface sqrt(F_t^2 + F_s^2)."""
        held = [r for r in self.system.ties.rows if r.tie == name and r.component in ("t", "s")]
        forces = [self._reaction(row) for row in held]
        return forces[0] if len(forces) == 1 else _resultant(forces)

    def _normals(self, contact: Contact) -> list[tuple[Scalar, str]]:
        """N of a support, sqrt(N_1^2 + N_2^2) of bilateral contacts, the tensions of a string.

        Each as (value, name of its column).
        """
        if contact.of_joint:
            labels = ("n 1", "n 2") if contact.round else ("n",)
            found = [self._component(contact.name, "joint", label, 1) for label in labels]
        else:
            mine = [r for r in self.system.ties.rows if r.tie == contact.name]
            found = [self._reaction(r) for r in mine if r.component.partition(" ")[0] in ("n", "tension")]
        return [_resultant(found)] if contact.round else found

    def _reaction(self, row: Row) -> tuple[Scalar, str]:
        """lam of a row: its multiplier where it closes, else from the balance of the bodies."""
        if row.status == "closing" and not self._redundant:
            return self.system.symbols.lam[self.system.ties.closing.index(row)], ""
        return self._component(row.tie, "tie", row.component, row.number)

    def _component(self, owner: str, kind: str, label: str, number: int) -> tuple[Scalar, str]:
        for j, c in enumerate(self.reactions.components):
            if (c.owner, c.kind, c.label) == (owner, kind, label) and (kind == "joint" or c.number == number):
                return self.reactions.value(j), c.name
        raise DerivationError(
            f"'{owner}' has no reaction '{label}'", mend="name a contact, a joint or a constraint of the model"
        )

    @cached_property
    def _redundant(self) -> bool:
        return bool(redundant_rows(self.system.ties))


def stopped_below(contact: Contact) -> Fraction | int:
    """The speed at which sliding stops: 0 where it has a sense that can turn; a speed only comes near to 0 [m/s]."""
    return STOPPED if contact.surface else 0


def sliding_velocity(system: System, contact: Contact) -> Scalar:
    """Of a closed contact with friction, along its tangent."""
    if contact.of_joint:
        return system.motion.link(contact.name).s_rate[0]
    return next(r.sliding for r in system.ties.rows if r.tie == contact.name and r.tangent)


def _resultant(forces: Sequence[tuple[Scalar, str]]) -> tuple[Scalar, str]:
    return sqrt(sum((force * force for force, _ in forces), start=0)), ""


def _size(x: Scalar) -> Scalar:
    return function("abs", x)
