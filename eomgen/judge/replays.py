"""A case, what is asked of it -> the same of its model with one thing left out: the derivation, replayed.

A force is left out, or a coordinate held where it is, or all of them: what somebody answers who forgets the one, or
takes the other for a structure at rest. So whatever was solved for on the way is answered as it would be then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

from eomgen.errors import EomgenError
from eomgen.judge.case import Case
from eomgen.judge.contributions import FEW
from eomgen.judge.diagnosis import PLAIN, SHARED, Mistake
from eomgen.judge.wrong_terms import WrongTerms
from eomgen.model.fields import Table
from eomgen.model.parts import Coordinate, Model
from eomgen.symbolic.expression.formula import Expression
from eomgen.symbolic.expression.node import Scalar, is_zero

MOST_LOADS = 30  # of a model that are left out, one by one
MOST_HELD = 6  # coordinates of a model that are held, one by one


def replays(case: Case, own: Scalar, requested: Callable[[Case], Scalar | None]) -> Iterator[Mistake]:
    """What a value changes by where the model is another one.

    Args:
        own: the value of the model itself.
        asked: the value of a case, over the symbols of the given one; None: it has none.
    """
    model = replace(case.model, outputs=Table())
    for name, text, parts in (*_without_forces(model), *_held(model)):
        try:
            value = requested(replace(case, model=replace(model, **parts)))
        except (EomgenError, AssertionError, KeyError, StopIteration):
            continue  # such a model has no answer
        if value is None or is_zero(value - own):
            continue
        if name and not model.coordinates:  # a structure: loads add up
            yield from _of_load(case, name, own - value)
        else:
            rank = SHARED if name else SHARED + 1
            yield Mistake(text, "missing_term", (value - own,), rank, "", name, open=False, text=text)


def _of_load(case: Case, force: str, does: Scalar) -> Iterator[Mistake]:
    """What may be wrong with the share of one load: all of it, a place of it, a term."""
    name = f"the force {force}"
    share = (case.phase.simple(does),)
    rank = PLAIN if case.model.space == "space" else SHARED  # of the plane there are balances
    yield Mistake(name, "factor", share, rank, "", force)
    for each in case.edits.of(share):
        text = f"in {name} {each.text}"
        yield Mistake(name, each.kind, (each.to[0] - share[0],), each.rank, "", force, False, text)
    parameters = tuple(case.system.symbols.parameters.values())
    yield from WrongTerms(case.edits, parameters, (), name, "", force).in_rows(share)


Parts = dict[str, Any]  # of a model, in place of its own


def _without_forces(model: Model) -> Iterator[tuple[str, str, Parts]]:
    """The model without each of its forces: (the force, in words, what changes)."""
    for name in model.forces if len(model.forces) <= MOST_LOADS else ():
        forces = {other: force for other, force in model.forces.items() if other != name}
        yield name, f"the force {name} is missing", {"forces": Table(forces)}


def _held(model: Model) -> Iterator[tuple[str, str, Parts]]:
    """The model with each of its coordinates held, and with all."""
    free = [name for name, q in model.coordinates.items() if not q.driven and not q.dependent]
    if len(free) > MOST_HELD or model.speeds:
        return
    for names in ([free] if free else []) + ([[name] for name in free] if len(free) > 1 else []):
        held = {name: _standing(q) if name in names else q for name, q in model.coordinates.items()}
        moved = _moved_by(model, names[0]) if len(names) == 1 else []
        what = "everything that moves" if names == free else names[0]
        what = f"{what} ({', '.join(moved)})" if 0 < len(moved) <= FEW else what
        text = f"what the motion of {what} does is missing: it is as if {what} stood still"
        yield "", text, {"coordinates": Table(held)}


def _moved_by(model: Model, coordinate: str) -> list[str]:
    """The bodies whose joints are moved by a coordinate, or placed with it."""
    joints = {name: body.joint for name, body in model.bodies.items() if body.joint is not None}
    return [name for name, x in joints.items() if any(coordinate in s.names for s in x.variables(model.space))]


def _standing(q: Coordinate) -> Coordinate:
    place = next((x for x in (q.start, q.near) if x is not None), Expression.number(0))
    return replace(q, start=None, speed=None, near=None, motion=place)
