"""System, condition, start -> Instant: the first time after the start at which the condition holds.

It is located in numbers first, then sought in closed form; what is found so is taken where it agrees with the numbers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from random import Random

from eomgen.errors import EomgenError, RunFailed
from eomgen.mechanics.bodies.places import Located
from eomgen.mechanics.bodies.sign import positive_parameters
from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.first_integrals.closed_instant import ClosedInstant
from eomgen.model.values import exact_parameters
from eomgen.simulation.first_time import FirstTime, values_of
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

TRIALS = (1.3, 3, 8, 20)  # how far from 1 values are tried for parameters that have none


@dataclass(frozen=True)
class Instant:
    """The state at an instant.

    Args:
        exact: t, q and u as scalars of the parameters, those that are known in closed form.
        numbers: t, q and u as numbers; t is nan where it is not known, as it takes for ever to leave an unstable rest;
            {} without values of all parameters.
        method: how it was found.
    """

    exact: State = field(default_factory=dict)
    numbers: State = field(default_factory=dict)
    method: str = "integration in time"


def reached(
    system: System,
    assembly: Assembly,
    accelerations: Sequence[Scalar],
    condition: Scalar,
    start_exact: Mapping[Node, Scalar],
    start_numbers: Mapping[Node, float],
) -> Instant:
    """The first instant after the start at which the condition is 0; one at the start itself is none.

    Args:
        accelerations: a as expressions of q, u and t.
        condition: of q, u, t and parameters.
        start_exact: q and u at the start as scalars of the parameters, t where it is not 0; {} where they have no
            closed form.
        start_numbers: the same as numbers; {} where parameters have no values.
    Raises:
        RunFailed: the condition is not met.
    """
    own = {node: system.inputs[name] for name, node in assembly.symbols.inputs.items()}
    *accelerations, condition = substituted((*accelerations, condition), own)
    search = _Search(system, assembly, tuple(accelerations), condition, dict(start_exact))
    values = values_of(assembly.symbols.parameters, exact_parameters(system.scope.model))
    return search.at(dict(start_numbers), values) if start_numbers else search.with_trial_values(values)


@dataclass(frozen=True)
class _Search:
    """An instant that is sought; the arguments are those of `reached`."""

    system: System
    assembly: Assembly
    accelerations: tuple[Scalar, ...]
    condition: Scalar
    start: State

    def at(self, start: State, values: State) -> Instant:
        """The instant at the parameters' values."""
        equations = (self.system, self.assembly, self.accelerations)
        numbers, method = FirstTime(*equations, self.condition, self.start, start, values).located()
        exact, way = self._exact(numbers, values)
        return Instant(exact, numbers, way or method)

    def with_trial_values(self, known: State) -> Instant:
        """The instant in closed form alone: branches are chosen at values that the parameters might have.

        Raises:
            RunFailed: at no trial is the condition met.
        """
        rng = Random(1)
        reason: EomgenError = RunFailed("the start has no closed form, and no numbers")
        for spread in TRIALS:
            values = {node: spread ** rng.uniform(-1, 1) for node in self.system.symbols.parameters.values()} | known
            try:
                numbers = evaluate(tuple(self.start.values()), values, FLOAT)
                start = {self.system.symbols.t: 0.0, **dict(zip(self.start, map(float, numbers), strict=True))}
                return replace(self.at(start, values), numbers={})
            except EomgenError as error:
                reason = error
        tried = "at the values tried for parameters without one"
        raise RunFailed(f"{reason.what} ({tried})", mend="give the parameters values")

    def _exact(self, numbers: State, values: State) -> tuple[State, str]:
        """(t, q and u in closed form, by which way); the way is "" where the numbers' own is the better word."""
        symbols = self.system.symbols
        moving = {*symbols.q, *symbols.u}
        if not moving <= self.start.keys():
            return {}, ""
        positive = positive_parameters(self.system.scope) | {q for q in symbols.q if numbers[q] > 0}
        located = Located({**values, **numbers}, positive)
        closed = ClosedInstant(self.system, self.assembly, self.accelerations, self.condition, self.start, located)
        by_time = closed.by_laws()
        if moving <= by_time.keys() or not depends_on(self.condition, moving):
            return by_time, "law of motion" if by_time.keys() & self._own else ""
        by_energy = closed.by_integrals()
        way = "energy theorem" if by_energy.keys() & {*symbols.u} else "law of motion" if by_time else ""
        return {**by_energy, **by_time}, way

    @property
    def _own(self) -> set[Node]:
        """The coordinates and speeds that no given motion says."""
        symbols, table = self.system.symbols, self.system.scope.model.coordinates
        return {*symbols.u, *(q for q in symbols.q if not table[q.name].driven)}
