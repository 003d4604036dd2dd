"""System, a state in which its equations have no value -> what has none there: a force, a joint, a tie, an input."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

from eomgen.mechanics.equations.system import System
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.traversal import order
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import LARGEST_SQUARED

REASONS = {
    "div": "divides by zero",
    "sqrt": "takes the root of a negative number",
    "log": "takes the logarithm of what is not positive",
    "pow": "takes a power that is no number",
}


@dataclass(frozen=True)
class Valueless:
    """What has no value in a state.

    Args:
        where: its path in the model.
        what: "force 'pull' is 0/0 at x = 0".
    """

    where: str
    what: str


def valueless(system: System, values: Mapping[Node, float]) -> Valueless | None:
    """The first part of a system that has no finite value in a state; None where each has one.

    Args:
        values: of t, q, u and the parameters.
    """
    for where, name, part in _parts(system):
        for scalar in _scalars(part):
            reason = reason_without_value(scalar, values)
            if reason:
                return Valueless(where, f"{name} {reason}")
    return None


def overlarge(system: System, values: Mapping[Node, float]) -> Valueless | None:
    """The largest part of a system in a state, where that is too large to be calculated with; None where none is."""
    sizes = [(_size(part, values), where, name) for where, name, part in _parts(system)]
    size, where, name = max(sizes, default=(0.0, "", ""))
    if not LARGEST_SQUARED < size < math.inf:
        return None
    what = f"{name} is of the size {size:.3g} there, beyond what doubles can follow; give it a smaller value"
    return Valueless(where, what)


def _size(part: Any, values: Mapping[Node, float]) -> float:
    """The largest number in it, in SI; 0 where the state does not say it."""
    scalars = tuple(x for x in _scalars(part) if all(symbol in values for symbol in symbols_of((x,))))
    return max((abs(x) for x in evaluate(scalars, values, FLOAT) if not math.isnan(x)), default=0.0)


def _parts(system: System) -> Iterator[tuple[str, str, Any]]:
    for name, value in system.inputs.items():
        yield f"inputs.{name}", f"input '{name}'", value
    for force in system.loads.applied:
        yield f"forces.{force.name}", f"force '{force.name}'", force.loads
    for effort in system.loads.efforts:
        yield f"bodies.{effort.body}.joint", f"the joint of body '{effort.body}'", effort.effort
    for row in system.ties.rows:
        yield f"constraints.{row.tie}", f"constraint '{row.tie}'", (row.gap, row.velocity, row.wrenches)
        yield f"constraints.{row.tie}", f"the friction of '{row.tie}'", (row.friction, row.shares)


def _scalars(part: Any) -> Iterator[Scalar]:
    """The formulas in a load or a row."""
    if type(part) in (Node, int, Fraction):
        yield part
    elif isinstance(part, (tuple, list)):
        for each in part:
            yield from _scalars(each)
    elif is_dataclass(part):
        for field in fields(part):
            yield from _scalars(getattr(part, field.name))


def reason_without_value(scalar: Scalar, values: Mapping[Node, float]) -> str:
    """Why it has no finite value, and where; "" where it has one, or holds what is not known in a state."""
    symbols = symbols_of((scalar,))
    if not all(symbol in values for symbol in symbols):
        return ""
    nodes = order((scalar,))
    known = dict(zip(nodes, evaluate(nodes, values, FLOAT), strict=True))
    culprit = next((node for node in nodes if not math.isfinite(known[node])), None)
    if culprit is None or culprit in values:  # a state that is no number is nobody's here
        return ""
    operands = [known[a] if type(a) is Node else float(a) for a in culprit.args]
    reason = REASONS.get(culprit.op, "has no finite value")
    reason = "is 0/0" if culprit.op == "div" and not any(operands) else reason
    held = symbols_of((culprit,))
    state = [symbol for symbol in held if not symbol.graph.is_constant(symbol)] or held
    return f"{reason} at {', '.join(f'{symbol.name} = {values[symbol]:.6g}' for symbol in state)}" if state else reason
