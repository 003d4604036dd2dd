"""Cylindrical shell: a thin round pipe, open at its ends."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import HALF, PI, MassProperties, Shape, around, diagonal
from eomgen.model.shapes.forms import HALF_OF, Form, turned_profile
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class CylindricalShell(Shape):
    """A thin pipe about its centre (the origin), length l along z: I_zz = m r^2, I_xx = I_yy = m (6 r^2 + l^2) / 12."""

    kind: ClassVar[str] = "cylindrical_shell"
    dimension: ClassVar[int] = 2
    radius: Length
    length: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r, half = value(self.radius), HALF_OF * value(self.length)
        return (turned_profile(((r, -half), (r, half)), r),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return (*around(value(self.radius), s[0]), value(self.length) * (s[1] - HALF))

    def measure(self, value: ValueOf) -> Any:
        return 2 * value(PI) * value(self.radius) * value(self.length)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r, length = value(self.radius), value(self.length)
        across = Fraction(1, 2) * m * r * r + Fraction(1, 12) * m * length * length
        return MassProperties(m, ZERO, diagonal(across, across, m * r * r))
