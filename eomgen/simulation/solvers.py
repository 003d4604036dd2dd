"""scipy's integrators, one step at a time: how each is begun, and how its state is replaced between two steps."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from eomgen.simulation.quick_steps import quick

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
    at = getattr(f, "address", None) if explicit else None
    with np.errstate(all="ignore"):
        if at is not None:
            return quick(method)(f, span[0], x0, span[1], at=at, **options)
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
