"""Equations of motion -> a few states in numbers at which formulas are compared: the start, in pieces, at random."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.errors import DerivationError
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.proof.at_a_state import NumericState
from eomgen.proof.states import TrialState
from eomgen.proof.trials import Trials
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.numeric.evaluation import NoValue

MOST = 3  # states at which all formulas are compared


def moving_states(equations: EquationsOfMotion) -> Iterator[NumericState]:
    """The first state of each supply where the motion has accelerations."""
    count = 0
    for _, supply in Trials(equations).states.supplies:
        for place in supply:
            state = _in_numbers(equations, place)
            try:
                state.unknowns.keys()
            except (NoValue, ZeroDivisionError, DerivationError):
                continue
            yield state
            count += 1
            break
        if count == MOST:
            return


def place_of(state: NumericState) -> str:
    """Its first coordinates, in words."""
    moving = [f"{node.name} = {x:.6g}" for node, x in state.numbers.items()]
    return ", ".join(moving[1:4])


def _in_numbers(equations: EquationsOfMotion, place: TrialState) -> NumericState:
    symbols, values = equations.symbols, place.state
    parameters = {node: Fraction(float(values[node])) for node in symbols.parameters.values()}
    return NumericState(equations, parameters, {x: float(values[x]) for x in (symbols.t, *symbols.q, *symbols.u)})
