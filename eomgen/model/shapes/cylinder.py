"""Cylinder: a solid round bar."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import HALF, PI, MassProperties, Shape, around, diagonal
from eomgen.model.shapes.forms import Form, cylinder_form
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Cylinder(Shape):
    """A solid cylinder about its centre (the origin), length l along z.

    I_zz = m r^2 / 2, I_xx = I_yy = m (3 r^2 + l^2) / 12.
    """

    kind: ClassVar[str] = "cylinder"
    dimension: ClassVar[int] = 3
    radius: Length
    length: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return (cylinder_form(value(self.radius), value(self.length)),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return (*around(value(self.radius) * s[0], s[1]), value(self.length) * (s[2] - HALF))

    def measure(self, value: ValueOf) -> Any:
        return value(PI) * value(self.radius) * value(self.radius) * value(self.length)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r, length = value(self.radius), value(self.length)
        across = Fraction(1, 4) * m * r * r + Fraction(1, 12) * m * length * length
        return MassProperties(m, ZERO, diagonal(across, across, Fraction(1, 2) * m * r * r))
