"""System, velocities, accelerations at one instant -> KinematicState: fields of bodies, points, the mechanism."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from typing import Any

from eomgen.errors import DerivationError, MissingValues
from eomgen.frozen import dataclass
from eomgen.mechanics.dynamics import EquationsOfMotion, System
from eomgen.mechanics.instant.mechanism import FoundPoint, Mechanism, PointPair, constructed
from eomgen.mechanics.instant.motion_kind import Kind, Kinds, instant_kind
from eomgen.mechanics.kinematics import (
    BodyLink,
    Motion,
    VelocityField,
)
from eomgen.mechanics.start import ScalarValues
from eomgen.model import is_node
from eomgen.symbolic.exact import Legibly
from eomgen.symbolic.expression import Matrix, Node, Scalar, State, Vector, substituted
from eomgen.symbolic.numeric import Work, tolerances
from eomgen.symbolic.print import text_size

SHORT = 400  # characters of all values of a state that a reader can take
LARGE = 4000  # characters of a value that is not made readable any more


@dataclass(frozen=True)
class KinematicState:
    """Velocities and accelerations of a system at one instant, as scalars of the parameters.

    Args:
        system: its bodies and constraints.
        moving: values of coordinates, speeds, time and inputs.
        accelerated: the same, with the accelerations; {} where they are not known.
        degrees_of_freedom: their number, from the rank of the constraints.
        formula: the same by counting, a number and its text.
        when: the instant in words.
        given: the given velocities and accelerations, as written.
        rate: the velocity that is left as a symbol, in terms of which all others are expressed; "" where all are known.
        symbol: of it.
        exact: True if the state is known in closed form.
        rounded: True if the accelerations are numbers although the state has a closed form.
        equations: the equations of motion; None where only the instant is known.
    """

    system: System
    moving: State
    accelerated: State
    degrees_of_freedom: int
    formula: tuple[int, str]
    when: str
    given: tuple[str, ...] = ()
    rate: str = ""
    symbol: Node | None = None
    exact: bool = True
    rounded: bool = False
    equations: EquationsOfMotion | None = None

    @property
    def state(self) -> State:
        """All known values, accelerations included where they are known."""
        return self.accelerated or self.moving

    @property
    def is_short(self) -> bool:
        """True if the state is known exactly, by formulas short enough to read."""
        return self.exact and not self.rounded and sum(map(text_size, self.state.values())) <= SHORT

    @property
    def plane(self) -> bool:
        return self.system.scope.model.space == "plane"

    # -- fields --------------------------------------------------------------------------------------

    @cached_property
    def fields(self) -> dict[str, VelocityField]:
        """Velocity field of every body; nodes of trusses are points, not bodies."""
        motion = self.system.motion
        bodies = [link.name for link in motion.links if not is_node(link.name)]
        return {name: motion.field(name).at(self.state) for name in bodies}

    @property
    def turning(self) -> dict[str, VelocityField]:
        """Velocity fields of the bodies that are no point masses."""
        links = self.system.motion.links
        points = {link.name for link in links if self.system.motion.is_particle(link)}
        return {name: field for name, field in self.fields.items() if name not in points}

    @cached_property
    def points(self) -> tuple[tuple[str, Vector, Vector, Vector | None], ...]:
        """(names, place, velocity, acceleration) of every named point; those of a hinge stand together."""
        links = self.system.motion.links
        named = [(name, *self._of(link.name, place)) for link in links for name, place in self._named(link)]
        found: list[tuple[list[str], int]] = []
        values = self._values([vectors for _, *vectors in named])
        for k, (name, *_) in enumerate(named):
            home = next((names for names, first in found if self._same(values[first], values[k])), None)
            if home is None:
                found.append(([name], k))
            else:
                home.append(name)
        return tuple((", ".join(names), *named[k][1:]) for names, k in found)

    def _values(self, named: Sequence[Sequence[Vector | None]]) -> list[list[Any]]:
        """Values of the vectors of every point; unknown vectors are left out."""
        flat = [[x for v in vectors if v is not None for x in v] for vectors in named]
        values = iter(self.values.of(x for vectors in flat for x in vectors))
        return [[next(values) for _ in vectors] for vectors in flat]

    def _same(self, one: Sequence[Any], other: Sequence[Any]) -> bool:
        return all(abs(x - y) < self.values.tolerance for x, y in zip(one, other, strict=True))

    def _named(self, link: BodyLink) -> Iterable[tuple[str, Vector]]:
        motion = self.system.motion
        if is_node(link.name):
            return [(link.name, Vector((0, 0, 0)))]
        own = motion.points[link.name]
        kept = [name for name in own if name != "origin"] or ["origin"]
        return [(f"{link.name}.{name}", own[name]) for name in kept]

    def _of(self, body: str, place: Vector) -> tuple[Vector, Vector, Vector | None]:
        """Place, velocity and acceleration of a place of a body, which may move in it."""
        scope = self.system.scope
        r = self.system.motion.position((body, place))
        v = scope.rate_of(r)
        a = self.put(scope.with_accelerations(v)) if self.accelerated else None
        return self.put(r), self.put(v), a

    def put(self, scalars: Sequence[Scalar]) -> Vector:
        """A vector at the instant, readable."""
        return self.simple.vector(substituted(tuple(scalars), self.state))

    @cached_property
    def simple(self) -> Legibly:
        """Scalars as a person writes them; as they are where they are very long."""
        return Legibly(Work.ANSWER, self.system.scope.positive, LARGE)

    def size(self, v: Vector) -> Scalar:
        """|v|"""
        return self.simple(v.length)

    @cached_property
    def values(self) -> ScalarValues:
        """Values of scalars at the model's parameters."""
        return ScalarValues(self.system.scope, tolerances.ZERO_AT_50 if self.exact else tolerances.COMPUTED)

    def number(self, x: Scalar) -> float | None:
        """Value of a scalar at the model's parameters; None where one that it needs has no value."""
        return self.values.number(x)

    # -- the mechanism -------------------------------------------------------------------------------

    @cached_property
    def mechanism(self) -> Mechanism | None:
        """Bodies with their centres of rotation, of a plane system; None in space."""
        return Mechanism(self.system, self.moving, self.values) if self.plane else None

    @cached_property
    def found(self) -> dict[PointPair, FoundPoint]:
        """The centres that a drawing finds, in its order."""
        return {} if self.mechanism is None else {each.pair: each for each in constructed(self.mechanism)}

    @property
    def disagreement(self) -> str:
        """The centres that the drawing finds elsewhere than the velocities; "" as it must be."""
        return ", ".join(f"({i}, {j})" for (i, j), each in self.found.items() if not each.agrees)


