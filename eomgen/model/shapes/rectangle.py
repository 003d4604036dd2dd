"""Rectangle: a thin plate."""

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from eomgen.model.kinds import Length
from eomgen.model.shapes.base import MassProperties, Shape, Value, diagonal
from eomgen.symbolic.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Rectangle(Shape):
    """A thin plate about its centre (the origin), width w along x, height h along y: I_zz = m (w^2 + h^2) / 12."""

    kind: ClassVar[str] = "rectangle"
    width: Length
    height: Length

    def points(self, value: Value) -> dict[str, Vector]:
        return {"origin": ZERO, "center": ZERO}

    def mass_properties(self, value: Value) -> MassProperties:
        m, w, h = self.mass_of(value), value(self.width), value(self.height)
        xx, yy = Fraction(1, 12) * m * h * h, Fraction(1, 12) * m * w * w
        return MassProperties(m, ZERO, diagonal(xx, yy, xx + yy))
