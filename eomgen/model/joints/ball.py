"""Orientation in space, the ball joint and the universal joint."""

from collections.abc import Iterable, Iterator
from itertools import product as combinations
from typing import Annotated, Any, ClassVar, NamedTuple

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.fields import CONFIGURATION, FormulaRule, ListRule, NameRule, TextRule, VectorRule
from eomgen.model.joints.base import Column, Joint, Move, Scalars, X, Y, Z, angular, linear, vector
from eomgen.model.kinds import Restitution, TurnsLimits, ValueOf
from eomgen.model.part import PartRule
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Fraction, Matrix, Pose, Vector, as_expression, cos, sin

# -------- orientation -----------------------------------------------------------------------------------------
# Orientation in space over any scalar: three angles about the body's own successive axes, or a unit quaternion.
#
# For the sequence "zxz" with angles psi, theta, phi: R = Rz(psi) Rx(theta) Rz(phi), child to parent. A quaternion e =
# (e0, e1, e2, e3), scalar first, child to parent, moves with the child's angular velocity w in its own axes:
#
#     e' = 1/2 e o (0, w),    w = 2 Im(e* o e'),    e . e = 1


HALF = Fraction(1, 2)
AXES = {"x": X, "y": Y, "z": Z}
SEQUENCES = tuple("".join(s) for s in combinations("xyz", repeat=3) if s[0] != s[1] != s[2])

Sequence = Annotated[str, TextRule((*SEQUENCES, "quaternion"))]
Angles = Annotated[tuple[Expression, ...], ListRule(FormulaRule("rad", "", CONFIGURATION), 3, 3)]
QuaternionNames = Annotated[tuple[str, ...], ListRule(NameRule("coordinate"), 4, 4)]
Omega = Annotated[tuple[str, ...], ListRule(NameRule("speed"), 3, 3)]

TURNING = ("orientation", "angles", "quaternion", "omega")


def other_space(joint: Any, keys: Iterable[str], path: DocumentPath, space: str) -> Iterator[Diagnostic]:
    """Diagnostics of fields that mean nothing in this space."""
    for key in keys:
        if getattr(joint, key) is not None:
            what = f"'{key}' of a {joint.kind} joint is for {'space' if space == 'plane' else 'the plane'}"
            yield Diagnostic((*path, key), what, "leave it out", key=True)


