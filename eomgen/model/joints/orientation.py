"""Orientation in space over any scalar: three angles about the body's own successive axes, or a unit quaternion.

For the sequence "zxz" with angles psi, theta, phi: R = Rz(psi) Rx(theta) Rz(phi), child to parent. A quaternion
e = (e0, e1, e2, e3), scalar first, child to parent, moves with the child's angular velocity w in its own axes:

    e' = 1/2 e o (0, w),    w = 2 Im(e* o e'),    e . e = 1
"""

from collections.abc import Iterable, Iterator
from itertools import product as combinations
from typing import Annotated, Any

from eomgen.model.catalog import Catalog
from eomgen.model.containers import ListRule
from eomgen.model.fields import CONFIGURATION, FormulaRule, NameRule, TextRule
from eomgen.model.findings import Finding
from eomgen.model.joints.base import Column, X, Y, Z, angular
from eomgen.model.joints.moves import Move, QuaternionTurn, TurnAbout
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import cos, sin
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import IDENTITY, Matrix, Vector, apply, product, rotation, transposed

HALF = Fraction(1, 2)
AXES = {"x": X, "y": Y, "z": Z}
SEQUENCES = tuple("".join(s) for s in combinations("xyz", repeat=3) if s[0] != s[1] != s[2])

Sequence = Annotated[str, TextRule((*SEQUENCES, "quaternion"))]
Angles = Annotated[tuple[Expression, ...], ListRule(FormulaRule("rad", "", CONFIGURATION), 3, 3)]
QuaternionNames = Annotated[tuple[str, ...], ListRule(NameRule("coordinate"), 4, 4)]
Omega = Annotated[tuple[str, ...], ListRule(NameRule("speed"), 3, 3)]

TURNING = ("orientation", "angles", "quaternion", "omega")


def other_space(joint: Any, keys: Iterable[str], path: DocumentPath, space: str) -> Iterator[Finding]:
    """Fields that mean nothing in this space."""
    for key in keys:
        if getattr(joint, key) is not None:
            what = f"'{key}' of a {joint.kind} joint is for {'space' if space == 'plane' else 'the plane'}"
            yield Finding((*path, key), what, "leave it out", key=True)


def turning_findings(joint: Any, path: DocumentPath, catalog: Catalog) -> Iterator[Finding]:
    """Of a joint that turns in space: no fields of it in the plane; in space those that its orientation needs."""
    if catalog.model.space == "plane":
        yield from other_space(joint, TURNING, path, "plane")
    else:
        yield from _orientation(joint, path, catalog)


def _orientation(joint: Any, path: DocumentPath, catalog: Catalog) -> Iterator[Finding]:
    """A sequence goes with three angles, "quaternion" with four names and the names of three speeds."""
    orientation, name = joint.orientation, path[1]
    if orientation is None:
        for key in ("angles", "quaternion"):
            if getattr(joint, key) is not None and (*path, "orientation") not in catalog.broken:
                yield Finding(
                    path,
                    f"the joint of body '{name}' has '{key}' but no 'orientation'",
                    f'orientation = "{"zxz" if key == "angles" else key}"',
                )
        return
    needed, other = ("angles", "quaternion") if orientation in SEQUENCES else ("quaternion", "angles")
    if getattr(joint, needed) is None and (*path, needed) not in catalog.broken:
        yield Finding((*path, "orientation"), f"orientation \"{orientation}\" needs '{needed}'", f"give '{needed}'")
    for key in (other, *joint.beside_orientation, *(("omega",) if needed == "angles" else ())):
        if getattr(joint, key) is not None:
            what = f"'{key}' does not go with orientation \"{orientation}\""
            mend = (
                "leave it out"
                if key != "omega"
                else "take orientation = \"quaternion\", or speeds of a declared 'rate'"
            )
            yield Finding((*path, key), what, mend, key=True)
    if needed == "quaternion" and joint.omega is None and (*path, "omega") not in catalog.broken:
        yield Finding((*path, "orientation"), "a quaternion needs 'omega'", 'omega = ["w1", "w2", "w3"], of [speeds]')


def turning_moves(joint: Any) -> tuple[Move, ...]:
    """The turns of a joint's orientation, as they are declared."""
    if joint.quaternion is not None:
        return (QuaternionTurn(joint.quaternion),)
    return tuple(TurnAbout(AXES[axis], angle) for axis, angle in zip(joint.orientation, joint.angles, strict=True))


def rotation_by(sequence: str, angles: tuple[Any, ...]) -> Matrix:
    """R = R1(a1) R2(a2) R3(a3), child to parent."""
    R = IDENTITY
    for axis, angle in zip(sequence, angles, strict=True):
        R = product(R, rotation(AXES[axis], cos(angle), sin(angle)))
    return R


def turning_columns(sequence: str, angles: tuple[Any, ...]) -> tuple[Column, ...]:
    """The columns of S of the three angles, child's axes: each axis seen through the turns after it."""
    columns = []
    for k, axis in enumerate(sequence):
        after = rotation_by(sequence[k + 1 :], angles[k + 1 :])
        columns.append(angular(apply(transposed(after), AXES[axis])))
    return tuple(columns)


def rotation_of(orientation: str, s: tuple[Any, ...]) -> Matrix:
    """R at the angles of a sequence, or at a quaternion of norm 1."""
    return _by_quaternion(s) if orientation == "quaternion" else rotation_by(orientation, s)


def columns_of(orientation: str, s: tuple[Any, ...]) -> tuple[Column, ...]:
    """The columns of S: of the rates of the angles, or of the angular velocity by which a quaternion moves."""
    if orientation == "quaternion":
        return (angular(X), angular(Y), angular(Z))
    return turning_columns(orientation, s)


def _by_quaternion(e: tuple[Any, ...]) -> Matrix:
    """R = (e0^2 - v.v) 1 + 2 v v^T + 2 e0 v~, v = (e1, e2, e3); where e . e = 1 it is a rotation."""
    e0, e1, e2, e3 = e
    return (
        (e0 * e0 + e1 * e1 - e2 * e2 - e3 * e3, 2 * (e1 * e2 - e0 * e3), 2 * (e1 * e3 + e0 * e2)),
        (2 * (e1 * e2 + e0 * e3), e0 * e0 - e1 * e1 + e2 * e2 - e3 * e3, 2 * (e2 * e3 - e0 * e1)),
        (2 * (e1 * e3 - e0 * e2), 2 * (e2 * e3 + e0 * e1), e0 * e0 - e1 * e1 - e2 * e2 + e3 * e3),
    )


def spin_of_quaternion(e: tuple[Any, ...], rate: tuple[Any, ...]) -> Vector:
    """w = 2 Im(e* o e'), child's axes."""
    (e0, e1, e2, e3), (d0, d1, d2, d3) = e, rate
    return (
        2 * (e0 * d1 - e1 * d0 - e2 * d3 + e3 * d2),
        2 * (e0 * d2 - e2 * d0 - e3 * d1 + e1 * d3),
        2 * (e0 * d3 - e3 * d0 - e1 * d2 + e2 * d1),
    )


def rate_matrix_of(e: tuple[Any, ...]) -> tuple[Vector, Vector, Vector, Vector]:
    """The rows of e' = G w: half the quaternion's products with the units i, j, k."""
    e0, e1, e2, e3 = (HALF * x for x in e)
    return ((-e1, -e2, -e3), (e0, -e3, e2), (e3, e0, -e1), (-e2, e1, e0))
