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
from eomgen.proof import identities
from eomgen.proof.check import Certificate
from eomgen.proof.trials import Trials
from eomgen.symbolic.numeric.gc_pause import growing


@growing()
def certify(system: System, assembly: Assembly, rhs: RightHandSide | None = None) -> Certificate:
    """Check the equations of a system.

    Args:
        assembly: the equations that a user gets.
        rhs: emitted code to be compared with the symbols.
    """
    trials = Trials(system, assembly)
    claims = [identities.rates(system, assembly), *identities.routes(system, assembly)]
    claims += [identities.mass_matrix(assembly), identities.energy(system, assembly)]
    if assembly.J:
        claims.append(identities.closing_rows(system, assembly))
    checks = [*identities.compared(claims, trials.states), trials.twists()]
    if system.elimination is not None:
        checks.append(trials.eliminated_rows())
    checks.append(trials.free_bodies())
    if rubs(system):
        checks.append(trials.friction())
    checks += [*trials.contacts(), *trials.passive_elements(), *trials.balance()]
    if rhs is not None:
        checks.append(trials.code(rhs))
    return Certificate(tuple(checks))
