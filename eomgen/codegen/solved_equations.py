"""Equations of motion -> accelerations and multipliers as expressions of q, u and t.

Where the equations are few by determinants, where freedoms are few over the independent accelerations, else by factors.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress

from eomgen.errors import DerivationError
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.explicit_accelerations import by_determinants, by_factors, regular_rows
from eomgen.mechanics.reactions.accelerations_at_start import FEW, by_independent
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.solve import cramer
from eomgen.symbolic.solve.factorization import factor_solution


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
    symbols = equations.symbols
    ((a, lam),) = by_factors(equations, kept)
    multipliers = {symbols.lam[i]: value for i, value in zip(kept, lam, strict=True)}
    return dict(zip(symbols.a, a, strict=True)) | {x: multipliers.get(x, 0) for x in symbols.lam}


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
    ((_, lam),) = by_factors(equations, kept)
    found = {system.symbols.lam[m]: value for m, value in zip(kept, lam, strict=True)}
    return {x: found.get(x, 0) for x in system.symbols.lam}
