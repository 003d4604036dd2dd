"""Particle: a mass without size."""

from collections.abc import Sequence
from typing import Any, ClassVar

from eomgen.model.kinds import ValueOf
from eomgen.model.shapes.base import MassProperties, Shape, diagonal
from eomgen.records import dataclass
from eomgen.symbolic.expression.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Particle(Shape):
    """A point mass at the origin: no inertia of its own."""

    kind: ClassVar[str] = "particle"
    dimension: ClassVar[int] = 0

    def filled(self, value: ValueOf, s: Sequence[Any]) -> Vector:
        return ZERO

    def measure(self, value: ValueOf) -> Any:
        return 0

    def of_mass(self, m: Any, value: ValueOf) -> MassProperties:
        return MassProperties(m, ZERO, diagonal(0, 0, 0))
