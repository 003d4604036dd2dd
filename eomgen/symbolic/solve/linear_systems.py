"""Linear equations over the graph: the front of all ways to solve them.

    way                   for                                          divides by
    minors                few unknowns hang together, A regular        determinants of blocks: singular where A is
    elimination           any rows, dependent and too few as well      pivots that do not vanish at a generic state
    normal equations      what has no pivot that is sure               determinants of W^T A
    common factors        rows and columns in units of their own       products of the symbols named

Numbers have `symbolic.numeric.dense`, the prime field `symbolic.numeric.modular`.
"""

from __future__ import annotations

from collections.abc import Callable

from eomgen.errors import DerivationError
from eomgen.symbolic.expression.graph import Scalar, is_zero
from eomgen.symbolic.solve import cramer
from eomgen.symbolic.solve.linear import LinearSystem, Pivots, Solution, sparse_solution
from eomgen.symbolic.solve.scaling import scaled_solution

__all__ = ["LinearSystem", "Pivots", "Solution", "general_solution", "unique_solution"]


def general_solution(system: LinearSystem, pivots: Pivots | None = None) -> Solution:
    """x as far as the rows determine it, by elimination; common factors are taken out first where any are named."""
    pivots = pivots or Pivots()
    return scaled_solution(system, pivots) if pivots.factors else sparse_solution(system, pivots)


def unique_solution(system: LinearSystem, *, vanishes: Callable[[Scalar], bool] | None = None) -> tuple[Scalar, ...]:
    """x of as many rows as unknowns: by minors where the unknowns are few, else by elimination.

    Args:
        vanishes: whether an entry is zero at all states, not only where the values are (None: told by these).
    Raises:
        DerivationError: there is no single solution.
    """
    if system.unknowns <= cramer.LARGEST_BLOCK and len(system.rows) == system.unknowns:
        found, _ = cramer.solution_by_minors(system.rows, [(x,) for x in system.right], vanishes=vanishes or is_zero)
        return tuple(x for (x,) in found)
    solution = general_solution(system, Pivots(vanishes=vanishes) if vanishes else None)
    if solution.free:
        raise DerivationError("the equations have no single solution")
    return tuple(solution.constants[j] for j in range(system.unknowns))
