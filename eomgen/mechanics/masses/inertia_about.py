"""System -> the inertia tensor and the angular momentum of bodies about a point, in ground axes.

With r from the point P, over the mass of the bodies that are meant:

    tensor    I_P = integral (r.r 1 - r r^T) dm = sum (R I_C R^T + m (d.d 1 - d d^T)),   d = C - P   (parallel axes)
    angular momentum   L_P = sum (R I_C R^T w + m d x v_C)
"""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.mechanics.bodies.inertia import mass_properties
from eomgen.mechanics.bodies.kinematics import Motion, velocity_of
from eomgen.model.composite import about
from eomgen.model.shapes import MassProperties
from eomgen.symbolic.expression.graph import is_zero
from eomgen.symbolic.expression.spatial import (
    ZERO,
    Matrix,
    Vector,
    added,
    apply,
    cross,
    minus,
    plus,
    product,
    times,
    transposed,
)


def in_ground(motion: Motion, body: str) -> MassProperties:
    """The mass properties of a body where it is: mass centre from the ground's origin, inertia in ground axes."""
    own, pose = mass_properties(motion.scope, body), motion.link(body).pose
    return MassProperties(own.m, pose.point(own.com), product(product(pose.R, own.I), transposed(pose.R)))


def tensor_about(motion: Motion, point: Vector, bodies: Sequence[str]) -> Matrix:
    """I_P of the bodies together, ground axes."""
    total: Matrix = (ZERO, ZERO, ZERO)
    for body in bodies:
        total = added(total, about(in_ground(motion, body), point))
    return total


def angular_momentum(motion: Motion, point: Vector, bodies: Sequence[str]) -> Vector:
    """L_P of the bodies together, of the velocities against the ground, ground axes [kg m^2/s]."""
    total: Vector = ZERO
    for body in bodies:
        link, mass = motion.link(body), in_ground(motion, body)
        velocity = velocity_of(motion, (body, mass_properties(motion.scope, body).com))
        spin = apply(mass.I, apply(link.pose.R, link.twist.w))
        total = plus(total, plus(spin, times(mass.m, cross(minus(mass.com, point), velocity))))
    return total


# -- what is not known ------------------------------------------------------------------------------


def flat_bodies(motion: Motion, bodies: Sequence[str]) -> tuple[str, ...]:
    """The bodies of a plane model of which only the moment about z is known: those given by `inertia`."""
    scope = motion.scope
    if scope.model.space != "plane":
        return ()
    given = [body for body in bodies if scope.model.bodies[body].inertia is not None]
    return tuple(body for body in given if not is_zero(mass_properties(scope, body).I[2][2]))


def shapeless(motion: Motion, bodies: Sequence[str]) -> tuple[str, ...]:
    """The bodies that have a mass and say nothing of its inertia."""
    parts = motion.scope.model.bodies
    silent = [b for b in bodies if parts[b].shape is None and parts[b].parts is None and parts[b].inertia is None]
    return tuple(body for body in silent if not is_zero(mass_properties(motion.scope, body).m))
