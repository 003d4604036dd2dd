"""Rectangle: a thin plate."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import HALF, MassProperties, Shape, diagonal
from eomgen.model.shapes.forms import Form, box_around
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Rectangle(Shape):
    """A thin plate about its centre (the origin), width w along x, height h along y: I_zz = m (w^2 + h^2) / 12."""

    kind: ClassVar[str] = "rectangle"
    dimension: ClassVar[int] = 2
    width: Length
    height: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return (box_around(value(self.width), value(self.height)),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return (value(self.width) * (s[0] - HALF), value(self.height) * (s[1] - HALF), 0)

    def measure(self, value: ValueOf) -> Any:
        return value(self.width) * value(self.height)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        w, h = value(self.width), value(self.height)
        xx, yy = Fraction(1, 12) * m * h * h, Fraction(1, 12) * m * w * w
        return MassProperties(m, ZERO, diagonal(xx, yy, xx + yy))
