"""Rod: a thin straight line of mass."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import MassProperties, Shape, diagonal
from eomgen.model.shapes.forms import Form, LineForm
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Rod(Shape):
    """A thin homogeneous rod along x, from `start` (the origin) to `end`: I = m l^2 / 12 across it."""

    kind: ClassVar[str] = "rod"
    dimension: ClassVar[int] = 1
    length: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return (LineForm((ZERO, (value(self.length), 0, 0))),)

    def points(self, value: ValueOf) -> dict[str, Vector]:
        length = value(self.length)
        return {"origin": ZERO, "start": ZERO, "end": (length, 0, 0), "center": (Fraction(1, 2) * length, 0, 0)}

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return (value(self.length) * s[0], 0, 0)

    def measure(self, value: ValueOf) -> Any:
        return value(self.length)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        length = value(self.length)
        across = Fraction(1, 12) * m * length * length
        return MassProperties(m, (Fraction(1, 2) * length, 0, 0), diagonal(0, across, across))

    @property
    def point_names(self) -> tuple[str, ...]:
        return ("origin", "start", "end", "center")
