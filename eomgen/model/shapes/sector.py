"""Sector: a thin plate cut out of a disc by two radii."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, Opening, ValueOf
from eomgen.model.shapes.base import (
    HALF,
    MassProperties,
    Shape,
    around,
    diagonal,
    more_than_a_turn,
    part_of_turn,
)
from eomgen.model.shapes.forms import HALF_OF, ArcForm, Form
from eomgen.records import dataclass
from eomgen.symbolic.expression.functions import over, sin
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Sector(Shape):
    """A thin plate about the centre of its circle (the origin), the angle A (`opening`) halved by +x; pi: half a disc.

    Centre 4 r sin(A/2) / (3 A) along x; about the origin I_xx = m r^2 (1 - sin(A)/A) / 4, I_zz = m r^2 / 2.
    """

    kind: ClassVar[str] = "sector"
    dimension: ClassVar[int] = 2
    radius: Length
    opening: Opening

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        half = HALF_OF * value(self.opening)
        r = value(self.radius)
        return (ArcForm(ZERO, r, r, -half, half, close="center"),)

    def impossible(self, value: ValueOf) -> str:
        return more_than_a_turn(value(self.opening))

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return (*around(value(self.radius) * s[0], (s[1] - HALF) * part_of_turn(value(self.opening))), 0)

    def measure(self, value: ValueOf) -> Any:
        r = value(self.radius)
        return Fraction(1, 2) * value(self.opening) * r * r

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r, A = value(self.radius), value(self.opening)
        x = over(4 * r * sin(Fraction(1, 2) * A), 3 * A)
        quarter, lean = Fraction(1, 4) * m * r * r, over(sin(A), A)
        shift = m * x * x
        return MassProperties(
            m, (x, 0, 0), diagonal(quarter * (1 - lean), quarter * (1 + lean) - shift, 2 * quarter - shift)
        )
