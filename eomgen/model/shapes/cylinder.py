"""Cylinder: a solid round bar."""

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from eomgen.model.kinds import Length
from eomgen.model.shapes.base import MassProperties, Shape, Value, diagonal
from eomgen.symbolic.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Cylinder(Shape):
    """A solid cylinder about its centre (the origin), length l along z.

    I_zz = m r^2 / 2, I_xx = I_yy = m (3 r^2 + l^2) / 12.
    """

    kind: ClassVar[str] = "cylinder"
    radius: Length
    length: Length

    def points(self, value: Value) -> dict[str, Vector]:
        return {"origin": ZERO, "center": ZERO}

    def mass_properties(self, value: Value) -> MassProperties:
        m, r, length = self.mass_of(value), value(self.radius), value(self.length)
        across = Fraction(1, 4) * m * r * r + Fraction(1, 12) * m * length * length
        return MassProperties(m, ZERO, diagonal(across, across, Fraction(1, 2) * m * r * r))
