"""scipy's integrators, one step at a time: how each is begun, never across a breakpoint, and how a state is replaced.

A step across a bend is a step of order one there, and a step from rest across a short pulse does not see it.
"""

from __future__ import annotations

import functools
from bisect import bisect_right
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from eomgen.codegen.trial import Address, Trial
from eomgen.model.part import leaves_of
from eomgen.model.parts import Model
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.numeric.tolerances import SOLVED

SAFETY, SMALLEST, LARGEST = 0.9, 0.2, 10.0  # factors between two step sizes, as scipy takes them


@functools.cache
def quick(method: str) -> Any:
    """The class of scipy's method with another step; its last argument is the address of the right-hand side."""
    import scipy.integrate

    base: Any = getattr(scipy.integrate, method)

    class Quick(base):  # type: ignore[misc]
        """The same method: error estimate and dense output are scipy's."""

        t: float
        y: np.ndarray
        h_abs: float

        def __init__(self, f: Any, *arguments: Any, at: Address, **options: Any) -> None:
            super().__init__(f, *arguments, **options)
            self.trial = Trial(at, self.A, self.B, self.C, self.K)

        def _step_impl(self) -> tuple[bool, str | None]:
            """One step, made smaller until its error is below the tolerance; the next one's size by that error."""
            least = 10 * abs(np.nextafter(self.t, np.inf) - self.t)
            size, growth = max(self.h_abs, least), LARGEST
            while size >= least:
                t = min(self.t + size, self.t_bound)
                h = t - self.t
                error, x = self._tried(h)
                if error < 1:
                    factor = LARGEST if error == 0 else SAFETY * error**self.error_exponent
                    self.h_abs, self.h_previous, self.y_old = h * min(growth, factor), h, self.y
                    self.t, self.y, self.f = t, x, self.K[-1].copy()
                    return True, None
                size, growth = h * max(SMALLEST, SAFETY * error**self.error_exponent), 1.0
            return False, self.TOO_SMALL_STEP

        def _tried(self, h: float) -> tuple[float, np.ndarray]:
            """(the error of a step against the tolerance, the state after it)."""
            self.K[0] = self.f
            x = self.trial(self.t, h, self.y)
            self.nfev += self.n_stages
            scale = self.atol + np.maximum(np.abs(self.y), np.abs(x)) * self.rtol
            return self._estimate_error_norm(self.K, h, scale), x

    return Quick


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
