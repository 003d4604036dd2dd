"""Prism: a solid whose section is a polygon."""

from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import HALF, Cell, MassProperties, Shape, diagonal
from eomgen.model.shapes.forms import HALF_OF, Form, PrismForm
from eomgen.model.shapes.polygon import Polygon, Vertices
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import added


@dataclass(frozen=True, kw_only=True)
class Prism(Shape):
    """A solid with the section of a polygon, from -l/2 to l/2 along z; its axes are those of the vertices.

    To the polygon's moments about x and y come m l^2 / 12.
    """

    kind: ClassVar[str] = "prism"
    dimension: ClassVar[int] = 3
    vertices: Vertices
    length: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        half = HALF_OF * value(self.length)
        return (PrismForm(tuple((value(x), value(y)) for x, y in self.vertices), -half, half),)

    @property
    def section(self) -> Polygon:
        return Polygon(vertices=self.vertices)

    def impossible(self, value: ValueOf) -> str:
        return self.section.impossible(value)

    def cells(self, value: ValueOf) -> tuple[Cell, ...]:
        return tuple(_raised(cell, value(self.length)) for cell in self.section.cells(value))

    def measure(self, value: ValueOf) -> Any:
        return self.section.measure(value) * value(self.length)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        plate = self.section.of_mass(m, value)
        across = Fraction(1, 12) * m * value(self.length) * value(self.length)
        return MassProperties(m, plate.com, added(plate.I, diagonal(across, across, 0)))


def _raised(cell: Cell, length: Any) -> Cell:
    """What stands on a cell of the section, from -l/2 to l/2."""
    return lambda s: (*cell(s)[:2], length * (s[2] - HALF))
