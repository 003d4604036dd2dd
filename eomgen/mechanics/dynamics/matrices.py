"""Equations of motion -> matrices for users: g(q), C(q, u), Jacobians, a system of sympy."""

from __future__ import annotations

from typing import Any

from eomgen.errors import DerivationError, UsageError
from eomgen.mechanics.dynamics.system import EquationsOfMotion, System, load_row, summed
from eomgen.mechanics.kinematics import velocity_of, weights
from eomgen.model import nearest
from eomgen.symbolic.exact import equal_at_random_states
from eomgen.symbolic.expression import Fraction, ScalarRow, ScalarRows, inner, jacobian

# -------- matrices --------------------------------------------------------------------------------------------
# EquationsOfMotion -> g(q) and C(q, u) of M u' + C u + g = everything else, and Jacobians of points.
#
# C_ij = 1/2 sum_k (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i) u_k,   so that M' - 2 C is skew


def gravity_of(system: System) -> ScalarRow:
    """g(q): minus the generalized forces of the uniform fields on every mass."""
    rows = [load_row(system.loads, weight) for weight in weights(system.loads)]
    return tuple(-x for x in summed(rows, len(system.symbols.u)))


def coriolis_of(equations: EquationsOfMotion) -> ScalarRows:
    """C with C u = c, by Christoffel's symbols of M.

    Raises:
        DerivationError: speeds are not the rates of the coordinates, or something moves as given.
    """
    q, u, n = equations.symbols.q, equations.symbols.u, len(equations.symbols.u)
    rates = tuple(x.name for x in u) == tuple(f"{x.name}'" for x in q)
    if not rates:
        what = "C of C u = c is that of Christoffel where the speeds are the rates of all coordinates"
        raise DerivationError(what, fix="take c, or a model without dependent or driven coordinates and other speeds")
    slopes = [jacobian(row, q) for row in equations.M]  # slopes[i][j][k] = dM_ij/dq_k
    half = Fraction(1, 2)
    C = tuple(
        tuple(
            half * inner([slopes[i][j][k] + slopes[i][k][j] - slopes[j][k][i] for k in range(n)], u) for j in range(n)
        )
        for i in range(n)
    )
    if not equal_at_random_states(zip((inner(row, u) for row in C), equations.c, strict=True)).equal:
        raise DerivationError("c has terms besides C u: something moves as a function of time", fix="take c")
    return C


def jacobian_of_point(system: System, point: str) -> ScalarRows:
    """J_P of v_P = J_P u + what moves as given, ground axes: 2 rows in the plane, 3 in space.

    Raises:
        UsageError: no such point.
    """
    model = system.scope.model
    if point not in model.named_points:
        raise UsageError(f"no point '{point}'", fix=nearest(point, model.named_points))
    velocity = velocity_of(system.motion, system.motion.place(point))
    return jacobian(velocity[: 2 if model.space == "plane" else 3], system.symbols.u)


# -------- sympy system ----------------------------------------------------------------------------------------
# EquationsOfMotion -> a SymbolicSystem of sympy.physics.mechanics.
#
# q' = N u + nu,  [[M, -J^T], [J, 0]] (u', lam) = (forcing, -gamma).
#
# sympy knows no multipliers: they are the derivatives of further speeds, the impulses of the constraints.


def sympy_system(equations: EquationsOfMotion) -> Any:
    """Coordinates, speeds and inputs are functions of time of their names, theta' is theta_dot; parameters are real.

    Raises:
        DerivationError: friction, which hangs on the reactions.
    """
    from sympy import Function, ImmutableDenseMatrix
    from sympy.physics.mechanics import SymbolicSystem
    from sympy.physics.vector import dynamicsymbols

    from eomgen.symbolic.print import symbol, to_sympy

    if equations.friction:
        raise DerivationError("friction that hangs on the reactions has no mass matrix", fix="take `rhs`, or codegen")
    own, t = equations.symbols, dynamicsymbols._t
    n, k = len(own.u), len(equations.J)
    moving = (*own.q, *own.u, *own.inputs.values())
    functions = {symbol(x.name): Function(x.name.replace("'", "_dot"))(t) for x in moving}
    impulses = [Function(f"impulse_{row.constraint}_{row.number}")(t) for row in equations.system.constraints.closing]
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
