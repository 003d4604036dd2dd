"""Contacts along a motion: their modes, the events that change them, and the modes that hold afterwards."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np

from eomgen.codegen import Program, RightHandSide, Solve
from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank, Row
from eomgen.mechanics.dynamics import EquationsOfMotion, System, WellPosed, with_accelerations
from eomgen.mechanics.free_bodies import Indeterminate, Reactions
from eomgen.mechanics.kinematics import ContactMode
from eomgen.model import Contact, Model, Table
from eomgen.simulation.event_location import Measured
from eomgen.simulation.reaction_columns import ReactionColumns
from eomgen.symbolic.expression import Expression, Fraction, Scalar, function, order, sqrt, symbols_of
from eomgen.symbolic.numeric import FLOAT, evaluate, tolerances

# -------- contact events --------------------------------------------------------------------------------------
# System, configuration of its contacts -> ContactEvents: what the contacts say, and the functions that end a phase.
#
# Each function is positive while the configuration holds:
#
#     closed, and can end:   N                 sticks:   mu |N| - |F|, F what holds it (of joints T - |F|)
#     slides:                push N            open:     the gap, of a string the integral of its rate
#     slides:                sense v           on a piece of a path:   the way to each of its ends


PRESSING = ("n", "tension", "couple")  # rows of a contact that can only push, or only pull
HOLDING = ("t", "s", "friction")  # rows that let a contact, or a joint, stick
STOPPED = Fraction(1, 10**7)  # on a surface [m/s]


@dataclass(frozen=True)
class Signal:
    """One function of the state.

    Args:
        owner: the contact.
        what: "N", of a string also "N2", ...; "hold", the force that lets it stick; "grip", the largest that can, of a
            unit of N where there is one; "slide", "slide'"; "gap", "gap'", "gap''".
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
        kind: the meaning of its end: "ends", "turns" (N changes its sign), "closes", "stops", "slips", "piece".
        value: over the phase's symbols, accelerations and multipliers; of a gap without a formula None.
        unit: the kind of quantity.
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
    """Signals and events of the contacts of one phase, as functions of its symbols.

    Args:
        configuration: of the contacts.
        contacts: of this phase.
        lengths: of the piece on which each body on a path is: what is before it, and its length, where more follows.
        system: motion, loads and constraints.
    """

    configuration: Configuration
    contacts: tuple[Contact, ...]
    lengths: Mapping[str, tuple[bool, Scalar | None]]
    system: System

    @cached_property
    def reactions(self) -> Reactions:
        """Every reaction of joints and constraints as the contacts are taken to slide or stick; open ones have none."""
        return Reactions.of(self.system, as_taken=True)

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
        elif mode.sense != 0 and contact.holds_both_ways:
            found.append(EventFunction(name, "turns", mode.push * signals["N"], "force"))
        if mode.sense == 0:
            grip = signals["grip"] * _size(signals.get("N", 1))
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
        row, scope = Row.of_constraint(self.system.motion, contact.name)[0], self.system.scope
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
        if contact.grip is None:
            return found
        v, scope = self.system.sliding_velocity(contact), self.system.scope
        found += [Signal(name, "slide", v), Signal(name, "slide'", scope.with_accelerations((v,))[0])]
        if self.mode(contact).sense == 0:
            found += [
                Signal(name, "grip", ContactMode.size_of(scope, contact.grip)),
                Signal(name, "hold", *self._holding(name)),
            ]
        return found

    def _holding(self, name: str) -> tuple[Scalar, str]:
        """Friction force that holds a sticking contact, as of `_reaction`; on a surface sqrt(F_t^2 + F_s^2)."""
        held = [r for r in self.system.constraints.rows if r.constraint == name and r.component in HOLDING]
        forces = [self._reaction(row) for row in held]
        return forces[0] if len(forces) == 1 else _resultant(forces)

    def _normals(self, contact: Contact) -> list[tuple[Scalar, str]]:
        """N of a support, sqrt(N_1^2 + N_2^2) of bilateral contacts, the tensions of a string.

        Each as (value, name of its column).
        """
        if contact.size is not None:
            return []
        if contact.of_joint:
            load = self.reactions.load(contact.body)
            return [(_size(load), "") if contact.round else (load, f"reaction_n({contact.body})")]
        mine = [r for r in self.system.constraints.rows if r.constraint == contact.name]
        found = [self._reaction(r) for r in mine if r.component.partition(" ")[0] in PRESSING]
        return [_resultant(found)] if contact.round else found

    def _reaction(self, row: Row) -> tuple[Scalar, str]:
        """lam of a row: its multiplier where it closes, else from the balance of the bodies."""
        if row.status == "closing" and not self._redundant:
            return self.system.symbols.lam[self.system.constraints.closing.index(row)], ""
        return self._component(row.constraint, "constraint", row.component, row.number)

    def _component(self, owner: str, kind: str, label: str, number: int) -> tuple[Scalar, str]:
        for j, c in enumerate(self.reactions.components):
            if (c.owner, c.kind, c.label) == (owner, kind, label) and (kind == "joint" or c.number == number):
                return self.reactions.value(j), c.name
        raise DerivationError(
            f"'{owner}' has no reaction '{label}'", fix="name a contact, a joint or a constraint of the model"
        )

    @cached_property
    def _redundant(self) -> bool:
        return bool(Rank(self.system.constraints).redundant())