def turning_diagnostics(joint: Any, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of a joint that turns in space: fields of it in the plane; in space, an incomplete orientation."""
    if catalog.model.space == "plane":
        yield from other_space(joint, TURNING, path, "plane")
    else:
        yield from _orientation(joint, path, catalog)


def _orientation(joint: Any, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
    """Diagnostics of an orientation that is incomplete or has fields of another one.

    A sequence goes with three angles, "quaternion" with four names and the names of three speeds.
    """
    orientation, name = joint.orientation, path[1]
    if orientation is None:
        for key in ("angles", "quaternion"):
            if getattr(joint, key) is not None and (*path, "orientation") not in catalog.broken:
                yield Diagnostic(
                    path,
                    f"the joint of body '{name}' has '{key}' but no 'orientation'",
                    f'orientation = "{"zxz" if key == "angles" else key}"',
                )
        return
    needed, other = ("angles", "quaternion") if orientation in SEQUENCES else ("quaternion", "angles")
    if getattr(joint, needed) is None and (*path, needed) not in catalog.broken:
        yield Diagnostic((*path, "orientation"), f"orientation \"{orientation}\" needs '{needed}'", f"give '{needed}'")
    for key in (other, *joint.beside_orientation, *(("omega",) if needed == "angles" else ())):
        if getattr(joint, key) is not None:
            what = f"'{key}' does not go with orientation \"{orientation}\""
            fix = (
                "leave it out"
                if key != "omega"
                else "take orientation = \"quaternion\", or speeds of a declared 'rate'"
            )
            yield Diagnostic((*path, key), what, fix, key=True)
    if needed == "quaternion" and joint.omega is None and (*path, "omega") not in catalog.broken:
        yield Diagnostic(
            (*path, "orientation"), "a quaternion needs 'omega'", 'omega = ["w1", "w2", "w3"], of [speeds]'
        )


def turning_moves(joint: Any) -> tuple[Move, ...]:
    """The turns of a joint's orientation, as they are declared."""
    if joint.quaternion is not None:
        return (Move(quaternion=joint.quaternion),)
    return tuple(Move(AXES[axis], angle=angle) for axis, angle in zip(joint.orientation, joint.angles, strict=True))


def rotation_by(sequence: str, angles: tuple[Any, ...]) -> Matrix:
    """R = R1(a1) R2(a2) R3(a3), child to parent."""
    R = Matrix.IDENTITY
    for axis, angle in zip(sequence, angles, strict=True):
        R = R @ Matrix.rotation(AXES[axis], cos(angle), sin(angle))
    return R


def turning_columns(sequence: str, angles: tuple[Any, ...]) -> tuple[Column, ...]:
    """The columns of S of the three angles, child's axes: each axis seen through the turns after it."""
    columns = []
    for k, axis in enumerate(sequence):
        after = rotation_by(sequence[k + 1 :], angles[k + 1 :])
        columns.append(angular(after.T @ AXES[axis]))
    return tuple(columns)


def rotation_of(orientation: str, s: tuple[Any, ...]) -> Matrix:
    """R at the angles of a sequence, or at a quaternion of norm 1."""
    return UnitQuaternion(*s).rotation if orientation == "quaternion" else rotation_by(orientation, s)


def columns_of(orientation: str, s: tuple[Any, ...]) -> tuple[Column, ...]:
    """The columns of S: of the rates of the angles, or of the angular velocity by which a quaternion moves."""
    if orientation == "quaternion":
        return (angular(X), angular(Y), angular(Z))
    return turning_columns(orientation, s)


class UnitQuaternion(NamedTuple):
    """e0, e1, e2, e3, scalar first, child to parent, of norm 1."""

    e0: Any
    e1: Any
    e2: Any
    e3: Any

    @property
    def rotation(self) -> Matrix:
        """R = (e0^2 - v.v) 1 + 2 v v^T + 2 e0 v~, v = (e1, e2, e3); where e . e = 1 it is a rotation."""
        e0, e1, e2, e3 = self
        return Matrix.of(
            (
                (e0 * e0 + e1 * e1 - e2 * e2 - e3 * e3, 2 * (e1 * e2 - e0 * e3), 2 * (e1 * e3 + e0 * e2)),
                (2 * (e1 * e2 + e0 * e3), e0 * e0 - e1 * e1 + e2 * e2 - e3 * e3, 2 * (e2 * e3 - e0 * e1)),
                (2 * (e1 * e3 - e0 * e2), 2 * (e2 * e3 + e0 * e1), e0 * e0 - e1 * e1 - e2 * e2 + e3 * e3),
            )
        )

    def spin(self, rates: tuple[Any, ...]) -> Vector:
        """w = 2 Im(e* o e'), child's axes."""
        (e0, e1, e2, e3), (d0, d1, d2, d3) = self, rates
        return Vector(
            (
                2 * (e0 * d1 - e1 * d0 - e2 * d3 + e3 * d2),
                2 * (e0 * d2 - e2 * d0 - e3 * d1 + e1 * d3),
                2 * (e0 * d3 - e3 * d0 - e1 * d2 + e2 * d1),
            )
        )

    @property
    def rates_by_spin(self) -> tuple[Vector, Vector, Vector, Vector]:
        """The rows of e' = G w: half the quaternion's products with the units i, j, k."""
        e0, e1, e2, e3 = (HALF * x for x in self)
        return (Vector((-e1, -e2, -e3)), Vector((e0, -e3, e2)), Vector((e3, e0, -e1)), Vector((-e2, e1, e0)))


# -------- spherical -------------------------------------------------------------------------------------------
# Spherical: a ball joint.


@dataclass(frozen=True, kw_only=True)
class Spherical(Joint):
    """A ball joint: the child turns about the joint point.

    s = the angles or the quaternion; W: all forces. S takes the rates of the angles, or the angular
    velocity by which the quaternion moves.

    Args:
        orientation: "zxz", "xyz", ...: turns about the body's own successive axes; zxz: R = Rz(psi) Rx(theta) Rz(phi),
            child to parent; or "quaternion".
        angles: of these turns [rad].
        quaternion: names of its four coordinates, scalar first.
        omega: names of the speeds: the child's angular velocity against the parent, child's axes [rad/s].
        limits: rigid stops of the angles: { angles = [[least, largest], ...] }, "inf" for none.
        restitution: of the stops: with this share of its speed it rebounds, 0 to 1 (None: not at all).
    """

    limited: ClassVar[tuple[str, ...]] = ("angles1", "angles2", "angles3")
    kind: ClassVar[str] = "spherical"
    only_space: ClassVar[bool] = True
    beside_orientation: ClassVar[tuple[str, ...]] = ()
    orientation: Sequence
    angles: Angles | None = None
    quaternion: QuaternionNames | None = None
    omega: Omega | None = None
    limits: Annotated[TurnsLimits, PartRule(TurnsLimits)] | None = None
    restitution: Restitution | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        yield from turning_diagnostics(self, path, catalog)
        if self.limits is not None and self.angles is None:
            what = "limits are of angles, and this joint turns by a quaternion"
            yield Diagnostic((*path, "limits"), what, 'orientation = "xyz" and three angles', key=True)
        elif self.limits is not None:
            yield from _each_angle(self, path)

    @property
    def spins(self) -> tuple[str, ...]:
        return (self.omega or ()) if self.orientation == "quaternion" else ()

    def turns(self) -> tuple[Expression, ...]:
        return self.angles or tuple(as_expression(name) for name in self.quaternion or ())

    def moves(self) -> tuple[Move, ...]:
        return turning_moves(self)

    def variables(self, space: str) -> tuple[Expression, ...]:
        return self.turns()

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        return Pose(rotation_of(self.orientation, s))

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return columns_of(self.orientation, s)

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return tuple(map(linear, (X, Y, Z)))


# -------- universal -------------------------------------------------------------------------------------------
# Universal: a Cardan joint, two turns about axes that cross.


TwoAxes = Annotated[
    tuple[tuple[Expression, ...], ...], ListRule(VectorRule(FormulaRule(), length=3, nonzero=True), 2, 2)
]
TwoAngles = Annotated[tuple[Expression, ...], ListRule(FormulaRule("rad", "", CONFIGURATION), 2, 2)]


@dataclass(frozen=True, kw_only=True)
class Universal(Joint):
    """Two rotations: about an axis of the parent, then about one of the child; the two must not be parallel.

    s = (a, b), R = Rot(n1, a) Rot(n2, b); S = (Rot(n2, b)^T n1, 0), (n2, 0); W: all forces, one torque.

    Args:
        axes: n1 fixed in the (turned) parent, n2 fixed in the child; at angles 0 the axes of both agree.
        angles: a and b [rad].
        limits: rigid stops of the angles: { angles = [[least, largest], [least, largest]] }, "inf" for none.
        restitution: of the stops: with this share of its speed it rebounds, 0 to 1 (None: not at all).
    """

    limited: ClassVar[tuple[str, ...]] = ("angles1", "angles2")
    kind: ClassVar[str] = "universal"
    only_space: ClassVar[bool] = True
    axes: TwoAxes
    angles: TwoAngles
    limits: Annotated[TurnsLimits, PartRule(TurnsLimits)] | None = None
    restitution: Restitution | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        """Diagnostics of limits that are not one of each angle."""
        if self.limits is not None:
            yield from _each_angle(self, path)

    def turns(self) -> tuple[Expression, ...]:
        return self.angles

    def moves(self) -> tuple[Move, ...]:
        return tuple(Move(axis, angle=angle) for axis, angle in zip(self.axes, self.angles, strict=True))

    def variables(self, space: str) -> tuple[Expression, ...]:
        return self.angles

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        first, _ = self._normals(value)
        return Pose(Matrix.rotation(first, cos(s[0]), sin(s[0])) @ self._second(s, value))

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        first, second = self._normals(value)
        return (angular(self._second(s, value).T @ first), angular(second))

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        (*first, _, _, _), (*second, _, _, _) = self.subspace(s, value)
        return (angular(Vector(tuple(first)).cross(Vector(tuple(second)))), *map(linear, (X, Y, Z)))

    def _normals(self, value: ValueOf) -> tuple[Vector, Vector]:
        first, second = (vector(axis, value).unit for axis in self.axes)
        return first, second

    def _second(self, s: Scalars, value: ValueOf) -> Matrix:
        """The turn about the axis of the child."""
        _, second = self._normals(value)
        return Matrix.rotation(second, cos(s[1]), sin(s[1]))


def _each_angle(joint: Spherical | Universal, path: DocumentPath) -> Iterator[Diagnostic]:
    """Diagnostics of limits that are fewer or more than the angles of their joint."""
    given, angles = getattr(joint.limits, "angles", None), joint.angles or ()
    if given is not None and len(given) != len(angles):
        what = f"limits of {len(given)} angles, and the joint has {len(angles)}"
        yield Diagnostic((*path, "limits", "angles"), what, 'one pair for each, ["-inf", "inf"] for none')
