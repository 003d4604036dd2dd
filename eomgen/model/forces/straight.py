"""What draws two points together by a law of the line between them: springs, dampers, pulls."""

from eomgen.model.forces.base import Force
from eomgen.model.forces.load import Load, LoadContext
from eomgen.model.forces.reach import Reach, reach
from eomgen.model.kinds import TwoPoints
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class Straight(Force):
    """Two points pull each other along the line between them, or along a fixed direction."""

    points: TwoPoints

    def law(self, scene: LoadContext, line: Reach) -> AnyScalar:
        """The law, attraction positive [N]."""
        raise NotImplementedError

    def by_length(self, scene: LoadContext, line: Reach) -> AnyScalar | None:
        """k of a law k l along the line between the points, which has no direction where these meet; else None."""
        return None

    def effort(self, scene: LoadContext) -> AnyScalar | None:
        """The pull [N]."""
        return self.law(scene, self.line(scene))

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """The pull on the first point, its opposite on the second."""
        line = self.line(scene)
        k = self.by_length(scene, line)
        return line.pulled(self.law(scene, line)) if k is None else line.pulled_by_length(k)

    def line(self, scene: LoadContext) -> Reach:
        """Between the points."""
        assert self.element is not None, "a law of this kind acts between two points"
        return reach(scene, self.points, self.element.along)
