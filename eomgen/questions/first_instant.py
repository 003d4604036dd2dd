"""Phase, condition, start -> the state at the first time after the start at which the condition holds.

It is located in numbers first, then sought in closed form; what is found so is taken where it agrees with the numbers.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from random import Random

from eomgen.errors import DerivationError, EomgenError, RunFailed
from eomgen.mechanics.bodies.places import Located
from eomgen.mechanics.first_integrals.closed_instant import ClosedInstant
from eomgen.model.values import exact_parameters
from eomgen.questions.at_instant import StateAtInstant
from eomgen.questions.in_phase import PhaseEquations
from eomgen.records import dataclass
from eomgen.simulation.first_time import FirstTime, values_of
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

TRIALS = (1.3, 3, 8, 20)  # how far from 1 values are tried for parameters that have none


def reached(
    phase: PhaseEquations, condition: Scalar, start: Mapping[Node, Scalar], numbers: Mapping[Node, float]
) -> StateAtInstant:
    """The first instant after the start at which the condition is 0; one at the start itself is none.

    Args:
        condition: of q, u, t and parameters.
        start: q and u at the start as scalars of the parameters, t where it is not 0; {} where a form is missing.
        numbers: the same as numbers; {} where parameters have no values.
    Raises:
        RunFailed: the condition is not met.
    """
    search, values = _search(phase, condition, start), _values(phase)
    return search.first(dict(numbers), values) if numbers else search.with_trial_values(values)


def closed_form(
    phase: PhaseEquations, condition: Scalar, start: Mapping[Node, Scalar], numbers: Mapping[Node, float]
) -> tuple[State, str]:
    """(t, q and u, those that are known in closed form, by which way) where the condition holds.

    Args:
        start: q and u at the start of the phase.
        numbers: t, q and u at the instant.
    """
    return _search(phase, condition, start).closed(dict(numbers), _values(phase))


def _search(phase: PhaseEquations, condition: Scalar, start: Mapping[Node, Scalar]) -> _Search:
    own = {node: phase.system.inputs[name] for name, node in phase.system.symbols.inputs.items()}
    *accelerations, condition = substituted((*phase.accelerations, condition), own)
    return _Search(phase, tuple(accelerations), condition, dict(start))


def _values(phase: PhaseEquations) -> State:
    return values_of(phase.system.symbols.parameters, exact_parameters(phase.model))


@dataclass(frozen=True)
class _Search:
    """An instant that is sought; the arguments are those of `reached`, inputs by their own functions of time."""

    phase: PhaseEquations
    accelerations: tuple[Scalar, ...]
    condition: Scalar
    start: State

    def first(self, start: State, values: State) -> StateAtInstant:
        """The instant at the parameters' values."""
        equations = (self.phase.equations, self.accelerations)
        numbers, method = FirstTime(*equations, self.condition, self.start, start, values).located()
        exact, way = self.closed(numbers, values)
        return StateAtInstant(self.phase, exact, numbers, way or method)

    def with_trial_values(self, known: State) -> StateAtInstant:
        """The instant in closed form alone: branches are chosen at values that the parameters might have.

        Raises:
            RunFailed: at no trial is the condition met.
        """
        symbols, rng = self.phase.system.symbols, Random(1)
        if not {*symbols.q, *symbols.u} <= self.start.keys():
            raise RunFailed("the start has no closed form, and no numbers", mend="give the parameters values")
        reason: EomgenError = RunFailed("no trial was made")
        parameters = symbols.parameters.values()
        for spread in TRIALS:
            values = {node: spread ** rng.uniform(-1, 1) for node in parameters} | known
            try:
                numbers = evaluate(tuple(self.start.values()), values, FLOAT)
                start = {symbols.t: 0.0, **dict(zip(self.start, map(float, numbers), strict=True))}
                return replace(self.first(start, values), numbers={})
            except (RunFailed, DerivationError) as error:
                reason = error
        tried = "at the values tried for parameters without one"
        raise RunFailed(f"{reason.what} ({tried})", mend="give the parameters values")

    def closed(self, numbers: State, values: State) -> tuple[State, str]:
        """(t, q and u in closed form, by which way); the way is "" where the numbers' own is the better word."""
        symbols = self.phase.system.symbols
        moving = {*symbols.q, *symbols.u}
        if not moving <= self.start.keys():
            return {}, ""
        positive = self.phase.system.scope.positive | {q for q in symbols.q if numbers[q] > 0}
        located = Located({**values, **numbers}, positive)
        equations = (self.phase.equations, self.accelerations)
        closed = ClosedInstant(*equations, self.condition, self.start, located)
        by_time = closed.by_laws()
        if moving <= by_time.keys() or not depends_on(self.condition, moving):
            return by_time, "law of motion" if by_time.keys() & self._own else ""
        by_energy = closed.by_integrals()
        way = "energy theorem" if by_energy.keys() & {*symbols.u} else "law of motion" if by_time else ""
        return {**by_energy, **by_time}, way

    @property
    def _own(self) -> set[Node]:
        """The coordinates and speeds that no given motion says."""
        symbols, table = self.phase.system.symbols, self.phase.model.coordinates
        return {*symbols.u, *(q for q in symbols.q if not table[q.name].driven)}
