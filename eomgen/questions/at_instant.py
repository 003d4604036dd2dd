"""Moments of a motion: what is known of the state at an instant, exactly and in numbers, in one phase or the next."""

from __future__ import annotations

from collections.abc import Mapping

from eomgen.mechanics.bodies.places import Located, places_of
from eomgen.mechanics.equations.system import System
from eomgen.model.values import numeric_parameters
from eomgen.questions.in_phase import PhaseEquations
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on, substituted
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.transplant import transplanted


@dataclass(frozen=True)
class StateAtInstant:
    """One instant of a motion.

    Args:
        phase: the equations of the phase.
        exact: t, q and u as scalars of the parameters, those that are known so.
        numbers: t, q and u as numbers; {} where parameters are missing.
        method: how it was found.
    """

    phase: PhaseEquations
    exact: Mapping[Node, Scalar]
    numbers: Mapping[Node, float]
    method: str


def carried(moment: StateAtInstant, phase: PhaseEquations) -> dict[Node, Scalar]:
    """The exact end of a phase as the start of the next; a displacement that did not exist is 0. {}: not exact."""
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


def placed(phase: PhaseEquations, known: Mapping[Node, Scalar], numbers: Mapping[Node, float]) -> dict[Node, Scalar]:
    """What is known of a state, and the coordinates that the ties then fix, where they have a closed form.

    Args:
        numbers: the same state in numbers, by which one of several places is chosen; {}: nothing is added.
    """
    system = phase.system
    unknown = [q for q in system.symbols.q if q not in known]
    gaps = [row.gap for row in system.ties.rows if row.gap is not None and not row.identical]
    if not unknown or not gaps or not numbers or len(gaps) < len(unknown) == len(system.symbols.q):
        return dict(known)  # nothing to begin with
    located = Located({**parameters_of(phase), **numbers}, phase.system.scope.positive)
    equations = [x for x in substituted(tuple(gaps), known) if depends_on(x, unknown)]
    return {**known, **places_of(equations, unknown, located)}


def resting(system: System, guess: Mapping[str, float] | None = None) -> StateAtInstant:
    """The place at which all forces balance, the nearest to the start; with unknowns in the loads, the start itself.

    Args:
        system: as it is at the start.
        guess: values of coordinates in place of `near` and `start`.
    Raises:
        DerivationError: there is none; a contact would have to pull there.
    """
    from eomgen.mechanics.equilibria.search import all_equilibria
    from eomgen.mechanics.equilibria.standing import standing_system
    from eomgen.mechanics.equilibria.static_equations import static_equations

    statics = static_equations(system)
    if statics.loaded:
        return _held(system)
    equilibria = all_equilibria(system, guess)
    place = equilibria.nearest()
    system = standing_system(place.statics.system)
    place.refuse_pulling()
    held = f", {', '.join(place.statics.held)} held" if place.statics.held else ""
    exact = {**place.exact, **_still(system)}
    numbers = {**place.numbers, **dict.fromkeys((system.symbols.t, *system.symbols.u), 0.0)} if place.numbers else {}
    return StateAtInstant(PhaseEquations(system), exact, numbers, f"balance of all forces at rest{held}")


def _held(system: System) -> StateAtInstant:
    """The start, held by the unknowns of the loads."""
    from eomgen.mechanics.equilibria.loads_at_rest import holding_of

    holding = holding_of(system)
    system = holding.statics.system
    return StateAtInstant(
        PhaseEquations(system), {**holding.place, **holding.unknowns, **_still(system)}, {}, "virtual work"
    )


def _still(system: System) -> dict[Node, Scalar]:
    return {system.symbols.t: 0, **dict.fromkeys(system.symbols.u, 0)}


def parameters_of(phase: PhaseEquations) -> dict[Node, float]:
    """The values of the parameters."""
    values = numeric_parameters(phase.model)
    return {phase.system.symbols.parameters[name]: float(x) for name, x in values.items()}
