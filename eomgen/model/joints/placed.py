"""Placed: the position of the child is given as expressions. Geometry, which carries no reaction."""

from collections.abc import Iterator
from typing import Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.catalog import Catalog
from eomgen.model.diagnostics import Diagnostic
from eomgen.model.joints.ball import (
    Angles,
    Omega,
    QuaternionNames,
    Sequence,
    columns_of,
    rotation_of,
    turning_diagnostics,
    turning_moves,
)
from eomgen.model.joints.base import Column, Effort, Joint, Move, Scalars, X, Y, Z, angular, linear, vector
from eomgen.model.kinds import Angle, SpaceDirection, ValueOf
from eomgen.model.positions import DocumentPath
from eomgen.symbolic.expression import Expression, Matrix, Pose, Vector, as_expression, cos, sin


@dataclass(frozen=True, kw_only=True)
class Placed(Joint):
    """A position given by expressions: `at` is that of `point`, along the turned axes, with the orientation.

    s = (at, angle | angles | quaternion), S as of a free body.

    Args:
        at: of `point` in the parent's axes, turned as `turned` says, 2 or 3 [m].
        angle: of the child about `axis` [rad]; in space `orientation` and `angles` instead.
        axis: of `angle`; None: z.
        orientation, angles, quaternion, omega: as of `spherical` (space).
    """

    kind: ClassVar[str] = "placed"
    carries_reaction: ClassVar[bool] = False
    seated: ClassVar[bool] = False
    beside_orientation: ClassVar[tuple[str, ...]] = ("angle",)
    angle: Angle | None = None
    axis: SpaceDirection | None = None
    orientation: Sequence | None = None
    angles: Angles | None = None
    quaternion: QuaternionNames | None = None
    omega: Omega | None = None

    def diagnostics(self, path: DocumentPath, catalog: Catalog) -> Iterator[Diagnostic]:
        yield from turning_diagnostics(self, path, catalog)

    @property
    def spins(self) -> tuple[str, ...]:
        return (self.omega or ()) if self.orientation == "quaternion" else ()

    def turns(self) -> tuple[Expression, ...]:
        if self.quaternion is not None:
            return tuple(as_expression(name) for name in self.quaternion)
        return self.angles or (() if self.angle is None else (self.angle,))

    def moves(self) -> tuple[Move, ...]:
        turned = (Move(self.axis, angle=self.angle),) if self.orientation is None else turning_moves(self)
        return (*map(Move, (X, Y, Z), self.at or ()), *turned)

    def variables(self, space: str) -> tuple[Expression, ...]:
        zero = Expression.number(0)
        at = (zero,) * (2 if space == "plane" else 3) if self.at is None else self.at
        assert not isinstance(at, str), "a ground point's name stands for its coordinates before this"
        return (*at, *(self.turns() or (zero,)))

    def turn(self, s: Scalars, value: ValueOf) -> Any:
        return s[2]

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        places = self._places(s)
        position = (*s[:places], *([0] * (3 - places)))
        return Pose(self._rotation(s[places:], value), Vector(position))

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        places = self._places(s)
        R_CP = self._rotation(s[places:], value).T
        along = tuple(linear(R_CP @ e) for e in (X, Y, Z)[:places])
        if self.orientation is not None:
            return (*along, *columns_of(self.orientation, s[places:]))
        return (*along, angular(vector(self.axis, value, Z).unit))

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        return ()

    def efforts(self) -> tuple[Effort | None, ...]:
        return ()

    def _places(self, s: Scalars) -> int:
        return len(s) - (4 if self.quaternion is not None else 3 if self.angles is not None else 1)

    def _rotation(self, angles: Scalars, value: ValueOf) -> Matrix:
        if self.orientation is not None:
            return rotation_of(self.orientation, angles)
        return Matrix.rotation(vector(self.axis, value, Z).unit, cos(angles[0]), sin(angles[0]))
