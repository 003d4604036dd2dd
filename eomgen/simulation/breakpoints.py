"""Model -> instants at which what is given through samples changes its course; no step goes across one.

A step across a bend is a step of order one there, and a step from rest across a short pulse does not see it.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from typing import Any

from eomgen.model.part import leaves_of
from eomgen.model.parts import Model
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.numeric.tolerances import SOLVED


def knots_of(model: Model) -> tuple[float, ...]:
    """The times of the samples of every motion and input, ascending [s]."""
    laws = (
        leaf.value
        for table in (model.coordinates, model.inputs, model.constraints)
        for name, part in table.items()
        for leaf in leaves_of(part, (name,))
    )
    sampled = (law.sampled for law in laws if isinstance(law, Expression))
    return tuple(sorted({float(t) for each in sampled if each is not None for t in each.spline.bounds}))


def step(solver: Any, knots: Sequence[float], end: float) -> None:
    """One step of an integrator, to the next of the knots at the latest; it goes on until the end."""
    if knots:
        k = bisect_right(knots, solver.t + SOLVED * max(1.0, abs(solver.t)))
        solver.t_bound = min([end, *knots[k : k + 1]])
        if hasattr(solver, "_lsoda_solver"):
            solver._lsoda_solver._integrator.rwork[0] = solver.t_bound
    solver.step()
    if solver.status == "finished" and solver.t < end:
        solver.status = "running"
