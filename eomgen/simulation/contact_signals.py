"""ContactEvents, PhaseFunctions -> ContactSignals: what the contacts of a phase say, in numbers along its states."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from eomgen.codegen.rhs import RightHandSide
from eomgen.records import dataclass
from eomgen.simulation.contact_events import ContactEvents, EventFunction, stopped_below
from eomgen.simulation.event_location import Measured
from eomgen.simulation.phase_functions import PhaseFunctions
from eomgen.simulation.reaction_columns import ReactionColumns
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import COMPUTED, SUMMED


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
            if signal.column in self._with_rank and columns is not None:
                values = reactions[:, columns.names.index(signal.column)]
            elif signal.value is None:
                values = self.functions.slacks(x)[:, self.watch.loose.index(signal.owner)]
            else:
                values = next(compiled)
            found[signal.owner, signal.what] = values
        return found

    def sizes(self, t: float, x: np.ndarray) -> tuple[float, float]:
        """How large forces and accelerations are at one state, the latter at least 1 m/s^2."""
        forces = [abs(v) for (_, what), v in self.look(t, x).items() if what[0] in "Nh" and np.isfinite(v)]
        found = np.abs(self._sized.many(np.array([t]), self.functions.inner(x)[None, :], self.functions.p)[0])
        n = len(self.functions.equations.symbols.u)
        return max([*forces, *found[:n]], default=0.0), max([1.0, *found[n:]])

    def floors(self, t: float, x: np.ndarray) -> np.ndarray:
        """What is rounding in each of the bounds, at one state; a speed that has just come near to 0 may pass it."""
        n = self.functions.places
        if not self.watch.bounds:
            return np.zeros(0)
        places, rates = np.max(np.abs(x[:n]), initial=1.0), np.max(np.abs(x[n:]), initial=1.0)
        size = {"force": COMPUTED * self.sizes(t, x)[0], "rate": COMPUTED * rates, "gap": COMPUTED * places}
        passing = [
            float(stopped_below(self.watch.contact(b.owner))) if b.kind == "stops" else 0.0 for b in self.watch.bounds
        ]
        return np.maximum([size[bound.unit] for bound in self.watch.bounds], passing) + SUMMED

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
        """Whether a bound follows from a balance that is solved with rank, is integrated, or knows a state before."""
        if bound.kind == "piece":
            return False
        contact = self.watch.contact(bound.owner)
        stops = bound.kind == "stops" and bool(stopped_below(contact))
        return (
            bound.value is None
            or stops
            or any(s.column in self._with_rank for s in self.watch.signals if s.owner == bound.owner)
        )

    def _left(self, bound: EventFunction, signals: Mapping[tuple[str, str], np.ndarray]) -> np.ndarray:
        """What is left of a bound of a contact."""
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
            return np.asarray(signals[name, "mu"] * np.abs(signals[name, "N"]) - np.abs(signals[name, "hold"]))
        return mode.push * signals[name, f"N{bound.row}" if bound.row > 1 else "N"]

    @cached_property
    def _looked(self) -> RightHandSide:
        return self.functions.function(
            tuple(s.value for s in self.watch.signals if s.value is not None and s.column not in self._with_rank)
        )

    @cached_property
    def _columns(self) -> ReactionColumns | None:
        """The reactions behind the signals that follow from the balance of the bodies; None without such."""
        return ReactionColumns(self.watch.reactions, self.functions.rhs) if self._with_rank else None

    @cached_property
    def _with_rank(self) -> frozenset[str]:
        """The columns for which the balance of the bodies is solved at each state, with its rank.

        A formula that divides by nothing but what the parameters make, and here is not zero, has a value at all states.
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
    """What a formula divides by, powers that are not whole among it."""
    found: list[Scalar] = []
    for x in order((value,)):
        if x.op == "div":
            found.append(x.args[1])
        elif x.op == "pow" and not (type(x.args[1]) is int and x.args[1] >= 0):
            found.append(x.args[0])
    return found
