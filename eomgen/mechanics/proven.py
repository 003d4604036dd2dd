"""System, a located state -> exact places of coordinates that several ties fix together, proven by substitution.

Two gaps in two angles have a closed form in rare places only: a loop whose bars are parallel, upright or at 30 degrees.
There the angle itself is tried. The number only says which one; that it is a root is proven: with it every gap that
holds no other unknown vanishes identically in the parameters.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from math import pi

from eomgen.errors import MissingValues
from eomgen.mechanics.loads import start_value
from eomgen.mechanics.system import System
from eomgen.mechanics.ties import holds_identically
from eomgen.model.values import numeric_parameters
from eomgen.symbolic.derivative import depends_on, substituted
from eomgen.symbolic.evaluation import FLOAT, NoValue, evaluate
from eomgen.symbolic.graph import Node, Scalar

SAME = 1e-8  # of a place against the located one
STEPS = 12  # of a half turn


def proven_places(
    system: System, known: Mapping[Node, Scalar], numbers: Mapping[Node, float]
) -> dict[Node, Scalar]:
    """Places of unknown coordinates at which every gap of theirs vanishes; {} where that is not found.

    phi(q_known, q_tried) = 0 for at least as many gaps as there are coordinates tried.

    Args:
        known: exact values of the other coordinates.
        numbers: the same state in numbers, all coordinates.
    """
    gaps = [row.gap for row in system.ties.rows if row.gap is not None and not row.identical]
    gaps = [gap for gap in substituted(tuple(gaps), known) if depends_on(gap, system.symbols.q)]
    unknown = [q for q in system.symbols.q if q not in known and depends_on_any(gaps, q)]
    tried = {q: place for q in unknown for place in _candidates(system, q, numbers)}
    others = [q for q in unknown if q not in tried]
    whole = [gap for gap in gaps if not depends_on(gap, others)]
    standing = {q: place for q, place in tried.items() if depends_on_any(whole, q)}
    if not standing or len(whole) < len(standing):
        return {}
    return standing if all(holds_identically(gap) for gap in substituted(tuple(whole), standing)) else {}


def depends_on_any(gaps: list[Scalar], q: Node) -> bool:
    """Whether one of the gaps holds the coordinate."""
    return any(depends_on(gap, (q,)) for gap in gaps)


def _candidates(system: System, q: Node, numbers: Mapping[Node, float]) -> Iterator[Scalar]:
    """What may be the place: the model's own start, or a multiple of 15 degrees, next to the number."""
    if q not in numbers:
        return
    turns = Fraction(round(numbers[q] / pi * STEPS), STEPS)
    if abs(float(turns) * pi - numbers[q]) <= SAME:
        yield turns * q.graph.pi if turns else 0
    else:
        yield from _own_start(system, q, numbers[q])


def _own_start(system: System, q: Node, number: float) -> Iterator[Scalar]:
    place = start_value(system.scope, system.scope.model.coordinates[q.name])
    try:
        given = numeric_parameters(system.scope.model)
        values = {node: given[name] for name, node in system.symbols.parameters.items()}
        if abs(evaluate((place,), values, FLOAT)[0] - number) <= SAME * (1 + abs(number)):
            yield place
    except (MissingValues, NoValue):
        return
