"""Equations, state -> whether friction is that of the declared coefficients and of the pushes at the start.

|F| = mu |N|, or c |N| |v|;    a contact that holds both ways pushes at the start as its friction takes it to
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.friction import frictions
from eomgen.mechanics.bodies.contact_modes import CLOSED
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.reactions.reactions import reactions_of
from eomgen.model.contacts import contacts_of
from eomgen.model.friction import Resistance
from eomgen.proof.in_numbers import InNumbers
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import CARRIED, ZERO_AT_50


def other_friction(system: System, state: State) -> str:
    """Whose friction is not that of a coefficient declared for it; "" where all are.

    Raises:
        NoValue: something has no value there.
    """
    proof, surfaces = InNumbers(system, state), {row.tie for row in system.ties.rows if row.shares}
    for name, factor, sliding in frictions(system):
        found, v = proof.at((factor, sliding))
        along = 1 if name in surfaces else abs(v)  # on a surface viscous friction is for a unit of v
        slides = (
            bool(system.modes.get(name, CLOSED).sense) or along != 0
        )  # in a phase it slides one way, also from rest
        due = [_declared(proof, law, along, slides) for law in _laws(system, name)]
        if all(abs(abs(found) - x) > ZERO_AT_50 * (1 + x) for x in due):
            return f"the friction of '{name}' is {float(abs(found)):.10g} times its normal force, not as declared"
    return ""


def _laws(system: System, name: str) -> Iterator[Resistance | None]:
    """Of a tie its own; of a path those of its pieces."""
    model = system.scope.model
    if name in model.constraints:
        yield getattr(model.constraints[name], "friction", None)
        return
    yield from (piece.friction for piece in getattr(model.bodies[name].joint, "pieces", ()))


def _declared(proof: InNumbers, law: Resistance | None, speed: Any, slides: bool) -> Any:
    """|F|/|N|"""
    if law is None:
        return 0
    size = abs(proof.one(proof.system.scope.value(law.viscous if law.coulomb is None else law.coulomb)))
    return size * speed if law.coulomb is None else size * slides


def pushing_otherwise(equations: EquationsOfMotion, start: State, moving: Callable[[State], State]) -> str:
    """Which contact that holds both ways pushes at the start against the sign by which its friction is taken; "".

    Args:
        start: the model's own.
        moving: it with the accelerations of the equations of motion.
    Raises:
        NoValue: something has no value there.
    """
    system = equations.system
    named = [
        c.name for c in contacts_of(system.scope.model) if c.friction is not None and not (c.unilateral or c.round)
    ]
    modes = {name: system.modes.get(name, CLOSED) for name in named}
    for name, mode in modes.items():
        if not mode.closed or mode.sense is not None:  # a phase of a motion: its own start is another
            continue
        try:
            normal = reactions_of(system).normal(name)
        except DerivationError:
            continue
        (N,) = evaluate((normal,), moving(start), fifty_digits())
        if mode.push * N < -CARRIED * (1 + abs(N)):
            return f"'{name}' pushes with {float(N):.6g} at the start, and its friction is that of the other sign"
    return ""
