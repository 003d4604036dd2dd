"""Joints without constraint, welds, and motion in a plane.

Free: the joint does not constrain the child.
"""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import CONFIGURATION, FormulaRule, VectorRule
from eomgen.model.joints.ball import (
    Angles,
    Omega,
    QuaternionNames,
    Sequence,
    columns_of,
    other_space,
    rotation_of,
    turning_diagnostics,
    turning_moves,
)
from eomgen.model.joints.base import Column, Effort, Joint, Move, PushAlong, Scalars, X, Y, Z, angular, linear, vector
from eomgen.model.kinds import (
    Angle,
    ConstantAngle,
    Displacement,
    PlanarFriction,
    PlanarLimits,
    Restitution,
    SpaceDirection,
    ValueOf,
)
from eomgen.model.part import PartRule
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Matrix, Pose, Vector, as_expression, cos, sin

Position = Annotated[tuple[Expression, ...], VectorRule(FormulaRule("m", "", CONFIGURATION), length=3)]

IN_PLANE = ("x", "y", "angle")


@dataclass(frozen=True, kw_only=True)
class Free(Joint):
    """A free joint, which constrains nothing: `x`, `y`, `angle`; in space `position` and an orientation.

    In the plane s = (x, y, angle), as `planar` but with no wrench left in it.

    In space s = (position, angles or quaternion), X = (R, position), S = (0, R^T e_x), (0, R^T e_y), (0, R^T e_z),
    (columns as of `spherical`), W = (). A particle needs no orientation: s = position, in the plane (x, y), and R = 1.

    Args:
        x, y, angle: of `point` in the parent's axes [m], and of the child [rad] (plane).
        position: of `point` in the parent's axes, 3 [m] (space).
        orientation, angles, quaternion, omega: as of `spherical` (space).
    """

    kind: ClassVar[str] = "free"
    beside_orientation: ClassVar[tuple[str, ...]] = ()
    x: Displacement | None = None
    y: Displacement | None = None
    angle: Angle | None = None
    position: Position | None = None
    orientation: Sequence | None = None
    angles: Angles | None = None
    quaternion: QuaternionNames | None = None
    omega: Omega | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics unless all fields of this space are given, and no others."""
        plane = catalog.model.space == "plane"
        yield from other_space(self, ("position",) if plane else IN_PLANE, path, catalog.model.space)
        place, turn = (("x", "y"), ("angle",)) if plane else (("position",), ("orientation",))
        for key in place if _is_point(path, catalog) else (*place, *turn):
            if getattr(self, key) is None and (*path, key) not in catalog.broken:
                yield Diagnostic(path, f"the joint of body '{path[1]}' has no '{key}'", f"give '{key}'")
        yield from turning_diagnostics(self, path, catalog)

    @property
    def spins(self) -> tuple[str, ...]:
        return (self.omega or ()) if self.orientation == "quaternion" else ()

    def turns(self) -> tuple[Expression, ...]:
        if self.angles is not None:
            return self.angles
        names = self.quaternion or ()
        return tuple(as_expression(name) for name in names) or (() if self.angle is None else (self.angle,))

    def moves(self) -> tuple[Move, ...]:
        if self.position is None:
            turning: tuple[Move, ...] = () if self.angle is None else (Move(angle=self.angle),)
            return (Move(X, self.x), Move(Y, self.y), *turning)
        turning = () if self.orientation is None else turning_moves(self)
        return (*map(Move, (X, Y, Z), self.position), *turning)

    def variables(self, space: str) -> tuple[Expression, ...]:
        if space == "space":
            return (*(self.position or ()), *self.turns())
        return (*(e or Expression.number(0) for e in (self.x, self.y)), *self.turns())

    def turn(self, s: Scalars, value: ValueOf) -> Any:
        return s[2] if s[2:] else 0

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        if self.position is None:
            return in_plane((*s[:2], self.turn(s, value)))
        return Pose(self._rotation(s), Vector(s[:3]))

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        if self.position is None:
            return plane_subspace((*s[:2], self.turn(s, value)))[: len(s)]
        along = (linear(self._rotation(s).T @ e) for e in (X, Y, Z))
        return (*along, *(() if self.orientation is None else columns_of(self.orientation, s[3:])))

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return PLANE_COMPLEMENT if self.position is None else ()

    def efforts(self) -> tuple[Effort | None, ...]:
        return ()

    def _rotation(self, s: Scalars) -> Matrix:
        return Matrix.IDENTITY if self.orientation is None else rotation_of(self.orientation, s[3:])


def _is_point(path: DocumentPath, catalog: Catalog) -> bool:
    """True if the body has no extent that could turn: a particle, or a mass without inertia."""
    body = catalog.table("bodies").get(path[1])
    if body is None or body.inertia is not None or body.parts:
        return False
    return body.shape is None or body.shape.kind == "particle"


# -------- fixed -----------------------------------------------------------------------------------------------
# Fixed: the child does not move against its parent.


@dataclass(frozen=True, kw_only=True)
class Fixed(Joint):
    """A weld: no relative motion.

    f = 0, W = 1.

    Args:
        angle: at which it is welded, constant [rad].
        axis: about which; None: z.
    """

    kind: ClassVar[str] = "fixed"
    angle: ConstantAngle | None = None
    axis: SpaceDirection | None = None

    def turns(self) -> tuple[Expression, ...]:
        return ()

    def moves(self) -> tuple[Move, ...]:
        return (Move(self.axis, angle=self.angle),)

    def variables(self, space: str) -> tuple[Expression, ...]:
        return ()

    def turn(self, s: Scalars, value: ValueOf) -> Any:
        return 0 if self.angle is None else value(self.angle)

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        angle = self.turn(s, value)
        return Pose(Matrix.rotation(vector(self.axis, value, Z).unit, cos(angle), sin(angle)))

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return ()

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return (*map(angular, (X, Y, Z)), *map(linear, (X, Y, Z)))


# -------- planar ----------------------------------------------------------------------------------------------
# Planar: the child moves in a plane of its parent.


@dataclass(frozen=True, kw_only=True)
class Planar(Joint):
    """Motion in the x-y plane of the parent (its turned axes).

    s = (x, y, angle), X = ((x, y, 0), Rot(z, angle)).

    S = (0, R^T e_x), (0, R^T e_y), (e_z, 0); W: the torques about x and y, and the force along z.

    Args:
        x, y: of `point` in the turned axes [m].
        angle: of the child against the parent [rad].
        limits: rigid stops: { x = [least, largest], y = ..., angle = ... }, "inf" for none.
        restitution: of the stops: with this share of its speed it rebounds, 0 to 1 (None: not at all).
        friction: dry: { x = { force = F }, y = ..., angle = { torque = T } }, each with `static` or `smooth`.
    """

    limited: ClassVar[tuple[str, ...]] = ("x", "y", "angle")
    kind: ClassVar[str] = "planar"
    x: Displacement
    y: Displacement
    angle: Angle
    limits: Annotated[PlanarLimits, PartRule(PlanarLimits)] | None = None
    restitution: Restitution | None = None
    friction: Annotated[PlanarFriction, PartRule(PlanarFriction)] | None = None

    def turns(self) -> tuple[Expression, ...]:
        return (self.angle,)

    def moves(self) -> tuple[Move, ...]:
        return (Move(X, self.x), Move(Y, self.y), Move(angle=self.angle))

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.x, self.y, self.angle)

    def turn(self, s: Scalars, value: ValueOf) -> Any:
        return s[2]

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        return in_plane(s)

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return plane_subspace(s)

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return PLANE_COMPLEMENT

    def efforts(self) -> tuple[Effort | None, ...]:
        return (None, None, None)

    def pushes(self) -> tuple[PushAlong, ...]:
        law = self.friction
        ways = zip(self.variables(""), ("x", "y", "angle"), strict=True)
        return () if law is None else tuple(PushAlong(way=way, friction=getattr(law, name)) for way, name in ways)


PLANE_COMPLEMENT = (angular(X), angular(Y), linear(Z))


def in_plane(s: Scalars) -> Pose:
    """The pose at s = (x, y, angle)."""
    x, y, angle = s
    return Pose(Matrix.rotation(Z, cos(angle), sin(angle)), Vector((x, y, 0)))


def plane_subspace(s: Scalars) -> tuple[Column, ...]:
    """The columns of S of (x, y, angle), in the turned axes."""
    R_CP = in_plane(s).R.T
    return (linear(R_CP @ X), linear(R_CP @ Y), angular(Z))
