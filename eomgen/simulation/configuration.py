"""Model -> how all of its contacts, and the pieces of its paths, are at a time, and what changes in words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field, replace
from typing import Any

from eomgen.mechanics.bodies.contact_modes import ContactMode
from eomgen.model.contacts import Contact, contacts_of, pieces_of
from eomgen.model.part import altered
from eomgen.model.parts import Model
from eomgen.model.table import Table
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression


@dataclass(frozen=True)
class Configuration:
    """How all contacts are in one phase.

    Args:
        modes: of each contact.
        pieces: the piece of the path on which each body on a path is, from 0.
    """

    modes: Table[ContactMode] = field(default_factory=Table)
    pieces: Table[int] = field(default_factory=Table)

    @property
    def open(self) -> tuple[str, ...]:
        """The ties that do not hold."""
        return tuple(name for name, mode in self.modes.items() if not mode.closed)


def by_the_law(model: Model, configuration: Configuration) -> Configuration:
    """The configuration where friction on a surface is along v/|v|, which has no value where v is 0."""
    surfaces = {contact.name for contact in contacts_of(model) if contact.surface}
    modes = {
        name: replace(mode, sense=None) if name in surfaces and mode.sense else mode
        for name, mode in configuration.modes.items()
    }
    return replace(configuration, modes=Table(modes))


def has_phases(model: Model) -> bool:
    """Whether the model has anything that can change as it moves."""
    return bool(changing(model))


def changing(model: Model) -> tuple[str, ...]:
    """What can change as the model moves: contacts, and bodies on a path of several pieces."""
    return tuple(dict.fromkeys((*(contact.name for contact in contacts_of(model)), *paths_of(model))))


def paths_of(model: Model) -> tuple[str, ...]:
    """The bodies on a path of several pieces."""
    return tuple(name for name, body in model.bodies.items() if len(pieces_of(body)) > 1)


def bounds_of(model: Model, body: str) -> tuple[tuple[Expression, Expression], ...]:
    """The arc lengths at the beginning and the end of every piece of a body's path."""
    joint: Any = model.bodies[body].joint
    bounds: tuple[tuple[Expression, Expression], ...] = joint.bounds()
    return bounds


def on_pieces(model: Model, pieces: Mapping[str, int]) -> Model:
    """The model with every path reduced to one of its pieces."""
    if not pieces:
        return model
    bodies = dict(model.bodies)
    for name, k in pieces.items():
        joint: Any = bodies[name].joint
        bodies[name] = altered(bodies[name], joint=joint.piece(k))
    return altered(model, bodies=Table(bodies))


def changed(model: Model, before: Configuration, after: Configuration) -> tuple[str, ...]:
    """What is different after, a phrase each: "the support 'wall' opens"."""
    contacts = {contact.name: contact for contact in contacts_of(on_pieces(model, after.pieces))}
    phrases = [_moved_on(model, name, k) for name, k in after.pieces.items() if before.pieces.get(name, k) != k]
    for name, mode in after.modes.items():
        old = before.modes.get(name)
        if old is not None and old != mode:
            phrases += _phrases(contacts[name], old, mode)
    return tuple(phrases)


def _moved_on(model: Model, body: str, k: int) -> str:
    joint: Any = model.bodies[body].joint
    named = joint.pieces[k].name
    return f"the body '{body}' comes to " + (f"the piece '{named}'" if named else f"piece {k + 1}") + " of its path"


def _phrases(contact: Contact, old: ContactMode, new: ContactMode) -> Iterable[str]:
    if old.closed and not new.closed:
        yield f"{contact.words} goes slack" if contact.pulls else f"{contact.words} opens"
    elif new.closed and not old.closed:
        yield f"{contact.words} is taut again" if contact.pulls else f"{contact.words} closes"
    elif old.sense != new.sense:
        yield _sliding(contact, old.sense, new.sense)
    elif old.push != new.push:
        yield f"{contact.words} pushes from the other side"


def _sliding(contact: Contact, old: int | None, new: int | None) -> str:
    if new == 0:
        return f"{contact.words} sticks"
    return f"{contact.words} begins to slide" if old == 0 else f"{contact.words} slides back"
