"""EquationsOfMotion -> g(q) and C(q, u) of M u' + C u + g = everything else, and Jacobians of points.

C_ij = 1/2 sum_k (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i) u_k,   so that M' - 2 C is skew
"""

from __future__ import annotations

from eomgen.errors import DerivationError, UsageError
from eomgen.mechanics.bodies.kinematics import velocity_of
from eomgen.mechanics.bodies.loads import weights
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.work import load_row, summed
from eomgen.model.findings import nearest
from eomgen.symbolic.exact.equality import equal_at_random_states
from eomgen.symbolic.expression.derivative import jacobian
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.node import ScalarRow, ScalarRows
from eomgen.symbolic.expression.rational import Fraction


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
        raise DerivationError(what, mend="take c, or a model without dependent or driven coordinates and other speeds")
    slopes = [jacobian(row, q) for row in equations.M]  # slopes[i][j][k] = dM_ij/dq_k
    half = Fraction(1, 2)
    C = tuple(
        tuple(
            half * inner([slopes[i][j][k] + slopes[i][k][j] - slopes[j][k][i] for k in range(n)], u) for j in range(n)
        )
        for i in range(n)
    )
    if not equal_at_random_states(zip((inner(row, u) for row in C), equations.c, strict=True)).equal:
        raise DerivationError("c has terms besides C u: something moves as a function of time", mend="take c")
    return C


def jacobian_of_point(system: System, point: str) -> ScalarRows:
    """J_P of v_P = J_P u + what moves as given, ground axes: 2 rows in the plane, 3 in space.

    Raises:
        UsageError: no such point.
    """
    model = system.scope.model
    if point not in model.named_points:
        raise UsageError(f"no point '{point}'", mend=nearest(point, model.named_points))
    velocity = velocity_of(system.motion, system.motion.place(point))
    return jacobian(velocity[: 2 if model.space == "plane" else 3], system.symbols.u)
