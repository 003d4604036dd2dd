"""Motion -> Field: velocities and accelerations of all points of one rigid body, ground axes.

    v_P = v_O + omega x r,      a_P = a_O + epsilon x r + omega x (omega x r),      r from O to P

O is the origin of the body's frame. Accelerations hold the symbols a and are linear in them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from eomgen.errors import DerivationError
from eomgen.mechanics.bodies.kinematics import Motion
from eomgen.records import dataclass
from eomgen.symbolic.expression.derivative import substituted
from eomgen.symbolic.expression.functions import function, over, sqrt
from eomgen.symbolic.expression.graph import Node, Scalar
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector, apply, cross, dot, minus, plus, times, vector_of
from eomgen.symbolic.solve.solving import vanishes

UP: Vector = (0, 0, 1)


@dataclass(frozen=True)
class VelocityField:
    """The motion of one rigid body at a state, ground axes.

    Args:
        p, v, a: place, velocity and acceleration of its origin, 3.
        w, e: angular velocity and acceleration, 3.
    """

    p: Vector = ZERO
    v: Vector = ZERO
    a: Vector = ZERO
    w: Vector = ZERO
    e: Vector = ZERO

    def velocity(self, place: Vector) -> Vector:
        """v = v_O + omega x r of the point of the body that is now at the place [m/s]."""
        return plus(self.v, cross(self.w, minus(place, self.p)))

    def acceleration(self, place: Vector) -> Vector:
        """a = a_O + epsilon x r + omega x (omega x r) of the point of the body that is now at the place [m/s^2]."""
        return plus(self.a, plus(self.angular(place), self.centripetal(place)))

    def angular(self, place: Vector) -> Vector:
        """epsilon x r [m/s^2]"""
        return cross(self.e, minus(place, self.p))

    def centripetal(self, place: Vector) -> Vector:
        """omega x (omega x r) [m/s^2]"""
        return cross(self.w, cross(self.w, minus(place, self.p)))

    def at(self, state: Mapping[Node, Scalar]) -> VelocityField:
        """The field with the state's values put in."""
        if not state:
            return self
        vectors = (self.p, self.v, self.a, self.w, self.e)
        flat = iter(substituted([x for vector in vectors for x in vector], state))
        return VelocityField(*(vector_of(next(flat) for _ in range(3)) for _ in vectors))

    def against(self, other: VelocityField) -> VelocityField:
        """The field of velocities that another body sees, in ground axes: v - v_other, omega - omega_other."""
        return replace(self, v=minus(self.v, other.velocity(self.p)), w=minus(self.w, other.w))


def field_of(motion: Motion, body: str) -> VelocityField:
    """The field of a body of the model; of the ground it is zero."""
    if body not in motion.index:
        return VelocityField()
    link, scope = motion.link(body), motion.scope
    v = scope.rate_of(link.pose.p)
    w = link.twist.w if link.angle is not None else apply(link.pose.R, link.twist.w)
    rates = scope.with_accelerations((*v, *w))
    return VelocityField(link.pose.p, v, vector_of(rates[:3]), w, vector_of(rates[3:]))


# -- points and lines of a field -------------------------------------------------------------------


def rotation_center(field: VelocityField) -> Vector:
    """In the plane: the point of the body at rest, p_O + omega x v_O / omega^2.

    Raises:
        DerivationError: omega = 0 for good; what was left to say is that it translates or rests.
    """
    if vanishes(field.w[2]):
        state = "rests" if all(vanishes(x) for x in field.v) else "translates"
        raise DerivationError(
            f"the body {state}: it has no centre of rotation at a finite place", mend="ask while the body turns"
        )
    return plus(field.p, times(over(1, field.w[2]), cross(UP, field.v)))


def acceleration_pole(field: VelocityField) -> Vector:
    """In the plane: the point without acceleration, p_O + (omega^2 a_O + epsilon x a_O)/(omega^4 + epsilon^2).

    Raises:
        DerivationError: omega = epsilon = 0: all points have the same acceleration.
    """
    w, e = field.w[2], field.e[2]
    if vanishes(w) and vanishes(e):
        raise DerivationError(
            "omega = epsilon = 0: all points of the body have the same acceleration, it has no pole",
            mend="ask while the body turns",
        )
    arm = plus(times(w * w, field.a), cross(field.e, field.a))
    return plus(field.p, times(over(1, w * w * w * w + e * e), arm))


def axis_point(field: VelocityField) -> Vector:
    """In space: the point of the screw axis nearest to the origin of the body, p_O + omega x v_O / omega.omega."""
    return plus(field.p, times(over(1, dot(field.w, field.w)), cross(field.w, field.v)))


def least_speed(field: VelocityField, start: Vector, end: Vector, short: Callable[[Scalar], Scalar]) -> Scalar:
    """The least speed of the points between two points of the body.

    Along the segment only the component of v along h = omega x (end - start) changes, linearly from a to b:
        v^2 = v_0^2 + max(0, min(a, b), min(-a, -b))^2
    with v_0 the part of v across h. In the plane h is across the segment, and v_0 is the component along it: nothing
    is divided by omega.

    Args:
        start, end: the places of the two points.
        short: puts a scalar into readable form.
    Raises:
        DerivationError: they are the same.
    """
    along = minus(end, start)
    if all(vanishes(x) for x in along):
        raise DerivationError(
            "the two points are the same: they have no segment between them", mend="name two points that are apart"
        )
    v_start, v_end = field.velocity(start), field.velocity(end)
    planar = vanishes(field.w[0]) and vanishes(field.w[1]) and vanishes(along[2]) and vanishes(field.v[2])
    h = cross(UP, along) if planar else cross(field.w, along)
    if all(vanishes(x) for x in h):
        return sqrt(dot(v_start, v_start))
    square, a, b = short(dot(h, h)), short(dot(v_start, h)), short(dot(v_end, h))
    rest = short(dot(v_start, v_start) - over(a * a, square))
    if vanishes(a) or vanishes(b):
        return sqrt(rest)
    either = (function("max", 0, function("min", x, y)) for x, y in ((a, b), (-a, -b)))
    nearest = short(function("max", *either))
    return sqrt(rest + over(nearest * nearest, square))


def inflection_center(field: VelocityField) -> Vector:
    """The centre of the circle through the centre of rotation on which the points are whose path is straight there.

    In the plane, with r from the centre of rotation, whose acceleration is a_P:  r^2 = r . a_P / omega^2.
    """
    pole = rotation_center(field)
    return plus(pole, times(over(Fraction(1, 2), field.w[2] * field.w[2]), field.acceleration(pole)))
