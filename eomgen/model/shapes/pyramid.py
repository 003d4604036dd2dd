"""Pyramid: a solid one on a rectangle."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import HALF, MassProperties, Shape, diagonal
from eomgen.model.shapes.forms import HALF_OF, Form, PolyhedronForm
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Pyramid(Shape):
    """A solid pyramid about its mass centre (the origin), apex towards +z, h/4 of its height h below the origin.

    Its base is w wide along x and d deep along y: I_xx = m (d^2 / 20 + 3 h^2 / 80), I_zz = m (w^2 + d^2) / 20.
    """

    kind: ClassVar[str] = "pyramid"
    dimension: ClassVar[int] = 3
    width: Length
    depth: Length
    height: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        x, y, h = HALF_OF * value(self.width), HALF_OF * value(self.depth), value(self.height)
        low, apex = -Fraction(1, 4) * h, (0, 0, Fraction(3, 4) * h)
        points = ((-x, -y, low), (x, -y, low), (x, y, low), (-x, y, low), apex)
        return (PolyhedronForm(points, ((3, 2, 1, 0), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4))),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        x, y = (
            value(edge) * (part - HALF) * (1 - s[2]) for edge, part in zip((self.width, self.depth), s, strict=False)
        )
        return (x, y, value(self.height) * (s[2] - HALF * HALF))

    def measure(self, value: ValueOf) -> Any:
        return Fraction(1, 3) * value(self.width) * value(self.depth) * value(self.height)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        x, y = (Fraction(1, 20) * m * value(edge) * value(edge) for edge in (self.width, self.depth))
        z = Fraction(3, 80) * m * value(self.height) * value(self.height)
        return MassProperties(m, ZERO, diagonal(y + z, z + x, x + y))
