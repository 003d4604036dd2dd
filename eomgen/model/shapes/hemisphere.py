"""Hemisphere: half a solid ball."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import HALF, PI, MassProperties, Shape, diagonal, on_ball
from eomgen.model.shapes.forms import Form, circle_points, turned_profile
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import Vector


@dataclass(frozen=True, kw_only=True)
class Hemisphere(Shape):
    """Half a solid ball, the centre of its flat face at the origin, the dome towards +z.

    Centre 3 r / 8 along z; about the origin I = 2 m r^2 / 5 about x, y and z.
    """

    kind: ClassVar[str] = "hemisphere"
    dimension: ClassVar[int] = 3
    radius: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r = value(self.radius)
        return (turned_profile(((0, 0), *circle_points(r, 12, 0, HALF)), r),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return on_ball(value(self.radius) * s[0], HALF * s[1], s[2])

    def measure(self, value: ValueOf) -> Any:
        r = value(self.radius)
        return Fraction(2, 3) * value(PI) * r * r * r

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r = value(self.radius)
        z, square = Fraction(3, 8) * r, Fraction(2, 5) * m * r * r
        across = square - m * z * z
        return MassProperties(m, (0, 0, z), diagonal(across, across, square))
