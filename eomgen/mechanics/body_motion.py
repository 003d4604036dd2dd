"""System, a state -> BodyMotion: what there is to say of the motion of each body at that state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from eomgen.errors import DerivationError, EomgenError
from eomgen.mechanics.field import Field, acceleration_pole, field_of, inflection_center, least_speed, rotation_center
from eomgen.mechanics.motion_kind import AtInstant, Kind, Kinds, instant_of
from eomgen.mechanics.positive import positive_parameters
from eomgen.mechanics.system import System
from eomgen.symbolic.derivative import substituted
from eomgen.symbolic.functions import sqrt
from eomgen.symbolic.graph import Node, Scalar
from eomgen.symbolic.normal_form import simplest
from eomgen.symbolic.spatial import Vector, dot, minus, vector_of

WORK = 10_000  # products of terms for making one formula readable


@dataclass(frozen=True)
class BodyMotion:
    """The motion of one body at one state, exactly.

    Args:
        body: its name.
        field: velocities and accelerations.
        instant: the kind of the field at the state.
        kind: the kind of motion in the long run; None where it is not known, or was not asked.
        center, pole: in the plane, the points without velocity and without acceleration; None where there are none.
        inflection: in the plane, (centre, radius) of the circle of the points whose path is straight there.
        slowest: (end, end, least speed between) of a bar.
    """

    body: str
    field: Field
    instant: AtInstant
    kind: Kind | None = None
    center: Vector | None = None
    pole: Vector | None = None
    inflection: tuple[Vector, Scalar] | None = None
    slowest: tuple[str, str, Scalar] | None = None


@dataclass(frozen=True)
class Readable:
    """Values at a state, in readable form.

    Args:
        state: exact scalars in place of coordinates, speeds, accelerations and t; {} for functions of them.
        positive: symbols that stand for positive numbers.
    """

    state: Mapping[Node, Scalar]
    positive: frozenset[Node]

    def scalar(self, x: Scalar) -> Scalar:
        return simplest(substituted((x,), self.state)[0], WORK, self.positive)

    def vector(self, x: Vector) -> Vector:
        return vector_of(map(self.scalar, x))

    def field(self, field: Field) -> Field:
        """The field at the state."""
        return Field(*map(self.vector, (field.p, field.v, field.a, field.w, field.e)))


def readable_at(system: System, state: Mapping[Node, Scalar]) -> Readable:
    """The readable values of a system at a state."""
    return Readable(state, positive_parameters(system.scope))


def body_motions(
    system: System, state: Mapping[Node, Scalar], kinds: Kinds | None = None, bodies: Sequence[str] = ()
) -> tuple[BodyMotion, ...]:
    """The motion of the bodies, of all of them where none is named.

    Args:
        state: exact scalars in place of coordinates, speeds, accelerations and t; {}: as functions of them.
        kinds: gives the kinds of motion in the long run.
    """
    named = bodies or [link.name for link in system.motion.links]
    return tuple(_body_motion(system, readable_at(system, state), kinds, body) for body in named)


def _body_motion(system: System, readable: Readable, kinds: Kinds | None, body: str) -> BodyMotion:
    field = readable.field(field_of(system.motion, body))
    motion = BodyMotion(body, field, instant_of(field, readable.scalar), _kind(kinds, body))
    slowest = _slowest(system, readable, body, field)
    if system.scope.model.space != "plane":
        return BodyMotion(body, field, motion.instant, motion.kind, slowest=slowest)
    center, pole = (_found(partial(find, field), readable) for find in (rotation_center, acceleration_pole))
    circle = None
    if center is not None and pole is not None:
        middle = readable.vector(inflection_center(field))
        arm = readable.vector(minus(middle, center))
        circle = middle, readable.scalar(sqrt(dot(arm, arm)))
    return BodyMotion(body, field, motion.instant, motion.kind, center, pole, circle, slowest)


def _kind(kinds: Kinds | None, body: str) -> Kind | None:
    if kinds is None:
        return None
    try:
        return kinds.of(body)
    except EomgenError:  # no motion near the start at which it could be tried
        return None


def _found(find: partial[Vector], readable: Readable) -> Vector | None:
    try:
        return readable.vector(find())
    except DerivationError:
        return None


def _slowest(system: System, readable: Readable, body: str, field: Field) -> tuple[str, str, Scalar] | None:
    """Of a bar: of what has a `line`, or of a rod."""
    motion, part = system.motion, system.scope.model.bodies[body]
    ends = part.line or ("start", "end")
    if not set(ends) <= motion.points[body].keys():
        return None
    start, end = (readable.vector(motion.position((body, motion.points[body][name]))) for name in ends)
    try:
        least = least_speed(field, start, end, readable.scalar)
    except DerivationError:
        return None
    return f"{body}.{ends[0]}", f"{body}.{ends[1]}", readable.scalar(least)
