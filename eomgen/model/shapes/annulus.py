"""Annulus: a thin round plate with a concentric hole."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import ValueOf
from eomgen.model.shapes.base import PI, MassProperties, around, between, diagonal
from eomgen.model.shapes.forms import Form, round_plate
from eomgen.model.shapes.hollow import Hollow
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Annulus(Hollow):
    """A thin round plate about its centre (the origin), axis z, between the radii r (`inner`) and R.

    I_zz = m (R^2 + r^2) / 2, I_xx = I_yy = half of it.
    """

    kind: ClassVar[str] = "annulus"
    dimension: ClassVar[int] = 2

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return round_plate(value(self.radius), value(self.inner))

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return (*around(between(value(self.inner), value(self.radius), s[0]), s[1]), 0)

    def measure(self, value: ValueOf) -> Any:
        R, r = value(self.radius), value(self.inner)
        return value(PI) * (R * R - r * r)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        R, r = value(self.radius), value(self.inner)
        quarter = Fraction(1, 4) * m * (R * R + r * r)
        return MassProperties(m, ZERO, diagonal(quarter, quarter, 2 * quarter))
