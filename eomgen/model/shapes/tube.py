"""Tube: a round bar with a concentric bore."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import HALF, PI, MassProperties, around, between, diagonal
from eomgen.model.shapes.forms import Form, cylinder_form
from eomgen.model.shapes.hollow import Hollow
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Tube(Hollow):
    """A cylinder of radius R with a bore of radius r (`inner`), about its centre (the origin), length l along z.

    I_zz = m (R^2 + r^2) / 2, I_xx = I_yy = m (3 (R^2 + r^2) + l^2) / 12.
    """

    kind: ClassVar[str] = "tube"
    dimension: ClassVar[int] = 3
    length: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return (cylinder_form(value(self.radius), value(self.length), value(self.inner)),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        radius = between(value(self.inner), value(self.radius), s[0])
        return (*around(radius, s[1]), value(self.length) * (s[2] - HALF))

    def measure(self, value: ValueOf) -> Any:
        R, r = value(self.radius), value(self.inner)
        return value(PI) * (R * R - r * r) * value(self.length)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        R, r, length = value(self.radius), value(self.inner), value(self.length)
        quarter = Fraction(1, 4) * m * (R * R + r * r)
        across = quarter + Fraction(1, 12) * m * length * length
        return MassProperties(m, ZERO, diagonal(across, across, 2 * quarter))
