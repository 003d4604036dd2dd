"""Hemisphere: half a solid ball."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar

from eomgen.model.kinds import Length
from eomgen.model.shapes.base import PI, Line, MassProperties, Shape, Value, circle, diagonal


@dataclass(frozen=True, kw_only=True)
class Hemisphere(Shape):
    """Half a solid ball, the centre of its flat face at the origin, the dome towards +z.

    Centre 3 r / 8 along z; about the origin I = 2 m r^2 / 5 about x, y and z.
    """

    kind: ClassVar[str] = "hemisphere"
    dimension: ClassVar[int] = 3
    radius: Length

    def outline(self, value: Value) -> tuple[Line, ...]:
        return (circle(value(self.radius)),)

    def measure(self, value: Value) -> Any:
        r = value(self.radius)
        return Fraction(2, 3) * value(PI) * r * r * r

    def of_mass(self, m: Any, value: Value) -> MassProperties:
        r = value(self.radius)
        z, square = Fraction(3, 8) * r, Fraction(2, 5) * m * r * r
        across = square - m * z * z
        return MassProperties(m, (0, 0, z), diagonal(across, across, square))
