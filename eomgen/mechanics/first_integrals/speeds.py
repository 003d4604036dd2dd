"""First integrals, start -> every speed as a function of the coordinates, without time.

Momenta and closing rows are linear in the speeds and leave one of them (`relations`), which the energy gives, or the
equation of its path (`free_speed`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.pieces import Extent
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.first_integrals.free_speed import FreeSpeed
from eomgen.mechanics.first_integrals.integrals import where_momenta_hold
from eomgen.mechanics.first_integrals.speeds_from_momenta import relations_of
from eomgen.model.values import exact_parameters
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate


def rates_of(
    equations: EquationsOfMotion,
    start: Mapping[Node, Scalar],
    *,
    there: Mapping[Node, float] | None = None,
    accelerations: Sequence[Scalar] | None = None,
    at: Mapping[Node, Scalar] | None = None,
) -> dict[Node, Scalar] | None:
    """Every speed as a function of the coordinates, by the integrals; None where they do not give it.

    Args:
        start: q and u at the start, scalars of the parameters.
        there: a state of the motion in numbers, with parameters, that says in which sense it goes; None: the start.
        accelerations: a as expressions, for what loses energy, and for the sense in which a motion leaves a rest.
        at: coordinates whose values are put in before anything is solved.
    Raises:
        DerivationError: a coordinate has no value at the start.
    """
    found = rates_and_extent(equations, start, there=there, accelerations=accelerations, at=at)
    return None if found is None else found[0]


def rates_and_extent(
    equations: EquationsOfMotion,
    start: Mapping[Node, Scalar],
    *,
    there: Mapping[Node, float] | None = None,
    accelerations: Sequence[Scalar] | None = None,
    at: Mapping[Node, Scalar] | None = None,
) -> tuple[dict[Node, Scalar], Extent] | None:
    """(the same, in which pieces the integrals hold that give it)."""
    relations = relations_of(equations, start, at)
    if relations is None:
        return None
    speeds, held = relations.speeds, where_momenta_hold(equations)
    if relations.speed is None:
        return speeds, held
    there = start_in_numbers(equations.system, start) if there is None else there
    found = FreeSpeed(equations, relations, start, there, accelerations, at or {}).value()
    if found is None:
        return None
    speed, of_speed = found
    rates = substituted(tuple(speeds.values()), {relations.speed: speed})
    return dict(zip(speeds, rates, strict=True)), held & of_speed


def start_in_numbers(system: System, start: Mapping[Node, Scalar]) -> dict[Node, float]:
    """The start in numbers; a parameter without a value counts as 1: some sense of the motion must be chosen."""
    known = exact_parameters(system.scope.model)
    values = {node: float(known.get(name, 1)) for name, node in system.symbols.parameters.items()}
    return values | {node: float(evaluate((x,), values, FLOAT)[0]) for node, x in start.items()}
