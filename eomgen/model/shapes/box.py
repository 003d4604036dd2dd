"""Box: a solid block."""

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from eomgen.model.kinds import Size
from eomgen.model.shapes.base import MassProperties, Shape, Value, diagonal
from eomgen.symbolic.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Box(Shape):
    """A solid block about its centre (the origin), size = [x, y, z]: I_xx = m (y^2 + z^2) / 12, and so on round."""

    kind: ClassVar[str] = "box"
    size: Size

    def points(self, value: Value) -> dict[str, Vector]:
        return {"origin": ZERO, "center": ZERO}

    def mass_properties(self, value: Value) -> MassProperties:
        m = self.mass_of(value)
        x, y, z = (Fraction(1, 12) * m * value(edge) * value(edge) for edge in self.size)
        return MassProperties(m, ZERO, diagonal(y + z, z + x, x + y))
