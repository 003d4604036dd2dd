"""Torus: a solid ring of round section."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import PI, MassProperties, Shape, around, diagonal
from eomgen.model.shapes.forms import Form, circle_points, turned_profile
from eomgen.records import dataclass
from eomgen.symbolic.expression.rational import Fraction
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Torus(Shape):
    """A solid ring about its centre (the origin), axis z: radius R (`major`) to the middle of its section of radius r.

    I_zz = m (R^2 + 3 r^2 / 4), I_xx = I_yy = m (R^2 / 2 + 5 r^2 / 8).
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
        return (*around(value(self.major) + out, s[2]), z)

    def measure(self, value: ValueOf) -> Any:
        return 2 * value(PI) * value(PI) * value(self.major) * value(self.minor) * value(self.minor)

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        R, r = value(self.major), value(self.minor)
        across = Fraction(1, 2) * m * R * R + Fraction(5, 8) * m * r * r
        return MassProperties(m, ZERO, diagonal(across, across, m * R * R + Fraction(3, 4) * m * r * r))
