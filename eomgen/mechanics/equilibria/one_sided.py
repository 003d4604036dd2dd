"""A place of rest -> the contacts that would have to pull there: it is no place of rest."""

from __future__ import annotations

from collections.abc import Mapping

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.balance_solution import Indeterminate
from eomgen.mechanics.bodies.contact_modes import CLOSED
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.reactions.reactions import reactions_of
from eomgen.model.contacts import contacts_of
from eomgen.symbolic.expression.derivative import symbols_of
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate
from eomgen.symbolic.numeric.tolerances import COMPUTED


def pulling_contacts(system: System, state: Mapping[Node, Scalar], values: Mapping[Node, float]) -> tuple[str, ...]:
    """The one-sided ties whose reaction is negative at a state.

    Args:
        state: exact scalars of everything that moves.
        values: of the parameters.
    """
    names = [
        contact.name
        for contact in contacts_of(system.scope.model)
        if contact.unilateral and system.modes.get(contact.name, CLOSED).closed
    ]
    if not names:
        return ()
    try:
        reactions = reactions_of(system, state)
    except DerivationError:  # what acts at no place has no reactions
        return ()
    found = []
    for j, component in enumerate(reactions.components):
        if component.owner in names and component.label in ("n", "tension"):
            try:
                value = reactions.value(j)
            except Indeterminate:
                continue
            known = all(x in values for x in symbols_of((value,)))
            if known and evaluate((value,), values, FLOAT)[0] < -COMPUTED:
                found.append(component.owner)
    return tuple(dict.fromkeys(found))
