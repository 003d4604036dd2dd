"""Spherical shell: a thin hollow ball."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import PI, MassProperties, Shape, diagonal, on_ball
from eomgen.model.shapes.forms import EllipsoidForm, Form
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class SphericalShell(Shape):
    """A thin homogeneous shell about its centre (the origin): I = 2 m r^2 / 3 about every axis."""

    kind: ClassVar[str] = "spherical_shell"
    dimension: ClassVar[int] = 2
    radius: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r = value(self.radius)
        return (EllipsoidForm(ZERO, (r, r, r)),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return on_ball(value(self.radius), s[0], s[1])

    def measure(self, value: ValueOf) -> Any:
        return 4 * value(PI) * value(self.radius) * value(self.radius)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r = value(self.radius)
        square = Fraction(2, 3) * m * r * r
        return MassProperties(m, ZERO, diagonal(square, square, square))
