"""Polygon: a thin plate with straight edges."""

from collections.abc import Sequence
from typing import Annotated, Any, ClassVar

from eomgen.model.containers import ListRule
from eomgen.model.fields import FormulaRule, VectorRule
from eomgen.model.kinds import ValueOf
from eomgen.model.shapes.base import Cell, MassProperties, Shape, between
from eomgen.model.shapes.forms import Form, PolygonForm
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression
from eomgen.symbolic.expression.functions import function, over
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import Vector

Vertices = Annotated[tuple[tuple[Expression, ...], ...], ListRule(VectorRule(FormulaRule("m"), length=2), least=3)]


@dataclass(frozen=True, kw_only=True)
class Polygon(Shape):
    """A thin homogeneous plate bounded by the lines from vertex to vertex (either sense of turning).

    Sums over the edges (Green): area A = sum k / 2 with k = x_i y_j - x_j y_i; the centre and the second moments follow
    from the same k. The body's axes are those in which the vertices are given.
    """

    kind: ClassVar[str] = "polygon"
    dimension: ClassVar[int] = 2
    vertices: Vertices

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return (PolygonForm(tuple((value(x), value(y), 0) for x, y in self.vertices)),)

    def impossible(self, value: ValueOf) -> str:
        corners = [(value(x), value(y)) for x, y in self.vertices]
        if crossing(corners):
            return "its edges cross one another"
        return "" if self.measure(value) else "it has no area"

    def cells(self, value: ValueOf) -> tuple[Cell, ...]:
        """The triangles from the origin to each edge; those on whose right it is take away."""
        corners = [(value(x), value(y)) for x, y in self.vertices]
        return tuple(_fan(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True))

    def measure(self, value: ValueOf) -> Any:
        corners = [(value(x), value(y)) for x, y in self.vertices]
        return Fraction(1, 2) * function("abs", _edge_sums(corners)[0])

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        corners = [(value(x), value(y)) for x, y in self.vertices]
        double_area, cx, cy, xx, yy, xy = _edge_sums(corners)
        x, y = over(cx, 3 * double_area), over(cy, 3 * double_area)
        density = over(m, double_area)  # half of it, per area
        I_xx = Fraction(1, 6) * density * xx - m * y * y
        I_yy = Fraction(1, 6) * density * yy - m * x * x
        I_xy = m * x * y - Fraction(1, 12) * density * xy
        return MassProperties(m, (x, y, 0), ((I_xx, I_xy, 0), (I_xy, I_yy, 0), (0, 0, I_xx + I_yy)))


def _fan(a: tuple[Any, Any], b: tuple[Any, Any]) -> Cell:
    """The triangle from the origin to the edge a b."""

    def at(s: Sequence[Any]) -> Vector:
        x, y = (between(a[k], b[k], s[1]) * s[0] for k in (0, 1))
        return (x, y, 0)

    return at


def _edge_sums(corners: list[tuple[Any, Any]]) -> tuple[Any, ...]:
    """2 A, 6 A x, 6 A y, 12 int y^2, 12 int x^2, 24 int x y over the area."""
    sums: list[Any] = [0] * 6
    for (x1, y1), (x2, y2) in zip(corners, corners[1:] + corners[:1], strict=True):
        k = x1 * y2 - x2 * y1
        terms = (
            k,
            (x1 + x2) * k,
            (y1 + y2) * k,
            (y1 * y1 + y1 * y2 + y2 * y2) * k,
            (x1 * x1 + x1 * x2 + x2 * x2) * k,
            (x1 * y2 + 2 * x1 * y1 + 2 * x2 * y2 + x2 * y1) * k,
        )
        sums = [total + term for total, term in zip(sums, terms, strict=True)]
    return tuple(sums)


def crossing(corners: list[tuple[Any, Any]]) -> bool:
    """Whether two edges cross; that they touch, as along a cut to a hole, does no harm. The corners are numbers."""
    edges = list(zip(corners, corners[1:] + corners[:1], strict=True))
    return any(_cross(*a, *b) for i, a in enumerate(edges) for b in edges[i + 1 :])


def _cross(a: Any, b: Any, c: Any, d: Any) -> bool:
    """Whether the segments a b and c d cross inside both."""
    return bool(_turn(a, b, c) * _turn(a, b, d) < 0 and _turn(c, d, a) * _turn(c, d, b) < 0)


def _turn(a: Any, b: Any, c: Any) -> Any:
    """Positive where c is on the left of the way from a to b: (b - a) x (c - b)."""
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
