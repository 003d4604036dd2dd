"""Equations of motion -> accelerations and multipliers by determinants: the shortest formulas of small systems.

M a - J^T lam = forcing,   J a = -gamma
"""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.errors import DerivationError
from eomgen.mechanics.constraints.freedom import redundant_rows
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.equations.wellposed import massless_motions
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.node import ScalarRow
from eomgen.symbolic.solve import cramer

MOST = 6  # unknowns that are written out for a reader


def by_determinants(equations: EquationsOfMotion, kept: Sequence[int]) -> dict[Node, Scalar]:
    """a and lam of the bordered equations at once; redundant rows are left out, their lam 0.

    Args:
        kept: the closing rows that do not follow from others.
    Raises:
        DerivationError: too many unknowns hang together.
    """
    symbols, n = equations.symbols, len(equations.M)
    rows, right = bordered_rows(equations, kept)
    values = [x for (x,) in cramer.solution_by_minors(rows, [(x,) for x in right])[0]]
    multipliers = {symbols.lam[m]: values[n + k] for k, m in enumerate(kept)}
    return dict(zip(symbols.a, values[:n], strict=True)) | {x: multipliers.get(x, 0) for x in symbols.lam}


def bordered_rows(equations: EquationsOfMotion, kept: Sequence[int]) -> tuple[list[dict[int, Scalar]], list[Scalar]]:
    """(rows, right side) of the equations for a, and lam of the kept rows: {index of the unknown: coefficient}."""
    n = len(equations.M)
    rows = [_entries(row) for row in equations.M]
    for i, row in enumerate(rows):
        row |= {n + k: -equations.J[m][i] for k, m in enumerate(kept) if not is_zero(equations.J[m][i])}
    rows += [_entries(equations.J[m]) for m in kept]
    return rows, [*equations.forcing, *(-equations.gamma[m] for m in kept)]


def _entries(row: ScalarRow) -> dict[int, Scalar]:
    return {j: x for j, x in enumerate(row) if not is_zero(x)}


def regular_rows(system: System) -> list[int]:
    """The closing rows that do not follow from others."""
    dropped = {(row.tie, row.number) for row in redundant_rows(system.ties)}
    return [i for i, row in enumerate(system.ties.closing) if (row.tie, row.number) not in dropped]


def short_accelerations(equations: EquationsOfMotion) -> ScalarRow | None:
    """a as functions of q, u, t and inputs; None where they are many, or the equations are singular."""
    if equations.friction:
        return equations.accelerations
    kept = regular_rows(equations.system) if equations.J else []
    if len(equations.M) + len(kept) > MOST or massless_motions(equations):
        return None
    try:
        found = by_determinants(equations, kept)
    except (DerivationError, ZeroDivisionError):
        return None
    return tuple(found[a] for a in equations.symbols.a)
