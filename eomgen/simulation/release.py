"""System, constraint -> Model without it: the next phase of a motion in which a contact has ended.

Where the coordinates satisfy the constraint by themselves they cannot describe the next phase. Then the body that the
constraint held, which stands where it is `placed`, is freed along the constraint's push: a new coordinate, the
displacement from the contact.
"""

from __future__ import annotations

from typing import Any

from eomgen.errors import DerivationError
from eomgen.frozen import dataclass
from eomgen.mechanics.constraints import Row, holds_identically
from eomgen.mechanics.dynamics import System
from eomgen.mechanics.kinematics import GROUND, BodyLink, ContactMode, ContactModes
from eomgen.model import Coordinate, Model, PointForce, Table
from eomgen.symbolic.exact import readable_all
from eomgen.symbolic.expression import (
    ZERO,
    Expression,
    Vector,
    apply,
    as_expression,
    dot,
    is_zero,
    minus,
    over,
    times,
    transposed,
    vector_of,
)
from eomgen.symbolic.print import to_text

DISPLACEMENTS = {"n": "gap", "tension": "gap", "t": "slip", "s": "slip"}
"""What a body can do along a row of forces that has ended."""


def released(system: System, constraint: str) -> tuple[Model, ContactModes]:
    """The model and the modes of the phase after the constraint has ended; the coordinates keep their names.

    The constraint stays in the model, open. New coordinates, if they are needed, start at 0 and stand last.

    Raises:
        DerivationError: nothing that is `placed` can be freed from the constraint.
    """
    rows = [row for row in system.constraints.rows if row.constraint == constraint]
    model = _with_free_coordinates(system.scope.model, [row.eliminates for row in rows if row.eliminates])
    for row in rows:
        if row.identical and row.component in DISPLACEMENTS:
            model = _freed(system, model, row)
    modes = {name: mode for name, mode in system.modes.items() if name != constraint}
    return model, {**modes, constraint: ContactMode(closed=False)}


def _with_free_coordinates(model: Model, names: list[str]) -> Model:
    """The model with dependent coordinates free that only the ended constraint determined."""
    table = {name: part.altered(dependent=False) if name in names else part for name, part in model.coordinates.items()}
    return model.altered(coordinates=Table(table)) if names else model


def stays_straight(system: System, constraint: str) -> bool:
    """True if each displacement that releases the constraint is along its own push, whatever else is released."""
    rows = [
        row
        for row in system.constraints.rows
        if row.constraint == constraint and row.identical and row.component in DISPLACEMENTS
    ]
    return all(_placed(system, row).straight for row in rows)


@dataclass(frozen=True)
class Leave:
    """Displacement of a placed body that releases a row.

    Args:
        link: the placed body.
        direction: of its displacement for a unit of the new coordinate, parent's axes.
        straight: True if that is the push of the row itself.
        turns: True if it must turn as well.
    """

    link: BodyLink
    direction: Vector
    straight: bool
    turns: bool = False


def _freed(system: System, model: Model, row: Row) -> Model:
    """The model in which the body that the row pushes may be displaced along the direction that the row alone held."""
    leave = _placed(system, row)
    model, name = _with_coordinate(model, row.constraint, DISPLACEMENTS[row.component])
    joint: Any = model.bodies[leave.link.name].joint
    at = joint.at or (Expression.number(0),) * (2 if model.space == "plane" else 3)
    changes: dict[str, Any] = {
        "at": tuple(
            place if is_zero(n) else as_expression(f"({place.text}) + {name}*({to_text(n)})")
            for place, n in zip(at, leave.direction, strict=False)
        )
    }
    if leave.turns:
        model, turn = _with_coordinate(model, row.constraint, "turn")
        changes["angle"] = as_expression(turn if joint.angle is None else f"({joint.angle.text}) + {turn}")
    body = model.bodies[leave.link.name].altered(joint=joint.altered(**changes))
    return model.altered(bodies=Table({**model.bodies, leave.link.name: body}))


def _with_coordinate(model: Model, constraint: str, what: str) -> tuple[Model, str]:
    """The model with a displacement from a contact that has ended, and its name."""
    taken = {*model.parameters, *model.coordinates, *model.speeds, *model.inputs, *model.unknowns}
    name = f"{constraint}_{what}"
    while name in taken:
        name += "_"
    zero = Expression.number(0)
    displaced = Coordinate(start=zero, speed=zero, about=f"displacement from {constraint}, which has ended")
    return model.altered(coordinates=Table({**model.coordinates, name: displaced})), name


def _placed(system: System, row: Row) -> Leave:
    """The placed body by which the row can be opened, and its displacement.

    d is the push n of the row less its part along what else holds the body identically, with n . d = 1. Where nothing
    of it is left (two parallel wires) the body goes along n and turns, and the other constraints hold it by
    multipliers.
    """
    pushed = _pushed(system, row)
    for link, n in pushed:
        others = [
            m
            for other in system.constraints.rows
            if other.identical and other.constraint != row.constraint
            for on, m in _pushed(system, other)
            if on is link
        ]
        d = _across(n, others)
        along = readable_all((dot(n, d),))[0]
        if not holds_identically(along):
            straight = all(holds_identically(a - b) for a, b in zip(n, d, strict=True))
            return Leave(link, vector_of(readable_all(tuple(over(x, along) for x in d))), straight)
    for link, n in pushed:
        if system.scope.model.space == "plane":
            return Leave(link, vector_of(readable_all(n)), straight=False, turns=True)
    raise DerivationError(
        f"'{row.constraint}' ends, and no body can leave it: the coordinates describe contact only",
        f"constraints.{row.constraint}",
        "place the body by coordinates that can leave the contact",
    )


def _pushed(system: System, row: Row) -> list[tuple[BodyLink, Vector]]:
    """The placed bodies that the row pushes, or that carry those, and the forces on them, their parents' axes."""
    found = []
    for push in row.pushes:
        if not isinstance(push, PointForce) or push.place[0] is None:
            continue
        link = _root(system, system.motion.link(push.place[0]))
        if link is None:
            continue
        force = push.force if push.axes is None else apply(system.motion.link(push.axes).pose.R, push.force)
        if link.parent != GROUND:
            force = apply(transposed(system.motion.links[link.parent].pose.R), force)
        found.append((link, force))
    return found


def _across(n: Vector, others: list[Vector]) -> Vector:
    """n less its part in the span of the others, by Gram and Schmidt."""
    basis: list[Vector] = []
    for vector in (*others, n):
        for e in basis:
            vector = minus(vector, times(over(dot(vector, e), dot(e, e)), e))
        if all(holds_identically(x) for x in vector):
            vector = ZERO
        else:
            basis.append(vector)
    return vector


def _root(system: System, link: BodyLink) -> BodyLink | None:
    """The body itself, or the nearest one that carries it, that is placed by expressions."""
    current: BodyLink | None = link
    while current is not None:
        if current.joint is not None and not current.joint.carries_reaction:
            return current
        current = None if current.parent == GROUND else system.motion.links[current.parent]
    return None
