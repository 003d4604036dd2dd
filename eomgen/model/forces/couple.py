"""Couple: on a body."""

from typing import ClassVar

from eomgen.model.forces import load
from eomgen.model.forces.base import Force
from eomgen.model.forces.element import Act, CoupleOn
from eomgen.model.kinds import AxesName, BodyName, CoupleFormula, OwnPointName
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import AnyScalar


@dataclass(frozen=True, kw_only=True)
class CoupleForce(Force):
    """A couple on a body.

    Args:
        body: on which it acts.
        couple: about z in the plane, 1; in space 3 components [N m].
        axes: "ground", or the body whose axes the components are in.
        point: of the body, where it acts: only what the body is strained by inside depends on it.
    """

    kind: ClassVar[str] = "couple"
    body: BodyName
    couple: CoupleFormula
    axes: AxesName = "ground"
    point: OwnPointName | None = None

    def effort(self, scene: load.LoadContext) -> AnyScalar | None:
        """The couple in the plane [N m]; None in space, where it has three components."""
        return scene.vector(self.couple)[0] if len(self.couple) == 1 else None

    @property
    def acts(self) -> tuple[Act, ...]:
        return (CoupleOn(self.body, self.couple, self.axes),)

    def loads(self, scene: load.LoadContext) -> tuple[load.Load, ...]:
        axes = None if self.axes == "ground" else self.axes
        couple = scene.vector(self.couple)
        if len(self.couple) == 1:
            couple = (0, 0, couple[0])
        place = None if self.point is None else scene.own_place(self.body, self.point)
        return (load.Couple(self.body, couple, axes, place),)
