"""EquationsOfMotion, parameters -> PhaseFunctions: the equations of one phase, compiled as they are asked for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eomgen.codegen.program import bordered, program_of, right_hand_side
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.mechanics.equations.articulated import with_accelerations
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.wellposed import refuse_massless
from eomgen.symbolic.expression.graph import Scalar


@dataclass(frozen=True)
class PhaseFunctions:
    """Functions of the states x = (q, u, slacks) of one phase.

    Args:
        equations: of motion, friction included.
        p: the parameters' values.
        target: of the emitted code of the right-hand side.
    """

    equations: EquationsOfMotion
    p: np.ndarray
    target: str | None

    @cached_property
    def rhs(self) -> RightHandSide:
        refuse_massless(self.equations)
        program = right_hand_side(with_accelerations(self.equations))
        return compiled(program, self.target)

    @property
    def places(self) -> int:
        """How many coordinates."""
        return len(self.equations.symbols.q)

    def inner(self, x: np.ndarray) -> np.ndarray:
        """(q, u) of states."""
        return np.ascontiguousarray(x[..., : self.places + len(self.equations.symbols.u)])

    def slacks(self, x: np.ndarray) -> np.ndarray:
        """What hangs loose of each string, as far as no formula gives it."""
        return x[..., self.places + len(self.equations.symbols.u) :]

    def evaluated(self, t: np.ndarray, x: np.ndarray, scalars: tuple[Scalar, ...]) -> np.ndarray:
        """Functions of q, u, t, accelerations and multipliers along the states, n x scalars."""
        return self.function(scalars).many(t, self.inner(x), self.p)

    def function(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        """Functions of q, u, t, accelerations and multipliers, compiled."""
        solve = bordered(self.equations) if self.equations.symbols.u else None
        return compiled(
            program_of(scalars, self.equations.symbols, inputs=self.equations.system.inputs, solve=solve), "numpy"
        )

    def kinematic(self, scalars: tuple[Scalar, ...]) -> RightHandSide:
        """Functions of q, u and t, compiled."""
        return compiled(program_of(scalars, self.equations.symbols, inputs=self.equations.system.inputs), "numpy")
