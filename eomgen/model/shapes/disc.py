"""Disc: a thin round plate."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import PI, MassProperties, Shape, around, diagonal
from eomgen.model.shapes.forms import Form, round_plate
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Disc(Shape):
    """A thin homogeneous disc about its centre (the origin), axis z: I_zz = m r^2 / 2, I_xx = I_yy = m r^2 / 4."""

    kind: ClassVar[str] = "disc"
    dimension: ClassVar[int] = 2
    radius: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return round_plate(value(self.radius))

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return (*around(value(self.radius) * s[0], s[1]), 0)

    def measure(self, value: ValueOf) -> Any:
        return value(PI) * value(self.radius) * value(self.radius)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r = value(self.radius)
        square = m * r * r
        quarter = Fraction(1, 4) * square
        return MassProperties(m, ZERO, diagonal(quarter, quarter, Fraction(1, 2) * square))
