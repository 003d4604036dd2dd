"""Equations, states along a motion -> what its energy does: H - H(0) against the integral of the power.

    H = u . dT/du - T + V    (T + V where nothing moves by itself)
    dH/dt = Q_nc . u + u . J^T lam + d(V - T)/dt of what moves by itself

The integral is taken along the motion by an explicit method of order 8, one step from each state to the next, with the
error that its formulas of orders 5 and 3 tell.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import field
from functools import cached_property
from typing import Any

import numpy as np

from eomgen.codegen.program import bordered, program_of
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.mechanics.balance.friction import with_rest
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.proof.identities import energy_function, given_power
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import depends_on
from eomgen.symbolic.expression.graph import Scalar, is_zero

Rates = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""(t n, x n x states) -> x', n x states."""


@dataclass(frozen=True)
class Energies:
    """The energies of one phase, and the power that changes them.

    Args:
        p: the parameters' values.
        pulled: whether the ties take power by being open: Baumgarte's rows.
        known: what was compiled of the equations, whatever the parameters' values.
    """

    equations: EquationsOfMotion
    p: np.ndarray
    pulled: bool = False
    known: dict[Hashable, Any] = field(default_factory=dict, repr=False, compare=False)

    @cached_property
    def power(self) -> Scalar:
        """dH/dt = Q_nc . u + u . J^T lam + what moves by itself."""
        equations = self.equations
        found = given_power(equations)
        for sigma, row, lam in zip(equations.sigma, equations.J, equations.symbols.lam, strict=True):
            if self.pulled:
                found = found + lam * sum((x * u for x, u in zip(row, equations.symbols.u, strict=True)), start=0)
            elif not is_zero(sigma):
                found = found - lam * sigma
        return with_rest(self.equations.system, (found,))[0]

    def along(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """(T, V, H), each n [J]."""
        return self._energies.many(t, x, self.p).T

    def powers(self, t: np.ndarray, x: np.ndarray) -> np.ndarray:
        """dH/dt, n [W]."""
        return self._power.many(t, x, self.p)[:, 0] if not is_zero(self.power) else np.zeros(len(t))

    @cached_property
    def _energies(self) -> RightHandSide:
        return self._compiled((self.equations.T, self.equations.V, energy_function(self.equations)))

    @cached_property
    def _power(self) -> RightHandSide:
        return self._compiled((self.power,))

    def _compiled(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        key = ("proof of energies", scalars)
        if key not in self.known:
            self.known[key] = self._program(scalars)
        found: RightHandSide = self.known[key]
        return found

    def _program(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        symbols = self.equations.symbols
        solve = bordered(self.equations) if depends_on(scalars[-1], symbols.lam) else None
        return compiled(program_of(scalars, symbols, inputs=self.equations.inputs, solve=solve), "numpy")


def followed(
    rates: Rates, powers: Rates, t: np.ndarray, x: np.ndarray, later: np.ndarray, parts: int = 1
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(the state at `later`, the work until then, how unsure both are), of each of n states by itself.

    y = (x, W), y' = (rates, powers), by Dormand and Prince's formulas of order 8 in so many equal steps.
    """
    from scipy.integrate import DOP853

    y, h = np.column_stack([x, np.zeros(len(t))]), (later - t) / parts
    unsure, errors = np.zeros_like(y), (DOP853.E5[:-1], DOP853.E3[:-1])  # the state at the end has no share in them
    counted = np.any([DOP853.B, *errors], axis=0)  # the power of other stages stands in no sum
    for part in range(parts):
        K = np.zeros((DOP853.n_stages, *y.shape))
        for i in range(DOP853.n_stages):
            now = (y + h[:, None] * np.tensordot(DOP853.A[i, :i], K[:i], axes=1))[:, :-1]
            when = t + (part + DOP853.C[i]) * h
            K[i, :, :-1] = rates(when, now)
            if counted[i]:
                K[i, :, -1:] = powers(when, now).reshape(len(t), -1)
        y = y + h[:, None] * np.tensordot(DOP853.B, K, axes=1)
        fine, coarse = (np.abs(h[:, None] * np.tensordot(E, K, axes=1)) for E in errors)
        unsure = unsure + fine * fine / np.maximum(np.hypot(fine, 0.1 * coarse), np.finfo(float).tiny)
    return y[:, :-1], y[:, -1], unsure