def stopped_below(contact: Contact) -> Fraction | int:
    """The speed at which sliding stops: 0 where it has a sense that can turn; a speed only comes near to 0 [m/s]."""
    return STOPPED if contact.surface else 0


def _resultant(forces: Sequence[tuple[Scalar, str]]) -> tuple[Scalar, str]:
    return sqrt(sum((force * force for force, _ in forces), start=0)), ""


def _size(x: Scalar) -> Scalar:
    return function("abs", x)


# -------- phase functions -------------------------------------------------------------------------------------
# EquationsOfMotion, parameters -> PhaseFunctions: the equations of one phase, compiled when they are first used.


@dataclass(frozen=True)
class PhaseFunctions:
    """Functions of the states x = (q, u, z, slacks) of one phase.

    Args:
        equations: of motion, friction included.
        p: the parameters' values.
        target: of the emitted code of the right-hand side.
        made: the functions that have been compiled so far; those of other values are the same.
    """

    equations: EquationsOfMotion
    p: np.ndarray
    target: str | None
    made: dict[Hashable, RightHandSide] = field(default_factory=dict, repr=False, compare=False)

    def at(self, p: np.ndarray) -> PhaseFunctions:
        """The same at other values of the parameters."""
        return replace(self, p=p)

    @property
    def rhs(self) -> RightHandSide:
        return self._once("rhs", self._right_hand_side)

    @property
    def energies(self) -> RightHandSide:
        """(T, V)."""
        self._once("rhs", self._right_hand_side)
        return self.made["energies"]

    def _right_hand_side(self) -> RightHandSide:
        """x', and T and V in addition."""
        WellPosed(self.equations).refuse_massless()
        program = Program.right_hand_side(with_accelerations(self.equations))
        energies = Program.of(
            (self.equations.T, self.equations.V), self.equations.symbols, inputs=self.equations.system.inputs
        )
        found, self.made["energies"] = RightHandSide.compiled_together((program, energies), self.target)
        return found

    def _once(self, key: Hashable, make: Callable[[], RightHandSide]) -> RightHandSide:
        if key not in self.made:
            self.made[key] = make()
        return self.made[key]

    @property
    def places(self) -> int:
        """Number of coordinates."""
        return len(self.equations.symbols.q)

    def inner(self, x: np.ndarray) -> np.ndarray:
        """(q, u, z) of states."""
        return np.ascontiguousarray(x[..., : len(self.equations.symbols.x)])

    def slacks(self, x: np.ndarray) -> np.ndarray:
        """Slack of each string whose slack is integrated, not given by a formula."""
        return x[..., len(self.equations.symbols.x) :]

    def evaluated(self, t: np.ndarray, x: np.ndarray, scalars: tuple[Scalar, ...]) -> np.ndarray:
        """Functions of q, u, z, t, accelerations and multipliers along the states, n x scalars."""
        return self.function(scalars).many(t, self.inner(x), self.p)

    def function(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        """Functions of q, u, z, t, accelerations and multipliers, compiled."""
        return self._once(("in motion", scalars), lambda: self._function(scalars))

    def _function(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        solve = Solve.bordered(self.equations) if self.equations.symbols.u else None
        return RightHandSide.of(
            Program.of(scalars, self.equations.symbols, inputs=self.equations.system.inputs, solve=solve), "numpy"
        )

    def kinematic(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        """Functions of q, u and t, compiled."""
        inputs = self.equations.system.inputs
        return self._once(
            ("placed", scalars),
            lambda: RightHandSide.of(Program.of(scalars, self.equations.symbols, inputs=inputs), "numpy"),
        )


# -------- contact signals -------------------------------------------------------------------------------------
# ContactEvents, PhaseFunctions -> ContactSignals: what the contacts of a phase say, in numbers along its states.


@dataclass(frozen=True)
class ContactSignals:
    """The signals and bounds of one phase at its states."""

    watch: ContactEvents
    functions: PhaseFunctions

    def look(self, t: float, x: np.ndarray) -> dict[tuple[str, str], float]:
        """The signals at one state, by owner and kind; nan where a reaction has no single value there."""
        key = t, x.tobytes()
        if key not in self._last:
            self._last.clear()
            found = self._along(np.array([t]), x[None, :])
            self._last[key] = {name: float(values[0]) for name, values in found.items()}
        return self._last[key]

    @cached_property
    def _last(self) -> dict[tuple[float, bytes], dict[tuple[str, str], float]]:
        """The signals at the state that was looked at last: it is looked at several times."""
        return {}

    def _along(self, t: np.ndarray, x: np.ndarray) -> dict[tuple[str, str], np.ndarray]:
        """The signals at n states."""
        inner = self.functions.inner(x)
        compiled = iter(self._looked.many(t, inner, self.functions.p).T)
        columns = self._columns
        reactions = np.zeros((len(t), 0)) if columns is None else columns.along(t, inner, self.functions.p)
        found = {}
        for signal in self.watch.signals:
            if signal.column in self.with_rank and columns is not None:
                values = reactions[:, columns.names.index(signal.column)]
            elif signal.value is None:
                values = self.functions.slacks(x)[:, self.watch.loose.index(signal.owner)]
            else:
                values = next(compiled)
            found[signal.owner, signal.what] = values
        return found

    def sizes(self, t: float, x: np.ndarray) -> tuple[float, float]:
        """Largest force and largest acceleration at one state, the latter at least 1 m/s^2."""
        forces = [
            abs(v)
            for (_, what), v in self.look(t, x).items()
            if what[0] in "Nhg" and what[:3] != "gap" and np.isfinite(v)
        ]
        found = np.abs(self._sized.many(np.array([t]), self.functions.inner(x)[None, :], self.functions.p)[0])
        n = len(self.functions.equations.symbols.u)
        return max([*forces, *found[:n]], default=0.0), max([1.0, *found[n:]])

    def rows_hold(self, t: float, x: np.ndarray) -> bool:
        """True if J a + gamma = 0 at one state: no forces can hold what passes a dead centre, where J is 0."""
        equations = self.functions.equations
        n, k = len(equations.symbols.u), len(equations.J)
        rows = (*equations.symbols.a, *equations.gamma, *(entry for row in equations.J for entry in row))
        found = self.functions.evaluated(np.array([t]), x[None, :], rows)[0]
        a, gamma, J = found[:n], found[n : n + k], found[n + k :].reshape(k, n)
        sizes = np.abs(J) @ np.abs(a) + np.abs(gamma) + max(1.0, float(np.max(np.abs(a), initial=0.0)))
        return bool(np.all(np.abs(J @ a + gamma) <= tolerances.COMPUTED * sizes))

    def floors(self, t: float, x: np.ndarray) -> np.ndarray:
        """Rounding error of each bound at one state; a speed may pass 0 by as much as counts as stopped."""
        n, k = self.functions.places, len(self.functions.equations.symbols.u)
        if not self.watch.bounds:
            return np.zeros(0)
        places, rates = np.max(np.abs(x[:n]), initial=1.0), np.max(np.abs(x[n : n + k]), initial=1.0)
        rebounding = {contact.name for contact in self.watch.contacts if contact.restitution is not None}
        size = {
            "force": tolerances.COMPUTED * self.sizes(t, x)[0],
            "rate": tolerances.COMPUTED * rates,
            "gap": tolerances.COMPUTED * places,
        }
        passing = [
            float(stopped_below(self.watch.contact(b.owner))) if b.kind == "stops" else 0.0 for b in self.watch.bounds
        ]
        found = [
            tolerances.GAP_CLOSED * places if b.kind == "closes" and b.owner in rebounding else size[b.unit]
            for b in self.watch.bounds
        ]
        return np.maximum(found, passing) + tolerances.SUMMED

    def watched(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """The bounds along the states, n x k; nan where a reaction has no single value."""
        if not self.watch.bounds:
            return np.zeros((len(t), 0))
        signals = self._along(t, x)
        ways = iter(self._ways.many(t, self.functions.inner(x), self.functions.p).T)
        found = [next(ways) if bound.kind == "piece" else self._left(bound, signals) for bound in self.watch.bounds]
        return np.column_stack(found)

    def measured(self, further: tuple[Scalar, ...]) -> Measured | None:
        """The bounds and further scalars as one function of q, u and t; None where a bound is not one of these."""
        if any(self._stands_apart(bound) for bound in self.watch.bounds):
            return None
        values = tuple(bound.value for bound in self.watch.bounds if bound.value is not None)
        return Measured(self.functions.function((*values, *further)), self.functions.p)

    def _stands_apart(self, bound: EventFunction) -> bool:
        """True if a bound follows from a balance solved by rank, is integrated, or depends on earlier states."""
        if bound.kind == "piece":
            return False
        contact = self.watch.contact(bound.owner)
        stops = bound.kind == "stops" and bool(stopped_below(contact))
        return (
            bound.value is None
            or stops
            or any(s.column in self.with_rank for s in self.watch.signals if s.owner == bound.owner)
        )

    def _left(self, bound: EventFunction, signals: Mapping[tuple[str, str], np.ndarray]) -> np.ndarray:
        """Margin of a bound of a contact, which is negative once the contact's mode has ended."""
        name = bound.owner
        mode = self.watch.configuration.modes[name]
        if bound.kind == "closes":
            return signals[name, "gap"]
        if bound.kind == "stops":
            slowing = signals[name, "slide'"] < 0  # a speed that grows from 0 does not stop
            return np.asarray(
                (mode.sense or 0) * signals[name, "slide"] - slowing * float(stopped_below(self.watch.contact(name)))
            )
        if bound.kind == "slips":
            return np.asarray(
                signals[name, "grip"] * np.abs(signals.get((name, "N"), 1.0)) - np.abs(signals[name, "hold"])
            )
        return mode.push * signals[name, f"N{bound.row}" if bound.row > 1 else "N"]

    @cached_property
    def _looked(self) -> RightHandSide:
        return self.functions.function(
            tuple(s.value for s in self.watch.signals if s.value is not None and s.column not in self.with_rank)
        )

    @cached_property
    def _columns(self) -> ReactionColumns | None:
        """The reactions behind the signals that follow from the balance of the bodies; None without such."""
        return ReactionColumns(self.watch.reactions, self.functions.rhs) if self.with_rank else None

    @cached_property
    def with_rank(self) -> frozenset[str]:
        """The columns for which the balance of the bodies is solved at each state, with its rank.

        A formula whose divisors depend on parameters only, and are not zero here, has a value at all states.
        """
        symbols = self.functions.equations.symbols
        known = dict(zip(symbols.parameters.values(), self.functions.p.tolist(), strict=True))

        def moves(value: Scalar) -> bool:
            below = divisors(value)
            if not known.keys() >= {*symbols_of(below)}:
                return True
            return any(not np.isfinite(x) or x == 0 for x in evaluate(below, known, FLOAT))

        return frozenset(s.column for s in self.watch.signals if s.column and s.value is not None and moves(s.value))

    @cached_property
    def _ways(self) -> RightHandSide:
        return self.functions.kinematic(
            tuple(b.value for b in self.watch.bounds if b.kind == "piece" and b.value is not None)
        )

    @cached_property
    def _sized(self) -> RightHandSide:
        return self.functions.function((*self.functions.equations.forcing, *self.functions.equations.symbols.a))


def divisors(value: Scalar) -> list[Scalar]:
    """Subexpressions by which a formula divides, and the bases of powers that are not whole or are negative."""
    found: list[Scalar] = []
    for x in order((value,)):
        if x.op == "div":
            found.append(x.args[1])
        elif x.op == "pow" and not (type(x.args[1]) is int and x.args[1] >= 0):
            found.append(x.args[0])
    return found


# -------- configuration ---------------------------------------------------------------------------------------
# Model -> how all of its contacts, and the pieces of its paths, are at a time, and what changes in words.


@dataclass(frozen=True)
class Configuration:
    """Modes of all contacts in one phase.

    Args:
        modes: of each contact.
        pieces: the piece of the path on which each body on a path is, from 0.
    """

    modes: Table[ContactMode] = field(default_factory=Table)
    pieces: Table[int] = field(default_factory=Table)

    @property
    def open(self) -> tuple[str, ...]:
        """The constraints that do not hold."""
        return tuple(name for name, mode in self.modes.items() if not mode.closed)

    def by_the_law(self, model: Model) -> Configuration:
        """The same where friction on a surface is along v/|v|, which has no value where v is 0."""
        surfaces = {contact.name for contact in model.contacts if contact.surface}
        modes = {
            name: replace(mode, sense=None) if name in surfaces and mode.sense else mode
            for name, mode in self.modes.items()
        }
        return replace(self, modes=Table(modes))


def bounds_of(model: Model, body: str) -> tuple[tuple[Expression, Expression], ...]:
    """The arc lengths at the beginning and the end of every piece of a body's path."""
    joint: Any = model.bodies[body].joint
    bounds: tuple[tuple[Expression, Expression], ...] = joint.bounds()
    return bounds


def on_pieces(model: Model, pieces: Mapping[str, int]) -> Model:
    """The model with every path reduced to one of its pieces."""
    if not pieces:
        return model
    bodies = dict(model.bodies)
    for name, k in pieces.items():
        joint: Any = bodies[name].joint
        bodies[name] = bodies[name].altered(joint=joint.piece(k))
    return model.altered(bodies=Table(bodies))


def changed(model: Model, before: Configuration, after: Configuration) -> tuple[str, ...]:
    """Changes from one configuration to another, a phrase each: "the support 'wall' opens"."""
    phrases = [_moved_on(model, name, k) for name, k in after.pieces.items() if before.pieces.get(name, k) != k]
    pairs = [(name, before.modes.get(name), mode) for name, mode in after.modes.items()]
    contacts = on_pieces(model, after.pieces).contacts if pairs else ()
    for name, old, mode in pairs:
        if old is not None and old is not mode and old != mode:
            phrases += _phrases(next(contact for contact in contacts if contact.name == name), old, mode)
    return tuple(phrases)


def _moved_on(model: Model, body: str, k: int) -> str:
    joint: Any = model.bodies[body].joint
    named = joint.pieces[k].name
    return f"the body '{body}' comes to " + (f"the piece '{named}'" if named else f"piece {k + 1}") + " of its path"


def _phrases(contact: Contact, old: ContactMode, new: ContactMode) -> Iterable[str]:
    if old.closed and not new.closed:
        yield f"{contact.words} goes slack" if contact.pulls else f"{contact.words} opens"
    elif new.closed and not old.closed:
        yield f"{contact.words} is taut again" if contact.pulls else f"{contact.words} closes"
    elif old.sense != new.sense:
        yield _sliding(contact, old.sense, new.sense)
    elif old.push != new.push:
        yield f"{contact.words} pushes from the other side"


def _sliding(contact: Contact, old: int | None, new: int | None) -> str:
    if new == 0:
        return f"{contact.words} sticks"
    return f"{contact.words} begins to slide" if old == 0 else f"{contact.words} slides back"
