"""Motion -> Composition: the motion of a point that moves on a moving body, in its parts, ground axes.

    v = v_t + v_r,             v_t = v_O + omega x r
    a = a_t + a_r + a_C,       a_t = a_O + epsilon x r + omega x (omega x r),      a_C = 2 omega x v_r

O is the origin of the body's frame, r goes from there to the point; the transport parts are those of the point of the
body that the moving point passes. In the body's frame a particle moves as if -m a_t and -m a_C acted on it.
"""

from __future__ import annotations

from eomgen.mechanics.bodies.kinematics import Motion
from eomgen.mechanics.fields.field import VelocityField, field_of
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import (
    IDENTITY,
    Matrix,
    Vector,
    apply,
    cross,
    minus,
    plus,
    times,
    transposed,
    vector_of,
)


@dataclass(frozen=True)
class Composition:
    """Where a point is, the field of the body from which it is seen, and how it moves against it.

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
        return apply(self.R, self.relative[1])

    @property
    def velocity(self) -> Vector:
        """v = v_t + v_r [m/s]"""
        return plus(self.transport_velocity, self.relative_velocity)

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
        return apply(self.R, self.relative[2])

    @property
    def coriolis(self) -> Vector:
        """a_C = 2 omega x v_r [m/s^2]"""
        return times(2, cross(self.carrier.w, self.relative_velocity))

    @property
    def acceleration(self) -> Vector:
        """a = a_t + a_r + a_C [m/s^2]"""
        return plus(self.transport_acceleration, plus(self.relative_acceleration, self.coriolis))


def composition_of(motion: Motion, point: str, body: str) -> Composition:
    """The motion of a point, seen from a body (or from the ground)."""
    scope = motion.scope
    owner, local = motion.place(point)
    place = motion.position((owner, local))
    R = body_axes(motion, body)
    if owner != body and body in motion.index:
        local = apply(transposed(R), minus(place, motion.link(body).pose.p))
    elif owner != body:
        local = place
    v = scope.rate_of(local)
    return Composition(place, field_of(motion, body), R, (local, v, vector_of(scope.with_accelerations(v))))


def body_axes(motion: Motion, body: str) -> Matrix:
    """The body's axes in the ground; of the ground its own."""
    return motion.link(body).pose.R if body in motion.index else IDENTITY
