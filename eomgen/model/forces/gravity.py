"""Gravity: a weight on every body, or on some."""

from typing import ClassVar

from eomgen.model.forces.base import Force
from eomgen.model.forces.element import Act, PushOfMass
from eomgen.model.forces.load import Load, LoadContext, PointForce, UniformField
from eomgen.model.kinds import Acceleration, Bodies, Flag
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import AnyScalar, dot, times


@dataclass(frozen=True, kw_only=True)
class Gravity(Force):
    """m g at the mass centre of each body: V = - m g . r.

    Args:
        acceleration: g, ground axes, 2 or 3 [m/s^2].
        bodies: on which it acts (None: all).
        axis_down: the last axis points down: a weight along it is meant.
    """

    kind: ClassVar[str] = "gravity"
    by_mass: ClassVar[bool] = True
    acceleration: Acceleration
    bodies: Bodies | None = None
    axis_down: Flag = False

    @property
    def acts(self) -> tuple[Act, ...]:
        return (PushOfMass(self.acceleration, self.bodies),)

    def loads(self, scene: LoadContext) -> tuple[Load, ...]:
        """A uniform field, or m g at the mass centre of each named body."""
        g = scene.vector(self.acceleration)
        if self.bodies is None:
            return (UniformField(g),)
        return tuple(PointForce(place, times(m, g)) for place, m in scene.masses(self.bodies))

    def potential(self, scene: LoadContext) -> AnyScalar | None:
        """V = - sum m g . r"""
        g = scene.vector(self.acceleration)
        V: AnyScalar = 0
        for place, m in scene.masses(self.bodies):
            V = V - m * dot(g, scene.position(place))
        return V
