"""Triangle: a thin right-angled plate."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import MassProperties, Shape
from eomgen.model.shapes.forms import Form, PolygonForm
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Triangle(Shape):
    """A thin homogeneous plate, right angle at the origin, legs w along +x and h along +y.

    Centre (w/3, h/3); about it I_xx = m h^2 / 18, I_yy = m w^2 / 18, I_xy = + m w h / 36 (the tensor's sign).
    """

    kind: ClassVar[str] = "triangle"
    dimension: ClassVar[int] = 2
    width: Length
    height: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        w, h = value(self.width), value(self.height)
        return (PolygonForm((ZERO, (w, 0, 0), (0, h, 0))),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return (value(self.width) * s[0], value(self.height) * s[1] * (1 - s[0]), 0)

    def measure(self, value: ValueOf) -> Any:
        return Fraction(1, 2) * value(self.width) * value(self.height)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        w, h = value(self.width), value(self.height)
        xx, yy, xy = Fraction(1, 18) * m * h * h, Fraction(1, 18) * m * w * w, Fraction(1, 36) * m * w * h
        center = (Fraction(1, 3) * w, Fraction(1, 3) * h, 0)
        return MassProperties(m, center, ((xx, xy, 0), (xy, yy, 0), (0, 0, xx + yy)))
