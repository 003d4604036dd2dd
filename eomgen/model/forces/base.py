"""What every force is: fields that say where it acts and by which law."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.forces.load import Load, Scalar, Scene
from eomgen.model.part import Part


@dataclass(frozen=True, kw_only=True)
class Force(Part):
    """Something applied to the system.

    A law gives `loads`, whether or not it has a `potential`: the two ways to its generalized forces.
    `works` is False for a kind that is read and checked but not derived yet.
    """

    kind: ClassVar[str]
    works: ClassVar[bool] = True
    placeless: ClassVar[bool] = False  # an energy of coordinates, which acts at no place

    def loads(self, scene: Scene) -> tuple[Load, ...]:
        """Forces and couples on bodies, and forces along coordinates."""
        return ()

    def potential(self, scene: Scene) -> Scalar | None:
        """V [J], or None where the force has none."""
        return None
