"""System, condition, start -> the state at which the condition first holds after the start, in numbers.

By the motion in time; from an unstable rest or a dead centre along the configurations (`rest_departure`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen.program import program_of
from eomgen.codegen.rhs import compiled
from eomgen.errors import DerivationError, RunFailed
from eomgen.mechanics.constraints.elimination import PLACE, singular_blocks
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.records import dataclass
from eomgen.simulation.configuration import Configuration
from eomgen.simulation.event_location import Events
from eomgen.simulation.integrator import Run, Stepping, march
from eomgen.simulation.motion import Plan, advance
from eomgen.simulation.phase_change import PhaseStart
from eomgen.simulation.phase_model import PhaseModel
from eomgen.simulation.phase_models import one_phase
from eomgen.simulation.rest_departure import RestDeparture
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import COMPUTED, DEGENERATE, FAIR_RUN, FINE_RUN, SOLVED
from eomgen.symbolic.solve.solving import roots

LONGEST = 1e9  # s, of a search
FINE = Stepping(rtol=FINE_RUN, atol=FINE_RUN, most_steps=100_000)
SEARCH = replace(FINE, most_steps=4000)
FAIR = replace(SEARCH, rtol=FAIR_RUN, atol=FAIR_RUN)  # where the finer one does not come across a singular position


@dataclass(frozen=True)
class FirstTime:
    """A motion in one phase, and what is sought on it.

    Args:
        equations, accelerations: the equations of motion.
        condition: of q, u, t and parameters; it vanishes at the instant.
        exact: q and u at the start as scalars of the parameters, {} where they have no closed form.
        start: t, q and u at the start.
        values: of the parameters.
    """

    equations: EquationsOfMotion
    accelerations: tuple[Scalar, ...]
    condition: Scalar
    exact: State
    start: State
    values: State

    def located(self) -> tuple[State, str]:
        """(t, q and u at the instant, how they were found); t is nan where it is not known.

        Raises:
            RunFailed: the condition is not met.
        """
        if not depends_on(self.condition, (*self.equations.symbols.q, *self.equations.symbols.u)):
            return self._at_time(), "integration in time"
        if self._departure.is_needed:
            return self._departure.first(self.condition), "energy theorem"
        run = self._met()
        self._refuse_undetermined(run)
        return self._state(run), "integration in time"

    @property
    def t0(self) -> float:
        return float(self.start.get(self.equations.symbols.t, 0.0))

    @cached_property
    def _phase(self) -> PhaseModel:
        p = np.array([self.values[node] for node in self.equations.symbols.parameters.values()])
        return one_phase(self.equations.system, self.equations, p)

    @cached_property
    def _here(self) -> PhaseStart:
        symbols = self.equations.symbols
        begun = {node.name: float(self.start[node]) for node in (*symbols.q, *symbols.u)}
        return PhaseStart(self.t0, self._phase.with_rates(self.t0, begun), Configuration())

    @cached_property
    def _departure(self) -> RestDeparture:
        equations = (self.equations, self.accelerations)
        return RestDeparture(*equations, self.exact, self.start, self.values, self._phase, dict(self._here.values))

    def _state(self, run: Run) -> State:
        symbols, values = self.equations.symbols, self._phase.values(run.end, run.last)
        return {symbols.t: run.end} | {node: values[node.name] for node in (*symbols.q, *symbols.u)}

    def _at_time(self) -> State:
        """The state at a time that is given by itself.

        Raises:
            RunFailed: the motion does not go on until then.
        """
        end = self._given_time()
        if end <= self.t0:
            return {**self.start, self.equations.symbols.t: end}
        run = advance(self._phase, self._here, Plan(end, FINE))
        if run.status != "finished" or not np.all(np.isfinite(run.last)):
            raise RunFailed(
                f"the motion ends before the instant: {run.message[0].lower()}{run.message[1:]}",
                mend="ask for an earlier one",
            )
        return self._state(run)

    def _met(self) -> Run:
        """The motion up to where the condition first holds.

        Raises:
            RunFailed: it is not met.
        """
        for how in (SEARCH, FAIR):
            run = advance(self._phase, self._here, Plan(self.t0 + LONGEST, how, None, lambda phase: self.condition))
            if run.status != "singular":
                break
        if run.crossing is None:
            raise RunFailed(
                f"the condition is not met as far as the motion was followed: {run.message}",
                mend="ask for what the motion reaches",
            )
        return run

    def _refuse_undetermined(self, run: Run) -> None:
        """Refuse an instant at which the rates of dependent coordinates are 0/0.

        Raises:
            RunFailed: they are named.
        """
        for block in singular_blocks(self.equations.system.elimination, self.equations.system.scope):
            t, x = np.array([self.t0, run.end]), np.vstack([self._phase.state(self._here.values), run.last])
            before, there = self._phase.functions.evaluated(t, x, (block.determinant,))[:, 0]
            if abs(there) < DEGENERATE * abs(before):
                raise RunFailed(
                    f"{block} at that instant ({PLACE})",
                    mend="leave out `dependent`: then their rates belong to the state",
                )

    def _given_time(self) -> float:
        """The first t, from the start on, at which a condition on t alone holds."""
        t = self.equations.symbols.t
        values = [float(evaluate((root,), self.values, FLOAT)[0]) for root in roots(self.condition, t)]
        later = [value for value in values if value >= self.t0 - SOLVED]
        if later:
            return min(later)
        if values:
            raise DerivationError(f"the instant t = {max(values):g} s is before the start", mend="ask for a later one")
        function = compiled(program_of((self.condition,), self.equations.symbols), "numpy")
        x = np.array([self.start[node] for node in (*self.equations.symbols.q, *self.equations.symbols.u)])
        events = Events(
            lambda t, _: function.many(t, np.tile(x, (len(t), 1)), self._phase.p), np.full(1, COMPUTED), (0,)
        )
        run = march(lambda t, _: np.ones(1), (self.t0, LONGEST), np.zeros(1), how=SEARCH, events=events)
        if run.crossing is None:
            raise RunFailed("the condition on the time is never met", mend="ask for an instant after the start")
        return run.end


def values_of(parameters: Mapping[str, Node], known: Mapping[str, Any]) -> State:
    """The parameters that have values, by node."""
    return {node: float(known[name]) for name, node in parameters.items() if name in known}
