"""Distributed: a line load between two points of a body."""

from typing import ClassVar

from eomgen.errors import ModelError
from eomgen.model.forces.base import Force
from eomgen.model.forces.element import Act, PushAlongLine
from eomgen.model.forces.load import Load, LoadContext, PointForce, SpreadLoad
from eomgen.model.kinds import BodyName, LineLoad, TwoLineLoads, TwoOwnPoints
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import sqrt
from eomgen.symbolic.expression.graph import is_zero
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import AnyScalar, Vector, dot, minus, plus, times


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
    one_of: ClassVar[tuple[str, ...]] = ("intensity", "intensities")
    body: BodyName
    between: TwoOwnPoints
    intensity: LineLoad | None = None
    intensities: TwoLineLoads | None = None

    @property
    def acts(self) -> tuple[Act, ...]:
        q = self.intensities if self.intensity is None else (self.intensity, self.intensity)
        return () if q is None else (PushAlongLine(self.body, tuple(self.between), q),)

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """Forces (2 q_A + q_B) L / 6 at A and (q_A + 2 q_B) L / 6 at B: the same resultant and moment as the load."""
        (line,) = self.spread(scene)
        length = _length(line)
        return (
            PointForce(line.start, _resultant(length, line.at_start, line.at_end)),
            PointForce(line.end, _resultant(length, line.at_end, line.at_start)),
        )

    def spread(self, scene: LoadContext) -> tuple[SpreadLoad, ...]:
        """q_A at A, q_B at B, linear between.

        Raises:
            ModelError: A and B are at one place.
        """
        a, b = (scene.place(_own(self.body, name)) for name in self.between)
        q_A, q_B = (scene.vector(q) for q in self.intensities or (self.intensity, self.intensity))
        line = SpreadLoad(a, b, q_A, q_B)
        length = _length(line)
        if is_zero(length) or scene.worth(length) == 0:
            ends = " and ".join(f"'{name}'" for name in self.between)
            raise ModelError(
                f"{ends} are at one place: a load along a line needs a length",
                scene.where,
                "name two points, or put a force there",
            )
        return (line,)


def _length(line: SpreadLoad) -> AnyScalar:
    along = minus(line.end[1], line.start[1])
    return sqrt(dot(along, along))


def _resultant(length: AnyScalar, near: Vector, far: Vector) -> Vector:
    """L (2 q_near + q_far) / 6"""
    return times(length * Fraction(1, 6), plus(times(2, near), far))


def _own(body: str, name: str) -> str:
    return name if "." in name else f"{body}.{name}"
