"""Model -> the states of its contacts where it rests: one choice for every verb that asks for rest."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice, product

from eomgen.errors import DerivationError, MissingValues, ModelError, UsageError
from eomgen.mechanics.dynamics import system_of
from eomgen.mechanics.equilibrium.equations import static_equations
from eomgen.mechanics.equilibrium.search import Equilibrium, nearest_equilibrium
from eomgen.mechanics.kinematics import ContactMode, ContactModes
from eomgen.mechanics.statics import ContactsAtStart
from eomgen.model import Model, Table
from eomgen.symbolic.numeric import NoValue

# A one-sided contact is closed at rest and pushes, or is open and has a gap:
#
#     closed   gap = 0, N >= 0              open     gap >= 0, N = 0
#
# The speeds of the start say nothing of it. First the contacts are taken as they would be if the model were let go
# at its start; where a place of rest contradicts that, what would have to pull is opened, what the system would have
# passed through is closed. Where that leads nowhere, all choices are tried, what holds before what lets go.


ROUNDS = 6  # of contacts that a place of rest contradicts
MOST_TRIED = 16  # choices of contacts


def contacts_at_rest(model: Model) -> tuple[ContactModes, tuple[str, ...]]:
    """(the contacts that are open at the equilibrium nearest to the start, or stick there; what was assumed).

    As at the start let go, where every choice contradicts something. Without coordinates nothing is open.
    """
    ending = [contact.name for contact in model.contacts if contact.unilateral]
    if not model.coordinates or not ending or model.rough_contacts:
        return ContactsAtStart.at_rest(model), ()
    begun = ContactsAtStart.of(_let_go(model))
    tried: list[frozenset[str]] = []
    wanted: frozenset[str] | None = frozenset(name for name, mode in begun.modes.items() if not mode.closed)
    while wanted is not None and wanted not in tried and len(tried) < ROUNDS:
        tried.append(wanted)
        place = _place(model, _opened(wanted))
        if place is not None and not place.contradicted:
            return _opened(wanted), begun.assumptions
        wanted = None if place is None else wanted.symmetric_difference(place.contradicted)
    for open_ in islice(_choices(ending), MOST_TRIED):
        place = None if open_ in tried else _place(model, _opened(open_))
        if place is not None and not place.contradicted:
            return _opened(open_), begun.assumptions
    return begun.modes, begun.assumptions


def _choices(names: list[str]) -> Iterator[frozenset[str]]:
    """The contacts that are open, in every choice of them."""
    for closed in product(*((True, False) for _ in names)):
        yield frozenset(name for name, holds in zip(names, closed, strict=True) if not holds)


def _opened(names: frozenset[str]) -> ContactModes:
    return dict.fromkeys(sorted(names), ContactMode(closed=False))


def _place(model: Model, modes: ContactModes) -> Equilibrium | None:
    """The equilibrium nearest to the start with these contacts; None where there is none, or it cannot be sought."""
    try:
        return nearest_equilibrium(static_equations(system_of(model, modes)))
    except (DerivationError, MissingValues, ModelError, UsageError, NoValue, ZeroDivisionError):
        return None


def _let_go(model: Model) -> Model:
    """The model with no speed at its start."""
    coordinates = {
        name: part if part.driven or part.speed is None else part.altered(speed=None)
        for name, part in model.coordinates.items()
    }
    speeds = {name: part if part.start is None else part.altered(start=None) for name, part in model.speeds.items()}
    return model.altered(coordinates=Table(coordinates), speeds=Table(speeds))
