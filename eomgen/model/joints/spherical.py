"""Spherical: a ball joint."""

from collections.abc import Iterator
from typing import ClassVar

from eomgen.model.catalog import Catalog
from eomgen.model.findings import Finding
from eomgen.model.joints.base import Column, Joint, Scalars, X, Y, Z, linear
from eomgen.model.joints.moves import Move
from eomgen.model.joints.orientation import (
    Angles,
    Omega,
    QuaternionNames,
    Sequence,
    columns_of,
    rotation_of,
    turning_findings,
    turning_moves,
)
from eomgen.model.kinds import ValueOf
from eomgen.model.positions import DocumentPath
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression, as_expression
from eomgen.symbolic.expression.spatial import Pose


@dataclass(frozen=True, kw_only=True)
class Spherical(Joint):
    """The child turns about the joint point: s = the angles or the quaternion; W: all forces.

    S takes the rates of the angles (`turning_columns`), or the angular velocity by which the quaternion moves.

    Args:
        orientation: "zxz", "xyz", ...: turns about the body's own successive axes; zxz:
            R = Rz(psi) Rx(theta) Rz(phi), child to parent; or "quaternion".
        angles: of these turns [rad].
        quaternion: names of its four coordinates, scalar first.
        omega: names of the speeds: the child's angular velocity against the parent, child's axes [rad/s].
    """

    kind: ClassVar[str] = "spherical"
    only_space: ClassVar[bool] = True
    beside_orientation: ClassVar[tuple[str, ...]] = ()
    orientation: Sequence
    angles: Angles | None = None
    quaternion: QuaternionNames | None = None
    omega: Omega | None = None

    def findings(self, path: DocumentPath, catalog: Catalog) -> Iterator[Finding]:
        yield from turning_findings(self, path, catalog)

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
