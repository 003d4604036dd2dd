"""Formulations: the seam of ways to the equations of motion."""

from collections.abc import Callable
from dataclasses import dataclass

from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.formulations import lagrange, projection, recursive


@dataclass(frozen=True)
class Formulation:
    """One way to the equations of motion.

    Args:
        name: what a user types.
        title: what a certificate says.
        assemble: System -> the equations.
    """

    name: str
    title: str
    assemble: Callable[[System], Assembly]


ALL = (
    Formulation("lagrange", "Lagrange's equations", lagrange.assembled_by_energies),
    Formulation("projection", "projection of Newton-Euler", projection.assembled_by_wrenches),
    Formulation("recursive", "recursion over the tree", recursive.assembled_by_recursion),
)
