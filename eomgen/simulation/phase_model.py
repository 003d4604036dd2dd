"""Model, configuration of its contacts -> PhaseModel: the equations of one phase, as functions of numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from eomgen.codegen.program import bordered, program_of, right_hand_side
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.mechanics.balance.friction import with_friction
from eomgen.mechanics.constraints.edges import edges_of
from eomgen.mechanics.equations.articulated import with_accelerations
from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.wellposed import is_conservative, refuse_massless
from eomgen.mechanics.formulations import recursive
from eomgen.mechanics.initial_state.initial_state import Start, start_of_motion
from eomgen.mechanics.reactions.reactions import Reactions
from eomgen.model.constraints.row import Edge
from eomgen.model.contacts import Contact
from eomgen.simulation.configuration import Configuration
from eomgen.simulation.constraint_drift import Projection, projection_of
from eomgen.simulation.constraint_rank import Nearness, Undetermined, nearness_of, undetermined_of
from eomgen.simulation.contact_events import ContactEvents, EventFunction, stopped_below
from eomgen.simulation.reaction_columns import ReactionColumns
from eomgen.simulation.slopes import slope_of
from eomgen.simulation.solvers import Slope
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.numeric.tolerances import COMPUTED, SUMMED

Values = Mapping[str, float]
"""Coordinates and rates by name, those of every phase alike: {"theta": 0.1, "theta'": 0}."""


@dataclass(frozen=True)
class PhaseModel:
    """The model of one phase. Its state is x = (q, u), and after these the slack of each string that hangs loose.

    Args:
        watch: its system, and what its contacts say.
        declared: the system over the speeds that the model declares; the state may hold more (see `integrated_system`).
        assembly: the equations of motion, friction included.
        p: the parameters' values.
        target: of the emitted code.
    """

    watch: ContactEvents
    declared: System
    assembly: Assembly
    p: np.ndarray
    target: str | None

    @property
    def system(self) -> System:
        return self.watch.system

    @property
    def configuration(self) -> Configuration:
        return self.watch.configuration

    @property
    def contacts(self) -> tuple[Contact, ...]:
        return self.watch.contacts

    @property
    def bounds(self) -> tuple[EventFunction, ...]:
        return self.watch.bounds

    @property
    def loose(self) -> tuple[str, ...]:
        return self.watch.loose

    @property
    def reactions(self) -> Reactions:
        return self.watch.reactions

    @property
    def coordinates(self) -> tuple[str, ...]:
        return tuple(q.name for q in self.system.symbols.q)

    @property
    def speeds(self) -> tuple[str, ...]:
        return tuple(u.name for u in self.system.symbols.u)

    @cached_property
    def rhs(self) -> RightHandSide:
        refuse_massless(self.system, self.assembly)
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

    @cached_property
    def declared_assembly(self) -> Assembly:
        """The equations of motion over the speeds that the model declares."""
        if self.declared is self.system:
            return self.assembly
        return with_friction(self.declared, recursive.assembled_by_recursion(self.declared))

    @property
    def shown(self) -> tuple[str, ...]:
        """The speeds that a user sees."""
        return tuple(u.name for u in self.declared.symbols.u)

    def begun(self, t: float, parameters: Values | None, start: Values | None) -> tuple[Start, dict[str, float]]:
        """(the start at which all ties hold, coordinates, rates and speeds by name).

        Raises:
            DerivationError: the ties do not hold at the start.
        """
        begun = start_of_motion(self.declared, parameters, start)
        return begun, self.with_rates(t, begun.values)

    def with_rates(self, t: float, values: Values) -> dict[str, float]:
        """Coordinates and declared speeds by name, with the rates of all coordinates."""
        x = self.state(values)
        found = self._kinematic(self.declared.scope.rates).many(np.array([t]), x[None, :], self.p)[0]
        rates = {f"{q}'": float(rate) for q, rate in zip(self.coordinates, found, strict=True)}
        return rates | dict.fromkeys(map(slack_name, self.loose), 0.0) | dict(values)

    def state(self, values: Values) -> np.ndarray:
        """x of the phase; a displacement that did not exist before is 0."""
        names = (*self.coordinates, *self.speeds, *map(slack_name, self.loose))
        return np.array([values.get(name, 0.0) for name in names])

    def columns(self, t: np.ndarray, x: np.ndarray) -> dict[str, np.ndarray]:
        """Coordinates, rates, speeds and slacks of n states, by name."""
        rates = self._rates.many(t, self.inner(x), self.p)
        named = dict(zip((*self.coordinates, *self.speeds), x.T, strict=False))
        named |= {f"{q}'": column for q, column in zip(self.coordinates, rates.T, strict=True)}
        return named | dict(zip(map(slack_name, self.loose), self._slacks(x).T, strict=True))

    def values(self, t: float, x: np.ndarray) -> dict[str, float]:
        """Coordinates, rates, speeds and slacks of one state, by name."""
        return {name: float(column[0]) for name, column in self.columns(np.array([t]), x[None, :]).items()}

    def energies(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """(T, V), each n [J]."""
        return self._energies.many(t, self.inner(x), self.p).T

    @cached_property
    def projection(self) -> Projection | None:
        """Onto the ties that hold; None where none closes."""
        return projection_of(self.system, self.p, self.target)

    @property
    def nearness(self) -> Nearness | None:
        """A new measure of how near a motion comes to positions in which the ties do not determine it."""
        return None if self._nearness is None else replace(self._nearness)

    @cached_property
    def _nearness(self) -> Nearness | None:
        found = nearness_of(self.system, self.assembly, self.p, self.declared)
        if found is None or not self.loose:
            return found
        (determinants, rows), inner = (found.determinants, found.rows), self.inner
        return replace(
            found,
            determinants=None if determinants is None else lambda t, x: determinants(t, inner(x)),
            rows=None if rows is None else replace(rows, rows=lambda t, x: rows.rows(t, inner(x))),
        )

    @cached_property
    def undetermined(self) -> tuple[Undetermined, ...]:
        """What of the motion is not determined at singular positions."""
        return undetermined_of(self.system, self.assembly, self.p, self.declared)

    @cached_property
    def slope(self) -> Slope | None:
        """d(x')/dx; None where it is found by differences."""
        return None if self.loose else slope_of(self.system, self.assembly, self.p, self.target)

    def look(self, t: float, x: np.ndarray) -> dict[tuple[str, str], float]:
        """The signals at one state, by owner and kind; nan where a reaction has no single value there."""
        return {key: float(found[0]) for key, found in self._along(np.array([t]), x[None, :]).items()}

    def _along(self, t: np.ndarray, x: np.ndarray) -> dict[tuple[str, str], np.ndarray]:
        """The signals at n states."""
        inner = self.inner(x)
        compiled = iter(self._looked.many(t, inner, self.p).T)
        reactions = self._columns.along(t, inner, self.p) if self._columns is not None else np.zeros((len(t), 0))
        found = {}
        for signal in self.watch.signals:
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
        """What is rounding in each of the bounds, at one state; a speed that has just come near to 0 may pass it."""
        n = len(self.coordinates)
        if not self.bounds:
            return np.zeros(0)
        places, rates = np.max(np.abs(x[:n]), initial=1.0), np.max(np.abs(x[n:]), initial=1.0)
        size = {"force": COMPUTED * self.sizes(t, x)[0], "rate": COMPUTED * rates, "gap": COMPUTED * places}
        passing = [float(stopped_below(self.contact(b.owner))) if b.kind == "stops" else 0.0 for b in self.bounds]
        return np.maximum([size[bound.unit] for bound in self.bounds], passing) + SUMMED

    def watched(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """The bounds along the states, n x k; nan where a reaction has no single value."""
        if not self.bounds:
            return np.zeros((len(t), 0))
        signals = self._along(t, x)
        ways = iter(self._ways.many(t, self.inner(x), self.p).T)
        found = [next(ways) if bound.kind == "piece" else self._left(bound, signals) for bound in self.bounds]
        return np.column_stack(found)

    def _left(self, bound: EventFunction, signals: Mapping[tuple[str, str], np.ndarray]) -> np.ndarray:
        """What is left of a bound of a contact."""
        name = bound.owner
        mode = self.configuration.modes[name]
        if bound.kind == "closes":
            return signals[name, "gap"]
        if bound.kind == "stops":
            slowing = signals[name, "slide'"] < 0  # a speed that grows from 0 does not stop
            return np.asarray(
                (mode.sense or 0) * signals[name, "slide"] - slowing * float(stopped_below(self.contact(name)))
            )
        if bound.kind == "slips":
            return np.asarray(signals[name, "mu"] * np.abs(signals[name, "N"]) - np.abs(signals[name, "hold"]))
        return mode.push * signals[name, f"N{bound.row}" if bound.row > 1 else "N"]

    def contact(self, name: str) -> Contact:
        return next(contact for contact in self.contacts if contact.name == name)

    @cached_property
    def edges(self) -> tuple[Edge, ...]:
        """Where the contacts that are closed no longer say at which place they hold."""
        return edges_of(self.system.motion, self.configuration.open)

    def evaluated(self, t: np.ndarray, x: np.ndarray, scalars: tuple[Scalar, ...]) -> np.ndarray:
        """Functions of q, u, t, accelerations and multipliers along the states, n x scalars."""
        return self.function(scalars).many(t, self.inner(x), self.p)

    def slowest(self, t: float, x: np.ndarray) -> float:
        """The least speed with which anything slides on a surface; inf where nothing does [m/s]."""
        rows = self.system.ties.rows
        speeds = tuple(row.sliding for row in rows if row.shares and row.friction is not None)
        return float(np.min(self.evaluated(np.array([t]), x[None, :], speeds))) if speeds else np.inf

    def rests(self, t: float, values: Values) -> bool:
        """Whether nothing moves, and nothing is given that could move it later."""
        symbols, coordinates = self.system.symbols, self.system.scope.model.coordinates
        given = (symbols.t, *symbols.inputs.values(), *(q for q in symbols.q if coordinates[q.name].driven))
        needed = (equation.needed for equation in self.reactions.balance.equations)
        if any(depends_on(x, given) for x in (*self.assembly.forcing, *needed)):
            return False
        x = self.state(values)
        _, size = self.sizes(t, x)
        return bool(np.max(np.abs(self.rate(t, x)), initial=0.0) <= COMPUTED * size)

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
        return self.function(tuple(s.value for s in self.watch.signals if s.value is not None and not s.column))

    @cached_property
    def _columns(self) -> ReactionColumns | None:
        """The reactions behind the signals that follow from the balance of the bodies; None without such."""
        return ReactionColumns(self.reactions, self.rhs) if any(s.column for s in self.watch.signals) else None

    @cached_property
    def _ways(self) -> RightHandSide:
        return self._kinematic(tuple(b.value for b in self.bounds if b.kind == "piece" and b.value is not None))

    @cached_property
    def _sized(self) -> RightHandSide:
        return self.function((*self.assembly.forcing, *self.system.symbols.a))

    @cached_property
    def _slackening(self) -> RightHandSide:
        rates = {s.owner: s.value for s in self.watch.signals if s.what == "gap'" and s.value is not None}
        return self._kinematic(tuple(rates[name] for name in self.loose))

    @cached_property
    def _rates(self) -> RightHandSide:
        return self._kinematic(self.system.scope.rates)

    @cached_property
    def _energies(self) -> RightHandSide:
        return self._kinematic((self.assembly.T, self.assembly.V))


def smallest_speed(values: Values) -> float:
    """What is no rounding any more, against the fastest of the rates."""
    return COMPUTED * max([1.0, *(abs(v) for name, v in values.items() if name.endswith("'"))])


def slack_name(tie: str) -> str:
    """What the integrated slack of a string is called among the values of a state."""
    return f"{tie} slack"
