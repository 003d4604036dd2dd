"""Hollow sphere: a ball with a concentric cavity."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import ValueOf
from eomgen.model.shapes.base import PI, MassProperties, between, diagonal, on_ball
from eomgen.model.shapes.forms import EllipsoidForm, Form
from eomgen.model.shapes.hollow import Hollow
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import over
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class HollowSphere(Hollow):
    """A ball of radius R with a cavity of radius r (`inner`), about their centre (the origin).

    I = 2 m (R^5 - r^5) / (5 (R^3 - r^3)) about every axis.
    """

    kind: ClassVar[str] = "hollow_sphere"
    dimension: ClassVar[int] = 3

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r = value(self.radius)
        return (EllipsoidForm(ZERO, (r, r, r)),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return on_ball(between(value(self.inner), value(self.radius), s[0]), s[1], s[2])

    def measure(self, value: ValueOf) -> Any:
        R, r = value(self.radius), value(self.inner)
        return Fraction(4, 3) * value(PI) * (R * R * R - r * r * r)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        R, r = value(self.radius), value(self.inner)
        above = R * R * R * R + R * R * R * r + R * R * r * r + R * r * r * r + r * r * r * r  # both over R - r
        square = over(Fraction(2, 5) * m * above, R * R + R * r + r * r)
        return MassProperties(m, ZERO, diagonal(square, square, square))
