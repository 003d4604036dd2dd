"""Rows of constraints."""

from __future__ import annotations

from eomgen.frozen import dataclass
from eomgen.model.forces.load import Couple, LoadContext, PointForce
from eomgen.model.joints.base import across
from eomgen.symbolic.expression import Fraction, Scalar, Vector
from eomgen.symbolic.numeric import tolerances


@dataclass(frozen=True)
class ConstraintRow:
    """One scalar row of a constraint.

    Args:
        pushes: forces and couples on the bodies for a unit of the row's multiplier; empty for an equation.
        gap: phi(q, t), 0 when the constraint holds; None where only the velocity row is given.
        rate: the row of an equation given in rates, 0 when it holds; with pushes, what it holds besides their dual.
            None elsewhere.
        component: name of the multiplier: "x", "y", "z", "n" (normal), "t" (along the contact), "couple",
            "tension", "wrench" (of an equation between points); "" for an equation of coordinates.
        material: the row sees the velocities of the bodies' material points, not of points that wander in them
            (rolling contacts, strings that leave a pulley).
        tangent: of a contact that has friction, the forces for a unit of friction; their dual is the sliding velocity.
        cross_tangent: of a contact on a surface the same along the second direction, across the first.
        round: of a bilateral contact on a line: N has this row's component and those of the rows before.
        part: what of the constraint the row belongs to, by name: the member of a truss; "" elsewhere.
        carrier: the body that carries all that the row holds together, from which its gap is seen; None: the ground.
        carried: the pushes in the axes of the carrier; () where that is the ground.
    """

    pushes: tuple[PointForce | Couple, ...]
    gap: Scalar | None
    rate: Scalar | None = None
    component: str = ""
    material: bool = False
    tangent: tuple[PointForce | Couple, ...] = ()
    cross_tangent: tuple[PointForce | Couple, ...] = ()
    part: str = ""
    round: bool = False
    carrier: str | None = None
    carried: tuple[PointForce | Couple, ...] = ()


@dataclass(frozen=True)
class Edge:
    """A function of the configuration, positive until a motion ends where it vanishes; what is so there, in words."""

    words: str
    vanishes: Scalar

    @property
    def left(self) -> Scalar:
        """Distance left to the edge, at which a motion ends."""
        return self.vanishes - Fraction(tolerances.AT_AN_EDGE)


def direction_of(scene: LoadContext, v: Vector) -> Vector:
    """v over its length; along an axis it is that axis, in the sense that v has with the model's values."""
    along = [k for k, x in enumerate(v) if not (type(x) is int and x == 0)]
    sense = scene.value_at_start(v[along[0]]) if len(along) == 1 else None
    if not sense:
        return v.unit
    x, y, z = ((1 if sense > 0 else -1) if k in along else 0 for k in range(3))
    return Vector((x, y, z))


def normals_of(scene: LoadContext, d: Vector) -> tuple[tuple[str, Vector], ...]:
    """Unit vectors across the unit vector d, with their names: in the plane its left normal, in space two."""
    if scene.plane:
        return (("n", Vector((-d[1], d[0], 0))),)
    first, second = (n.unit for n in across(d))
    return ("n 1", first), ("n 2", second)


def scene_axes(scene: LoadContext) -> tuple[Vector, ...]:
    """The ground's axes in which a point can be held: x, y, and in space z."""
    axes: tuple[Vector, ...] = (Vector((1, 0, 0)), Vector((0, 1, 0)), Vector((0, 0, 1)))
    return axes[:2] if scene.plane else axes


AXIS_NAMES = ("x", "y", "z")
"""The components of a held point, in the order of `scene_axes`."""
