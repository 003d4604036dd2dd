"""State -> Configuration: which contacts hold, and which of them slide, stick or open, from this instant on.

Of all configurations that the positions and velocities allow, the first whose forces and accelerations agree with it:

    closed   N >= 0              sticks   |F| <= mu |N|, and F can hold it: v' = 0
    open     gap'' >= 0          slides from rest along its sense   sense v' >= 0
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import islice, product

import numpy as np

from eomgen.errors import DerivationError
from eomgen.mechanics.balance.balance_solution import Indeterminate
from eomgen.mechanics.bodies.contact_modes import ContactMode
from eomgen.model.contacts import Contact, contacts_of
from eomgen.model.table import Table
from eomgen.simulation.configuration import Configuration, on_pieces
from eomgen.simulation.contact_events import stopped_below
from eomgen.simulation.phase_model import PhaseModel, Values, smallest_speed
from eomgen.simulation.phase_models import OPEN, PhaseModels
from eomgen.symbolic.numeric.tolerances import COMPUTED

MOST_TRIED = 2000  # configurations at one instant
STICKS = ContactMode(sense=0)


def settled(
    phase_models: PhaseModels,
    t: float,
    values: Values,
    *,
    pieces: Mapping[str, int],
    apart: frozenset[str],
    ended: frozenset[Configuration] = frozenset(),
    before: Configuration | None = None,
) -> Configuration | None:
    """The configuration from here on; None where no forces agree with any.

    Args:
        pieces: of the paths, on which bodies are.
        apart: contacts that are open for certain: they do not touch, or move apart.
        ended: configurations that have just ended: taken only where there is no other.
        before: the configuration so far; contacts keep what they can of it.
    Raises:
        Indeterminate: something moves, and the balance does not tell how the contacts share what holds.
    """
    contacts = contacts_of(on_pieces(phase_models.model, pieces))
    sliding = _sliding(phase_models, contacts, t, values, pieces=pieces, apart=apart)
    last: Configuration | None = None
    refused: list[DerivationError] = []
    for modes in islice(_choices(contacts, apart, sliding, before), MOST_TRIED):
        tried = Configuration(Table(modes), Table(pieces))
        phase = _made(phase_models, tried, refused)
        if phase is None or not agrees(phase, t, values, sliding=sliding, apart=apart):
            continue
        standing = _standing(phase, t, values, sliding=sliding, apart=apart)
        if standing and (undetermined := _indeterminate(refused)) is not None:
            held = {c.name: _closed(c) for c in contacts if c.name in standing}
            tried = Configuration(Table({**modes, **held}), Table(pieces))
            if not phase_models.of(tried).rests(t, values):
                raise undetermined
        if tried not in ended:
            return tried
        last = last or tried
    if last is None and refused:
        raise _indeterminate(refused) or refused[0]
    return last


def _closed(contact: Contact) -> ContactMode:
    return STICKS if contact.mu is not None else ContactMode()


def _made(phase_models: PhaseModels, tried: Configuration, refused: list[DerivationError]) -> PhaseModel | None:
    """The phase of a configuration; where there is none, or its forces are not determined, why is noted."""
    try:
        phase = phase_models.of(tried)
    except DerivationError as error:  # nothing can leave a contact that is open in it, or hold one that sticks
        refused.append(error)
        return None
    if phase.watch.undetermined is not None:
        refused.append(phase.watch.undetermined)
    return phase if phase.watch.undetermined is None else None


def _indeterminate(refused: list[DerivationError]) -> Indeterminate | None:
    return next((error for error in refused if isinstance(error, Indeterminate)), None)


def _sliding(
    phase_models: PhaseModels,
    contacts: tuple[Contact, ...],
    t: float,
    values: Values,
    *,
    pieces: Mapping[str, int],
    apart: frozenset[str],
) -> dict[str, int]:
    """The sense of sliding of every contact with Coulomb friction; 0 where it does not slide."""
    if all(contact.mu is None for contact in contacts):
        return {}
    closed = Configuration(Table({c.name: OPEN if c.name in apart else ContactMode() for c in contacts}), Table(pieces))
    found, still = phase_models.slides(closed).at(t, values), smallest_speed(values)
    least = {c.name: max(still, 2 * stopped_below(c)) for c in contacts}
    return {name: 0 if abs(v) <= least[name] else 1 if v > 0 else -1 for name, v in found.items()}


def _choices(
    contacts: tuple[Contact, ...], apart: frozenset[str], sliding: Mapping[str, int], before: Configuration | None
) -> Iterator[dict[str, ContactMode]]:
    """The modes that positions and velocities allow, those that hold before those that let go."""
    offered = []
    for contact in contacts:
        modes = [OPEN] if contact.name in apart else _modes(contact, sliding.get(contact.name, 0), before)
        offered.append([(contact.name, mode) for mode in modes])
    for choice in product(*offered):
        yield dict(choice)


def _modes(contact: Contact, sense: int, before: Configuration | None) -> list[ContactMode]:
    if contact.friction is None:
        return [ContactMode(), OPEN]
    old = None if before is None else before.modes.get(contact.name)
    first = 1 if old is None else old.push
    pushes = (1,) if contact.unilateral or contact.round else (first, -first)
    if contact.mu is None:
        modes = [ContactMode(push=push) for push in pushes]
    elif sense:
        modes = [ContactMode(sense=sense, push=push) for push in pushes]
    else:
        senses = (1,) if contact.surface else (1, -1)
        modes = [STICKS, *(ContactMode(sense=s, push=push) for s in senses for push in pushes)]
    return [*modes, OPEN] if contact.unilateral else modes


def agrees(phase: PhaseModel, t: float, values: Values, *, sliding: Mapping[str, int], apart: frozenset[str]) -> bool:
    """Whether forces and accelerations are such as the configuration says; an N without one value denies nothing."""
    x = phase.state(values)
    found = phase.signals.look(t, x)
    forces, accelerations = phase.signals.sizes(t, x)
    asked = [contact for contact in phase.contacts if contact.name not in apart]
    signs = [_signs(phase.watch.mode(contact), contact, found, sliding.get(contact.name, 0)) for contact in asked]
    return not any(
        force < -COMPUTED * forces or acceleration < -COMPUTED * accelerations
        for pairs in signs
        for force, acceleration in pairs
    )


def _standing(
    phase: PhaseModel, t: float, values: Values, *, sliding: Mapping[str, int], apart: frozenset[str]
) -> tuple[str, ...]:
    """The contacts that are to begin sliding or to part, and do not: one way of many in which all of them hold."""
    x = phase.state(values)
    found, (_, size) = phase.signals.look(t, x), phase.signals.sizes(t, x)
    accelerations = {}
    for contact in phase.contacts:
        mode, name = phase.watch.mode(contact), contact.name
        if mode.closed and mode.sense and not sliding[name]:
            accelerations[name] = found[name, "slide'"]
        elif not mode.closed and name not in apart:
            accelerations[name] = found[name, "gap''"]
    return tuple(name for name, a in accelerations.items() if abs(a) <= COMPUTED * size)


def _signs(
    mode: ContactMode, contact: Contact, found: Mapping[tuple[str, str], float], sense: int
) -> Iterator[tuple[float, float]]:
    """(force, acceleration) that must not be negative (0 where there is nothing to ask)."""
    name = contact.name
    if not mode.closed:
        yield 0.0, found[name, "gap''"]
        return
    if contact.unilateral or mode.sense != 0:
        yield from ((mode.push * N, 0.0) for (owner, what), N in found.items() if owner == name and what[0] == "N")
    if mode.sense == 0:
        grip = found[name, "mu"] * abs(found[name, "N"]) - abs(found[name, "hold"])
        yield grip if np.isfinite(found[name, "hold"]) else -np.inf, -abs(found[name, "slide'"])  # at a dead centre
    elif mode.sense is not None and sense == 0 and not contact.surface:
        yield 0.0, mode.sense * found[name, "slide'"]
