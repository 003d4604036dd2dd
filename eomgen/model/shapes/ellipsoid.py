"""Ellipsoid: a solid one."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Size, ValueOf
from eomgen.model.shapes.base import PI, MassProperties, Shape, diagonal, on_ball
from eomgen.model.shapes.forms import EllipsoidForm, Form
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector, vector_of


@dataclass(frozen=True, kw_only=True)
class Ellipsoid(Shape):
    """A solid ellipsoid about its centre (the origin), semiaxes = [a, b, c]: I_xx = m (b^2 + c^2) / 5, and so on."""

    kind: ClassVar[str] = "ellipsoid"
    dimension: ClassVar[int] = 3
    semiaxes: Size

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        a, b, c = map(value, self.semiaxes)
        return (EllipsoidForm(ZERO, (a, b, c)),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return vector_of(value(a) * x for a, x in zip(self.semiaxes, on_ball(s[0], s[1], s[2]), strict=True))

    def measure(self, value: ValueOf) -> Any:
        a, b, c = map(value, self.semiaxes)
        return Fraction(4, 3) * value(PI) * a * b * c

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        x, y, z = (Fraction(1, 5) * m * value(axis) * value(axis) for axis in self.semiaxes)
        return MassProperties(m, ZERO, diagonal(y + z, z + x, x + y))
