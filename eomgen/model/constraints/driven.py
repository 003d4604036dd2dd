"""Gears, and coordinates that are driven through a constraint."""

from typing import Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.plane import same_turn
from eomgen.model.constraints.row import ConstraintRow
from eomgen.model.forces.load import Couple, LoadContext, Push
from eomgen.model.kinds import CoordinateName, MotionOfCoordinate, Pure, TwoBodies
from eomgen.symbolic.expression import Scalar, as_expression

# -------- gear ------------------------------------------------------------------------------------------------
# Gear: two bodies turn in a fixed ratio.


@dataclass(frozen=True, kw_only=True)
class Gear(Constraint):
    """Two gear wheels: omega of the first = ratio * omega of the second.

    In the plane the angles are those against the ground's axes; in space those of the bodies' own joints, which turn
    them about one axis each (revolute, cylindrical, screw): the axes may have any directions, as of bevel gears.

    One row: the couple on the first; -ratio times it on the second. The wheels' axles carry what is left over. In space
    each couple is along its joint's axis, the opposite on the body that carries the joint. Wheels on a common cage: an
    epicyclic gear, or the differential of a car.

    Args:
        bodies: the two wheels.
        ratio: of their rates, negative where they turn against one another.
    """

    kind: ClassVar[str] = "gear"
    bodies: TwoBodies
    ratio: Pure

    def wheels(self) -> tuple[str, str, Any]:
        first, second = self.bodies
        return first, second, self.ratio

    def stays(self, component: str) -> bool:
        return True

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """theta_1 - ratio theta_2 stays; a couple 1 on the first body, - ratio on the second, none on the ground.

        In space each couple is along the axis of the body's joint, its opposite on the body that carries the joint.
        """
        first, second = self.bodies
        ratio = scene.value(self.ratio)
        if scene.plane:
            return (same_turn(scene, first, second, ratio),)
        (one, on_first), (other, on_second) = (_at_joint(scene, body, k) for body, k in ((first, 1), (second, -ratio)))
        turned = one - ratio * other
        return (ConstraintRow((*on_first, *on_second), turned - scene.start(turned), component="couple"),)


def _at_joint(scene: LoadContext, body: str, couple: Scalar) -> tuple[Scalar, tuple[Push, ...]]:
    """The angle of a body's joint, and the couple along its axis on the body, the opposite on its parent."""
    angle, axis, parent = scene.turn_of_joint(body)
    on_parent = () if parent is None else (Couple(parent, -couple * axis, axes=body),)
    return angle, (Couple(body, couple * axis, axes=body), *on_parent)


# -------- motion ----------------------------------------------------------------------------------------------
# Motion: a coordinate is driven through a constraint, which gives its driving force.


@dataclass(frozen=True, kw_only=True)
class Motion(Constraint):
    """A drive of a coordinate through a constraint: q = value(t).

    One row: the driving force along the coordinate, a generalized force.

    Args:
        coordinate: the driven coordinate.
        value: its value at each instant.
    """

    kind: ClassVar[str] = "motion"
    coordinate: CoordinateName
    value: MotionOfCoordinate

    def drives(self) -> str:
        """Its coordinate."""
        return self.coordinate

    def rows(self, scene: LoadContext) -> tuple[ConstraintRow, ...]:
        """q - f(t) = 0; lam is the generalized force along q."""
        return (ConstraintRow((), scene.value(as_expression(self.coordinate)) - scene.value(self.value)),)
