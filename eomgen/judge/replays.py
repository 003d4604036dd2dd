"""A case, what is asked of it -> the same of its model with one thing left out: the derivation, replayed.

A force is left out, or a coordinate held where it is, or all of them: what somebody answers who forgets the one, or
takes the other for a structure at rest. So whatever was solved for on the way is answered as it would be then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

from eomgen.errors import EomgenError
from eomgen.judge.case import Case
from eomgen.judge.corruption import PLACED, PLAIN, SHARED, Corruption
from eomgen.judge.wrong_terms import WrongTerms
from eomgen.model.forces.base import Force
from eomgen.model.forces.couple import CoupleForce
from eomgen.model.forces.distributed import Distributed
from eomgen.model.forces.force import PointForce as AtPoint
from eomgen.model.forces.load import PointForce, SpreadLoad
from eomgen.model.parts import Coordinate, Model
from eomgen.model.table import Table
from eomgen.symbolic.expression.expressions import Expression, parse
from eomgen.symbolic.expression.graph import Node, Scalar, is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import Vector, cross, minus, vector_of
from eomgen.symbolic.print.text import to_text

MOST_LOADS = 30  # of a model that are left out, one by one
SHARES = (  # of a line: where the resultant of a load along it is thought to be
    (Fraction(0), "the start"),
    (Fraction(1), "the end"),
    (Fraction(1, 2), "the middle"),
    (Fraction(1, 3), "a third"),
    (Fraction(2, 3), "two thirds"),
)
MOST_HELD = 6  # coordinates of a model that are held, one by one


def replays(case: Case, own: Scalar, asked: Callable[[Case], Scalar | None]) -> Iterator[Corruption]:
    """What a value changes by where the model is another one.

    Args:
        own: the value of the model itself.
        asked: the value of a case, over the symbols of the given one; None: it has none.
    """
    model = replace(case.model, outputs=Table())
    for name, text, parts in (*_without_forces(model), *_spread_otherwise(model), *_held(model)):
        try:
            value = asked(replace(case, model=replace(model, **parts)))
        except (EomgenError, AssertionError, KeyError, StopIteration):
            continue  # such a model has no answer
        if value is None or is_zero(value - own):
            continue
        if text.startswith("the line load"):
            yield Corruption(text, "wrong_quantity", (value - own,), SHARED, "", name, open=False, text=text)
        elif name and not model.coordinates:  # a structure: loads add up
            yield from _of_load(case, name, own - value)
        else:
            rank = SHARED if name else SHARED + 1
            yield Corruption(text, "missing_term", (value - own,), rank, "", name, open=False, text=text)
    if not model.coordinates:
        yield from _of_weights(case, asked)
        if model.space == "plane":
            yield from _at_other_places(case, asked)


def _of_load(case: Case, force: str, does: Scalar) -> Iterator[Corruption]:
    """What may be wrong with the share of one load: all of it, a place of it, a term."""
    name = f"the force {force}"
    share = (case.phase.simple(does),)
    yield Corruption(name, "factor", share, PLAIN, "", force)
    for each in case.edits.of(share):
        text = f"in {name} {each.text}"
        yield Corruption(name, each.kind, (each.to[0] - share[0],), each.rank, "", force, False, text)
    parameters = tuple(case.system.symbols.parameters.values())
    yield from WrongTerms(case.edits, parameters, (), name, "", force).in_rows(share)


def _of_weights(case: Case, asked: Callable[[Case], Scalar | None]) -> Iterator[Corruption]:
    """What the weight of each body does, where several have one."""
    mine = [part for part in case.parts.elementary if part.kind == "weight" and isinstance(part.load, PointForce)]
    for part in mine if 1 < len(mine) <= MOST_LOADS else ():
        assert isinstance(part.load, PointForce)
        weight = tuple(parse(to_text(x)) if type(x) is Node else Expression.number(x) for x in part.load.force)
        does = _of_force_alone(case, AtPoint(point=f"{part.body}.center", force=weight), asked)
        if not is_zero(does):
            yield Corruption(part.name, "factor", (does,), PLAIN, part.body, part.force)


def _at_other_places(case: Case, asked: Callable[[Case], Scalar | None]) -> Iterator[Corruption]:
    """The forces of a plane structure at other places of their bodies: by what a couple on each body does."""
    system, does = case.system, dict[str, Scalar]()
    for force in system.loads.applied:
        for load in force.loads:
            if not isinstance(load, PointForce) or load.axes is not None or load.place[0] is None:
                continue
            body = load.place[0]
            if body not in does:
                does[body] = _of_unit_couple(case, body, asked)
            for where, r in _places(system.motion.points[body], force.spread):
                moved = minus(system.motion.position((body, r)), system.motion.position(load.place))
                row = cross(moved, load.force)[2] * does[body]
                if not is_zero(row):
                    text = f"the force {force.name} acts at {where} in the equation: its lever arm is wrong"
                    yield Corruption(text, "wrong_point", (row,), PLACED, body, force.name, open=False, text=text)


def _of_unit_couple(case: Case, body: str, asked: Callable[[Case], Scalar | None]) -> Scalar:
    """What is asked, of the structure with a couple of 1 on a body alone; 0: it has no answer."""
    return _of_force_alone(case, CoupleForce(body=body, couple=(Expression.number(1),)), asked)


def _of_force_alone(case: Case, force: Force, asked: Callable[[Case], Scalar | None]) -> Scalar:
    """What is asked, of the structure with one force alone; 0: it has no answer."""
    with suppress(EomgenError):
        value = asked(replace(case, model=replace(case.model, outputs=Table(), forces=Table({"alone": force}))))
        return 0 if value is None else value
    return 0


def _places(points: Mapping[str, Vector], spread: Sequence[SpreadLoad]) -> Iterator[tuple[str, Vector]]:
    """Where a force may be thought to act: points of its body, and parts of the line along which it is spread."""
    yield from points.items()
    for line in spread:
        (_, a), (_, b) = line.start, line.end
        for share, where in SHARES:
            yield f"{where} of the load", vector_of(x + share * (y - x) for x, y in zip(a, b, strict=True))


Parts = dict[str, Any]  # of a model, in place of its own


def _without_forces(model: Model) -> Iterator[tuple[str, str, Parts]]:
    """The model without each of its forces: (the force, in words, what changes)."""
    for name in model.forces if len(model.forces) <= MOST_LOADS else ():
        forces = {other: force for other, force in model.forces.items() if other != name}
        yield name, f"the force {name} is missing", {"forces": Table(forces)}


def _spread_otherwise(model: Model) -> Iterator[tuple[str, str, Parts]]:
    """The model with each load that grows along its line spread evenly, or growing the other way."""
    for name, force in model.forces.items():
        if isinstance(force, Distributed) and force.intensities is not None:
            start, end = force.intensities
            for how, other in (
                ("evenly", (end, end)),
                ("evenly", (start, start)),
                ("growing the other way", (end, start)),
            ):
                forces = {**model.forces, name: replace(force, intensities=other)}
                yield name, f"the line load {name} is taken as spread {how}", {"forces": Table(forces)}


def _held(model: Model) -> Iterator[tuple[str, str, Parts]]:
    """The model with each of its coordinates held, and with all."""
    free = [name for name, q in model.coordinates.items() if not q.driven and not q.dependent]
    if len(free) > MOST_HELD or model.speeds:
        return
    for names in ([free] if free else []) + ([[name] for name in free] if len(free) > 1 else []):
        held = {name: _standing(q) if name in names else q for name, q in model.coordinates.items()}
        what = "everything that moves" if names == free else names[0]
        text = f"what the motion of {what} does is missing: it is as if {what} stood still"
        yield "", text, {"coordinates": Table(held)}


def _standing(q: Coordinate) -> Coordinate:
    place = next((x for x in (q.start, q.near) if x is not None), Expression.number(0))
    return replace(q, start=None, speed=None, near=None, motion=place)
