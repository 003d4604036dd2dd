"""Ring: a thin hoop."""

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from eomgen.model.kinds import Length
from eomgen.model.shapes.base import MassProperties, Shape, Value, diagonal
from eomgen.symbolic.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Ring(Shape):
    """A thin homogeneous hoop about its centre (the origin), axis z: I_zz = m r^2, I_xx = I_yy = m r^2 / 2."""

    kind: ClassVar[str] = "ring"
    radius: Length

    def points(self, value: Value) -> dict[str, Vector]:
        return {"origin": ZERO, "center": ZERO}

    def mass_properties(self, value: Value) -> MassProperties:
        m, r = self.mass_of(value), value(self.radius)
        square = m * r * r
        return MassProperties(m, ZERO, diagonal(Fraction(1, 2) * square, Fraction(1, 2) * square, square))
