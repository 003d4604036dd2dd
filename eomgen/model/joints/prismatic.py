"""Prismatic: the child slides along one axis."""

from typing import Any, ClassVar

from eomgen.model.joints.axis import AxisJoint
from eomgen.model.joints.base import Effort, Scalars, Z, unit, vector
from eomgen.model.joints.moves import Move, PushAlong, SlideAlong, TurnAbout
from eomgen.model.kinds import (
    ConstantAngle,
    Direction,
    Displacement,
    ForceFormula,
    LinearDamping,
    LinearStiffness,
    RestLength,
    SlideInertia,
    ValueOf,
)
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import cos, sin
from eomgen.symbolic.expression.spatial import Matrix, Vector, rotation


@dataclass(frozen=True, kw_only=True)
class Prismatic(AxisJoint):
    """A slide: s = displacement, X = (Rot(angle), s n), S = (0, R^T n); W: every torque and the forces across n.

    Args:
        axis: n, in the turned axes; need not have unit length.
        displacement: along n [m].
        angle: the constant angle of the child's axes (about z in the plane, about n in space) [rad].
        force: on the child, minus on the parent [N].
        stiffness, damping, rest, armature: - k (s - rest), - d s', and armature s'^2 / 2 to T.
    """

    kind: ClassVar[str] = "prismatic"
    axis: Direction
    displacement: Displacement
    angle: ConstantAngle | None = None
    force: ForceFormula | None = None
    stiffness: LinearStiffness | None = None
    damping: LinearDamping | None = None
    rest: RestLength | None = None
    armature: SlideInertia | None = None

    def turns(self) -> tuple[Expression, ...]:
        return ()

    def moves(self) -> tuple[Move, ...]:
        turn_axis = None if len(self.axis) == 2 else self.axis
        return (SlideAlong(self.axis, self.displacement), TurnAbout(turn_axis, self.angle))

    def variables(self, space: str) -> tuple[Expression, ...]:
        return (self.displacement,)

    def normal(self, value: ValueOf) -> Vector:
        return unit(vector(self.axis, value))

    def steps(self, value: ValueOf) -> tuple[tuple[Any, Any], ...]:
        return ((0, 1),)

    def mounting(self, value: ValueOf) -> Matrix:
        angle = self.turn((), value)
        return rotation(Z if len(self.axis) == 2 else self.normal(value), cos(angle), sin(angle))

    def turn(self, s: Scalars, value: ValueOf) -> Any:
        return 0 if self.angle is None else value(self.angle)

    def efforts(self) -> tuple[Effort | None, ...]:
        return (Effort(self.force, self.stiffness, self.damping, self.rest, self.armature),)

    def pushes(self) -> tuple[PushAlong, ...]:
        return (
            PushAlong(
                way=self.displacement,
                push=self.force,
                stiffness=self.stiffness,
                damping=self.damping,
                rest=self.rest,
                armature=self.armature,
            ),
        )
