"""Arc: a thin rod bent to a part of a circle."""

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
class Arc(Shape):
    """A bent rod about the centre of its circle (the origin), the angle A (`opening`) halved by +x; pi: half a hoop.

    Centre 2 r sin(A/2) / A along x; about the origin I_xx = m r^2 (1 - sin(A)/A) / 2, I_zz = m r^2.
    """

    kind: ClassVar[str] = "arc"
    dimension: ClassVar[int] = 1
    radius: Length
    opening: Opening

    def forms(self, value: ValueOf) -> tuple[Form, ...]:
        half = HALF_OF * value(self.opening)
        r = value(self.radius)
        return (ArcForm(ZERO, r, r, -half, half),)

    def impossible(self, value: ValueOf) -> str:
        return more_than_a_turn(value(self.opening))

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return (*around(value(self.radius), (s[0] - HALF) * part_of_turn(value(self.opening))), 0)

    def measure(self, value: ValueOf) -> Any:
        return value(self.radius) * value(self.opening)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        r, A = value(self.radius), value(self.opening)
        x = over(2 * r * sin(Fraction(1, 2) * A), A)
        half, lean = Fraction(1, 2) * m * r * r, over(sin(A), A)
        shift = m * x * x
        return MassProperties(m, (x, 0, 0), diagonal(half * (1 - lean), half * (1 + lean) - shift, 2 * half - shift))
