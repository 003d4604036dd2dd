"""Ellipsoid: a solid one."""

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from eomgen.model.kinds import Size
from eomgen.model.shapes.base import MassProperties, Shape, Value, diagonal
from eomgen.symbolic.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Ellipsoid(Shape):
    """A solid ellipsoid about its centre (the origin), semiaxes = [a, b, c]: I_xx = m (b^2 + c^2) / 5, and so on."""

    kind: ClassVar[str] = "ellipsoid"
    semiaxes: Size

    def points(self, value: Value) -> dict[str, Vector]:
        return {"origin": ZERO, "center": ZERO}

    def mass_properties(self, value: Value) -> MassProperties:
        m = self.mass_of(value)
        x, y, z = (Fraction(1, 5) * m * value(axis) * value(axis) for axis in self.semiaxes)
        return MassProperties(m, ZERO, diagonal(y + z, z + x, x + y))
