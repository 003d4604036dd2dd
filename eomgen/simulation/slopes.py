"""Equations of motion -> d(x')/dx, exactly: what implicit integrators ask for.

x' = (N u + nu, a), with a and lam from  M a - J^T lam = forcing,  J a = -gamma. The derivative of that solution comes
from the same matrix, nothing is inverted in symbols:

    [[M, -J^T], [J, 0]] [da; dlam] = - d(M a - J^T lam - forcing, J a + gamma) at fixed a, lam
"""

from __future__ import annotations

import numpy as np

from eomgen.codegen.program import bordered, kinematic_rates, program_of
from eomgen.codegen.rhs import RightHandSide, compiled
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import jacobian
from eomgen.symbolic.numeric.tolerances import LEAST_CHANGE

LONG = 60_000  # operations from which on differences are cheaper than the derivative
SHORT = 400  # operations up to which a function is not worth a compiler


def slope_of(equations: EquationsOfMotion, p: np.ndarray, target: str | None = None) -> ExactSlope | None:
    """(t, x) -> d(x')/dx; None where the derivative is so long that differences are cheaper.

    Args:
        p: the parameters' values.
        target: in which language a long function is run.
    """
    states = equations.symbols.q + equations.symbols.u
    n, k = len(equations.M), len(equations.J)
    parts = (
        jacobian(kinematic_rates(equations), states),
        jacobian([x for rows in equations.residual for x in rows], states),
        equations.M,
        equations.J,
    )
    entries = tuple(x for rows in parts for row in rows for x in row)
    program = program_of(
        entries, equations.system.symbols, inputs=equations.system.inputs, solve=bordered(equations) if n else None
    )
    if program.count.total > LONG:
        return None
    return ExactSlope(compiled(program, target if program.count.total > SHORT else "numpy"), p, n, k)


@dataclass(frozen=True)
class ExactSlope:
    """(t, x) -> d(x')/dx.

    Args:
        function: the derivatives of q' and of M a - J^T lam - forcing, J a + gamma, at fixed a and lam; M, J.
        p: the parameters' values.
        n, k: speeds and rows of ties.
    """

    function: RightHandSide
    p: np.ndarray
    n: int
    k: int

    def __call__(self, t: float, x: np.ndarray) -> np.ndarray:
        n, k, m = self.n, self.k, len(x)
        ends = np.cumsum([(m - n) * m, (n + k) * m, n * n])
        rates, residual, M, J = np.split(np.asarray(self.function(t, x, self.p)), ends)
        M, J = M.reshape(n, n), J.reshape(k, n)
        matrix = np.block([[M, -J.T], [J, np.zeros((k, k))]])
        solved = np.linalg.lstsq(matrix, -residual.reshape(n + k, m), rcond=LEAST_CHANGE)[0]
        return np.vstack([rates.reshape(-1, m), solved[:n]])
