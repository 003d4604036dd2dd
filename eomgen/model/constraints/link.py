"""Link: a massless rod or wire of constant length."""

from typing import ClassVar

from eomgen.errors import ModelError
from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.meeting import Thread
from eomgen.model.constraints.row import TieRow
from eomgen.model.forces.load import LoadContext, PointForce
from eomgen.model.kinds import Flag, Length, TwoPoints
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import over, sqrt
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import AnyScalar, Vector, dot, minus, times, vector_of


@dataclass(frozen=True, kw_only=True)
class Link(Constraint):
    """Two points keep their distance; tension positive.

    Args:
        points: the two ends.
        length: their distance [m] (None: the one at the start).
        unilateral: a wire, which can only pull.
    """

    kind: ClassVar[str] = "link"
    pulls: ClassVar[bool] = True
    by_squares: ClassVar[bool] = True
    points: TwoPoints
    length: Length | None = None
    unilateral: Flag = False

    def thread(self) -> Thread:
        return Thread(self.points, length=self.length)

    def stays(self, component: str) -> bool:
        return self.length is None

    @property
    def lies_by_start(self) -> bool:
        return self.length is None

    def rows(self, scene: LoadContext) -> tuple[TieRow, ...]:
        """(L - r . r / L) / 2 = 0, r from the first point to the second; a tension 1 pulls the first along r / L.

        It is L - |r| to first order, without a root.
        """
        first, second = (scene.place(point) for point in self.points)
        r = minus(scene.position(second), scene.position(first))
        L = self._length(scene, r)
        d = vector_of(over(x, L) for x in r)
        pulls = (PointForce(first, d), PointForce(second, times(-1, d)))
        return (TieRow(pulls, Fraction(1, 2) * (L - dot(r, d)), component="tension"),)

    def _length(self, scene: LoadContext, r: Vector) -> AnyScalar:
        if self.length is not None:
            return scene.value(self.length)
        square = scene.start(dot(r, r))
        if scene.worth(square) == 0 or scene.vanishes(square):
            ends = " and ".join(f"'{point}'" for point in self.points)
            raise ModelError(
                f"{ends} are at one place at the start: the link has no length there",
                scene.where,
                "give its 'length', or use a pin",
            )
        return sqrt(square)
