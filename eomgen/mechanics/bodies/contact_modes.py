"""Contacts: ties and paths that can end, slide or stick. A mode says how each of them is in one phase of the motion.

Coulomb:  friction = -mu |N| sign(v) along the contact, N the contact's own reaction, v its sliding velocity;
viscous:  -c |N| v.  While a contact sticks, its sliding velocity is held at 0 by a row of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from eomgen.model.constraints.row import TieRow
from eomgen.model.friction import Resistance
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import function
from eomgen.symbolic.expression.graph import Scalar


@dataclass(frozen=True)
class ContactMode:
    """How one contact is.

    Args:
        closed: False: the contact is open, the string slack.
        sense: of the sliding, +1 or -1 along the contact's tangent; 0: it sticks; None: the law, with sign(v) in it.
        push: the sign of N, for contacts that hold both ways.
    """

    closed: bool = True
    sense: int | None = None
    push: int = 1


ContactModes = Mapping[str, ContactMode]
"""By the name of the tie, or of the body on a path. What is not named is closed and slides by the law."""

CLOSED = ContactMode()


def rows_in_mode(constraint: Any, rows: tuple[TieRow, ...], mode: ContactMode) -> tuple[TieRow, ...]:
    """The rows that a tie has in a mode: none while it is open, one more while it sticks (on a surface two)."""
    if not mode.closed:
        return ()
    law = getattr(constraint, "friction", None)
    if law is None or mode.sense != 0 or law.coulomb is None:
        return rows
    with_friction = [row for row in rows if row.tangent]
    pairs = (
        (name, row, push) for row in with_friction for name, push in (("t", row.tangent), ("s", row.cross_tangent))
    )
    held = (TieRow(push, None, component=name, material=row.material) for name, row, push in pairs if push)
    return (*rows, *held)


def friction_factor(
    law: Resistance | None, value: Callable[[Any], Scalar], sliding: Scalar, mode: ContactMode
) -> Scalar | None:
    """The friction of a unit of N along the tangent; None without friction, or while it sticks."""
    if law is None:
        return None
    if law.coulomb is None:
        return -mode.push * value(law.viscous) * sliding
    if mode.sense == 0:
        return None
    sense = function("sign", sliding) if mode.sense is None else mode.sense
    return -mode.push * value(law.coulomb) * sense
