"""Distributed: a line load between two points of a body."""

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from eomgen.model.forces.base import Force
from eomgen.model.forces.load import Load, PointForce, Scalar, Scene, Vector
from eomgen.model.kinds import BodyName, LineLoad, TwoLineLoads, TwoOwnPoints
from eomgen.symbolic.functions import sqrt
from eomgen.symbolic.spatial import dot, minus, plus, times


@dataclass(frozen=True, kw_only=True)
class Distributed(Force):
    """A load spread along the line from A to B, constant or linear.

    Args:
        body: on which it acts.
        between: the names of A and B, points of this body (or `body.A`).
        intensity: force per length, constant, ground axes, 2 or 3 [N/m].
        intensities: at A and at B instead.
    """

    kind: ClassVar[str] = "distributed"
    body: BodyName
    between: TwoOwnPoints
    intensity: LineLoad | None = None
    intensities: TwoLineLoads | None = None

    def loads(self, scene: Scene) -> tuple[Load, ...]:
        """Forces (2 q_A + q_B) L / 6 at A and (q_A + 2 q_B) L / 6 at B: the same resultant and moment as the load."""
        (body, a), (_, b) = (scene.place(_own(self.body, name)) for name in self.between)
        length = sqrt(dot(minus(b, a), minus(b, a)))
        q_A, q_B = (scene.vector(q) for q in self.intensities or (self.intensity, self.intensity))
        return (
            PointForce((body, a), _resultant(length, q_A, q_B)),
            PointForce((body, b), _resultant(length, q_B, q_A)),
        )


def _resultant(length: Scalar, near: Vector, far: Vector) -> Vector:
    """L (2 q_near + q_far) / 6"""
    return times(length * Fraction(1, 6), plus(times(2, near), far))


def _own(body: str, name: str) -> str:
    return name if "." in name else f"{body}.{name}"
