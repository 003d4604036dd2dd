"""Base class of shapes: named points and mass properties, over any scalar."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.kinds import Mass, ValueOf
from eomgen.model.part import Part
from eomgen.model.shapes.forms import Form
from eomgen.symbolic.expression import Fraction, Matrix, Scalar, SpatialInertia, Vector, over, parse
from eomgen.symbolic.numeric import tolerances

Cell = Callable[[Sequence[Any]], Vector]
PI = parse("pi")
HALF, THIRD = 0.5, 1 / 3  # of a length in numbers


class InertiaMatrix(Matrix):
    """I of some bodies about a point: the integral of (r.r 1 - r r^T) dm, 3 x 3 [kg m^2]."""

    __slots__ = ()

    @classmethod
    def of_moments(cls, xx: Any, yy: Any, zz: Any, xy: Any = 0, yz: Any = 0, zx: Any = 0) -> "InertiaMatrix":
        """The symmetric matrix with these entries."""
        return cls((Vector((xx, xy, zx)), Vector((xy, yy, yz)), Vector((zx, yz, zz))))

    def about_axis(self, along: Vector) -> Scalar:
        """d.I d / d.d, the moment about the axis through the point in the direction d, of any length."""
        return over(along @ (self @ along), along @ along)

    @property
    def polar(self) -> Scalar:
        """Moment about the point itself: the integral of r.r dm = tr(I) / 2."""
        found: Scalar = Fraction(1, 2) * (self[0][0] + self[1][1] + self[2][2])
        return found

    @property
    def second_moments(self) -> Matrix:
        """P = tr(I) / 2 - I, the integrals of x_i x_j dm: moments about planes, and the textbook's products, with +."""
        half = self.polar
        return Matrix.of(((half if i == j else 0) - self[i][j] for j in range(3)) for i in range(3))

    def is_possible(self, size: float = 0.0) -> bool:
        """True if a body can have it, in numbers: no principal minor of P is negative (the triangle inequality).

        Args:
            size: of what the moments were added up from, where that is larger than they are.
        """
        (xx, xy, zx), (_, yy, yz), (_, _, zz) = self
        size = max(size, *map(abs, (xx, yy, zz, xy, yz, zx))) or 1.0
        xx, yy, zz, xy, yz, zx = (x / size for x in (xx, yy, zz, xy, yz, zx))
        half = (xx + yy + zz) / 2
        a, b, c = half - xx, half - yy, half - zz
        determinant = a * (b * c - yz * yz) - xy * (xy * c + yz * zx) - zx * (xy * yz + b * zx)
        second = (a * b - xy * xy, b * c - yz * yz, c * a - zx * zx)
        return bool(min(a, b, c, *second, determinant) >= -tolerances.SOLVED)


@dataclass(frozen=True)
class MassProperties:
    """Mass m [kg], mass centre com (3, body axes) [m], inertia I about it (3 x 3, body axes) [kg m^2]."""

    m: Any
    com: Vector
    I: Matrix

    @property
    def scalars(self) -> tuple[Any, ...]:
        """m, com and I, row by row: 13 scalars."""
        return (self.m, *self.com, *(x for row in self.I for x in row))

    @staticmethod
    def of_scalars(scalars: Sequence[Any]) -> "MassProperties":
        """The mass properties of these 13 scalars."""
        m, *others = scalars
        return MassProperties(m, Vector(others[:3]), Matrix.of((others[3:6], others[6:9], others[9:12])))

    def about(self, point: Vector) -> Matrix:
        """Inertia about a point, the axes unchanged: I + m (d.d 1 - d d^T), d from the point to the mass centre."""
        return SpatialInertia.about_center(self.m, self.com - point, self.I).I


@dataclass(frozen=True, kw_only=True)
class Shape(Part, ABC):
    """A homogeneous body of a simple form. Its mass may only be left out in a piece of a composite body.

    Args:
        mass: m; 0 makes a massless body [kg].
    """

    kind: ClassVar[str]
    dimension: ClassVar[int]  # what its mass is spread over: 0 a point, 1 a line, 2 a surface, 3 a volume
    is_tyre: ClassVar[bool] = False  # a ring with radii `major`, `minor`, which rolls on its section
    mass: Mass | None = None

    @property
    def is_point(self) -> bool:
        """True if its mass has no extent."""
        return self.dimension == 0

    def points(self, value: ValueOf) -> dict[str, Vector]:
        """The named points of the shape, body axes [m]: `origin`, `center`, the mass centre, and its own."""
        return {"origin": Vector.ZERO, "center": self.of_mass(1, value).com}

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        """The point at s, as many parts from 0 to 1 as it has dimensions, which run through all of it once.

        Lengths are numbers; the parts may be arrays of complex numbers: what follows is smooth in them.
        """
        raise NotImplementedError

    def cells(self, value: ValueOf) -> tuple[Cell, ...]:
        """The maps from [0, 1]^dimension that fill it: `filled`, or several whose measures count with their sign."""
        return (lambda s: self.filled(value, s),)

    @abstractmethod
    def measure(self, value: ValueOf) -> Any:
        """Its length [m], area [m^2] or volume [m^3], as its dimension says."""

    @abstractmethod
    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        """Mass centre and inertia of the shape if its mass is m."""

    def mass_properties(self, value: ValueOf) -> MassProperties:
        """Mass, mass centre and inertia of the shape."""
        return self.of_mass(self.mass_of(value), value)

    def impossible(self, value: ValueOf) -> str:
        """The reason why no such body exists, "" where one does; the values are numbers."""
        return ""

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        """Forms that a picture shows of it, body axes."""
        return ()

    def mass_of(self, value: ValueOf) -> Any:
        return 0 if self.mass is None else value(self.mass)

    @property
    def point_names(self) -> tuple[str, ...]:
        """The names of the shape's points."""
        return ("origin", "center")


def diagonal(xx: Any, yy: Any, zz: Any) -> Matrix:
    """The 3 x 3 matrix with this diagonal."""
    return Matrix.of(((xx, 0, 0), (0, yy, 0), (0, 0, zz)))


def tensor(second: Sequence[Sequence[Any]]) -> Matrix:
    """The inertia tensor from the second moments P_ij, the integrals of x_i x_j dm: I = tr(P) 1 - P."""
    trace = second[0][0] + second[1][1] + second[2][2]
    return Matrix.of(((trace if i == j else 0) - second[i][j] for j in range(3)) for i in range(3))


def around(radius: Any, turn: Any) -> tuple[Any, Any]:
    """(x, y) at a distance from the origin, a part of a whole turn from +x."""
    from numpy import cos, sin

    angle = 2 * math.pi * turn
    return radius * cos(angle), radius * sin(angle)


def on_ball(radius: Any, fall: Any, turn: Any) -> Vector:
    """(x, y, z) at a distance from the origin, a part of half a turn down from +z, a part of a turn about it."""
    z, out = around(radius, HALF * fall)
    return Vector((*around(out, turn), z))


def between(start: Any, end: Any, part: Any) -> Any:
    """The value at `part` of the way from the one to the other."""
    return start + part * (end - start)


def part_of_turn(angle: Any) -> Any:
    return angle / (2 * math.pi)


def not_inside(inner: Any, outer: Any) -> str:
    """The error of a hollow body's inner radius; "" if there is none."""
    return "" if inner < outer else "'inner' is not smaller than 'radius'"


def more_than_a_turn(opening: float) -> str:
    """The error of the angle of a sector or an arc; "" if there is none."""
    return "" if opening <= 2 * math.pi * (1 + tolerances.SOLVED) else "'opening' is more than a whole turn"
