"""Ties -> where the coordinates start that the ties place, or move.

phi(q) = 0        dependent coordinates from their guesses, then the nearest place of all others
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Sequence
from random import Random
from typing import Any

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.places import Located, places_of
from eomgen.mechanics.bodies.system_scene import start_values, with_unit_quaternions
from eomgen.mechanics.constraints.closure import closed, gaps_of, of_50_digits, still_values
from eomgen.mechanics.constraints.consistency import bilateral, is_guess, is_typed, nearest_places
from eomgen.mechanics.constraints.elimination import dependent_coordinates
from eomgen.mechanics.constraints.ties import Row, Ties
from eomgen.model.contacts import contacts_of
from eomgen.model.parts import Model
from eomgen.model.values import exact_parameters
from eomgen.symbolic.expression.derivative import depends_on, gradient, substituted, symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import COMPUTED, OPEN_GAP

SEEDS = (11, 12)  # of values for parameters that have none: what is no closed form agrees at one of them by chance


def begun_places(ties: Ties) -> dict[Node, Scalar]:
    """Where the coordinates start that the ties place, or move: in closed form, else in numbers; {} where none do.

    Raises:
        DerivationError: a place has no closed form, and parameters have no value.
    """
    scope, rows = ties.motion.scope, gaps_of(ties)
    if not rows:
        return {}
    declared = with_unit_quaternions(scope, start_values(scope)) | {scope.symbols.t: 0}
    drawn = any(name not in exact_parameters(scope.model) for name in scope.symbols.parameters)
    states = [_assembled(ties, declared, seed) for seed in (SEEDS if drawn else SEEDS[:1])]
    moved = [q for q in scope.symbols.q if any(_differs(declared[q], q, state) for state in states)]
    if not moved:
        return {}
    known = {x: value for x, value in declared.items() if x not in moved}
    equations = [x for x in substituted(rows, known) if depends_on(x, moved)]
    located = [Located({x: float(value) for x, value in state.items()}, scope.positive) for state in states]
    found = places_of(equations, moved, located[0])
    exact = {q: x for q, x in found.items() if q in moved and all(each.agrees(x, q) for each in located)}
    left = [q for q in moved if q not in exact or depends_on(exact[q], moved)]
    if left and drawn:
        what = f"where '{left[0].name}' starts has no closed form, and no number while parameters have no value"
        raise DerivationError(what, f"coordinates.{left[0].name}", "give the parameters values")
    return exact | {q: Fraction(str(states[0][q])) for q in left}


def _assembled(ties: Ties, declared: dict[Node, Scalar], seed: int) -> State:
    """A state at t = 0 in which positions agree with the ties."""
    scope = ties.motion.scope
    state, guesses = still_values(ties, Random(seed))
    state = state | dict(zip(declared, evaluate(tuple(declared.values()), state, fifty_digits()), strict=True))
    sought = fixed_by_position(ties)
    state |= {q: of_50_digits(guesses[q.name]) for q in sought}
    state = (closed(ties, state, sought) or state) if sought else state
    called = frozenset(q.name for q in scope.symbols.q if is_typed(scope.model, q.name))
    return with_gaps_closed(ties, state, called)[0]


def _differs(declared: Scalar, q: Node, state: State) -> bool:
    """Whether a coordinate is not where it is declared to start."""
    before = float(evaluate((declared,), state, fifty_digits())[0])
    return abs(float(state[q]) - before) > COMPUTED * (1 + abs(before))


def with_gaps_closed(ties: Ties, state: State, called: frozenset[str]) -> tuple[State, tuple[str, ...]]:
    """(the nearest state in which positions agree with the ties, the ties that did not hold).

    Args:
        called: coordinates whose start a person typed, or a caller gave: these are moved last.
    """
    scope = ties.motion.scope
    apart = open_at(((row, row.gap) for row in ties.rows if not row.identical), scope.symbols.q, state)
    staying = that_stay(ties, apart)
    opened = tuple(name for name in apart if any(row.tie == name for row in staying.rows))
    if not opened:
        return state, ()
    standing, sought = set(symbols_of(gaps_of(staying))), fixed_by_position(ties)
    own = [
        q for q in scope.symbols.q if q in standing and q not in sought and not scope.model.coordinates[q.name].driven
    ]
    silent, given, typed = tiers_of(scope.model, own, called)
    return nearest_places(staying, state, ([*sought, *silent], given, typed), (*sought, *silent)) or state, opened


def fixed_by_position(ties: Ties) -> list[Node]:
    """The dependent coordinates that stand in a gap."""
    scope, standing = ties.motion.scope, set(symbols_of(gaps_of(ties)))
    names = dependent_coordinates(scope)
    return [q for q in scope.symbols.q if q.name in names and q in standing]


def tiers_of(model: Model, own: Sequence[Node], called: frozenset[str]) -> tuple[list[Node], list[Node], list[Node]]:
    """Coordinates or speeds in the order in which they are changed: nobody's, those of the model, those called."""
    silent = [node for node in own if node.name not in called and is_guess(model, node.name)]
    typed = [node for node in own if node.name in called]
    return silent, [node for node in own if node not in silent and node not in typed], typed


def open_at(pairs: Iterable[tuple[Row, Scalar | None]], symbols: Sequence[Node], state: State) -> tuple[str, ...]:
    """The ties whose scalars ought to be zero and are not."""
    named = ((row, x) for row, x in pairs if x is not None)
    return tuple(dict.fromkeys(row.tie for row, x in named if open_by(x, symbols, state)))


def that_stay(ties: Ties, apart: Sequence[str]) -> Ties:
    """All ties but the contacts that are open and may be so."""
    ending = [contact.name for contact in contacts_of(ties.motion.scope.model) if contact.unilateral]
    return bilateral(ties, ending, [name for name in ending if name not in apart])


def open_by(x: Scalar, symbols: Sequence[Node], state: State) -> float:
    """|x|, where it is more than rounding: against its terms, and against what the symbols would have to move."""
    try:
        slopes = evaluate(gradient(x, symbols), state, fifty_digits())
        value, terms = _value_and_terms(x, state)
    except (NoValue, ZeroDivisionError):
        return float("inf")
    steepest = float(max((abs(slope) for slope in slopes), default=0))
    return value if value > OPEN_GAP * terms and value > COMPUTED * steepest else 0.0


def _value_and_terms(x: Scalar, state: State) -> tuple[float, float]:
    """(|x|, the same with every sum taken of absolute values): how large the terms are that cancel."""
    nodes = order((x,))
    values = dict(zip(nodes, evaluate(nodes, state, fifty_digits()), strict=True))
    terms = {node: abs(value) for node, value in values.items()}
    for node in nodes:
        if node.op in _OF_TERMS:
            terms[node] = _OF_TERMS[node.op](
                *(terms[a] if type(a) is Node else abs(of_50_digits(a)) for a in node.args)
            )
    return (float(abs(values[x])), float(terms[x])) if type(x) is Node else (abs(float(x)), 0.0)


_OF_TERMS: dict[str, Callable[..., Any]] = {
    "add": operator.add,
    "sub": operator.add,
    "mul": operator.mul,
    "neg": operator.pos,
}
