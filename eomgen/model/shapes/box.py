"""Box: a solid block."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Size, ValueOf
from eomgen.model.shapes.base import HALF, MassProperties, Shape, diagonal
from eomgen.model.shapes.forms import BoxForm, Form
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Box(Shape):
    """A solid block about its centre (the origin), size = [x, y, z]: I_xx = m (y^2 + z^2) / 12, and so on round."""

    kind: ClassVar[str] = "box"
    dimension: ClassVar[int] = 3
    size: Size

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        width, height, depth = map(value, self.size)
        return (BoxForm(ZERO, (width, height, depth)),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        x, y, z = map(value, self.size)
        return (x * (s[0] - HALF), y * (s[1] - HALF), z * (s[2] - HALF))

    def measure(self, value: ValueOf) -> Any:
        x, y, z = map(value, self.size)
        return x * y * z

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        x, y, z = (Fraction(1, 12) * m * value(edge) * value(edge) for edge in self.size)
        return MassProperties(m, ZERO, diagonal(y + z, z + x, x + y))
