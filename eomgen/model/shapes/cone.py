"""Cone: a solid round cone."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import HALF, PI, MassProperties, Shape, around, diagonal
from eomgen.model.shapes.forms import Form, turned_profile
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Cone(Shape):
    """A solid cone about its mass centre (the origin), apex towards +z, h/4 of its height h below the origin.

    I_zz = 3 m r^2 / 10, I_xx = I_yy = 3 m (4 r^2 + h^2) / 80.
    """

    kind: ClassVar[str] = "cone"
    dimension: ClassVar[int] = 3
    radius: Length
    height: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r, h = value(self.radius), value(self.height)
        base, apex = -Fraction(1, 4) * h, Fraction(3, 4) * h
        return (turned_profile(((0, base), (r, base), (0, apex)), r),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return (*around(value(self.radius) * (1 - s[2]) * s[0], s[1]), value(self.height) * (s[2] - HALF * HALF))

    def measure(self, value: ValueOf) -> Any:
        return Fraction(1, 3) * value(PI) * value(self.radius) * value(self.radius) * value(self.height)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r, h = value(self.radius), value(self.height)
        across = Fraction(3, 20) * m * r * r + Fraction(3, 80) * m * h * h
        return MassProperties(m, ZERO, diagonal(across, across, Fraction(3, 10) * m * r * r))
