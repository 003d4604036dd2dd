"""Skate: a knife edge."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.kinds import Direction, PointName


@dataclass(frozen=True, kw_only=True)
class Skate(Constraint):
    """No velocity of the point across `along` (body axes); the reaction acts along the left normal."""

    kind: ClassVar[str] = "skate"
    point: PointName
    along: Direction
