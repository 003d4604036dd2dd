"""EquationsOfMotion -> a SymbolicSystem of sympy.physics.mechanics.

q' = N u + nu,  [[M, -J^T], [J, 0]] (u', lam) = (forcing, -gamma).

sympy knows no multipliers: they are the derivatives of further speeds, the impulses of the ties.
"""

from __future__ import annotations

from typing import Any

from eomgen.errors import DerivationError
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.symbolic.expression.node import ScalarRow


def sympy_system(equations: EquationsOfMotion) -> Any:
    """Coordinates, speeds and inputs are functions of time of their names, theta' is theta_dot; parameters are real.

    Raises:
        DerivationError: friction, which hangs on the reactions.
    """
    from sympy import Function, ImmutableDenseMatrix
    from sympy.physics.mechanics import SymbolicSystem
    from sympy.physics.vector import dynamicsymbols

    from eomgen.symbolic.print.sympy_form import symbol, to_sympy

    if equations.friction:
        raise DerivationError("friction that hangs on the reactions has no mass matrix", mend="take `rhs`, or codegen")
    own, t = equations.symbols, dynamicsymbols._t
    n, k = len(own.u), len(equations.J)
    moving = (*own.q, *own.u, *own.inputs.values())
    functions = {symbol(x.name): Function(x.name.replace("'", "_dot"))(t) for x in moving}
    impulses = [Function(f"impulse_{row.tie}_{row.number}")(t) for row in equations.system.ties.closing]
    rows: list[ScalarRow] = [(*row, *(-J[i] for J in equations.J)) for i, row in enumerate(equations.M)]
    rows += [(*row, *(0 for _ in equations.J)) for row in equations.J]
    rates = equations.system.scope.rates
    right = (*equations.forcing, *(-x for x in equations.gamma))
    known = functions | {symbol("t"): t}
    entries = [x.xreplace(known) for x in to_sympy([*(x for row in rows for x in row), *right, *rates])]
    return SymbolicSystem(
        [functions[symbol(x.name)] for x in own.q],
        ImmutableDenseMatrix(n + k, 1, entries[(n + k) ** 2 : (n + k) * (n + k + 1)]),
        speeds=[*(functions[symbol(x.name)] for x in own.u), *impulses],
        mass_matrix=ImmutableDenseMatrix(n + k, n + k, entries[: (n + k) ** 2]),
        coordinate_derivatives=ImmutableDenseMatrix(len(own.q), 1, entries[(n + k) * (n + k + 1) :]),
    )
