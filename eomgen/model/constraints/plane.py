"""Directions, turns and round bodies in the plane, as constraints need them; vectors are 3 with z = 0."""

from __future__ import annotations

from eomgen.frozen import dataclass
from eomgen.model.constraints.row import ConstraintRow
from eomgen.model.forces.load import BodyPoint, Couple, LoadContext, PointForce, Push
from eomgen.symbolic.expression import Scalar, Vector


def left(d: Vector) -> Vector:
    """d turned by a quarter, counter-clockwise."""
    return Vector((-d[1], d[0], 0))


def right(d: Vector) -> Vector:
    """d turned by a quarter, clockwise."""
    return Vector((d[1], -d[0], 0))


def angle_of(scene: LoadContext, body: str | None) -> Scalar:
    """The angle of a body against the ground's axes; the ground's is 0 [rad]."""
    return 0 if body is None else scene.angle(body)


def couples(first: str | None, second: str | None, ratio: Scalar = 1) -> tuple[Push, ...]:
    """A unit couple on the first body and - ratio on the second (none on the ground)."""
    pairs = ((first, 1), (second, -ratio))
    return tuple(Couple(body, Vector((0, 0, tau))) for body, tau in pairs if body is not None)


def same_turn(scene: LoadContext, first: str | None, second: str | None, ratio: Scalar = 1) -> ConstraintRow:
    """theta_1 - ratio theta_2 stays as at the start: a couple on the first body, - ratio times it on the second."""
    turned = angle_of(scene, first) - ratio * angle_of(scene, second)
    return ConstraintRow(couples(first, second, ratio), turned - scene.start(turned), component="couple")


@dataclass(frozen=True)
class Touch:
    """Point of application of a force on a body: at `arm` (ground axes) from a place that is fixed in the body.

    The place of contact wanders in a round body; its centre stays, and the moment arm x F is added to the force.
    """

    place: BodyPoint
    arm: Vector = Vector.ZERO

    def pushed(self, force: Vector) -> tuple[Push, ...]:
        """The force, as the same force at the place and its moment."""
        body, _ = self.place
        moment = self.arm.cross(force)
        if body is None or all(type(x) is int and x == 0 for x in self.arm):
            return (PointForce(self.place, force),)
        at_place = PointForce(self.place, force, beyond=self.arm)
        if all(type(x) is int and x == 0 for x in moment):
            return (at_place,)
        return (at_place, Couple(body, moment, beyond=self.arm))


def opposite(touch: Touch, other: Touch, force: Vector) -> tuple[Push, ...]:
    """A force on the first, its opposite on the other."""
    return (*touch.pushed(force), *other.pushed(-force))
