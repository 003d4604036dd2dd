"""Moments of a motion: what is known of the state at an instant, exactly and in numbers, in one phase or the next."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from eomgen.mechanics.places import Located, places_of
from eomgen.model.values import numeric_parameters
from eomgen.situation import Situation
from eomgen.symbolic.derivative import depends_on, substituted
from eomgen.symbolic.graph import Node, Scalar
from eomgen.symbolic.transplant import transplanted


@dataclass(frozen=True)
class Moment:
    """One instant of a motion.

    Args:
        situation: the equations of the phase.
        exact: t, q and u as scalars of the parameters, those that are known so.
        numbers: t, q and u as numbers; {} where parameters are missing.
        method: how it was found.
    """

    situation: Situation
    exact: Mapping[Node, Scalar]
    numbers: Mapping[Node, float]
    method: str


def carried(moment: Moment, situation: Situation) -> dict[Node, Scalar]:
    """The exact end of a phase as the start of the next; a displacement that did not exist is 0. {}: not exact."""
    symbols = situation.system.symbols
    known = {node.name: x for node, x in moment.exact.items()}
    old = {x.name for x in (*moment.situation.system.symbols.q, *moment.situation.system.symbols.u)}
    wanted = [symbols.t, *symbols.q, *symbols.u]
    if any(node.name not in known and (node.name in old or node is symbols.t) for node in wanted):
        known = _with_rates(moment, known)
    if any(node.name not in known and (node.name in old or node is symbols.t) for node in wanted):
        return {}
    meanings = dict(symbols.parameters)
    values = transplanted([known.get(node.name, 0) for node in wanted], symbols.graph, meanings)
    return dict(zip(wanted, values, strict=True))


def _with_rates(moment: Moment, known: dict[str, Scalar]) -> dict[str, Scalar]:
    """The rates of coordinates that were dependent, too."""
    scope = moment.situation.system.scope
    rates = substituted(scope.rates, dict(moment.exact))
    return {f"{q.name}'": rate for q, rate in zip(scope.symbols.q, rates, strict=True)} | known


def placed(situation: Situation, known: Mapping[Node, Scalar], numbers: Mapping[Node, float]) -> dict[Node, Scalar]:
    """What is known of a state, and the coordinates that the ties then fix, where they have a closed form.

    Args:
        numbers: the same state in numbers, by which one of several places is chosen; {}: nothing is added.
    """
    system = situation.system
    unknown = [q for q in system.symbols.q if q not in known]
    gaps = [row.gap for row in system.ties.rows if row.gap is not None and not row.identical]
    if not unknown or not gaps or not numbers:
        return dict(known)
    located = Located({**parameters_of(situation), **numbers}, situation.positive)
    equations = [x for x in substituted(tuple(gaps), known) if depends_on(x, unknown)]
    return {**known, **places_of(equations, unknown, located)}


def parameters_of(situation: Situation) -> dict[Node, float]:
    """The values of the parameters."""
    values = numeric_parameters(situation.model)
    return {situation.system.symbols.parameters[name]: float(x) for name, x in values.items()}

