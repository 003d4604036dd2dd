"""Tetrahedron: a solid with four corners."""

from collections.abc import Sequence
from typing import Annotated, Any, ClassVar

from eomgen.model.containers import ListRule
from eomgen.model.fields import FormulaRule, VectorRule
from eomgen.model.kinds import ValueOf
from eomgen.model.shapes.base import MassProperties, Shape, tensor
from eomgen.model.shapes.forms import Form, PolyhedronForm
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import function
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import Vector, cross, dot, minus, vector_of

Corners = Annotated[
    tuple[tuple[Expression, ...], ...], ListRule(VectorRule(FormulaRule("m"), length=3), least=4, most=4)
]


@dataclass(frozen=True, kw_only=True)
class Tetrahedron(Shape):
    """A solid homogeneous tetrahedron, in the axes in which its four vertices are given.

    Volume |a . (b x c)| / 6 of the edges from one vertex; the centre c is the mean of the vertices p_k, about which
    the integral of x_i x_j dm is m / 20 times the sum of (p_k - c)_i (p_k - c)_j.
    """

    kind: ClassVar[str] = "tetrahedron"
    dimension: ClassVar[int] = 3
    vertices: Corners

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return (PolyhedronForm(tuple(self._corners(value)), ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))),)

    def impossible(self, value: ValueOf) -> str:
        return "" if self.measure(value) else "its four vertices lie in one plane"

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        """a + s_1 (b - a) + s_1 s_2 (c - b) + s_1 s_2 s_3 (d - c)"""
        a, b, c, d = self._corners(value)
        steps = ((s[0], minus(b, a)), (s[0] * s[1], minus(c, b)), (s[0] * s[1] * s[2], minus(d, c)))
        return vector_of(a[i] + sum(part * step[i] for part, step in steps) for i in range(3))

    def measure(self, value: ValueOf) -> Any:
        first, *others = self._corners(value)
        a, b, c = (minus(p, first) for p in others)
        return Fraction(1, 6) * function("abs", dot(a, cross(b, c)))

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        corners = self._corners(value)
        com = vector_of(Fraction(1, 4) * sum(p[i] for p in corners) for i in range(3))
        arms = [minus(p, com) for p in corners]
        second = [[Fraction(1, 20) * m * sum(r[i] * r[j] for r in arms) for j in range(3)] for i in range(3)]
        return MassProperties(m, com, tensor(second))

    def _corners(self, value: ValueOf) -> list[Vector]:
        return [vector_of(map(value, vertex)) for vertex in self.vertices]
