"""Model, configuration of its contacts -> Stage: the equations of one phase, and the functions that end it.

Each function is positive while the configuration holds:

    closed, and can end:   N                 sticks:   mu |N| - |F|, F what holds it
    rubs:                  push N            open:     the gap, of a string the integral of its rate
    slides:                sense v           on a piece of a path:   the way to each of its ends
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

from eomgen.codegen.program import bordered, program_of, right_hand_side
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.errors import DerivationError
from eomgen.mechanics.articulated import with_accelerations
from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.contacts import Mode
from eomgen.mechanics.freedom import redundant_rows
from eomgen.mechanics.reactions import Indeterminate, Reactions, reactions_of
from eomgen.mechanics.system import System
from eomgen.mechanics.ties import Row, rows_of
from eomgen.mechanics.wellposed import is_conservative, refuse_massless
from eomgen.simulation.contacts import Configuration, Contact
from eomgen.simulation.reaction_columns import ReactionColumns
from eomgen.symbolic.derivative import depends_on
from eomgen.symbolic.functions import function
from eomgen.symbolic.graph import Scalar

Values = Mapping[str, float]
"""Coordinates and rates by name, those of every phase alike: {"theta": 0.1, "theta'": 0}."""

FORCE, RATE, GAP = 1e-9, 1e-9, 1e-9  # what is rounding, against the size of forces, speeds, places
TINY = 1e-13


@dataclass(frozen=True)
class Signal:
    """One function of the state.

    Args:
        owner: the contact.
        what: "N", of a string also "N2", ...; "hold", the force that lets it stick; "mu"; "slide", "slide'"; "gap",
            "gap'", "gap''".
        value: over the stage's symbols, accelerations and multipliers; of a gap without a formula None.
        column: of what follows from the balance of the bodies, its name among their reactions.
    """

    owner: str
    what: str
    value: Scalar | None
    column: str = ""


@dataclass(frozen=True)
class Bound:
    """A function that must stay positive.

    Args:
        owner: the contact, or the body on a path.
        kind: what its end means: "ends", "turns" (N changes its sign), "closes", "stops", "slips", "piece".
        value: over the stage's symbols, accelerations and multipliers; of a gap without a formula None.
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
class Stage:
    """The model of one phase. Its state is x = (q, u), and after these the slack of each string that hangs loose.

    Args:
        configuration: of the contacts.
        contacts: of this stage.
        lengths: of the piece on which each body on a path is: what is before it, and its length, where more follows.
        system, assembly: motion, loads and ties; the equations of motion, friction included.
        p: the parameters' values.
        target: of the emitted code.
    """

    configuration: Configuration
    contacts: tuple[Contact, ...]
    lengths: Mapping[str, tuple[bool, Scalar | None]]
    system: System
    assembly: Assembly
    p: np.ndarray
    target: str | None

    @property
    def coordinates(self) -> tuple[str, ...]:
        return tuple(q.name for q in self.system.symbols.q)

    @property
    def speeds(self) -> tuple[str, ...]:
        return tuple(u.name for u in self.system.symbols.u)

    @cached_property
    def rhs(self) -> RightHandSide:
        refuse_massless(self.assembly)
        program = right_hand_side(with_accelerations(self.system, self.assembly), self.system.inputs)
        return compiled(program, self.target)

    def rate(self, t: float, x: np.ndarray) -> np.ndarray:
        """x', the slack of loose strings included."""
        if not self.loose:
            return self.rhs(t, x, self.p)
        inner = self.inner(x)
        slackening = self._slackening(t, inner, self.p)
        return np.concatenate([self.rhs(t, inner, self.p), slackening])

    @cached_property
    def conservative(self) -> bool:
        return is_conservative(self.system, self.assembly)

    def state(self, values: Values) -> np.ndarray:
        """x of the stage; a displacement that did not exist before is 0."""
        names = (*self.coordinates, *self.speeds, *map(slack_name, self.loose))
        return np.array([values.get(name, 0.0) for name in names])

    def columns(self, t: np.ndarray, x: np.ndarray) -> dict[str, np.ndarray]:
        """Coordinates, rates and slacks of n states, by name."""
        rates = self._rates.many(t, self.inner(x), self.p)
        named = dict(zip(self.coordinates, x.T, strict=False))
        named |= {f"{q}'": column for q, column in zip(self.coordinates, rates.T, strict=True)}
        return named | dict(zip(map(slack_name, self.loose), self._slacks(x).T, strict=True))

    def values(self, t: float, x: np.ndarray) -> dict[str, float]:
        """Coordinates, rates and slacks of one state, by name."""
        return {name: float(column[0]) for name, column in self.columns(np.array([t]), x[None, :]).items()}

    def energies(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """(T, V), each n [J]."""
        return self._energies.many(t, self.inner(x), self.p).T

    def gaps(self, t: np.ndarray, x: np.ndarray) -> float:
        """The largest |phi| of the ties that hold."""
        return float(np.max(np.abs(self._gaps.many(t, self.inner(x), self.p)), initial=0.0))

    def look(self, t: float, x: np.ndarray) -> dict[tuple[str, str], float]:
        """The signals at one state, by owner and kind; nan where a reaction has no single value there."""
        return {key: float(found[0]) for key, found in self._along(np.array([t]), x[None, :]).items()}

    def _along(self, t: np.ndarray, x: np.ndarray) -> dict[tuple[str, str], np.ndarray]:
        """The signals at n states."""
        inner = self.inner(x)
        compiled = iter(self._looked.many(t, inner, self.p).T)
        reactions = self._columns.along(t, inner, self.p) if self._columns is not None else np.zeros((len(t), 0))
        found = {}
        for signal in self.signals:
            if signal.column and self._columns is not None:
                values = reactions[:, self._columns.names.index(signal.column)]
            elif signal.value is None:
                values = self._slacks(x)[:, self.loose.index(signal.owner)]
            else:
                values = next(compiled)
            found[signal.owner, signal.what] = values
        return found

    def sizes(self, t: float, x: np.ndarray) -> tuple[float, float]:
        """How large forces and accelerations are at one state, the latter at least 1 m/s^2."""
        forces = [abs(v) for (_, what), v in self.look(t, x).items() if what[0] in "Nh" and np.isfinite(v)]
        found = np.abs(self._sized.many(np.array([t]), self.inner(x)[None, :], self.p)[0])
        n = len(self.system.symbols.u)
        return max([*forces, *found[:n]], default=0.0), max([1.0, *found[n:]])

    def floors(self, t: float, x: np.ndarray) -> np.ndarray:
        """What is rounding in each of the bounds, at one state."""
        n = len(self.coordinates)
        places, rates = np.max(np.abs(x[:n]), initial=1.0), np.max(np.abs(x[n:]), initial=1.0)
        size = {"force": FORCE * self.sizes(t, x)[0], "rate": RATE * rates, "gap": GAP * places}
        return np.array([size[bound.unit] for bound in self.bounds]) + TINY

    def watched(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """The bounds along the states, n x k; nan where a reaction has no single value."""
        signals = self._along(t, x)
        ways = iter(self._ways.many(t, self.inner(x), self.p).T)
        found = [next(ways) if bound.kind == "piece" else self._left(bound, signals) for bound in self.bounds]
        return np.column_stack(found) if found else np.zeros((len(t), 0))

    def _left(self, bound: Bound, signals: Mapping[tuple[str, str], np.ndarray]) -> np.ndarray:
        """What is left of a bound of a contact."""
        name = bound.owner
        mode = self.configuration.modes[name]
        if bound.kind == "closes":
            return signals[name, "gap"]
        if bound.kind == "stops":
            return (mode.sense or 0) * signals[name, "slide"]
        if bound.kind == "slips":
            return signals[name, "mu"] * np.abs(signals[name, "N"]) - np.abs(signals[name, "hold"])
        return mode.push * signals[name, f"N{bound.row}" if bound.row > 1 else "N"]

    @cached_property
    def reactions(self) -> Reactions:
        """Every reaction of joints and ties; open contacts have none."""
        return reactions_of(self.system)

    def evaluated(self, t: np.ndarray, x: np.ndarray, scalars: tuple[Scalar, ...]) -> np.ndarray:
        """Functions of q, u, t, accelerations and multipliers along the states, n x scalars."""
        return self.function(scalars).many(t, self.inner(x), self.p)

    # -- what the contacts say -------------------------------------------------------------------

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

    def rests(self, t: float, values: Values) -> bool:
        """Whether nothing moves, and nothing is given that could move it later."""
        symbols, coordinates = self.system.symbols, self.system.scope.model.coordinates
        given = (symbols.t, *symbols.inputs.values(), *(q for q in symbols.q if coordinates[q.name].driven))
        needed = (equation.needed for equation in self.reactions.balance.equations)
        if any(depends_on(x, given) for x in (*self.assembly.forcing, *needed)):
            return False
        x = self.state(values)
        _, size = self.sizes(t, x)
        return bool(np.max(np.abs(self.rate(t, x)), initial=0.0) <= RATE * size)

    @cached_property
    def bounds(self) -> tuple[Bound, ...]:
        found: list[Bound] = []
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

    def mode(self, contact: Contact) -> Mode:
        return self.configuration.modes[contact.name]

    def _bounds(self, contact: Contact, signals: Mapping[str, Any]) -> list[Bound]:
        name, mode = contact.name, self.mode(contact)
        if not mode.closed:
            return [Bound(name, "closes", signals["gap"], "gap")]
        found = []
        if contact.unilateral:
            tensions = [value for what, value in signals.items() if what[0] == "N"]
            several = len(tensions) > 1
            found += [Bound(name, "ends", x, "force", row=k * several) for k, x in enumerate(tensions, start=1)]
        elif mode.sense != 0:
            found.append(Bound(name, "turns", mode.push * signals["N"], "force"))
        if mode.sense == 0:
            grip = signals["mu"] * _size(signals["N"])
            found.append(Bound(name, "slips", grip - _size(signals["hold"]), "force"))
        elif mode.sense is not None:
            found.append(Bound(name, "stops", mode.sense * signals["slide"], "rate"))
        return found

    @property
    def _ends_of_pieces(self) -> list[Bound]:
        """The way left to both ends of each path's piece; the first and the last piece go on."""
        found = []
        for body, (more_before, length) in self.lengths.items():
            s = self.system.motion.link(body).s[0]
            found += [Bound(body, "piece", s, "gap", -1)] if more_before else []
            found += [Bound(body, "piece", length - s, "gap", 1)] if length is not None else []
        return found

    def _of_open(self, contact: Contact) -> list[Signal]:
        row, scope = rows_of(self.system.motion, contact.name)[0], self.system.scope
        gap, rate = row.gap, row.velocity if row.gap is None else scope.time_derivative((row.gap,))[0]
        return [Signal(contact.name, "gap", gap), Signal(contact.name, "gap'", rate),
                Signal(contact.name, "gap''", scope.with_accelerations((rate,))[0])]  # fmt: skip

    def _of_closed(self, contact: Contact) -> list[Signal]:
        name = contact.name
        normals = enumerate(self._normals(contact), start=1)
        found = [Signal(name, f"N{k}" if k > 1 else "N", value, column) for k, (value, column) in normals]
        if contact.mu is None:
            return found
        v, scope = sliding_velocity(self.system, contact), self.system.scope
        found += [Signal(name, "slide", v), Signal(name, "slide'", scope.with_accelerations((v,))[0])]
        if self.mode(contact).sense == 0:
            held = next(r for r in self.system.ties.rows if r.tie == name and r.component == "t")
            found += [Signal(name, "mu", scope.value(contact.mu)), Signal(name, "hold", *self._reaction(held))]
        return found

    def _normals(self, contact: Contact) -> list[tuple[Scalar, str]]:
        """N of a support, the tensions of a string: (value, name of its column)."""
        if contact.kind == "path":
            return [self._component(contact.name, "joint", "n", 1)]
        rows = [r for r in self.system.ties.rows if r.tie == contact.name and r.component in ("n", "tension")]
        return [self._reaction(row) for row in rows]

    def _reaction(self, row: Row) -> tuple[Scalar, str]:
        """lam of a row: its multiplier where it closes, else from the balance of the bodies."""
        if row.status == "closing" and not self._redundant:
            return self.system.symbols.lam[self.system.ties.closing.index(row)], ""
        return self._component(row.tie, "tie", row.component, row.number)

    def _component(self, owner: str, kind: str, label: str, number: int) -> tuple[Scalar, str]:
        for j, c in enumerate(self.reactions.components):
            if (c.owner, c.kind, c.label) == (owner, kind, label) and (kind == "joint" or c.number == number):
                return self.reactions.value(j), c.name
        raise DerivationError(f"'{owner}' has no reaction '{label}'")

    @cached_property
    def _redundant(self) -> bool:
        return bool(redundant_rows(self.system.ties))

    # -- compiled --------------------------------------------------------------------------------

    def inner(self, x: np.ndarray) -> np.ndarray:
        """(q, u) of states."""
        return np.ascontiguousarray(x[..., : len(self.coordinates) + len(self.speeds)])

    def _slacks(self, x: np.ndarray) -> np.ndarray:
        return x[..., len(self.coordinates) + len(self.speeds) :]

    def function(self, scalars: tuple[Scalar, ...], target: str | None = "numpy") -> RightHandSide:
        """Functions of q, u, t, accelerations and multipliers, compiled."""
        solve = bordered(self.assembly) if self.system.symbols.u else None
        return compiled(program_of(scalars, self.assembly.symbols, inputs=self.system.inputs, solve=solve), target)

    def _kinematic(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        return compiled(program_of(scalars, self.assembly.symbols, inputs=self.system.inputs), "numpy")

    @cached_property
    def _looked(self) -> RightHandSide:
        return self.function(tuple(s.value for s in self.signals if s.value is not None and not s.column))

    @cached_property
    def _columns(self) -> ReactionColumns | None:
        """The reactions behind the signals that follow from the balance of the bodies; None without such."""
        return ReactionColumns(self.reactions, self.rhs) if any(s.column for s in self.signals) else None

    @cached_property
    def _ways(self) -> RightHandSide:
        return self._kinematic(tuple(b.value for b in self.bounds if b.kind == "piece" and b.value is not None))

    @cached_property
    def _sized(self) -> RightHandSide:
        return self.function((*self.assembly.forcing, *self.system.symbols.a))

    @cached_property
    def _slackening(self) -> RightHandSide:
        rates = {s.owner: s.value for s in self.signals if s.what == "gap'" and s.value is not None}
        return self._kinematic(tuple(rates[name] for name in self.loose))

    @cached_property
    def _rates(self) -> RightHandSide:
        return self._kinematic(self.system.scope.rates)

    @cached_property
    def _energies(self) -> RightHandSide:
        return self._kinematic((self.assembly.T, self.assembly.V))

    @cached_property
    def _gaps(self) -> RightHandSide:
        return self._kinematic(tuple(r.gap for r in self.system.ties.rows if r.gap is not None and not r.identical))


def sliding_velocity(system: System, contact: Contact) -> Scalar:
    """Of a closed contact that rubs, along its tangent."""
    if contact.kind == "path":
        return system.motion.link(contact.name).s_rate[0]
    return next(r.sliding for r in system.ties.rows if r.tie == contact.name and r.tangent)


def smallest_speed(values: Values) -> float:
    """What is no rounding any more, against the fastest of the rates."""
    return RATE * max([1.0, *(abs(v) for name, v in values.items() if name.endswith("'"))])


def slack_name(tie: str) -> str:
    """What the integrated slack of a string is called among the values of a state."""
    return f"{tie} slack"


def _size(x: Any) -> Scalar:
    return function("abs", x)
