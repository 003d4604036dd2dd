"""Ellipse: a thin elliptic plate."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import PlaneSize, ValueOf
from eomgen.model.shapes.base import PI, MassProperties, Shape, around, diagonal
from eomgen.model.shapes.forms import ArcForm, Form, LineForm
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Ellipse(Shape):
    """A thin plate about its centre (the origin), semiaxes = [a, b] in x and y: I_xx = m b^2 / 4, I_yy = m a^2 / 4."""

    kind: ClassVar[str] = "ellipse"
    dimension: ClassVar[int] = 2
    semiaxes: PlaneSize

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        a, b = map(value, self.semiaxes)
        return (ArcForm(ZERO, a, b, close="chord"), LineForm((ZERO, (a, 0, 0)), fine=True))

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        x, y = around(s[0], s[1])
        a, b = map(value, self.semiaxes)
        return (a * x, b * y, 0)

    def measure(self, value: ValueOf) -> Any:
        a, b = map(value, self.semiaxes)
        return value(PI) * a * b

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        a, b = map(value, self.semiaxes)
        xx, yy = Fraction(1, 4) * m * b * b, Fraction(1, 4) * m * a * a
        return MassProperties(m, ZERO, diagonal(xx, yy, xx + yy))
