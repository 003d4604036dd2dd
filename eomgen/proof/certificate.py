"""Equations of motion -> Certificate: what was checked about the equations, by which arithmetic, and whether it holds.

Independent routes must agree: energies and their derivatives (Lagrange), twists and wrenches
(projection), recursion over the tree. What they share is checked by itself: twists against
differences of poses, accelerations against free bodies in numbers, the energy identity, reactions by the balance of
every body and of the whole, the emitted code.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from eomgen.mechanics.dynamics import EquationsOfMotion
from eomgen.mechanics.free_bodies import SystemFriction
from eomgen.proof.check import Certificate
from eomgen.proof.identities import identity_checks
from eomgen.proof.masses import other_data
from eomgen.proof.printed import Printed
from eomgen.proof.trials import Trials
from eomgen.resources import doing, growing

if TYPE_CHECKING:
    from eomgen.codegen import RightHandSide


@growing()
@doing("the proof of the equations")
def certify(
    equations: EquationsOfMotion,
    rhs: RightHandSide | None = None,
    derived: EquationsOfMotion | None = None,
    *,
    printed: Printed | None = None,
    begins: bool = True,
) -> Certificate:
    """Check the equations of a system.

    Args:
        equations: those that a user gets.
        rhs: emitted code to be compared with the symbols.
        derived: the same by the way in which a derivation is written.
        printed: a derivation as it is printed.
        begins: True if their motion begins as the model's does; what is requested at rest has no start speeds.
    """
    trials = Trials(equations)
    checks = [*identity_checks(equations, derived, trials.states), trials.places(), trials.twists()]
    if trials.given:
        checks.append(trials.given_motions())
    if equations.system.elimination is not None:
        checks.append(trials.eliminated_rows())
    checks += [trials.free_bodies(), *trials.accelerations()]
    if SystemFriction(equations.system).exists:
        checks += [trials.friction(), *trials.pushes()]
    checks += trials.begun_contacts() if begins else ()
    checks += [
        *trials.tensors(),
        *trials.contacts(),
        *trials.threads(),
        *trials.kept_constraints(),
        *trials.slack_springs(),
        *trials.elements(),
        *trials.declared(),
        *trials.energies(),
        *trials.balance(),
    ]
    checks += [] if printed is None else trials.printed(printed)
    if rhs is not None:
        checks.append(trials.code(rhs))
    return Certificate((*checks, *other_data(equations.system.motion)))


@doing("the proof of what stands")
def certify_standing(equations: EquationsOfMotion) -> Certificate:
    """Check what no coordinate moves: where it stands, what is applied to it, the balance of every body."""
    trials = Trials(equations)
    checks = (trials.places(), *trials.kept_constraints(), *trials.elements(), *trials.declared(), *trials.balance())
    return Certificate((*checks, *other_data(equations.system.motion)))
