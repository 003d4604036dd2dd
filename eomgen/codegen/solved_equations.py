"""Equations of motion -> accelerations and multipliers as expressions of q, u and t.

Where the equations are few by determinants, where freedoms are few over the independent accelerations, else by factors.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress

from eomgen.codegen.factorization import factor_solution
from eomgen.errors import DerivationError
from eomgen.mechanics.balance.balance_solution import values_at_a_state
from eomgen.mechanics.constraints.ties import holds_identically
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.explicit_accelerations import by_determinants, regular_rows
from eomgen.mechanics.reactions.accelerations_at_start import FEW, by_independent
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.solve import cramer
from eomgen.symbolic.solve.linear_systems import LinearSystem, Pivots, general_solution


def accelerations_and_multipliers(equations: EquationsOfMotion) -> dict[Node, Scalar]:
    """a and lam of M a = forcing + J^T lam, J a + gamma = 0, as expressions; redundant rows are left out, their lam 0.

    Raises:
        DerivationError: the mass matrix is singular whatever the state.
    """
    symbols = equations.system.symbols
    if equations.friction and equations.accelerations is not None:
        found = dict(zip(symbols.a, equations.accelerations, strict=True))
        return found | _multipliers(equations, found)
    if not equations.J:
        return dict(zip(symbols.a, factor_solution(equations.M, equations.forcing), strict=True))
    kept = regular_rows(equations.system)
    if len(symbols.a) + len(kept) <= cramer.LARGEST_BLOCK:
        return by_determinants(equations, kept)
    if len(symbols.a) - len(kept) <= FEW:
        with suppress(DerivationError):
            return by_independent(equations, kept)
    return _by_factors(equations, kept)


def _by_factors(equations: EquationsOfMotion, kept: Sequence[int]) -> dict[Node, Scalar]:
    """a = X F + X J^T lam,  (J X J^T) lam = -(gamma + J X F),  X = M^-1, never formed: M is solved for each column."""
    symbols, J = equations.symbols, [equations.J[i] for i in kept]
    M, forcing = _weighted(equations, kept) if _some_massless(equations) else (equations.M, equations.forcing)
    free = factor_solution(M, forcing)
    columns = [factor_solution(M, row) for row in J]
    S = [[inner(row, column) for column in columns] for row in J]
    lam = factor_solution(S, [-(equations.gamma[i] + inner(row, free)) for i, row in zip(kept, J, strict=True)])
    a = tuple(a + inner(lam, [column[k] for column in columns]) for k, a in enumerate(free))
    multipliers = {symbols.lam[i]: value for i, value in zip(kept, lam, strict=True)}
    return dict(zip(symbols.a, a, strict=True)) | {x: multipliers.get(x, 0) for x in symbols.lam}


def _some_massless(equations: EquationsOfMotion) -> bool:
    """Whether ties alone say what some acceleration is."""
    return any(is_zero(row[k]) for k, row in enumerate(equations.M))


def _weighted(equations: EquationsOfMotion, kept: Sequence[int]) -> tuple[Sequence[ScalarRow], ScalarRow]:
    """M + J^T J and F - J^T gamma, with the same a and lam as J a = -gamma, and regular where the ties make M so."""
    J, n = [equations.J[i] for i in kept], range(len(equations.M))
    gamma = [equations.gamma[i] for i in kept]
    columns = [[row[k] for row in J] for k in n]
    M = [tuple(equations.M[i][j] + inner(columns[i], columns[j]) for j in n) for i in n]
    return M, tuple(equations.forcing[k] - inner(columns[k], gamma) for k in n)


def _multipliers(equations: EquationsOfMotion, a: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
    """lam of J^T lam = M a - forcing with the accelerations known."""
    system = equations.system
    if not equations.J:
        return {}
    kept = regular_rows(system)
    n = len(equations.M)
    if n + len(kept) <= cramer.LARGEST_BLOCK:  # what divides by a pivot of J has no value where that vanishes
        found = by_determinants(equations, kept)
        return {x: found[x] for x in system.symbols.lam}
    rows = [{k: equations.J[m][i] for k, m in enumerate(kept)} for i in range(n)]
    right = [inner(equations.M[i], list(a.values())) - equations.forcing[i] for i in range(n)]
    entries = [x for row in rows for x in row.values()]
    linear = LinearSystem(rows, right, len(kept), values_at_a_state(system, entries))
    solution = general_solution(linear, Pivots(vanishes=holds_identically))
    found = {system.symbols.lam[m]: solution.constants[k] for k, m in enumerate(kept)}
    return {x: found.get(x, 0) for x in system.symbols.lam}
