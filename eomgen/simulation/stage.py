"""Model, configuration of its contacts -> Stage: the equations of one phase, and the functions that end it.

Each function is positive while the configuration holds:

    closed, and can end:   N                 sticks:   mu |N| - |F|, F what holds it
    rubs:                  push N            open:     the gap
    slides:                sense v           on a piece of a path:   the way to each of its ends
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from eomgen.codegen.program import bordered, program_of, right_hand_side
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.errors import DerivationError
from eomgen.mechanics.articulated import with_accelerations
from eomgen.mechanics.assembly import Assembly
from eomgen.mechanics.contacts import Mode
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.freedom import redundant_rows
from eomgen.mechanics.friction import with_friction
from eomgen.mechanics.reactions import Reactions, reactions_of
from eomgen.mechanics.release import released
from eomgen.mechanics.system import System, system_of
from eomgen.mechanics.ties import Row, rows_of
from eomgen.mechanics.wellposed import is_conservative, refuse_massless
from eomgen.model.parts import Model
from eomgen.simulation.contacts import Configuration, Contact, contacts_of, on_pieces
from eomgen.symbolic.functions import function
from eomgen.symbolic.graph import Scalar

Values = Mapping[str, float]
"""Coordinates and rates by name, those of every phase alike: {"theta": 0.1, "theta'": 0}."""

FORCE, RATE, GAP = 1e-9, 1e-9, 1e-9  # what is rounding, against the size of forces, speeds, places
TINY = 1e-13
Unit = Literal["force", "rate", "gap"]


@dataclass(frozen=True)
class Signal:
    """One function of the state.

    Args:
        owner: the contact, or the body on a path.
        what: "N"; "grip" mu |N| and "hold" of what sticks; "slide", "slide'"; "gap", "gap'", "gap''"; "along", "along'" a path.
        value: over the stage's symbols, accelerations and multipliers.
    """

    owner: str
    what: str
    value: Scalar


@dataclass(frozen=True)
class Bound:
    """A function that must stay positive, and what it measures; `step`: to which piece of a path its end leads."""

    owner: str
    value: Scalar
    unit: Unit
    step: int = 0


@dataclass(frozen=True)
class Stage:
    """The model of one phase.

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

    @cached_property
    def conservative(self) -> bool:
        return is_conservative(self.system, self.assembly)

    def state(self, values: Values) -> np.ndarray:
        """x of the stage; a displacement that did not exist before is 0."""
        return np.array([values.get(name, 0.0) for name in (*self.coordinates, *self.speeds)])

    def columns(self, t: np.ndarray, x: np.ndarray) -> dict[str, np.ndarray]:
        """Coordinates and rates of n states, by name."""
        rates = self._rates.many(t, x, self.p)
        named = dict(zip(self.coordinates, x.T[: len(self.coordinates)], strict=True))
        return named | {f"{q}'": column for q, column in zip(self.coordinates, rates.T, strict=True)}

    def values(self, t: float, x: np.ndarray) -> dict[str, float]:
        """Coordinates and rates of one state, by name."""
        return {name: float(column[0]) for name, column in self.columns(np.array([t]), x[None, :]).items()}

    def energies(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """(T, V), each n [J]."""
        return self._energies.many(t, x, self.p).T

    def gaps(self, t: np.ndarray, x: np.ndarray) -> float:
        """The largest |phi| of the closing ties."""
        return float(np.max(np.abs(self._gaps.many(t, x, self.p)), initial=0.0))

    def look(self, t: float, x: np.ndarray) -> dict[tuple[str, str], float]:
        """The signals at one state, by owner and kind."""
        found = self._looked.many(np.array([t]), x[None, :], self.p)[0]
        return {(s.owner, s.what): float(v) for s, v in zip(self.signals, found, strict=True)}

    def sizes(self, t: float, x: np.ndarray) -> tuple[float, float]:
        """How large forces and accelerations are at one state, the latter at least 1 m/s^2."""
        forces = [abs(v) for (_, what), v in self.look(t, x).items() if what in ("N", "hold")]
        found = np.abs(self._sized.many(np.array([t]), x[None, :], self.p)[0])
        n = len(self.system.symbols.u)
        return max([*forces, *found[:n]], default=0.0), max([1.0, *found[n:]])

    def floors(self, t: float, x: np.ndarray) -> np.ndarray:
        """What is rounding in each of the bounds, at one state."""
        n = len(self.coordinates)
        places, rates = np.max(np.abs(x[:n]), initial=1.0), np.max(np.abs(x[n:]), initial=1.0)
        size = {"force": FORCE * self.sizes(t, x)[0], "rate": RATE * rates, "gap": GAP * places}
        return np.array([size[bound.unit] for bound in self.bounds]) + TINY

    @property
    def watched(self) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
        """(t n, x n x states) -> the bounds, n x k."""
        return lambda t, x: self._watched.many(t, x, self.p)

    @cached_property
    def reactions(self) -> Reactions:
        """Every reaction of joints and ties; open contacts have none."""
        return reactions_of(self.system)

    def evaluated(self, t: np.ndarray, x: np.ndarray, scalars: tuple[Scalar, ...]) -> np.ndarray:
        """Functions of q, u, t, accelerations and multipliers along the states, n x scalars."""
        return self._function(scalars).many(t, x, self.p)

    # -- what the contacts say -------------------------------------------------------------------

    @cached_property
    def signals(self) -> tuple[Signal, ...]:
        found: list[Signal] = []
        for contact in self.contacts:
            found += self._of_open(contact) if not self.mode(contact).closed else self._of_closed(contact)
        for body in self.configuration.pieces:
            link = self.system.motion.link(body)
            found += [Signal(body, "along", link.s[0]), Signal(body, "along'", link.s_rate[0])]
        return tuple(found)

    @cached_property
    def bounds(self) -> tuple[Bound, ...]:
        value = {(s.owner, s.what): s.value for s in self.signals}
        found: list[Bound] = []
        for contact in self.contacts:
            name, mode = contact.name, self.mode(contact)
            if not mode.closed:
                found.append(Bound(name, value[name, "gap"], "gap"))
                continue
            if contact.unilateral or mode.sense != 0:
                found.append(Bound(name, mode.push * value[name, "N"], "force"))
            if mode.sense == 0:
                found.append(Bound(name, value[name, "grip"] - _size(value[name, "hold"]), "force"))
            elif mode.sense is not None:
                found.append(Bound(name, mode.sense * value[name, "slide"], "rate"))
        return (*found, *self._ends_of_pieces)

    def mode(self, contact: Contact) -> Mode:
        return self.configuration.modes[contact.name]

    @property
    def _ends_of_pieces(self) -> list[Bound]:
        """The way left to both ends of each path's piece; the first and the last piece go on."""
        found = []
        for body, (more_before, length) in self.lengths.items():
            s = self.system.motion.link(body).s[0]
            found += [Bound(body, s, "gap", -1)] if more_before else []
            found += [Bound(body, length - s, "gap", 1)] if length is not None else []
        return found

    def _of_open(self, contact: Contact) -> list[Signal]:
        scope = self.system.scope
        row = rows_of(self.system.motion, contact.name)[0]
        if row.gap is None:
            raise DerivationError(f"{contact.words} ends, and when it holds again cannot be told from where it is",
                                  f"constraints.{contact.name}")  # fmt: skip
        rate = scope.time_derivative((row.gap,))[0]
        values = (row.gap, rate, *scope.with_accelerations((rate,)))
        return [Signal(contact.name, what, x) for what, x in zip(("gap", "gap'", "gap''"), values, strict=True)]

    def _of_closed(self, contact: Contact) -> list[Signal]:
        name = contact.name
        found = [Signal(name, "N", self._normal(contact))]
        if contact.mu is None:
            return found
        v, scope = self._sliding(contact), self.system.scope
        found += [Signal(name, "slide", v), Signal(name, "slide'", *scope.with_accelerations((v,)))]
        if self.mode(contact).sense == 0:
            found.append(Signal(name, "grip", scope.value(contact.mu) * _size(found[0].value)))
            found.append(Signal(name, "hold", self._multiplier(self._row(contact, "t"))))
        return found

    def _row(self, contact: Contact, component: str) -> Row:
        return next(r for r in self.system.ties.rows if r.tie == contact.name and r.component == component)

    def _sliding(self, contact: Contact) -> Scalar:
        if contact.kind == "path":
            return self.system.motion.link(contact.name).s_rate[0]
        return next(r.sliding for r in self.system.ties.rows if r.tie == contact.name and r.tangent)

    def _normal(self, contact: Contact) -> Scalar:
        """N, its multiplier where that is it, else from the balance of the bodies."""
        if contact.kind == "path":
            return self.reactions.normal(contact.name)
        row = next(r for r in self.system.ties.rows if r.tie == contact.name)
        if row.status == "closing" and not self._redundant:
            return self._multiplier(row)
        label = "tension" if contact.pulls else "n"
        (j,) = (
            j for j, c in enumerate(self.reactions.components)
            if (c.owner, c.label, c.number) == (contact.name, label, row.number)
        )  # fmt: skip
        return self.reactions.value(j)

    def _multiplier(self, row: Row) -> Scalar:
        if self._redundant or row.status != "closing":
            (j,) = (j for j, c in enumerate(self.reactions.components) if (c.owner, c.number) == (row.tie, row.number))
            return self.reactions.value(j)
        return self.system.symbols.lam[self.system.ties.closing.index(row)]

    @cached_property
    def _redundant(self) -> bool:
        return bool(redundant_rows(self.system.ties))

    # -- compiled --------------------------------------------------------------------------------

    def _function(self, scalars: tuple[Scalar, ...], target: str | None = "numpy") -> RightHandSide:
        solve = bordered(self.assembly) if self.system.symbols.u else None
        return compiled(program_of(scalars, self.assembly.symbols, inputs=self.system.inputs, solve=solve), target)

    @cached_property
    def _looked(self) -> RightHandSide:
        return self._function(tuple(s.value for s in self.signals))

    @cached_property
    def _sized(self) -> RightHandSide:
        return self._function((*self.assembly.forcing, *self.system.symbols.a))

    @cached_property
    def _watched(self) -> RightHandSide:
        return self._function(tuple(b.value for b in self.bounds), self.target)

    @cached_property
    def _rates(self) -> RightHandSide:
        return compiled(program_of(self.system.scope.rates, self.assembly.symbols, inputs=self.system.inputs), "numpy")

    @cached_property
    def _energies(self) -> RightHandSide:
        energies = (self.assembly.T, self.assembly.V)
        return compiled(program_of(energies, self.assembly.symbols, inputs=self.system.inputs), "numpy")

    @cached_property
    def _gaps(self) -> RightHandSide:
        gaps = tuple(row.gap for row in self.system.ties.rows if row.gap is not None and not row.identical)
        return compiled(program_of(gaps, self.assembly.symbols, inputs=self.system.inputs), "numpy")


def _size(x: Scalar) -> Scalar:
    return function("abs", x)


class Stages:
    """The stages of a model, each derived and compiled once.

    Args:
        model: whose contacts change.
        p: the values of its parameters.
        target: of the emitted code.
    """

    def __init__(self, model: Model, p: np.ndarray, target: str | None) -> None:
        self.model, self.p, self.target = model, p, target
        self._made: dict[Configuration, Stage] = {}

    def of(self, configuration: Configuration) -> Stage:
        """The stage of a configuration.

        Raises:
            DerivationError: a contact ends and nothing can leave it.
        """
        if configuration not in self._made:
            self._made[configuration] = self._stage(configuration)
        return self._made[configuration]

    def _stage(self, configuration: Configuration) -> Stage:
        model = on_pieces(self.model, configuration.pieces)
        system = opened(model, configuration.modes)
        assembly = with_friction(system, recursive.assemble(system))
        lengths = {body: self._length(system, body, k) for body, k in configuration.pieces.items()}
        return Stage(configuration, contacts_of(model), lengths, system, assembly, self.p, self.target)

    def _length(self, system: System, body: str, k: int) -> tuple[bool, Scalar | None]:
        bounds = self.model.bodies[body].joint.bounds()
        start, end = bounds[k]
        return k > 0, system.scope.value(end - start) if k + 1 < len(bounds) else None


def opened(model: Model, modes: Mapping[str, Mode]) -> System:
    """The system with its contacts in these modes: those that are open released, one after the other.

    Raises:
        DerivationError: nothing can leave a contact that has ended.
    """
    closed = {name: mode for name, mode in modes.items() if mode.closed}
    system = system_of(model, closed)
    for name, mode in modes.items():
        if not mode.closed:
            system = _released(system, name)
    return system


def _released(system: System, tie: str) -> System:
    model, modes = released(system, tie)
    after = system_of(model, modes)
    held = [row for row in system.ties.rows if row.tie == tie and row not in redundant_rows(system.ties)]
    if _freedom(after) < _freedom(system) + len(held):
        raise DerivationError(f"'{tie}' ends, and what it held does not become free", f"constraints.{tie}",
                              "place the body by coordinates that can leave the contact")  # fmt: skip
    return after


def _freedom(system: System) -> int:
    """Independent speeds less the independent closing rows."""
    ties = system.ties
    return len(system.symbols.u) - len(ties.closing) + len(redundant_rows(ties))
