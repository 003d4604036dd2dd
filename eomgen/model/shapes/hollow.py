"""What lies between two concentric round surfaces."""

from abc import ABC

from eomgen.model.kinds import Length, ValueOf
from eomgen.model.shapes.base import Shape, not_inside
from eomgen.records import dataclass


@dataclass(frozen=True, kw_only=True)
class Hollow(Shape, ABC):
    """A round body of radius R with a concentric hole of radius r (`inner`)."""

    radius: Length
    inner: Length

    def impossible(self, value: ValueOf) -> str:
        return not_inside(value(self.inner), value(self.radius))
