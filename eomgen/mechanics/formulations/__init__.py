"""Formulations: the seam of ways to the equations of motion, and which of them a method of derivation goes."""

from collections.abc import Callable

from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.formulations import lagrange, projection, recursive
from eomgen.records import dataclass
from eomgen.symbolic.expression.node import ScalarRow

Along = Callable[[System], tuple[ScalarRow, ScalarRow, ScalarRow]]


@dataclass(frozen=True)
class Formulation:
    """One way to the equations of motion.

    Args:
        name: as tests say it.
        title: what a certificate says.
        assemble: System -> the equations, every entry of M.
        along: System -> (M a, c, Q) along one motion, for any accelerations: O(n), no entry of M is formed; None where
            that is the residual of inverse dynamics.
    """

    name: str
    title: str
    assemble: Callable[[System], EquationsOfMotion]
    along: Along | None = None


LAGRANGE = Formulation(
    "lagrange", "Lagrange's equations", lagrange.assembled_by_energies, along=lagrange.energies_along
)
PROJECTION = Formulation(
    "projection", "projection of Newton-Euler", projection.assembled_by_wrenches, along=projection.wrenches_along
)
RECURSION = Formulation("recursive", "recursion over the tree", recursive.assembled_by_recursion)

ALL = (LAGRANGE, PROJECTION, RECURSION)

METHODS = {"lagrange": LAGRANGE, "projection": PROJECTION, "kinetostatic": PROJECTION}
"""By which way a method of derivation goes; the reactions of a kineto-static one do no work and drop out of it."""


def derived_by(method: str, system: System) -> EquationsOfMotion:
    """The equations by the way of a method, friction left out.

    Speeds that are no rates have no equation of Lagrange's: there the balances are projected (Kane's way).
    """
    way = PROJECTION if system.scope.model.speeds else METHODS[method]
    return way.assemble(system)
