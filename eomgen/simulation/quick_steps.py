"""scipy's explicit Runge-Kutta methods, with the stages of a step in C where the right-hand side is."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

from eomgen.codegen.trial import Address, Trial

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