# -------- relative motion -------------------------------------------------------------------------------------
# Motion -> Composition: the motion of a point that moves on a moving body, in its parts, ground axes.
#
#     v = v_t + v_r,             v_t = v_O + omega x r
#     a = a_t + a_r + a_C,       a_t = a_O + epsilon x r + omega x (omega x r),      a_C = 2 omega x v_r
#
# O is the origin of the body's frame, r goes from there to the point; the transport parts are those of the point of
# the body that the moving point passes. In the body's frame a particle moves as if -m a_t and -m a_C acted on it.


@dataclass(frozen=True)
class Composition:
    """Motion of a point composed of the motion of a carrier body and the motion relative to that body.

    Args:
        place: of the point, ground axes.
        carrier: the field of the body.
        R: the body's axes in the ground.
        relative: place, velocity and acceleration of the point in the body's frame, body axes.
    """

    place: Vector
    carrier: VelocityField
    R: Matrix
    relative: tuple[Vector, Vector, Vector]

    @property
    def transport_velocity(self) -> Vector:
        """v_t = v_O + omega x r [m/s]"""
        return self.carrier.velocity(self.place)

    @property
    def relative_velocity(self) -> Vector:
        """v_r [m/s]"""
        return self.R @ self.relative[1]

    @property
    def velocity(self) -> Vector:
        """v = v_t + v_r [m/s]"""
        return self.transport_velocity + self.relative_velocity

    @property
    def transport_acceleration(self) -> Vector:
        """a_t = a_O + epsilon x r + omega x (omega x r) [m/s^2]"""
        return self.carrier.acceleration(self.place)

    @property
    def euler(self) -> Vector:
        """epsilon x r [m/s^2]"""
        return self.carrier.angular(self.place)

    @property
    def centripetal(self) -> Vector:
        """omega x (omega x r) [m/s^2]"""
        return self.carrier.centripetal(self.place)

    @property
    def relative_acceleration(self) -> Vector:
        """a_r [m/s^2]"""
        return self.R @ self.relative[2]

    @property
    def coriolis(self) -> Vector:
        """a_C = 2 omega x v_r [m/s^2]"""
        return 2 * self.carrier.w.cross(self.relative_velocity)

    @property
    def acceleration(self) -> Vector:
        """a = a_t + a_r + a_C [m/s^2]"""
        return self.transport_acceleration + (self.relative_acceleration + self.coriolis)


