"""System, state -> whether what stays as at the start is closed there.

phi(q_0, t = 0) = 0,   q_0 as the coordinates are declared to start, quaternions of length 1
"""

from __future__ import annotations

from typing import Any

from eomgen.errors import DerivationError, MissingValues, ModelError
from eomgen.mechanics.bodies.loads import Applied
from eomgen.mechanics.bodies.scope import Scope
from eomgen.mechanics.constraints.ties import Row
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.initial_state.initial_state import start_of_motion
from eomgen.model.values import exact_parameters
from eomgen.symbolic.expression.graph import Scalar
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import FLOAT, NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import SOLVED, ZERO_AT_50


def rows_that_stay(system: System) -> tuple[tuple[Row, Scalar], ...]:
    """The rows whose ties say only that something stays as it is at the start, with their gaps."""
    ties = system.scope.model.constraints
    named = ((row, row.gap) for row in system.ties.rows if row.tie in ties and row.gap is not None)
    return tuple((row, gap) for row, gap in named if ties[row.tie].stays(row.component))


def open_at_start(system: System, state: State) -> str:
    """Which of them is open at the start, with the parameters of a state; "" where none is.

    Raises:
        NoValue: something has no value there.
    """
    begun = {**state, **_declared_start(system.scope, state)}
    kept = rows_that_stay(system)
    for (row, _), gap in zip(kept, evaluate([gap for _, gap in kept], begun, fifty_digits()), strict=True):
        if abs(gap) > ZERO_AT_50 * (1 + max(map(abs, begun.values()))):
            return f"'{row.tie}' is open by {float(gap):.10g} where it starts"
    return ""


def springs_of_the_start(system: System) -> tuple[Applied, ...]:
    """The springs that are slack at the length, or angle, which they have at the start."""
    forces = system.scope.model.forces
    return tuple(applied for applied in system.loads.applied if forces[applied.name].of_the_start)


def pulled_at_start(system: System) -> str:
    """Which of them is not slack where the motion starts, all ties closed; "" where all are.

    Raises:
        NoValue: the start is not known in numbers.
    """
    try:
        start = start_of_motion(system).values
    except (DerivationError, MissingValues, ModelError) as error:
        raise NoValue(str(error).splitlines()[0]) from None
    symbols = system.symbols
    known = exact_parameters(system.scope.model)
    state = {node: float(known[name]) for name, node in symbols.parameters.items() if name in known}
    state |= {node: start.get(node.name, 0.0) for node in (*symbols.q, *symbols.u)} | {symbols.t: 0.0}
    for applied in springs_of_the_start(system):
        if applied.potential is not None and evaluate((applied.potential,), state, FLOAT)[0] > SOLVED:
            return f"forces.{applied.name} is not slack where the motion starts"
    return ""


def _declared_start(scope: Scope, state: State) -> dict[Any, Any]:
    """t = 0, and where every coordinate is declared to start."""
    digits, parts = fifty_digits(), scope.model.coordinates
    found: dict[Any, Any] = {scope.symbols.t: digits.number(0)}
    for q in scope.symbols.q:
        part = parts[q.name]
        declared = part.motion or (part.near if part.start is None else part.start)
        (found[q],) = evaluate((scope.value(declared),), {**state, **found}, digits)
    for four in scope.quaternions:
        length = digits.functions["sqrt"](sum(found[e] ** 2 for e in four))
        found |= {e: found[e] / length for e in four}
    return found
