"""Solid bodies."""

from collections.abc import Sequence
from typing import Annotated, Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.fields import FormulaRule, ListRule, VectorRule
from eomgen.model.kinds import Length, Size, ValueOf
from eomgen.model.shapes.base import HALF, PI, Cell, MassProperties, Shape, around, between, diagonal, on_ball, tensor
from eomgen.model.shapes.forms import (
    HALF_OF,
    BoxForm,
    EllipsoidForm,
    Form,
    PolyhedronForm,
    PrismForm,
    circle_points,
    cylinder_form,
    turned_profile,
)
from eomgen.model.shapes.plates import Polygon, Vertices
from eomgen.symbolic.expression import Expression, Fraction, Vector, function, over

# -------- box -------------------------------------------------------------------------------------------------
# Box: a solid block.


@dataclass(frozen=True, kw_only=True)
class Box(Shape):
    """A solid block about its centre (the origin), size = [x, y, z]: I_xx = m (y^2 + z^2) / 12, and so on round.

    Args:
        size: the edges along x, y and z [m].
    """

    kind: ClassVar[str] = "box"
    dimension: ClassVar[int] = 3
    size: Size

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        width, height, depth = map(value, self.size)
        return (BoxForm(Vector.ZERO, Vector((width, height, depth))),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        x, y, z = map(value, self.size)
        return Vector((x * (s[0] - HALF), y * (s[1] - HALF), z * (s[2] - HALF)))

    def measure(self, value: ValueOf) -> Any:
        x, y, z = map(value, self.size)
        return x * y * z

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        x, y, z = (Fraction(1, 12) * m * value(edge) * value(edge) for edge in self.size)
        return MassProperties(m, Vector.ZERO, diagonal(y + z, z + x, x + y))


# -------- cone ------------------------------------------------------------------------------------------------
# Cone: a solid round cone.


@dataclass(frozen=True, kw_only=True)
class Cone(Shape):
    """A solid cone about its mass centre (the origin), apex towards +z, h/4 of its height h below the origin.

    I_zz = 3 m r^2 / 10, I_xx = I_yy = 3 m (4 r^2 + h^2) / 80.

    Args:
        radius: r, of the base [m].
        height: h [m].
    """

    kind: ClassVar[str] = "cone"
    dimension: ClassVar[int] = 3
    radius: Length
    height: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r, h = value(self.radius), value(self.height)
        base, apex = -Fraction(1, 4) * h, Fraction(3, 4) * h
        return (turned_profile(((0, base), (r, base), (0, apex)), r),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector(
            (*around(value(self.radius) * (1 - s[2]) * s[0], s[1]), value(self.height) * (s[2] - HALF * HALF))
        )

    def measure(self, value: ValueOf) -> Any:
        return Fraction(1, 3) * value(PI) * value(self.radius) * value(self.radius) * value(self.height)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r, h = value(self.radius), value(self.height)
        across = Fraction(3, 20) * m * r * r + Fraction(3, 80) * m * h * h
        return MassProperties(m, Vector.ZERO, diagonal(across, across, Fraction(3, 10) * m * r * r))


# -------- cylinder --------------------------------------------------------------------------------------------
# Cylinder: a solid round bar.


@dataclass(frozen=True, kw_only=True)
class Cylinder(Shape):
    """A solid cylinder about its centre (the origin), length l along z.

    I_zz = m r^2 / 2, I_xx = I_yy = m (3 r^2 + l^2) / 12.

    Args:
        radius: r [m].
        length: l, along z [m].
    """

    kind: ClassVar[str] = "cylinder"
    dimension: ClassVar[int] = 3
    radius: Length
    length: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return (cylinder_form(value(self.radius), value(self.length)),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector((*around(value(self.radius) * s[0], s[1]), value(self.length) * (s[2] - HALF)))

    def measure(self, value: ValueOf) -> Any:
        return value(PI) * value(self.radius) * value(self.radius) * value(self.length)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r, length = value(self.radius), value(self.length)
        across = Fraction(1, 4) * m * r * r + Fraction(1, 12) * m * length * length
        return MassProperties(m, Vector.ZERO, diagonal(across, across, Fraction(1, 2) * m * r * r))


# -------- ellipsoid -------------------------------------------------------------------------------------------
# Ellipsoid: a solid one.


@dataclass(frozen=True, kw_only=True)
class Ellipsoid(Shape):
    """A solid ellipsoid about its centre (the origin), semiaxes = [a, b, c]: I_xx = m (b^2 + c^2) / 5, and so on.

    Args:
        semiaxes: a, b, c along x, y, z [m].
    """

    kind: ClassVar[str] = "ellipsoid"
    dimension: ClassVar[int] = 3
    semiaxes: Size

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        a, b, c = map(value, self.semiaxes)
        return (EllipsoidForm(Vector.ZERO, Vector((a, b, c))),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector(value(a) * x for a, x in zip(self.semiaxes, on_ball(s[0], s[1], s[2]), strict=True))

    def measure(self, value: ValueOf) -> Any:
        a, b, c = map(value, self.semiaxes)
        return Fraction(4, 3) * value(PI) * a * b * c

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        x, y, z = (Fraction(1, 5) * m * value(axis) * value(axis) for axis in self.semiaxes)
        return MassProperties(m, Vector.ZERO, diagonal(y + z, z + x, x + y))


# -------- frustum ---------------------------------------------------------------------------------------------
# Frustum: a solid round cone without its tip.


@dataclass(frozen=True, kw_only=True)
class Frustum(Shape):
    """A solid frustum, the centre of its base at the origin, radius R there and r (`top`) at the height h along +z.

    With s = R^2 + R r + r^2: centre h (R^2 + 2 R r + 3 r^2) / (4 s); I_zz = 3 m (R^5 - r^5) / (10 (R^3 - r^3));
    the integral of z^2 dm is m h^2 (R^2 + 3 R r + 6 r^2) / (10 s).

    Args:
        radius: R, of the base [m].
        top: r, of the other end [m].
        height: h [m].
    """

    kind: ClassVar[str] = "frustum"
    dimension: ClassVar[int] = 3
    radius: Length
    top: Length
    height: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        R, r, h = value(self.radius), value(self.top), value(self.height)
        return (turned_profile(((0, 0), (R, 0), (r, h), (0, h)), R),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        radius = between(value(self.radius), value(self.top), s[2])
        return Vector((*around(radius * s[0], s[1]), value(self.height) * s[2]))

    def measure(self, value: ValueOf) -> Any:
        R, r = value(self.radius), value(self.top)
        return Fraction(1, 3) * value(PI) * value(self.height) * (R * R + R * r + r * r)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        R, r, h = value(self.radius), value(self.top), value(self.height)
        s = R * R + R * r + r * r
        z = over(Fraction(1, 4) * h * (R * R + 2 * R * r + 3 * r * r), s)
        fifth = R * R * R * R + R * R * R * r + R * R * r * r + R * r * r * r + r * r * r * r  # both over R - r
        I_zz = over(Fraction(3, 10) * m * fifth, s)
        along = over(Fraction(1, 10) * m * h * h * (R * R + 3 * R * r + 6 * r * r), s)
        across = Fraction(1, 2) * I_zz + along - m * z * z
        return MassProperties(m, Vector((0, 0, z)), diagonal(across, across, I_zz))


# -------- hemisphere ------------------------------------------------------------------------------------------
# Hemisphere: half a solid ball.


@dataclass(frozen=True, kw_only=True)
class Hemisphere(Shape):
    """Half a solid ball, the centre of its flat face at the origin, the dome towards +z.

    Centre 3 r / 8 along z; about the origin I = 2 m r^2 / 5 about x, y and z.

    Args:
        radius: r [m].
    """

    kind: ClassVar[str] = "hemisphere"
    dimension: ClassVar[int] = 3
    radius: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r = value(self.radius)
        return (turned_profile(((0, 0), *circle_points(r, 12, 0, HALF)), r),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return on_ball(value(self.radius) * s[0], HALF * s[1], s[2])

    def measure(self, value: ValueOf) -> Any:
        r = value(self.radius)
        return Fraction(2, 3) * value(PI) * r * r * r

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r = value(self.radius)
        z, square = Fraction(3, 8) * r, Fraction(2, 5) * m * r * r
        across = square - m * z * z
        return MassProperties(m, Vector((0, 0, z)), diagonal(across, across, square))


# -------- prism -----------------------------------------------------------------------------------------------
# Prism: a solid whose section is a polygon.


@dataclass(frozen=True, kw_only=True)
class Prism(Shape):
    """A solid with the section of a polygon, from -l/2 to l/2 along z; its axes are those of the vertices.

    To the polygon's moments about x and y come m l^2 / 12.

    Args:
        vertices: of its section, in their order [m].
        length: l, along z [m].
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
        return MassProperties(m, plate.com, plate.I + diagonal(across, across, 0))


def _raised(cell: Cell, length: Any) -> Cell:
    """Prism on a cell of the section, from -l/2 to l/2."""
    return lambda s: Vector((*cell(s)[:2], length * (s[2] - HALF)))


# -------- pyramid ---------------------------------------------------------------------------------------------
# Pyramid: a solid one on a rectangle.


@dataclass(frozen=True, kw_only=True)
class Pyramid(Shape):
    """A solid pyramid about its mass centre (the origin), apex towards +z, h/4 of its height h below the origin.

    Its base is w wide along x and d deep along y: I_xx = m (d^2 / 20 + 3 h^2 / 80), I_zz = m (w^2 + d^2) / 20.

    Args:
        width: w, of the base along x [m].
        depth: d, of the base along y [m].
        height: h [m].
    """

    kind: ClassVar[str] = "pyramid"
    dimension: ClassVar[int] = 3
    width: Length
    depth: Length
    height: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        x, y, h = HALF_OF * value(self.width), HALF_OF * value(self.depth), value(self.height)
        low, apex = -Fraction(1, 4) * h, Vector((0, 0, Fraction(3, 4) * h))
        points = (*(Vector(p) for p in ((-x, -y, low), (x, -y, low), (x, y, low), (-x, y, low))), apex)
        return (PolyhedronForm(points, ((3, 2, 1, 0), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4))),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        x, y = (
            value(edge) * (part - HALF) * (1 - s[2]) for edge, part in zip((self.width, self.depth), s, strict=False)
        )
        return Vector((x, y, value(self.height) * (s[2] - HALF * HALF)))

    def measure(self, value: ValueOf) -> Any:
        return Fraction(1, 3) * value(self.width) * value(self.depth) * value(self.height)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        x, y = (Fraction(1, 20) * m * value(edge) * value(edge) for edge in (self.width, self.depth))
        z = Fraction(3, 80) * m * value(self.height) * value(self.height)
        return MassProperties(m, Vector.ZERO, diagonal(y + z, z + x, x + y))


# -------- sphere ----------------------------------------------------------------------------------------------
# Sphere: a solid ball.


@dataclass(frozen=True, kw_only=True)
class Sphere(Shape):
    """A solid homogeneous ball about its centre (the origin): I = 2 m r^2 / 5 about every axis.

    Args:
        radius: r [m].
    """

    kind: ClassVar[str] = "sphere"
    dimension: ClassVar[int] = 3
    radius: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r = value(self.radius)
        return (EllipsoidForm(Vector.ZERO, Vector((r, r, r))),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return on_ball(value(self.radius) * s[0], s[1], s[2])

    def measure(self, value: ValueOf) -> Any:
        return Fraction(4, 3) * value(PI) * value(self.radius) * value(self.radius) * value(self.radius)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r = value(self.radius)
        square = Fraction(2, 5) * m * r * r
        return MassProperties(m, Vector.ZERO, diagonal(square, square, square))


# -------- tetrahedron -----------------------------------------------------------------------------------------
# Tetrahedron: a solid with four corners.


Corners = Annotated[
    tuple[tuple[Expression, ...], ...], ListRule(VectorRule(FormulaRule("m"), length=3), least=4, most=4)
]


@dataclass(frozen=True, kw_only=True)
class Tetrahedron(Shape):
    """A solid homogeneous tetrahedron, in the axes in which its four vertices are given.

    Volume |a . (b x c)| / 6 of the edges from one vertex; the centre c is the mean of the vertices p_k, about which
    the integral of x_i x_j dm is m / 20 times the sum of (p_k - c)_i (p_k - c)_j.

    Args:
        vertices: four of them [m].
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
        steps = ((s[0], b - a), (s[0] * s[1], c - b), (s[0] * s[1] * s[2], d - c))
        return Vector(a[i] + sum(part * step[i] for part, step in steps) for i in range(3))

    def measure(self, value: ValueOf) -> Any:
        first, *others = self._corners(value)
        a, b, c = (p - first for p in others)
        return Fraction(1, 6) * function("abs", a @ b.cross(c))

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        corners = self._corners(value)
        com = Vector(Fraction(1, 4) * sum(p[i] for p in corners) for i in range(3))
        arms = [p - com for p in corners]
        second = [[Fraction(1, 20) * m * sum(r[i] * r[j] for r in arms) for j in range(3)] for i in range(3)]
        return MassProperties(m, com, tensor(second))

    def _corners(self, value: ValueOf) -> list[Vector]:
        return [Vector(map(value, vertex)) for vertex in self.vertices]


# -------- torus -----------------------------------------------------------------------------------------------
# Torus: a solid ring of round section.


@dataclass(frozen=True, kw_only=True)
class Torus(Shape):
    """A solid ring about its centre (the origin), axis z: radius R (`major`) to the middle of its section of radius r.

    I_zz = m (R^2 + 3 r^2 / 4), I_xx = I_yy = m (R^2 / 2 + 5 r^2 / 8).

    Args:
        major: R, from the centre to the middle of the section [m].
        minor: r, of the section [m].
    """

    kind: ClassVar[str] = "torus"
    dimension: ClassVar[int] = 3
    is_tyre: ClassVar[bool] = True
    major: Length
    minor: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        R, r = value(self.major), value(self.minor)
        profile = tuple((R + x, z) for x, z in circle_points(r, 16, 0, 2))
        return (turned_profile(profile, R + r, R - r),)

    def impossible(self, value: ValueOf) -> str:
        return "" if value(self.minor) <= value(self.major) else "'minor' is larger than 'major'"

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        out, z = around(value(self.minor) * s[0], s[1])
        return Vector((*around(value(self.major) + out, s[2]), z))

    def measure(self, value: ValueOf) -> Any:
        return 2 * value(PI) * value(PI) * value(self.major) * value(self.minor) * value(self.minor)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        R, r = value(self.major), value(self.minor)
        across = Fraction(1, 2) * m * R * R + Fraction(5, 8) * m * r * r
        return MassProperties(m, Vector.ZERO, diagonal(across, across, m * R * R + Fraction(3, 4) * m * r * r))
