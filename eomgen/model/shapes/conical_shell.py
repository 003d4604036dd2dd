"""Conical shell: the thin mantle of a cone, without its base."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import PI, THIRD, MassProperties, Shape, around, diagonal
from eomgen.model.shapes.forms import Form, turned_profile
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import sqrt
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class ConicalShell(Shape):
    """A thin mantle about its mass centre (the origin), apex towards +z, h/3 of its height h below the origin.

    I_zz = m r^2 / 2, I_xx = I_yy = m r^2 / 4 + m h^2 / 18.
    """

    kind: ClassVar[str] = "conical_shell"
    dimension: ClassVar[int] = 2
    radius: Length
    height: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r, h = value(self.radius), value(self.height)
        return (turned_profile(((r, -Fraction(1, 3) * h), (0, Fraction(2, 3) * h)), r),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return (*around(value(self.radius) * (1 - s[1]), s[0]), value(self.height) * (s[1] - THIRD))

    def measure(self, value: ValueOf) -> Any:
        r, h = value(self.radius), value(self.height)
        return value(PI) * r * sqrt(r * r + h * h)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r, h = value(self.radius), value(self.height)
        across = Fraction(1, 4) * m * r * r + Fraction(1, 18) * m * h * h
        return MassProperties(m, ZERO, diagonal(across, across, Fraction(1, 2) * m * r * r))