def composition_of(motion: Motion, point: str, body: str) -> Composition:
    """The motion of a point, seen from a body (or from the ground)."""
    scope = motion.scope
    owner, local = motion.place(point)
    place = motion.position((owner, local))
    R = body_axes(motion, body)
    if owner != body and body in motion.index:
        local = R.T @ (place - motion.link(body).pose.p)
    elif owner != body:
        local = place
    v = scope.rate_of(local)
    return Composition(place, motion.field(body), R, (local, v, Vector(scope.with_accelerations(v))))


def body_axes(motion: Motion, body: str) -> Matrix:
    """The body's axes in the ground; of the ground its own."""
    return motion.link(body).pose.R if body in motion.index else Matrix.IDENTITY


# -------- body motion -----------------------------------------------------------------------------------------
# System, a state -> BodyMotion: what there is to say of the motion of each body at that state.


LARGE_MOTION = 8000  # characters of a formula that is not made readable


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

    @staticmethod
    def of(system: System, state: Mapping[Node, Scalar]) -> Readable:
        """The readable values of a system at a state."""
        return Readable(state, Legibly(Work.VALUE, system.scope.positive, LARGE_MOTION))


@dataclass(frozen=True)
class BodyMotion:
    """The motion of one body at one state, exactly.

    Args:
        body: its name.
        field: velocities and accelerations.
        readable: puts scalars into the state.
        ends: (name, place) of both ends of a bar; () where it is none.
        plane: True for a motion in the plane.
        kind: the kind of motion in the long run; None where it is not known or was not requested.
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
        return self.readable.scalar(w @ w), self.readable.scalar(w @ v)

    @cached_property
    def center(self) -> Vector | None:
        """Instantaneous centre of rotation (the point without velocity) in the plane; None where there is none."""
        return self._found(VelocityField.rotation_center)

    @cached_property
    def pole(self) -> Vector | None:
        """Acceleration pole (the point without acceleration) in the plane; None where there is none."""
        return self._found(VelocityField.acceleration_pole)

    @cached_property
    def inflection(self) -> tuple[Vector, Scalar] | None:
        """Inflection circle in the plane, (centre, radius): its points move without curvature of their path there."""
        middle = self._found(VelocityField.inflection_center)
        if middle is None or self.center is None:
            return None
        arm = self.readable.vector(middle - self.center)
        return middle, self.readable.scalar(arm.length)

    @cached_property
    def slowest(self) -> tuple[str, str, Scalar] | None:
        """(end, end, least speed between) of a bar."""
        if not self.ends:
            return None
        (first, start), (last, end) = self.ends
        try:
            least = self.field.least_speed(start, end, self.readable.scalar)
        except DerivationError:  # both ends are one place
            return None
        return first, last, self.readable.scalar(least)

    def _found(self, find: Callable[[VelocityField], Vector]) -> Vector | None:
        try:
            return self.readable.vector(find(self.field)) if self.plane else None
        except DerivationError:  # there is no such point
            return None

    @staticmethod
    def all_of(
        system: System, state: Mapping[Node, Scalar], kinds: Kinds | None = None, bodies: Sequence[str] = ()
    ) -> tuple[BodyMotion, ...]:
        """The motion of the bodies, of all of them where none is named; nodes of trusses are none.

        Args:
            state: exact scalars in place of coordinates, speeds, accelerations and t; {}: as functions of them.
            kinds: gives the kinds of motion in the long run.
        """
        readable, plane = Readable.of(system, state), system.scope.model.space == "plane"
        return tuple(
            BodyMotion(
                body,
                readable.field(system.motion.field(body)),
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
    """Both ends of a body with a `line`, or of a rod."""
    points, part = system.motion.points[body], system.scope.model.bodies[body]
    names = part.line or ("start", "end")
    if not set(names) <= points.keys():
        return ()
    return tuple((f"{body}.{name}", readable.vector(system.motion.position((body, points[name])))) for name in names)
