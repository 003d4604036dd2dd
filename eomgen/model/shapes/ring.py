"""Ring: a thin hoop."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import PI, MassProperties, Shape, around, diagonal
from eomgen.model.shapes.forms import Form, hoop
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Ring(Shape):
    """A thin homogeneous hoop about its centre (the origin), axis z: I_zz = m r^2, I_xx = I_yy = m r^2 / 2."""

    kind: ClassVar[str] = "ring"
    dimension: ClassVar[int] = 1
    radius: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return hoop(value(self.radius))

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return (*around(value(self.radius), s[0]), 0)

    def measure(self, value: ValueOf) -> Any:
        return 2 * value(PI) * value(self.radius)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r = value(self.radius)
        square = m * r * r
        return MassProperties(m, ZERO, diagonal(Fraction(1, 2) * square, Fraction(1, 2) * square, square))
