"""Hollow bodies and thin shells.

Bodies between two concentric round surfaces.
"""

from abc import ABC
from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import (
    HALF,
    PI,
    THIRD,
    MassProperties,
    Shape,
    around,
    between,
    diagonal,
    not_inside,
    on_ball,
)
from eomgen.model.shapes.forms import HALF_OF, EllipsoidForm, Form, circle_points, cylinder_form, turned_profile
from eomgen.symbolic.expression import Fraction, Vector, over, sqrt


@dataclass(frozen=True, kw_only=True)
class Hollow(Shape, ABC):
    """A round body of radius R with a concentric hole of radius r (`inner`)."""

    radius: Length
    inner: Length

    def impossible(self, value: ValueOf) -> str:
        return not_inside(value(self.inner), value(self.radius))


# -------- hollow sphere ---------------------------------------------------------------------------------------
# Hollow sphere: a ball with a concentric cavity.


@dataclass(frozen=True, kw_only=True)
class HollowSphere(Hollow):
    """A ball of radius R with a cavity of radius r (`inner`), about their centre (the origin).

    I = 2 m (R^5 - r^5) / (5 (R^3 - r^3)) about every axis.

    Args:
        radius: R, outside [m].
        inner: r, of the cavity [m].
    """

    kind: ClassVar[str] = "hollow_sphere"
    dimension: ClassVar[int] = 3

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r = value(self.radius)
        return (EllipsoidForm(Vector.ZERO, Vector((r, r, r))),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return on_ball(between(value(self.inner), value(self.radius), s[0]), s[1], s[2])

    def measure(self, value: ValueOf) -> Any:
        R, r = value(self.radius), value(self.inner)
        return Fraction(4, 3) * value(PI) * (R * R * R - r * r * r)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        R, r = value(self.radius), value(self.inner)
        above = R * R * R * R + R * R * R * r + R * R * r * r + R * r * r * r + r * r * r * r  # both over R - r
        square = over(Fraction(2, 5) * m * above, R * R + R * r + r * r)
        return MassProperties(m, Vector.ZERO, diagonal(square, square, square))


# -------- tube ------------------------------------------------------------------------------------------------
# Tube: a round bar with a concentric bore.


@dataclass(frozen=True, kw_only=True)
class Tube(Hollow):
    """A cylinder of radius R with a bore of radius r (`inner`), about its centre (the origin), length l along z.

    I_zz = m (R^2 + r^2) / 2, I_xx = I_yy = m (3 (R^2 + r^2) + l^2) / 12.

    Args:
        radius: R, outside [m].
        inner: r, of the bore [m].
        length: l, along z [m].
    """

    kind: ClassVar[str] = "tube"
    dimension: ClassVar[int] = 3
    length: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return (cylinder_form(value(self.radius), value(self.length), value(self.inner)),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        radius = between(value(self.inner), value(self.radius), s[0])
        return Vector((*around(radius, s[1]), value(self.length) * (s[2] - HALF)))

    def measure(self, value: ValueOf) -> Any:
        R, r = value(self.radius), value(self.inner)
        return value(PI) * (R * R - r * r) * value(self.length)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        R, r, length = value(self.radius), value(self.inner), value(self.length)
        quarter = Fraction(1, 4) * m * (R * R + r * r)
        across = quarter + Fraction(1, 12) * m * length * length
        return MassProperties(m, Vector.ZERO, diagonal(across, across, 2 * quarter))


# -------- conical shell ---------------------------------------------------------------------------------------
# Conical shell: the thin mantle of a cone, without its base.


@dataclass(frozen=True, kw_only=True)
class ConicalShell(Shape):
    """A thin mantle, without its base, about its mass centre (the origin), apex towards +z.

    Its base is h/3 of its height h below the origin: I_zz = m r^2 / 2, I_xx = I_yy = m r^2 / 4 + m h^2 / 18.

    Args:
        radius: r, of the rim [m].
        height: h [m].
    """

    kind: ClassVar[str] = "conical_shell"
    dimension: ClassVar[int] = 2
    radius: Length
    height: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r, h = value(self.radius), value(self.height)
        return (turned_profile(((r, -Fraction(1, 3) * h), (0, Fraction(2, 3) * h)), r),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector((*around(value(self.radius) * (1 - s[1]), s[0]), value(self.height) * (s[1] - THIRD)))

    def measure(self, value: ValueOf) -> Any:
        r, h = value(self.radius), value(self.height)
        return value(PI) * r * sqrt(r * r + h * h)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r, h = value(self.radius), value(self.height)
        across = Fraction(1, 4) * m * r * r + Fraction(1, 18) * m * h * h
        return MassProperties(m, Vector.ZERO, diagonal(across, across, Fraction(1, 2) * m * r * r))


# -------- cylindrical shell -----------------------------------------------------------------------------------
# Cylindrical shell: a thin round pipe, open at its ends.


@dataclass(frozen=True, kw_only=True)
class CylindricalShell(Shape):
    """A thin pipe, open at its ends, about its centre (the origin), length l along z.

    I_zz = m r^2, I_xx = I_yy = m (6 r^2 + l^2) / 12.

    Args:
        radius: r [m].
        length: l, along z [m].
    """

    kind: ClassVar[str] = "cylindrical_shell"
    dimension: ClassVar[int] = 2
    radius: Length
    length: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r, half = value(self.radius), HALF_OF * value(self.length)
        return (turned_profile(((r, -half), (r, half)), r),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector((*around(value(self.radius), s[0]), value(self.length) * (s[1] - HALF)))

    def measure(self, value: ValueOf) -> Any:
        return 2 * value(PI) * value(self.radius) * value(self.length)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r, length = value(self.radius), value(self.length)
        across = Fraction(1, 2) * m * r * r + Fraction(1, 12) * m * length * length
        return MassProperties(m, Vector.ZERO, diagonal(across, across, m * r * r))


# -------- hemispherical shell ---------------------------------------------------------------------------------
# Hemispherical shell: half a thin hollow ball.


@dataclass(frozen=True, kw_only=True)
class HemisphericalShell(Shape):
    """Half a thin shell, the centre of its rim at the origin, the dome towards +z.

    Centre r / 2 along z; about the origin I = 2 m r^2 / 3 about x, y and z.

    Args:
        radius: r [m].
    """

    kind: ClassVar[str] = "hemispherical_shell"
    dimension: ClassVar[int] = 2
    radius: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r = value(self.radius)
        return (turned_profile(circle_points(r, 12, 0, HALF), r),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return on_ball(value(self.radius), HALF * s[0], s[1])

    def measure(self, value: ValueOf) -> Any:
        r = value(self.radius)
        return 2 * value(PI) * r * r

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r = value(self.radius)
        z, square = Fraction(1, 2) * r, Fraction(2, 3) * m * r * r
        across = square - m * z * z
        return MassProperties(m, Vector((0, 0, z)), diagonal(across, across, square))


# -------- spherical shell -------------------------------------------------------------------------------------
# Spherical shell: a thin hollow ball.


@dataclass(frozen=True, kw_only=True)
class SphericalShell(Shape):
    """A thin homogeneous shell about its centre (the origin): I = 2 m r^2 / 3 about every axis.

    Args:
        radius: r [m].
    """

    kind: ClassVar[str] = "spherical_shell"
    dimension: ClassVar[int] = 2
    radius: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        r = value(self.radius)
        return (EllipsoidForm(Vector.ZERO, Vector((r, r, r))),)

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return on_ball(value(self.radius), s[0], s[1])

    def measure(self, value: ValueOf) -> Any:
        return 4 * value(PI) * value(self.radius) * value(self.radius)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r = value(self.radius)
        square = Fraction(2, 3) * m * r * r
        return MassProperties(m, Vector.ZERO, diagonal(square, square, square))
