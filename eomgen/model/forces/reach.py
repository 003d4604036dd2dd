"""From one point to another: distance, direction and rate, for whatever acts along a line."""

from __future__ import annotations

from eomgen.errors import DerivationError
from eomgen.model.forces.load import BodyPoint, Load, LoadContext, PointForce
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import over, sqrt
from eomgen.symbolic.expression.graph import is_zero
from eomgen.symbolic.expression.spatial import AnyScalar, Vector, dot, minus, times, vector_of


@dataclass(frozen=True)
class Reach:
    """The line from one point to another.

    Args:
        ends: the two points.
        gap: from the first to the second, ground axes [m].
        length: their distance, or the component along a fixed direction [m].
        direction: unit vector from the first to the second, ground axes.
        rate: of the length [m/s].
    """

    ends: tuple[BodyPoint, BodyPoint]
    gap: Vector
    length: AnyScalar
    direction: Vector
    rate: AnyScalar

    def pulled(self, tension: AnyScalar) -> tuple[Load, ...]:
        """Equal and opposite forces that draw the ends together [N]."""
        return self._opposite(times(tension, self.direction))

    def pulled_by_length(self, stiffness: AnyScalar) -> tuple[Load, ...]:
        """The same for a tension k l, which has a value where the ends meet too: k times the gap."""
        return self._opposite(times(stiffness, self.gap))

    def _opposite(self, pull: Vector) -> tuple[Load, ...]:
        return (PointForce(self.ends[0], pull), PointForce(self.ends[1], times(-1, pull)))


def reach(scene: LoadContext, points: tuple[str, ...], along: tuple[Expression, ...] | None = None) -> Reach:
    """The line between two points: l = |p2 - p1|, or n . (p2 - p1) along a fixed direction n."""
    ends = (scene.place(points[0]), scene.place(points[1]))
    gap = minus(scene.position(ends[1]), scene.position(ends[0]))
    rate = minus(scene.velocity(ends[1]), scene.velocity(ends[0]))
    if along is None:
        length = sqrt(dot(gap, gap))
        if is_zero(length):
            raise DerivationError(
                f"'{points[0]}' and '{points[1]}' are always at one place: there is no line between them",
                mend="let the force act between points that part, or give its direction by `along`",
            )
        direction = vector_of(over(x, length) for x in gap)
    else:
        n = scene.vector(along)
        size = sqrt(dot(n, n))
        direction = vector_of(over(x, size) for x in n)
        length = dot(gap, direction)
    return Reach(ends, gap, length, direction, dot(rate, direction))
