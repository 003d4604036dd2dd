"""Equations of motion -> accelerations and multipliers, by determinants or by factors.

Determinants give the shortest formulas of small systems; the pivots of factors vanish at no state.

M a - J^T lam = forcing,   J a = -gamma
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Rank
from eomgen.mechanics.dynamics.system import EquationsOfMotion
from eomgen.mechanics.dynamics.wellposed import WellPosed
from eomgen.symbolic.exact import cramer, factor_solution
from eomgen.symbolic.expression import Node, Scalar, ScalarRow, depends_on, inner, is_zero, over
from eomgen.symbolic.print import text_size

MOST = 6  # unknowns that are written out for a reader


@dataclass(frozen=True)
class Explicit:
    """Accelerations and multipliers of equations of motion as explicit functions."""

    equations: EquationsOfMotion

    def by_determinants(self, kept: Sequence[int]) -> dict[Node, Scalar]:
        """a and lam of the bordered equations at once; redundant rows are left out, their lam 0.

        Args:
            kept: the constraint rows that do not follow from others.
        Raises:
            DerivationError: too many unknowns hang together.
        """
        symbols, n = self.equations.symbols, len(self.equations.M)
        rows, right = self.bordered(kept)
        values = [x for (x,) in cramer.solution_by_minors(rows, [(x,) for x in right])[0]]
        multipliers = {symbols.lam[m]: values[n + k] for k, m in enumerate(kept)}
        return dict(zip(symbols.a, values[:n], strict=True)) | {x: multipliers.get(x, 0) for x in symbols.lam}

    def by_factors(
        self, kept: Sequence[int], pushes: Sequence[ScalarRow] = ()
    ) -> list[tuple[list[Scalar], list[Scalar]]]:
        """(a, lam of the kept rows) of the equations, and then what each push, a force along the speeds, adds to them.

        a = X F + X J^T lam,  (J X J^T) lam = -(gamma + J X F),  X = M^-1, never formed: M is solved for each column.

        Raises:
            DerivationError: the mass matrix is singular whatever the state.
        """
        M, J, n = self.equations.M, [self.equations.J[m] for m in kept], range(len(self.equations.M))
        gamma = [self.equations.gamma[m] for m in kept]
        loads: list[tuple[ScalarRow, list[Scalar]]] = [(self.equations.forcing, gamma)]
        loads += [(push, [0] * len(kept)) for push in pushes]
        if any(is_zero(row[k]) for k, row in enumerate(M)):  # the constraints alone say what some acceleration is
            across = [[row[k] for row in J] for k in n]
            M = tuple(tuple(M[i][j] + inner(across[i], across[j]) for j in n) for i in n)
            loads = [(tuple(F[k] - inner(across[k], bias) for k in n), bias) for F, bias in loads]
        columns = [factor_solution(M, row) for row in J]
        S = [[inner(row, column) for column in columns] for row in J]
        found = []
        for F, bias in loads:
            free = factor_solution(M, F)
            lam = factor_solution(S, [-(b + inner(row, free)) for row, b in zip(J, bias, strict=True)])
            found.append(([x + inner(lam, [column[k] for column in columns]) for k, x in enumerate(free)], list(lam)))
        return found

    def bordered(self, kept: Sequence[int]) -> tuple[list[dict[int, Scalar]], list[Scalar]]:
        """(rows, right side) of the equations for a, and lam of the kept rows: {index of unknown: coefficient}."""
        n = len(self.equations.M)
        rows = [_entries(row) for row in self.equations.M]
        for i, row in enumerate(rows):
            row |= {n + k: -self.equations.J[m][i] for k, m in enumerate(kept) if not is_zero(self.equations.J[m][i])}
        rows += [_entries(self.equations.J[m]) for m in kept]
        return rows, [*self.equations.forcing, *(-self.equations.gamma[m] for m in kept)]

    def by_short_rows(self, simple: Callable[[Scalar], Scalar]) -> dict[Node, Scalar] | None:
        """a and lam by determinants of simplest entries, where constraints hold fixed ratios of rates; else None.

        A constraint row is divided by the entry which leaves it shortest: a gear's row then holds two ratios of radii,
        no factor of it comes back squared in every minor.
        """
        symbols, kept = self.equations.symbols, Rank(self.equations.system.constraints).regular()
        if len(symbols.a) + len(kept) > cramer.LARGEST_BLOCK:
            return None
        moving = (*symbols.x, *symbols.inputs.values(), symbols.t)
        rows, divisors = [], []
        for row, bias in zip(self.equations.J, self.equations.gamma, strict=True):
            whole = tuple(simple(x) for x in (*row, bias))
            if any(depends_on(x, moving) for x in whole[:-1]):
                return None
            short, divisor = _shortest(whole, simple)
            rows.append(short)
            divisors.append(divisor)
        found = Explicit(
            replace(
                self.equations,
                M=tuple(tuple(simple(x) for x in row) for row in self.equations.M),
                forcing=tuple(simple(x) for x in self.equations.forcing),
                J=tuple(row[:-1] for row in rows),
                gamma=tuple(row[-1] for row in rows),
            )
        ).by_determinants(
            kept,
        )
        return found | {x: over(found[x], divisor) for x, divisor in zip(symbols.lam, divisors, strict=True)}

    @property
    def short(self) -> ScalarRow | None:
        """a as functions of q, u, t and inputs; None where they are many, or the equations are singular."""
        if self.equations.friction:
            return self.equations.accelerations
        kept = Rank(self.equations.system.constraints).regular() if self.equations.J else []
        if len(self.equations.M) + len(kept) > MOST or WellPosed(self.equations).massless_motions:
            return None
        try:
            found = self.by_determinants(kept)
        except (DerivationError, ZeroDivisionError):
            return None
        return tuple(found[a] for a in self.equations.symbols.a)


def _entries(row: ScalarRow) -> dict[int, Scalar]:
    return {j: x for j, x in enumerate(row) if not is_zero(x)}


def _shortest(row: ScalarRow, simple: Callable[[Scalar], Scalar]) -> tuple[ScalarRow, Scalar]:
    """(the row over one of its entries, that entry); the row as it is, and 1, where none makes it shorter."""
    tried: list[tuple[ScalarRow, Scalar]] = [(row, 1)]
    for x in dict.fromkeys(x for x in row[:-1] if type(x) is Node):
        tried.append((tuple(simple(over(y, x)) for y in row), x))
    return min(tried, key=lambda one: sum(map(text_size, one[0])))
