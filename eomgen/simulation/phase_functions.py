"""EquationsOfMotion, parameters -> PhaseFunctions: the equations of one phase, compiled when they are first used."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import field, replace

import numpy as np

from eomgen.codegen import Program, RightHandSide, Solve
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, WellPosed, with_accelerations
from eomgen.symbolic.expression import Scalar


@dataclass(frozen=True)
class PhaseFunctions:
    """Functions of the states x = (q, u, z, slacks) of one phase.

    Args:
        equations: of motion, friction included.
        p: the parameters' values.
        target: of the emitted code of the right-hand side.
        made: the functions that have been compiled so far; those of other values are the same.
    """

    equations: EquationsOfMotion
    p: np.ndarray
    target: str | None
    made: dict[Hashable, RightHandSide] = field(default_factory=dict, repr=False, compare=False)

    def at(self, p: np.ndarray) -> PhaseFunctions:
        """The same at other values of the parameters."""
        return replace(self, p=p)

    @property
    def rhs(self) -> RightHandSide:
        return self._once("rhs", self._right_hand_side)

    @property
    def energies(self) -> RightHandSide:
        """(T, V)."""
        self._once("rhs", self._right_hand_side)
        return self.made["energies"]

    def _right_hand_side(self) -> RightHandSide:
        """x', and T and V in addition."""
        WellPosed(self.equations).refuse_massless()
        program = Program.right_hand_side(with_accelerations(self.equations))
        energies = Program.of(
            (self.equations.T, self.equations.V), self.equations.symbols, inputs=self.equations.system.inputs
        )
        found, self.made["energies"] = RightHandSide.compiled_together((program, energies), self.target)
        return found

    def _once(self, key: Hashable, make: Callable[[], RightHandSide]) -> RightHandSide:
        if key not in self.made:
            self.made[key] = make()
        return self.made[key]

    @property
    def places(self) -> int:
        """Number of coordinates."""
        return len(self.equations.symbols.q)

    def inner(self, x: np.ndarray) -> np.ndarray:
        """(q, u, z) of states."""
        return np.ascontiguousarray(x[..., : len(self.equations.symbols.x)])

    def slacks(self, x: np.ndarray) -> np.ndarray:
        """Slack of each string whose slack is integrated, not given by a formula."""
        return x[..., len(self.equations.symbols.x) :]

    def evaluated(self, t: np.ndarray, x: np.ndarray, scalars: tuple[Scalar, ...]) -> np.ndarray:
        """Functions of q, u, z, t, accelerations and multipliers along the states, n x scalars."""
        return self.function(scalars).many(t, self.inner(x), self.p)

    def function(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        """Functions of q, u, z, t, accelerations and multipliers, compiled."""
        return self._once(("in motion", scalars), lambda: self._function(scalars))

    def _function(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        solve = Solve.bordered(self.equations) if self.equations.symbols.u else None
        return RightHandSide.of(
            Program.of(scalars, self.equations.symbols, inputs=self.equations.system.inputs, solve=solve), "numpy"
        )

    def kinematic(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        """Functions of q, u and t, compiled."""
        inputs = self.equations.system.inputs
        return self._once(
            ("placed", scalars),
            lambda: RightHandSide.of(Program.of(scalars, self.equations.symbols, inputs=inputs), "numpy"),
        )
