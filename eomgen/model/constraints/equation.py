"""Equation: a tie written as an expression."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.row import TieRow
from eomgen.model.forces.load import Scene
from eomgen.model.kinds import Gap, RateLaw


@dataclass(frozen=True, kw_only=True)
class Equation(Constraint):
    """gap = 0 (holonomic), or rate = 0 (in the rates)."""

    kind: ClassVar[str] = "equation"
    gap: Gap | None = None
    rate: RateLaw | None = None

    def rows(self, scene: Scene) -> tuple[TieRow, ...]:
        if self.gap is not None:
            return (TieRow((), scene.value(self.gap)),)
        return (TieRow((), None, scene.value(self.rate)),)
