"""System -> Kind: what kind of motion a body makes, from its field of velocities along every possible motion.

Two invariants belong to a field: omega.omega and omega.v. Where omega vanishes the body translates; where its direction
stays and omega.v vanishes it moves in parallel planes; where moreover its axis stays,

    c = p + omega x v / omega.omega,     c' along omega,

it turns about that axis, and moves helically where omega.v does not vanish: by the pitch omega.v/omega.omega a radian.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

from eomgen.mechanics.equations.system import System
from eomgen.mechanics.fields.curves import Constants, Curve, curve_of
from eomgen.mechanics.fields.field import VelocityField, axis_point, field_of
from eomgen.mechanics.fields.possible import Possible
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.spatial import Vector, apply, cross, dot, minus, plus, times, transposed
from eomgen.symbolic.solve.solving import vanishes

REST, TRANSLATION, ROTATION, PLANE = "rest", "translation", "rotation about a fixed axis", "plane motion"
HELICAL, SLIDING = "helical motion", "rotation about a fixed axis and sliding along it"
SPHERICAL, GENERAL = "rotation about a fixed point", "general motion"
WAYS = {"line": "rectilinear translation", "circle": "circular translation", "curve": "curvilinear translation"}


@dataclass(frozen=True)
class Kind:
    """The kind of motion of a body.

    Args:
        name: in words.
        at: a point of the axis, the fixed point; None where there is none, or none in closed form.
        axis: direction of the axis, of the normal of the planes.
        pitch: advance along the axis per radian.
        way: of a translation, the line on which its points run.
        point: the body's point that is there, by name, "" where it has none.
    """

    name: str
    at: Vector | None = None
    axis: Vector | None = None
    pitch: Scalar | None = None
    way: Curve | None = None
    point: str = ""


@dataclass(frozen=True)
class Kinds:
    """The kinds of motion of the bodies of a system.

    Args:
        system: the system.
        start: an exact state of its motion, or {}.
    """

    system: System
    start: Mapping[Node, Scalar]

    @cached_property
    def possible(self) -> Possible:
        return Possible(self.system)

    @cached_property
    def constants(self) -> Constants:
        return Constants(self.possible, self.start, self.system.scope.positive)

    def of(self, body: str) -> Kind:
        """The kind of motion of one body.

        Raises:
            DerivationError: the ties do not close, or the motion is singular near the start.
        """
        field, vanish = field_of(self.system.motion, body), self.possible.vanish
        if vanish(*field.w):
            if vanish(*field.v):
                return Kind(REST)
            way = curve_of(field.p, self.possible, self.constants)
            return Kind(WAYS[way.kind], way=way)
        if vanish(*cross(field.w, field.e)):
            return self._about_one_direction(body, field)
        return self._in_all_directions(body, field)

    def _about_one_direction(self, body: str, field: VelocityField) -> Kind:
        """omega keeps its direction."""
        vanish, possible = self.possible.vanish, self.possible
        axis = self._direction(field.w)
        planar = vanish(dot(field.w, field.v))
        center = axis_point(field)
        if not vanish(*cross(possible.rate_of(center), field.w)):
            return Kind(PLANE if planar else GENERAL, axis=axis)
        if planar:
            return Kind(ROTATION, self.constants.vector(center), axis, point=self._named(body, field))
        pitch = over(dot(field.w, field.v), dot(field.w, field.w))
        if not vanish(*possible.rate((pitch,))):
            return Kind(SLIDING, self._on_axis(center, field.w), axis)
        return Kind(HELICAL, self._on_axis(center, field.w), axis, self.constants.of(pitch))

    def _in_all_directions(self, body: str, field: VelocityField) -> Kind:
        """omega turns: a point of the body may still stay."""
        place = fixed_point(field)
        if self.possible.vanish(*field.velocity(place), *self.possible.rate(place)):
            return Kind(SPHERICAL, self.constants.vector(place), point=self._named(body, field))
        return Kind(GENERAL)

    def _direction(self, w: Vector) -> Vector | None:
        """A constant vector along omega, whose first component that does not vanish is 1."""
        for component in w:
            if not self.possible.vanish(component):
                return self.constants.vector(times(over(1, component), w))
        return None

    def _on_axis(self, center: Vector, w: Vector) -> Vector | None:
        """The point of a fixed axis nearest to the ground's origin."""
        return self.constants.vector(minus(center, times(over(dot(center, w), dot(w, w)), w)))

    def _named(self, body: str, field: VelocityField) -> str:
        """The body's first point that stays where it is: `bar.start`; "" where none has a name."""
        motion = self.system.motion
        for name, local in motion.points[body].items():
            if not motion.moves(local) and self.possible.vanish(*field.velocity(motion.position((body, local)))):
                return f"{body}.{name}"
        return ""


def fixed_point(field: VelocityField) -> Vector:
    """The point of a body whose velocity and acceleration vanish together, where there is one and omega turns.

    v + omega x r = 0 gives r but for its part along omega, and a + epsilon x r + omega x (omega x r) = 0 that one.
    """
    w, e = field.w, field.e
    across = times(over(1, dot(w, w)), cross(w, field.v))
    turning = cross(e, w)
    left = plus(field.a, plus(cross(e, across), cross(w, cross(w, across))))
    along = over(-dot(left, turning), dot(turning, turning))
    return plus(field.p, plus(across, times(along, w)))


# -- at one instant --------------------------------------------------------------------------------


def instant_kind(field: VelocityField) -> str:
    """The kind of a field at one instant: rest, translation, rotation, helical motion."""
    if all(vanishes(x) for x in field.w):
        return REST if all(vanishes(x) for x in field.v) else TRANSLATION
    return "rotation" if vanishes(dot(field.w, field.v)) else HELICAL


def in_body(system: System, body: str, place: Vector) -> Vector:
    """A place of the ground seen from a body, in its axes [m]."""
    pose = system.motion.link(body).pose
    return apply(transposed(pose.R), minus(place, pose.p))
