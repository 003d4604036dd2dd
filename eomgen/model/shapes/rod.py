"""Rod: a thin straight line of mass."""

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from eomgen.model.kinds import Length
from eomgen.model.shapes.base import MassProperties, Shape, Value, diagonal
from eomgen.symbolic.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Rod(Shape):
    """A thin homogeneous rod along x, from `start` (the origin) to `end`: I = m l^2 / 12 across it."""

    kind: ClassVar[str] = "rod"
    length: Length

    def points(self, value: Value) -> dict[str, Vector]:
        length = value(self.length)
        return {"origin": ZERO, "start": ZERO, "end": (length, 0, 0), "center": (Fraction(1, 2) * length, 0, 0)}

    def mass_properties(self, value: Value) -> MassProperties:
        m, length = self.mass_of(value), value(self.length)
        across = Fraction(1, 12) * m * length * length
        return MassProperties(m, (Fraction(1, 2) * length, 0, 0), diagonal(0, across, across))

    @property
    def point_names(self) -> tuple[str, ...]:
        return ("origin", "start", "end", "center")
