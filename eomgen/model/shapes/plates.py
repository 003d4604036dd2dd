"""Thin plates."""

from collections.abc import Sequence
from typing import Annotated, Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.fields import FormulaRule, ListRule, VectorRule
from eomgen.model.kinds import Length, Opening, PlaneSize, ValueOf
from eomgen.model.shapes.base import (
    HALF,
    PI,
    Cell,
    MassProperties,
    Shape,
    around,
    between,
    diagonal,
    more_than_a_turn,
    part_of_turn,
)
from eomgen.model.shapes.forms import HALF_OF, ArcForm, Form, LineForm, PolygonForm, box_around, round_plate
from eomgen.model.shapes.hollow import Hollow
from eomgen.symbolic.expression import Expression, Fraction, Matrix, Vector, function, over, sin

# -------- annulus ---------------------------------------------------------------------------------------------
# Annulus: a thin round plate with a concentric hole.


@dataclass(frozen=True, kw_only=True)
class Annulus(Hollow):
    """A thin round plate about its centre (the origin), axis z, between the radii r (`inner`) and R.

    I_zz = m (R^2 + r^2) / 2, I_xx = I_yy = half of it.

    Args:
        radius: R, outside [m].
        inner: r, of the hole [m].
    """

    kind: ClassVar[str] = "annulus"
    dimension: ClassVar[int] = 2

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return round_plate(value(self.radius), value(self.inner))

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector((*around(between(value(self.inner), value(self.radius), s[0]), s[1]), 0))

    def measure(self, value: ValueOf) -> Any:
        R, r = value(self.radius), value(self.inner)
        return value(PI) * (R * R - r * r)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        R, r = value(self.radius), value(self.inner)
        quarter = Fraction(1, 4) * m * (R * R + r * r)
        return MassProperties(m, Vector.ZERO, diagonal(quarter, quarter, 2 * quarter))


# -------- disc ------------------------------------------------------------------------------------------------
# Disc: a thin round plate.


@dataclass(frozen=True, kw_only=True)
class Disc(Shape):
    """A thin homogeneous disc about its centre (the origin), axis z: I_zz = m r^2 / 2, I_xx = I_yy = m r^2 / 4.

    Args:
        radius: r [m].
    """

    kind: ClassVar[str] = "disc"
    dimension: ClassVar[int] = 2
    radius: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return round_plate(value(self.radius))

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector((*around(value(self.radius) * s[0], s[1]), 0))

    def measure(self, value: ValueOf) -> Any:
        return value(PI) * value(self.radius) * value(self.radius)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r = value(self.radius)
        square = m * r * r
        quarter = Fraction(1, 4) * square
        return MassProperties(m, Vector.ZERO, diagonal(quarter, quarter, Fraction(1, 2) * square))


# -------- ellipse ---------------------------------------------------------------------------------------------
# Ellipse: a thin elliptic plate.


@dataclass(frozen=True, kw_only=True)
class Ellipse(Shape):
    """A thin plate about its centre (the origin), semiaxes = [a, b] in x and y: I_xx = m b^2 / 4, I_yy = m a^2 / 4.

    Args:
        semiaxes: a along x, b along y [m].
    """

    kind: ClassVar[str] = "ellipse"
    dimension: ClassVar[int] = 2
    semiaxes: PlaneSize

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        a, b = map(value, self.semiaxes)
        return (ArcForm(Vector.ZERO, a, b, close="chord"), LineForm((Vector.ZERO, Vector((a, 0, 0))), fine=True))

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        x, y = around(s[0], s[1])
        a, b = map(value, self.semiaxes)
        return Vector((a * x, b * y, 0))

    def measure(self, value: ValueOf) -> Any:
        a, b = map(value, self.semiaxes)
        return value(PI) * a * b

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        a, b = map(value, self.semiaxes)
        xx, yy = Fraction(1, 4) * m * b * b, Fraction(1, 4) * m * a * a
        return MassProperties(m, Vector.ZERO, diagonal(xx, yy, xx + yy))


# -------- polygon ---------------------------------------------------------------------------------------------
# Polygon: a thin plate with straight edges.


Vertices = Annotated[tuple[tuple[Expression, ...], ...], ListRule(VectorRule(FormulaRule("m"), length=2), least=3)]


@dataclass(frozen=True, kw_only=True)
class Polygon(Shape):
    """A thin homogeneous plate bounded by the lines from vertex to vertex (either sense of turning).

    Sums over the edges (Green): area A = sum k / 2 with k = x_i y_j - x_j y_i; the centre and the second moments follow
    from the same k. The body's axes are those in which the vertices are given.

    Args:
        vertices: in their order, as [[0, 0], [1, 0], [0, 1]] [m].
    """

    kind: ClassVar[str] = "polygon"
    dimension: ClassVar[int] = 2
    vertices: Vertices

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return (PolygonForm(tuple(Vector((value(x), value(y), 0)) for x, y in self.vertices)),)

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
        return MassProperties(m, Vector((x, y, 0)), Matrix.of(((I_xx, I_xy, 0), (I_xy, I_yy, 0), (0, 0, I_xx + I_yy))))


