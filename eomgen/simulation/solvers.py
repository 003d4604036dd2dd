"""scipy's integrators, one step at a time: how each is begun, never across a breakpoint, and how a state is replaced.

A step across a bend is a step of order one there, and a step from rest across a short pulse does not see it.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from eomgen.model.part import leaves_of
from eomgen.model.parts import Model
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.numeric.tolerances import SOLVED


def breakpoints_of(model: Model) -> tuple[float, ...]:
    """The times of the samples of every motion and input, ascending [s]."""
    laws = (
        leaf.value
        for table in (model.coordinates, model.inputs, model.constraints)
        for name, part in table.items()
        for leaf in leaves_of(part, (name,))
    )
    sampled = (law.sampled for law in laws if isinstance(law, Expression))
    return tuple(sorted({float(t) for each in sampled if each is not None for t in each.spline.bounds}))


def step(solver: Any, breakpoints: Sequence[float], end: float) -> None:
    """One step of an integrator, to the next breakpoint at the latest; it goes on until the end.

    Raises:
        NotFinite: the right-hand side or its slope has no value.
    """
    if breakpoints:
        k = bisect_right(breakpoints, solver.t + SOLVED * max(1.0, abs(solver.t)))
        solver.t_bound = min([end, *breakpoints[k : k + 1]])
        if hasattr(solver, "_lsoda_solver"):
            solver._lsoda_solver._integrator.rwork[0] = solver.t_bound
    try:
        solver.step()
    except ValueError as error:  # what an implicit method makes of a slope that is beyond doubles
        raise NotFinite from error
    if solver.status == "finished" and solver.t < end:
        solver.status = "running"


EXPLICIT = ("DOP853", "RK45", "RK23")
IMPLICIT = ("Radau", "BDF", "LSODA")
METHODS = EXPLICIT + IMPLICIT

StateRate = Callable[[float, np.ndarray], np.ndarray]
Slope = Callable[[float, np.ndarray], np.ndarray]


class NotFinite(ArithmeticError):
    """An implicit method met a right-hand side without a value."""


def solver_of(
    method: str,
    f: StateRate,
    span: tuple[float, float],
    x0: np.ndarray,
    *,
    rtol: float,
    atol: float,
    slope: Slope | None = None,
) -> Any:
    """An integrator at its start.

    Args:
        method: one of METHODS.
        slope: (t, x) -> df/dx, for the implicit methods; None: by differences.
    """
    import scipy.integrate

    def finite(t: float, x: np.ndarray) -> np.ndarray:
        dx = f(t, x)
        if not np.all(np.isfinite(dx)):
            raise NotFinite
        return dx

    explicit = method in EXPLICIT  # these shrink the step where a trial has no value
    options = {"rtol": rtol, "atol": atol} | ({} if explicit or slope is None else {"jac": slope})
    with np.errstate(all="ignore"):
        return getattr(scipy.integrate, method)(f if explicit else finite, span[0], x0, span[1], **options)


def put(solver: Any, x: np.ndarray) -> None:
    """Let an integrator go on from another state that is near its own.

    Methods of one step begin anew from it; in those of several the state is an entry of their history, whose
    differences stay.
    """
    solver.y = x
    if hasattr(solver, "f"):  # of one step
        solver.f = solver.fun(solver.t, x)
    elif hasattr(solver, "_lsoda_solver"):
        solver._lsoda_solver._y = x.copy()
        solver._lsoda_solver._integrator.rwork[20 : 20 + len(x)] = x
    else:  # BDF
        solver.D[0] = x
