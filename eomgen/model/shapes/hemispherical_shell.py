"""Hemispherical shell: half a thin hollow ball."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import HALF, PI, MassProperties, Shape, diagonal, on_ball
from eomgen.model.shapes.forms import Form, circle_points, turned_profile
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import Vector


@dataclass(frozen=True, kw_only=True)
class HemisphericalShell(Shape):
    """Half a thin shell, the centre of its rim at the origin, the dome towards +z.

    Centre r / 2 along z; about the origin I = 2 m r^2 / 3 about x, y and z.
    """

    kind: ClassVar[str] = "hemispherical_shell"
    dimension: ClassVar[int] = 2
    radius: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r = value(self.radius)
        return (turned_profile(circle_points(r, 12, 0, HALF), r),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return on_ball(value(self.radius), HALF * s[0], s[1])

    def measure(self, value: ValueOf) -> Any:
        r = value(self.radius)
        return 2 * value(PI) * r * r

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r = value(self.radius)
        z, square = Fraction(1, 2) * r, Fraction(2, 3) * m * r * r
        across = square - m * z * z
        return MassProperties(m, (0, 0, z), diagonal(across, across, square))
