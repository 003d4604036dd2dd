"""A case, what is asked of it -> the same of its model with one thing left out: the derivation, replayed.

A force is left out, or a coordinate held where it is, or all of them: what somebody answers who forgets the one, or
takes the other for a structure at rest. So whatever was solved for on the way is answered as it would be then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from eomgen.errors import DerivationError, EomgenError
from eomgen.judge.case import Case
from eomgen.judge.corruption import PLAIN, SHARED, Corruption
from eomgen.model.parts import Coordinate, Model
from eomgen.model.table import Table
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.graph import Scalar, is_zero

MOST_LOADS = 30  # of a model that are left out, one by one
MOST_HELD = 6  # coordinates of a model that are held, one by one


def replays(case: Case, own: Scalar, asked: Callable[[Case], Scalar | None]) -> Iterator[Corruption]:
    """What a value changes by where the model is another one.

    Args:
        own: the value of the model itself.
        asked: the value of a case, over the symbols of the given one; None: it has none.
    """
    model = replace(case.model, outputs=Table())
    for name, text, changed in (*_without_forces(model), *_held(model)):
        try:
            value = asked(replace(case, model=changed))
        except (EomgenError, AssertionError, KeyError, StopIteration):
            continue  # such a model has no answer
        if value is None or is_zero(value - own):
            continue
        if name and not model.coordinates:  # a structure: loads add up
            yield Corruption(f"the force {name}", "factor", (own - value,), PLAIN, "", name)
        else:
            yield Corruption(text, "missing_term", (value - own,), SHARED, "", name, open=False, text=text)


def _without_forces(model: Model) -> Iterator[tuple[str, str, Model]]:
    """The model without each of its forces: (the force, in words, the model)."""
    for name in model.forces if len(model.forces) <= MOST_LOADS else ():
        forces = {other: force for other, force in model.forces.items() if other != name}
        yield name, f"the force {name} is missing", replace(model, forces=Table(forces))


def _held(model: Model) -> Iterator[tuple[str, str, Model]]:
    """The model with each of its coordinates held, and with all."""
    free = [name for name, q in model.coordinates.items() if not q.driven and not q.dependent]
    if len(free) > MOST_HELD or model.speeds:
        return
    for names in ([free] if free else []) + ([[name] for name in free] if len(free) > 1 else []):
        held = {name: _standing(q) if name in names else q for name, q in model.coordinates.items()}
        what = "everything that moves" if names == free else names[0]
        text = f"what the motion of {what} does is missing: it is as if {what} stood still"
        try:
            yield "", text, replace(model, coordinates=Table(held))
        except (EomgenError, DerivationError):
            continue


def _standing(q: Coordinate) -> Coordinate:
    place = q.start or q.near or Expression.number(0)
    return replace(q, start=None, speed=None, near=None, motion=place)
