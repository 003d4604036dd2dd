"""An equation of one coordinate alone -> whether all places that satisfy it are places of rest.

Rest of what is free: driven coordinates go on as they are driven. The roots of the equation are sought in numbers, at
several values of the parameters, and at each of them the forces must balance.
"""

from __future__ import annotations

from itertools import islice
from typing import Any

import numpy as np

from eomgen.judge.case import Case
from eomgen.judge.decision import is_zero_everywhere, states_of
from eomgen.symbolic.expression.derivative import depends_on, gradient, substituted
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.batch_evaluation import ARRAYS
from eomgen.symbolic.numeric.evaluation import evaluate
from eomgen.symbolic.numeric.tolerances import CARRIED, SAME_EIGENVALUE

GRID, BISECTED, VALUES = 400, 60, 3
WIDEST = 3.5  # times the size of a coordinate at the start: as far as roots are sought


def balance_at_rest(case: Case, scalar: Scalar) -> tuple[Node, Scalar] | None:
    """(the coordinate, its equation of motion at rest); None where there are several, ties, or time stands in it."""
    symbols = case.system.symbols
    if len(case.rows) != 1 or case.closing or symbols.lam or case.system.free is not None:
        return None
    free = [q for q in symbols.q if not case.model.coordinates[q.name].driven]
    still = dict.fromkeys((*symbols.u, *symbols.a), 0)
    (row,) = substituted(case.rows, still)
    others = [x for x in (symbols.t, *symbols.q) if x not in free]
    if len(free) != 1 or depends_on(scalar, others) or not depends_on(scalar, free):
        return None
    if depends_on(row, others):  # cos(psi)^2 + sin(psi)^2 does not
        if not is_zero_everywhere(case.system, *gradient(row, others)).holds:
            return None
        (row,) = substituted((row,), dict.fromkeys(others, 0))
    return free[0], row


def is_of_rest(case: Case, scalar: Scalar) -> bool | None:
    """Whether every place that satisfies scalar = 0 is one of rest; None: it is not decided so."""
    found = balance_at_rest(case, scalar)
    if found is None:
        return None
    q, row = found
    seen = 0
    for state in islice(states_of(case.system, (scalar, row), on_ties=True), VALUES):
        values = {x: float(value) for x, value in state.items()}
        for root in sign_changes(scalar, q, values):
            near = _at((row,), q, values, np.array([root]))[0, 0]
            size = np.nanmax(np.abs(_at((row,), q, values, _grid(values[q]))))
            if not abs(near) <= SAME_EIGENVALUE * size:
                return False
            seen += 1
    return True if seen else None


def sign_changes(scalar: Scalar, q: Node, values: dict[Node, float]) -> list[float]:
    """Where it changes its sign by going through zero, the nearest to the value of q first."""
    grid = _grid(values[q])
    (height,) = _at((scalar,), q, values, grid)
    found = []
    places = [(a, b) for a, b, x, y in zip(grid, grid[1:], height, height[1:], strict=False) if x * y <= 0]
    for low, high in places:
        (first,) = _at((scalar,), q, values, np.array([low]))[0]
        for _ in range(BISECTED):
            middle = (low + high) / 2
            (x,) = _at((scalar,), q, values, np.array([middle]))[0]
            low, high, first = (middle, high, x) if x * first > 0 else (low, middle, first)
        (left,) = _at((scalar,), q, values, np.array([(low + high) / 2]))[0]
        if abs(left) <= CARRIED * np.nanmax(np.abs(height)):
            found.append((low + high) / 2)
    return sorted(found, key=lambda root: abs(root - values[q]))


def _grid(near: float) -> Any:
    """Places on both sides of zero, none of them round."""
    wide = WIDEST * max(1.0, abs(near))
    return np.linspace(-wide - 0.0137, wide + 0.0271, GRID)


def _at(scalars: tuple[Scalar, ...], q: Node, values: dict[Node, float], places: Any) -> Any:
    with np.errstate(all="ignore"):
        found = evaluate(scalars, {**{x: np.float64(y) for x, y in values.items()}, q: places}, ARRAYS)
    return np.array([np.broadcast_to(np.asarray(x, dtype=float), places.shape) for x in found])
