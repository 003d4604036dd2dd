"""Particles and thin lines of mass."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.frozen import dataclass
from eomgen.model.kinds import Length, Opening, ValueOf
from eomgen.model.shapes.base import HALF, PI, MassProperties, Shape, around, diagonal, more_than_a_turn, part_of_turn
from eomgen.model.shapes.forms import HALF_OF, ArcForm, Form, LineForm, hoop
from eomgen.symbolic.expression import Fraction, Vector, over, sin

# -------- particle --------------------------------------------------------------------------------------------
# Particle: a mass without size.


@dataclass(frozen=True, kw_only=True)
class Particle(Shape):
    """A point mass at the origin: no inertia of its own."""

    kind: ClassVar[str] = "particle"
    dimension: ClassVar[int] = 0

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector.ZERO

    def measure(self, value: ValueOf) -> Any:
        return 0

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        return MassProperties(m, Vector.ZERO, diagonal(0, 0, 0))


# -------- rod -------------------------------------------------------------------------------------------------
# Rod: a thin straight line of mass.


@dataclass(frozen=True, kw_only=True)
class Rod(Shape):
    """A thin homogeneous rod along x, from `start` (the origin) to `end`: I = m l^2 / 12 across it.

    Args:
        length: l [m].
    """

    kind: ClassVar[str] = "rod"
    dimension: ClassVar[int] = 1
    length: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return (LineForm((Vector.ZERO, Vector((value(self.length), 0, 0)))),)

    def points(self, value: ValueOf) -> dict[str, Vector]:
        length = value(self.length)
        return {
            "origin": Vector.ZERO,
            "start": Vector.ZERO,
            "end": Vector((length, 0, 0)),
            "center": Vector((Fraction(1, 2) * length, 0, 0)),
        }

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector((value(self.length) * s[0], 0, 0))

    def measure(self, value: ValueOf) -> Any:
        return value(self.length)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        length = value(self.length)
        across = Fraction(1, 12) * m * length * length
        return MassProperties(m, Vector((Fraction(1, 2) * length, 0, 0)), diagonal(0, across, across))

    @property
    def point_names(self) -> tuple[str, ...]:
        return ("origin", "start", "end", "center")


# -------- arc -------------------------------------------------------------------------------------------------
# Arc: a thin rod bent to a part of a circle.


@dataclass(frozen=True, kw_only=True)
class Arc(Shape):
    """A bent rod about the centre of its circle (the origin), the angle A (`opening`) halved by +x; pi: half a hoop.

    Centre 2 r sin(A/2) / A along x; about the origin I_xx = m r^2 (1 - sin(A)/A) / 2, I_zz = m r^2.

    Args:
        radius: r, of the circle [m].
        opening: A, at the centre of the circle [rad].
    """

    kind: ClassVar[str] = "arc"
    dimension: ClassVar[int] = 1
    radius: Length
    opening: Opening

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        half = HALF_OF * value(self.opening)
        r = value(self.radius)
        return (ArcForm(Vector.ZERO, r, r, -half, half),)

    def impossible(self, value: ValueOf) -> str:
        return more_than_a_turn(value(self.opening))

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector((*around(value(self.radius), (s[0] - HALF) * part_of_turn(value(self.opening))), 0))

    def measure(self, value: ValueOf) -> Any:
        return value(self.radius) * value(self.opening)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r, A = value(self.radius), value(self.opening)
        x = over(2 * r * sin(Fraction(1, 2) * A), A)
        half, lean = Fraction(1, 2) * m * r * r, over(sin(A), A)
        shift = m * x * x
        return MassProperties(
            m, Vector((x, 0, 0)), diagonal(half * (1 - lean), half * (1 + lean) - shift, 2 * half - shift)
        )


# -------- ring ------------------------------------------------------------------------------------------------
# Ring: a thin hoop.


@dataclass(frozen=True, kw_only=True)
class Ring(Shape):
    """A thin homogeneous hoop about its centre (the origin), axis z: I_zz = m r^2, I_xx = I_yy = m r^2 / 2.

    Args:
        radius: r [m].
    """

    kind: ClassVar[str] = "ring"
    dimension: ClassVar[int] = 1
    radius: Length

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        return hoop(value(self.radius))

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return Vector((*around(value(self.radius), s[0]), 0))

    def measure(self, value: ValueOf) -> Any:
        return 2 * value(PI) * value(self.radius)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r = value(self.radius)
        square = m * r * r
        return MassProperties(m, Vector.ZERO, diagonal(Fraction(1, 2) * square, Fraction(1, 2) * square, square))
