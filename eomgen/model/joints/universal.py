"""Universal: a Cardan joint, two turns about axes that cross."""

from typing import Annotated, ClassVar

from eomgen.model.containers import ListRule
from eomgen.model.fields import CONFIGURATION, FormulaRule, VectorRule
from eomgen.model.joints.base import Column, Joint, Scalars, X, Y, Z, angular, linear, unit, vector
from eomgen.model.joints.moves import Move, TurnAbout
from eomgen.model.kinds import ValueOf
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import cos, sin
from eomgen.symbolic.expression.spatial import Matrix, Pose, Vector, apply, cross, product, rotation, transposed

TwoAxes = Annotated[
    tuple[tuple[Expression, ...], ...], ListRule(VectorRule(FormulaRule(), length=3, nonzero=True), 2, 2)
]
TwoAngles = Annotated[tuple[Expression, ...], ListRule(FormulaRule("rad", "", CONFIGURATION), 2, 2)]


@dataclass(frozen=True, kw_only=True)
class Universal(Joint):
    """s = (a, b), R = Rot(n1, a) Rot(n2, b); S = (Rot(n2, b)^T n1, 0), (n2, 0); W: all forces, one torque.

    Args:
        axes: n1 fixed in the (turned) parent, n2 fixed in the child; at angles 0 the axes of both agree.
        angles: a and b [rad].
    """

    kind: ClassVar[str] = "universal"
    only_space: ClassVar[bool] = True
    axes: TwoAxes
    angles: TwoAngles

    def turns(self) -> tuple[Expression, ...]:
        return self.angles

    def moves(self) -> tuple[Move, ...]:
        return tuple(map(TurnAbout, self.axes, self.angles))

    def variables(self, space: str) -> tuple[Expression, ...]:
        return self.angles

    def pose(self, s: Scalars, value: ValueOf) -> Pose:
        first, _ = self._normals(value)
        return Pose(product(rotation(first, cos(s[0]), sin(s[0])), self._second(s, value)))

    def subspace(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        first, second = self._normals(value)
        return (angular(apply(transposed(self._second(s, value)), first)), angular(second))

    def complement(self, s: Scalars, value: ValueOf) -> tuple[Column, ...]:
        (*first, _, _, _), (*second, _, _, _) = self.subspace(s, value)
        return (angular(cross(tuple(first), tuple(second))), *map(linear, (X, Y, Z)))

    def _normals(self, value: ValueOf) -> tuple[Vector, Vector]:
        first, second = (unit(vector(axis, value)) for axis in self.axes)
        return first, second

    def _second(self, s: Scalars, value: ValueOf) -> Matrix:
        """The turn about the axis of the child."""
        _, second = self._normals(value)
        return rotation(second, cos(s[1]), sin(s[1]))
