"""Frustum: a solid round cone without its tip."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import PI, MassProperties, Shape, around, between, diagonal
from eomgen.model.shapes.forms import Form, turned_profile
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import Vector


@dataclass(frozen=True, kw_only=True)
class Frustum(Shape):
    """A solid frustum, the centre of its base at the origin, radius R there and r (`top`) at the height h along +z.

    With s = R^2 + R r + r^2: centre h (R^2 + 2 R r + 3 r^2) / (4 s); I_zz = 3 m (R^5 - r^5) / (10 (R^3 - r^3));
    the integral of z^2 dm is m h^2 (R^2 + 3 R r + 6 r^2) / (10 s).
    """

    kind: ClassVar[str] = "frustum"
    dimension: ClassVar[int] = 3
    radius: Length
    top: Length
    height: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        R, r, h = value(self.radius), value(self.top), value(self.height)
        return (turned_profile(((0, 0), (R, 0), (r, h), (0, h)), R),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        radius = between(value(self.radius), value(self.top), s[2])
        return (*around(radius * s[0], s[1]), value(self.height) * s[2])

    def measure(self, value: ValueOf) -> Any:
        R, r = value(self.radius), value(self.top)
        return Fraction(1, 3) * value(PI) * value(self.height) * (R * R + R * r + r * r)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        R, r, h = value(self.radius), value(self.top), value(self.height)
        s = R * R + R * r + r * r
        z = over(Fraction(1, 4) * h * (R * R + 2 * R * r + 3 * r * r), s)
        fifth = R * R * R * R + R * R * R * r + R * R * r * r + R * r * r * r + r * r * r * r  # both over R - r
        I_zz = over(Fraction(3, 10) * m * fifth, s)
        along = over(Fraction(1, 10) * m * h * h * (R * R + 3 * R * r + 6 * r * r), s)
        across = Fraction(1, 2) * I_zz + along - m * z * z
        return MassProperties(m, (0, 0, z), diagonal(across, across, I_zz))
