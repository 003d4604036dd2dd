"""Sphere: a solid ball."""

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from eomgen.model.kinds import Length
from eomgen.model.shapes.base import MassProperties, Shape, Value, diagonal
from eomgen.symbolic.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Sphere(Shape):
    """A solid homogeneous ball about its centre (the origin): I = 2 m r^2 / 5 about every axis."""

    kind: ClassVar[str] = "sphere"
    radius: Length

    def points(self, value: Value) -> dict[str, Vector]:
        return {"origin": ZERO, "center": ZERO}

    def mass_properties(self, value: Value) -> MassProperties:
        m, r = self.mass_of(value), value(self.radius)
        square = Fraction(2, 5) * m * r * r
        return MassProperties(m, ZERO, diagonal(square, square, square))
