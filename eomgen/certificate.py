"""System, Assembly -> Certificate: what was checked about the equations, by which arithmetic, and whether it holds.

Independent routes must agree: energies and their derivatives (Lagrange), twists and wrenches
(projection), recursion over the tree. What they share is checked by itself: twists against
differences of poses, accelerations against free bodies in numbers, the energy identity, reactions by the balance of
every body and of the whole, the emitted code.
"""

from __future__ import annotations

from eomgen.codegen.rhs import RightHandSide
from eomgen.mechanics.balance.friction import rubs
from eomgen.mechanics.equations.assembly import Assembly
from eomgen.mechanics.equations.system import System
from eomgen.proof import identities, trials
from eomgen.proof.check import Certificate
from eomgen.symbolic.numeric.gc_pause import growing


@growing()
def certify(system: System, assembly: Assembly, rhs: RightHandSide | None = None) -> Certificate:
    """Check the equations of a system.

    Args:
        assembly: the equations that a user gets.
        rhs: emitted code to be compared with the symbols.
    """
    checks = [identities.rates(system, assembly), *identities.routes(system, assembly)]
    checks += [identities.mass_matrix(assembly), trials.twists(system)]
    checks.append(identities.energy(system, assembly))
    if assembly.J:
        checks.append(identities.closing_rows(system, assembly))
    if system.elimination is not None:
        checks.append(trials.eliminated_rows(system))
    checks.append(trials.free_bodies(system, assembly))
    if rubs(system):
        checks.append(trials.friction(system, assembly))
    checks += trials.balance(system, assembly)
    if rhs is not None:
        checks.append(trials.code(system, assembly, rhs))
    return Certificate(tuple(checks))
