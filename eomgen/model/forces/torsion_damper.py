"""Torsion damper: between two bodies, or a body and the ground."""

from typing import ClassVar

from eomgen.model.forces.base import Force
from eomgen.model.forces.element import Element
from eomgen.model.forces.load import Load, LoadContext
from eomgen.model.forces.twist import relative, turned
from eomgen.model.kinds import AngularDamping, BodyName, TwoBodies
from eomgen.records import dataclass


@dataclass(frozen=True, kw_only=True)
class TorsionDamper(Force):
    """A torsion damper: couple - c theta'.

    Args:
        bodies: theta is the angle of the second against the first.
        body: alone: theta is its angle against the ground's axes.
        damping: c [N m s].
    """

    kind: ClassVar[str] = "torsion_damper"
    one_of: ClassVar[tuple[str, ...]] = ("bodies", "body")
    bodies: TwoBodies | None = None
    body: BodyName | None = None
    damping: AngularDamping

    @property
    def element(self) -> Element:
        return Element(bodies=self.bodies or (None, self.body), damping=self.damping)

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """A couple - c theta' on the second body, the opposite on the first."""
        rate = relative(self.bodies, self.body, scene.angle_rate)
        return turned(self.bodies, self.body, -scene.value(self.damping) * rate)
