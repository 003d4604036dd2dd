"""What every shape gives: its points and its mass properties, over any scalar."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

from eomgen.model.kinds import Mass
from eomgen.model.part import Part
from eomgen.symbolic.expressions import Expression
from eomgen.symbolic.spatial import Matrix, Vector

Value = Callable[[Expression], Any]
"""What an expression is worth: the arithmetic in which a law runs."""


@dataclass(frozen=True)
class MassProperties:
    """Mass m [kg], mass centre com (3, body axes) [m], inertia I about it (3 x 3, body axes) [kg m^2]."""

    m: Any
    com: Vector
    I: Matrix


@dataclass(frozen=True, kw_only=True)
class Shape(Part, ABC):
    """A homogeneous body of a simple form. Its mass may only be left out in a piece of a composite body."""

    kind: ClassVar[str]
    mass: Mass | None = None

    @abstractmethod
    def points(self, value: Value) -> dict[str, Vector]:
        """The named points of the shape, body axes [m]: `origin`, `center`, and its own."""

    @abstractmethod
    def mass_properties(self, value: Value) -> MassProperties:
        """Mass, mass centre and inertia of the shape."""

    def mass_of(self, value: Value) -> Any:
        return 0 if self.mass is None else value(self.mass)

    @property
    def point_names(self) -> tuple[str, ...]:
        """The names of the shape's points."""
        return ("origin", "center")


def diagonal(xx: Any, yy: Any, zz: Any) -> Matrix:
    """The 3 x 3 matrix with this diagonal."""
    return ((xx, 0, 0), (0, yy, 0), (0, 0, zz))


