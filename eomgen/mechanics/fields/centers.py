"""Field -> Center: the point about which a body turns in the plane, seen from the ground or from another body.

With v_0 the velocity of the body's point that is at the ground's origin, a point (x, y) has the velocity
(v_0x - w y, v_0y + w x). It is 0 at the homogeneous point

    c = (-v_0y : v_0x : w)

which is at infinity, across the velocity, where w = 0; c = 0 where nothing moves. The field is linear, hence so are
relative centres: c_ij = c_0j - c_0i, and any three centres c_ij, c_jk, c_ik are on one line (Aronhold, Kennedy).
"""

from __future__ import annotations

from eomgen.errors import DerivationError
from eomgen.mechanics.fields.field import VelocityField, rotation_center
from eomgen.symbolic.expression.spatial import ZERO, Vector
from eomgen.symbolic.solve.solving import vanishes

Homogeneous = Vector
"""(x : y : w), a point of the plane; w = 0 at infinity."""


def homogeneous_center(field: VelocityField) -> Homogeneous:
    """c = (-v_0y : v_0x : w) of a field."""
    v = field.velocity(ZERO)
    return (-v[1], v[0], field.w[2])


def finite_center(field: VelocityField, whose: str) -> Vector:
    """The centre of rotation where there is one in sight.

    Args:
        whose: the body, for messages.
    Raises:
        DerivationError: it is at infinity: a translation; or everywhere: a rest.
    """
    if not vanishes(field.w[2]):
        return rotation_center(field)
    if all(vanishes(x) for x in field.v):
        raise DerivationError(
            f"{whose} is at rest: every point is a centre of rotation", mend="ask while the body turns"
        )
    raise DerivationError(
        f"{whose} translates{_along(field.v)}: its centre of rotation is at infinity", mend="ask while the body turns"
    )


def _along(v: Vector) -> str:
    return " along y" if vanishes(v[0]) else " along x" if vanishes(v[1]) else ""
