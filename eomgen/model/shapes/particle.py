"""Particle: a mass without size."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.shapes.base import MassProperties, Shape, Value, diagonal
from eomgen.symbolic.spatial import ZERO, Vector


@dataclass(frozen=True, kw_only=True)
class Particle(Shape):
    """A point mass at the origin: no inertia of its own."""

    kind: ClassVar[str] = "particle"

    def points(self, value: Value) -> dict[str, Vector]:
        return {"origin": ZERO, "center": ZERO}

    def mass_properties(self, value: Value) -> MassProperties:
        return MassProperties(self.mass_of(value), ZERO, diagonal(0, 0, 0))
