"""System, Assembly -> accelerations and multipliers as expressions of q, u and t.

Where the equations are few by determinants, where freedoms are few over the independent accelerations, else by factors.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress

from eomgen.codegen.factorization import factor_solution
from eomgen.errors import DerivationError
from eomgen.mechanics.balance.balance_solution import values_at_a_state
from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.explicit_accelerations import by_determinants, regular_rows
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.reactions.accelerations_at_start import FEW, by_independent
from eomgen.symbolic.expression.functions import inner
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.solve import cramer
from eomgen.symbolic.solve.linear_systems import LinearSystem, general_solution


def accelerations_and_multipliers(system: System, assembly: Assembly) -> dict[Node, Scalar]:
    """a and lam of M a = forcing + J^T lam, J a + gamma = 0, as expressions; redundant rows are left out, their lam 0.

    Raises:
        DerivationError: the mass matrix is singular whatever the state.
    """
    symbols = system.symbols
    if assembly.friction and assembly.accelerations is not None:
        found = dict(zip(symbols.a, assembly.accelerations, strict=True))
        return found | _multipliers(system, assembly, found)
    if not assembly.J:
        return dict(zip(symbols.a, factor_solution(assembly.M, assembly.forcing), strict=True))
    kept = regular_rows(system)
    if len(symbols.a) + len(kept) <= cramer.LARGEST_BLOCK:
        return by_determinants(assembly, kept)
    if len(symbols.a) - len(kept) <= FEW:
        with suppress(DerivationError):
            return by_independent(system, assembly, kept)
    return _by_factors(assembly, kept)


def _by_factors(assembly: Assembly, kept: Sequence[int]) -> dict[Node, Scalar]:
    """a = X F + X J^T lam,  (J X J^T) lam = -(gamma + J X F),  X = M^-1, never formed: M is solved for each column."""
    symbols, J = assembly.symbols, [assembly.J[i] for i in kept]
    M, forcing = _weighted(assembly, kept) if _some_massless(assembly) else (assembly.M, assembly.forcing)
    free = factor_solution(M, forcing)
    columns = [factor_solution(M, row) for row in J]
    S = [[inner(row, column) for column in columns] for row in J]
    lam = factor_solution(S, [-(assembly.gamma[i] + inner(row, free)) for i, row in zip(kept, J, strict=True)])
    a = tuple(a + inner(lam, [column[k] for column in columns]) for k, a in enumerate(free))
    multipliers = {symbols.lam[i]: value for i, value in zip(kept, lam, strict=True)}
    return dict(zip(symbols.a, a, strict=True)) | {x: multipliers.get(x, 0) for x in symbols.lam}


def _some_massless(assembly: Assembly) -> bool:
    """Whether ties alone say what some acceleration is."""
    return any(is_zero(row[k]) for k, row in enumerate(assembly.M))


def _weighted(assembly: Assembly, kept: Sequence[int]) -> tuple[Sequence[ScalarRow], ScalarRow]:
    """M + J^T J and F - J^T gamma, with the same a and lam as J a = -gamma, and regular where the ties make M so."""
    J, n = [assembly.J[i] for i in kept], range(len(assembly.M))
    gamma = [assembly.gamma[i] for i in kept]
    columns = [[row[k] for row in J] for k in n]
    M = [tuple(assembly.M[i][j] + inner(columns[i], columns[j]) for j in n) for i in n]
    return M, tuple(assembly.forcing[k] - inner(columns[k], gamma) for k in n)


def _multipliers(system: System, assembly: Assembly, a: Mapping[Node, Scalar]) -> dict[Node, Scalar]:
    """lam of J^T lam = M a - forcing with the accelerations known."""
    if not assembly.J:
        return {}
    kept = regular_rows(system)
    n = len(assembly.M)
    if n + len(kept) <= cramer.LARGEST_BLOCK:  # what divides by a pivot of J has no value where that vanishes
        found = by_determinants(assembly, kept)
        return {x: found[x] for x in system.symbols.lam}
    rows = [{k: assembly.J[m][i] for k, m in enumerate(kept)} for i in range(n)]
    right = [inner(assembly.M[i], list(a.values())) - assembly.forcing[i] for i in range(n)]
    entries = [x for row in rows for x in row.values()]
    solution = general_solution(LinearSystem(rows, right, len(kept), values_at_a_state(system, entries)))
    found = {system.symbols.lam[m]: solution.constants[k] for k, m in enumerate(kept)}
    return {x: found.get(x, 0) for x in system.symbols.lam}
