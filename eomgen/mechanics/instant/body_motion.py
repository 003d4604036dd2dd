"""System, a state -> BodyMotion: what there is to say of the motion of each body at that state."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property

from eomgen.errors import DerivationError, MissingValues
from eomgen.mechanics.equations.system import System
from eomgen.mechanics.fields.field import (
    VelocityField,
    acceleration_pole,
    field_of,
    inflection_center,
    least_speed,
    rotation_center,
)
from eomgen.mechanics.fields.motion_kind import Kind, Kinds, instant_kind
from eomgen.model.trusses import is_node
from eomgen.records import dataclass
from eomgen.symbolic.exact.normal_form import Legibly
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.functions import sqrt
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.spatial import Vector, dot, minus
from eomgen.symbolic.numeric.work import Work

LARGE = 8000  # characters of a formula that is not made readable


@dataclass(frozen=True)
class Readable:
    """Values at a state, in readable form; what is very long stays as it is.

    Args:
        state: exact scalars in place of coordinates, speeds, accelerations and t; {} for functions of them.
        simple: how they are written.
    """

    state: Mapping[Node, Scalar]
    simple: Legibly

    def scalar(self, x: Scalar) -> Scalar:
        return self.simple(substituted((x,), self.state)[0])

    def vector(self, x: Vector) -> Vector:
        return self.simple.vector(substituted(x, self.state))

    def field(self, field: VelocityField) -> VelocityField:
        """The field at the state."""
        return VelocityField(*map(self.vector, (field.p, field.v, field.a, field.w, field.e)))


def readable_at(system: System, state: Mapping[Node, Scalar]) -> Readable:
    """The readable values of a system at a state."""
    return Readable(state, Legibly(Work.VALUE, system.scope.positive, LARGE))


@dataclass(frozen=True)
class BodyMotion:
    """The motion of one body at one state, exactly.

    Args:
        body: its name.
        field: velocities and accelerations.
        readable: puts scalars into the state.
        ends: (name, place) of both ends of a bar; () where it is none.
        plane: whether the motion is one in the plane.
        kind: the kind of motion in the long run; None where it is not known, or was not asked.
    """

    body: str
    field: VelocityField
    readable: Readable
    ends: tuple[tuple[str, Vector], ...] = ()
    plane: bool = True
    kind: Kind | None = None

    @cached_property
    def now(self) -> str:
        """The kind of the field at the state: rest, translation, rotation, helical motion."""
        return instant_kind(self.field)

    @cached_property
    def invariants(self) -> tuple[Scalar, Scalar]:
        """omega.omega and omega.v, the same at all points of the body."""
        w, v = self.field.w, self.field.v
        return self.readable.scalar(dot(w, w)), self.readable.scalar(dot(w, v))

    @cached_property
    def center(self) -> Vector | None:
        """In the plane, the point without velocity; None where there is none."""
        return self._found(rotation_center)

    @cached_property
    def pole(self) -> Vector | None:
        """In the plane, the point without acceleration; None where there is none."""
        return self._found(acceleration_pole)

    @cached_property
    def inflection(self) -> tuple[Vector, Scalar] | None:
        """In the plane, (centre, radius) of the circle of the points whose path is straight there."""
        middle = self._found(inflection_center)
        if middle is None or self.center is None:
            return None
        arm = self.readable.vector(minus(middle, self.center))
        return middle, self.readable.scalar(sqrt(dot(arm, arm)))

    @cached_property
    def slowest(self) -> tuple[str, str, Scalar] | None:
        """(end, end, least speed between) of a bar."""
        if not self.ends:
            return None
        (first, start), (last, end) = self.ends
        try:
            least = least_speed(self.field, start, end, self.readable.scalar)
        except DerivationError:  # both ends are one place
            return None
        return first, last, self.readable.scalar(least)

    def _found(self, find: Callable[[VelocityField], Vector]) -> Vector | None:
        try:
            return self.readable.vector(find(self.field)) if self.plane else None
        except DerivationError:  # there is no such point
            return None


def body_motions(
    system: System, state: Mapping[Node, Scalar], kinds: Kinds | None = None, bodies: Sequence[str] = ()
) -> tuple[BodyMotion, ...]:
    """The motion of the bodies, of all of them where none is named; nodes of trusses are none.

    Args:
        state: exact scalars in place of coordinates, speeds, accelerations and t; {}: as functions of them.
        kinds: gives the kinds of motion in the long run.
    """
    readable, plane = readable_at(system, state), system.scope.model.space == "plane"
    return tuple(
        BodyMotion(
            body,
            readable.field(field_of(system.motion, body)),
            readable,
            _ends(system, readable, body),
            plane,
            _kind(kinds, body),
        )
        for body in bodies or [link.name for link in system.motion.links if not is_node(link.name)]
    )


def _kind(kinds: Kinds | None, body: str) -> Kind | None:
    if kinds is None:
        return None
    try:
        return kinds.of(body)
    except (DerivationError, MissingValues):  # no motion near the start at which it could be tried
        return None


def _ends(system: System, readable: Readable, body: str) -> tuple[tuple[str, Vector], ...]:
    """Both ends of what has a `line`, or of a rod."""
    points, part = system.motion.points[body], system.scope.model.bodies[body]
    names = part.line or ("start", "end")
    if not set(names) <= points.keys():
        return ()
    return tuple((f"{body}.{name}", readable.vector(system.motion.position((body, points[name])))) for name in names)
