"""Equations, state -> whether friction is that of the declared coefficients, and contacts are as they start.

|F| = mu |N|, or c |N| |v|;    a contact that holds both ways pushes at the start as its friction takes it to;
one that can end and is closed does not open there:   gap' <= 0 at the speeds of the start, such contacts open
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from eomgen.errors import DerivationError, ModelError, UsageError
from eomgen.mechanics.balance.friction import frictions
from eomgen.mechanics.bodies.contact_modes import CLOSED, ContactMode
from eomgen.mechanics.constraints.ties import rows_of_tie
from eomgen.mechanics.equations.equations_of_motion import EquationsOfMotion
from eomgen.mechanics.equations.system import System, system_of
from eomgen.mechanics.initial_state.initial_state import start_of_motion
from eomgen.mechanics.reactions.reactions import reactions_of
from eomgen.model.contacts import contacts_of
from eomgen.model.friction import Resistance
from eomgen.model.values import exact_parameters
from eomgen.proof.in_numbers import InNumbers
from eomgen.proof.states import own_start
from eomgen.symbolic.expression.node import State
from eomgen.symbolic.numeric.evaluation import NoValue, evaluate, fifty_digits
from eomgen.symbolic.numeric.tolerances import CARRIED, ZERO_AT_50

OPEN = ContactMode(closed=False)


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


def leaving_at_start(equations: EquationsOfMotion) -> str:
    """Which contact that can end is closed, and leaves its surface where the motion starts; "" where none does.

    Raises:
        NoValue: the start is not known in numbers, or something has no value there.
    """
    system = equations.system
    model, modes = system.scope.model, system.modes
    ending = [c.name for c in contacts_of(model) if c.unilateral and modes.get(c.name, CLOSED) == CLOSED]
    if not ending or not model.coordinates or len(exact_parameters(model)) < len(model.parameters):
        return ""
    try:
        free = system_of(model, {**modes, **dict.fromkeys(ending, OPEN)})
        start = start_of_motion(free)
    except (DerivationError, ModelError, UsageError) as error:
        raise NoValue(str(error).splitlines()[0]) from None
    given = {x.name for x in free.symbols.q}
    if any(change.name in given for change in start.changes):
        return ""  # positions are guesses that the contacts complete
    known = own_start(free)
    if known is None:
        return ""
    rows = {name: rows_of_tie(free.motion, name)[0] for name in ending}
    gaps = [row.gap for row in rows.values() if row.gap is not None]
    if any(abs(x) > CARRIED for x in evaluate(gaps, known, fifty_digits())):
        return ""  # it does not begin in contact: where it does, somebody else says
    rates = evaluate([row.velocity for row in rows.values()], known, fifty_digits())
    for name, rate in zip(rows, rates, strict=True):
        if rate > CARRIED * (1 + max(map(abs, rates))):
            return f"'{name}' is closed, and opens with {float(rate):.6g} m/s where the motion starts"
    return ""


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