def _fan(a: tuple[Any, Any], b: tuple[Any, Any]) -> Cell:
    """The triangle from the origin to the edge a b."""

    def at(s: Sequence[Any]) -> Vector:
        x, y = (between(a[k], b[k], s[1]) * s[0] for k in (0, 1))
        return Vector((x, y, 0))

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
    """True if two edges cross; edges that only touch, as along a cut to a hole, do not. The corners are numbers."""
    edges = list(zip(corners, corners[1:] + corners[:1], strict=True))
    return any(_cross(*a, *b) for i, a in enumerate(edges) for b in edges[i + 1 :])


def _cross(a: Any, b: Any, c: Any, d: Any) -> bool:
    """True if the segments a b and c d cross inside both."""
    return bool(_turn(a, b, c) * _turn(a, b, d) < 0 and _turn(c, d, a) * _turn(c, d, b) < 0)


def _turn(a: Any, b: Any, c: Any) -> Any:
    """Positive where c is on the left of the way from a to b: (b - a) x (c - b)."""
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])


# -------- rectangle -------------------------------------------------------------------------------------------
# Rectangle: a thin plate.


@dataclass(frozen=True, kw_only=True)
class Rectangle(Shape):
    """A thin plate about its centre (the origin), width w along x, height h along y: I_zz = m (w^2 + h^2) / 12.

    Args:
        width: w, along x [m].
        height: h, along y [m].
    """

    kind: ClassVar[str] = "rectangle"
    dimension: ClassVar[int] = 2
    width: Length
    height: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return (box_around(value(self.width), value(self.height)),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector((value(self.width) * (s[0] - HALF), value(self.height) * (s[1] - HALF), 0))

    def measure(self, value: ValueOf) -> Any:
        return value(self.width) * value(self.height)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        w, h = value(self.width), value(self.height)
        xx, yy = Fraction(1, 12) * m * h * h, Fraction(1, 12) * m * w * w
        return MassProperties(m, Vector.ZERO, diagonal(xx, yy, xx + yy))


# -------- sector ----------------------------------------------------------------------------------------------
# Sector: a thin plate cut out of a disc by two radii.


@dataclass(frozen=True, kw_only=True)
class Sector(Shape):
    """A thin plate about the centre of its circle (the origin), the angle A (`opening`) halved by +x; pi: half a disc.

    Centre 4 r sin(A/2) / (3 A) along x; about the origin I_xx = m r^2 (1 - sin(A)/A) / 4, I_zz = m r^2 / 2.

    Args:
        radius: r, of the circle [m].
        opening: A, at the centre of the circle [rad].
    """

    kind: ClassVar[str] = "sector"
    dimension: ClassVar[int] = 2
    radius: Length
    opening: Opening

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        half = HALF_OF * value(self.opening)
        r = value(self.radius)
        return (ArcForm(Vector.ZERO, r, r, -half, half, close="center"),)

    def impossible(self, value: ValueOf) -> str:
        return more_than_a_turn(value(self.opening))

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector((*around(value(self.radius) * s[0], (s[1] - HALF) * part_of_turn(value(self.opening))), 0))

    def measure(self, value: ValueOf) -> Any:
        r = value(self.radius)
        return Fraction(1, 2) * value(self.opening) * r * r

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r, A = value(self.radius), value(self.opening)
        x = over(4 * r * sin(Fraction(1, 2) * A), 3 * A)
        quarter, lean = Fraction(1, 4) * m * r * r, over(sin(A), A)
        shift = m * x * x
        return MassProperties(
            m, Vector((x, 0, 0)), diagonal(quarter * (1 - lean), quarter * (1 + lean) - shift, 2 * quarter - shift)
        )


# -------- triangle --------------------------------------------------------------------------------------------
# Triangle: a thin right-angled plate.


@dataclass(frozen=True, kw_only=True)
class Triangle(Shape):
    """A thin homogeneous plate, right angle at the origin, legs w along +x and h along +y.

    Centre (w/3, h/3); about it I_xx = m h^2 / 18, I_yy = m w^2 / 18, I_xy = + m w h / 36 (the tensor's sign).

    Args:
        width: w, the leg along x [m].
        height: h, the leg along y [m].
    """

    kind: ClassVar[str] = "triangle"
    dimension: ClassVar[int] = 2
    width: Length
    height: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        w, h = value(self.width), value(self.height)
        return (PolygonForm((Vector.ZERO, Vector((w, 0, 0)), Vector((0, h, 0)))),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector((value(self.width) * s[0], value(self.height) * s[1] * (1 - s[0]), 0))

    def measure(self, value: ValueOf) -> Any:
        return Fraction(1, 2) * value(self.width) * value(self.height)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        w, h = value(self.width), value(self.height)
        xx, yy, xy = Fraction(1, 18) * m * h * h, Fraction(1, 18) * m * w * w, Fraction(1, 36) * m * w * h
        center = (Fraction(1, 3) * w, Fraction(1, 3) * h, 0)
        return MassProperties(m, Vector(center), Matrix.of(((xx, xy, 0), (xy, yy, 0), (0, 0, xx + yy))))
