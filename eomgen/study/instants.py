"""States of a motion at an instant, exactly and in numbers, in one phase or the next."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from random import Random

from eomgen.errors import DerivationError, EomgenError, RunFailed
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.integrals import ClosedInstant
from eomgen.mechanics.kinematics import Located
from eomgen.simulation import FirstTime
from eomgen.study.study import Study
from eomgen.symbolic.expression import Node, Scalar, State, depends_on, substituted
from eomgen.symbolic.numeric import FLOAT, evaluate, transplanted


@dataclass(frozen=True)
class StateAtInstant:
    """State of a motion at one instant.

    Args:
        phase: the equations of the phase.
        exact: t, q and u as scalars of the parameters, as far as they have a closed form.
        numbers: t, q and u as numbers; {} where parameters have no values.
        method: name of the method by which the instant was found.
    """

    phase: Study
    exact: Mapping[Node, Scalar]
    numbers: Mapping[Node, float]
    method: str

    @classmethod
    def resting(cls, study: Study) -> StateAtInstant:
        """Equilibrium that is nearest to the start; with unknowns in the loads, the start itself.

        Args:
            study: of the contacts as they are at rest.
        Raises:
            DerivationError: there is no equilibrium, or a contact would have to pull there.
        """
        from eomgen.mechanics.equilibrium import standing_system

        if study.statics.loaded:
            return _held(study.system)
        place = study.equilibria.nearest()
        system = standing_system(place.statics.system)
        place.refuse_contradicted()
        held = f", {', '.join(place.statics.held)} held" if place.statics.held else ""
        exact = {**place.exact, **_still(system)}
        numbers = (
            {**place.numbers, **dict.fromkeys((system.symbols.t, *system.symbols.u), 0.0)} if place.numbers else {}
        )
        return StateAtInstant(Study(system), exact, numbers, f"balance of all forces at rest{held}")


def carried(moment: StateAtInstant, phase: Study) -> dict[Node, Scalar]:
    """Exact end of a phase as the start of the next; {} where it is not exact.

    A displacement that the phase before did not have is 0.
    """
    symbols = phase.system.symbols
    known = {node.name: x for node, x in moment.exact.items()}
    old = {x.name for x in (*moment.phase.system.symbols.q, *moment.phase.system.symbols.u)}
    wanted = [symbols.t, *symbols.q, *symbols.u]
    if any(node.name not in known and (node.name in old or node is symbols.t) for node in wanted):
        known = _with_rates(moment, known)
    if any(node.name not in known and (node.name in old or node is symbols.t) for node in wanted):
        return {}
    meanings = dict(symbols.parameters)
    values = transplanted([known.get(node.name, 0) for node in wanted], symbols.graph, meanings)
    return dict(zip(wanted, values, strict=True))


def _with_rates(moment: StateAtInstant, known: dict[str, Scalar]) -> dict[str, Scalar]:
    """The rates of coordinates that were dependent, too."""
    scope = moment.phase.system.scope
    rates = substituted(scope.rates, dict(moment.exact))
    return {f"{q.name}'": rate for q, rate in zip(scope.symbols.q, rates, strict=True)} | known


def placed(phase: Study, known: Mapping[Node, Scalar], numbers: Mapping[Node, float]) -> dict[Node, Scalar]:
    """Known values of a state, with the coordinates that the constraints then fix, where they have a closed form.

    Args:
        numbers: the same state in numbers, by which one of several positions is chosen; {}: nothing is added.
    """
    system = phase.system
    unknown = [q for q in system.symbols.q if q not in known]
    gaps = [row.gap for row in system.constraints.rows if row.gap is not None and not row.identical]
    if not unknown or not gaps or not numbers or len(gaps) < len(unknown) == len(system.symbols.q):
        return dict(known)  # nothing to begin with
    located = Located({**phase.numeric_parameters, **numbers}, phase.system.scope.positive)
    equations = [x for x in substituted(tuple(gaps), known) if depends_on(x, unknown)]
    return {**known, **located.places(equations, unknown)}


def _held(system: System) -> StateAtInstant:
    """The start, held by the unknowns of the loads."""
    from eomgen.mechanics.equilibrium import holding_of

    holding = holding_of(system)
    system = holding.statics.system
    return StateAtInstant(Study(system), {**holding.place, **holding.unknowns, **_still(system)}, {}, "virtual work")


def _still(system: System) -> dict[Node, Scalar]:
    return {system.symbols.t: 0, **dict.fromkeys(system.symbols.u, 0)}


# -------- first instant ---------------------------------------------------------------------------------------
# Phase, condition, start -> the state at the first time after the start at which the condition holds.
#
# It is located in numbers first, then sought in closed form; a closed form is used where it agrees with the numbers.


TRIALS = (1.3, 3, 8, 20)  # how far from 1 values are tried for parameters that have none


def reached(
    phase: Study, condition: Scalar, start: Mapping[Node, Scalar], numbers: Mapping[Node, float]
) -> StateAtInstant:
    """State at the first instant after the start at which the condition is 0; the start itself does not count.

    Args:
        condition: function of q, u, t and parameters.
        start: q and u at the start as scalars of the parameters, t where it is not 0; {} without a closed form.
        numbers: the same as numbers; {} where parameters have no values.
    Raises:
        RunFailed: the condition is not met.
    """
    search, values = _search(phase, condition, start), _values(phase)
    return search.first(dict(numbers), values) if numbers else search.with_trial_values(values)


def closed_form(
    phase: Study, condition: Scalar, start: Mapping[Node, Scalar], numbers: Mapping[Node, float]
) -> tuple[State, str]:
    """State in closed form where the condition holds, and the name of the method.

    t, q and u are given as far as they have a closed form.
    Args:
        start: q and u at the start of the phase.
        numbers: t, q and u at the instant.
    """
    return _search(phase, condition, start).closed(dict(numbers), _values(phase))


def _search(phase: Study, condition: Scalar, start: Mapping[Node, Scalar]) -> _Search:
    own = {node: phase.system.inputs[name] for name, node in phase.system.symbols.inputs.items()}
    *accelerations, condition = substituted((*phase.accelerations, condition), own)
    return _Search(phase, tuple(accelerations), condition, dict(start))


def _values(phase: Study) -> State:
    parameters, known = phase.system.symbols.parameters, phase.model.exact_parameters()
    return {node: float(known[name]) for name, node in parameters.items() if name in known}


@dataclass(frozen=True)
class _Search:
    """Search for an instant; arguments as of `reached`, inputs replaced by their own functions of time."""

    phase: Study
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
        """State at the instant in closed form alone; its branch is chosen at trial values of the parameters.

        Raises:
            RunFailed: the condition is met at none of the trials.
        """
        symbols, rng = self.phase.system.symbols, Random(1)
        if not {*symbols.q, *symbols.u} <= self.start.keys():
            raise RunFailed("the start has no closed form, and no numbers", fix="give the parameters values")
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
        raise RunFailed(f"{reason.what} ({tried})", fix="give the parameters values")

    def closed(self, numbers: State, values: State) -> tuple[State, str]:
        """State in closed form, and the name of the method; "" where the method of the numbers describes it better."""
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
        """Speeds, and the coordinates that are not given as functions of time."""
        symbols, table = self.phase.system.symbols, self.phase.model.coordinates
        return {*symbols.u, *(q for q in symbols.q if not table[q.name].driven)}
