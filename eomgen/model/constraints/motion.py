"""Motion: a coordinate is driven through a tie, which gives its driving force."""

from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.row import TieRow
from eomgen.model.forces.load import LoadContext
from eomgen.model.kinds import CoordinateName, MotionOfCoordinate
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import as_expression


@dataclass(frozen=True, kw_only=True)
class Motion(Constraint):
    """coordinate = value(t).

    Args:
        coordinate: what is driven.
        value: where it is at each instant.
    """

    kind: ClassVar[str] = "motion"
    coordinate: CoordinateName
    value: MotionOfCoordinate

    def drives(self) -> str:
        """Its coordinate."""
        return self.coordinate

    def rows(self, scene: LoadContext) -> tuple[TieRow, ...]:
        """q - f(t) = 0; lam is the generalized force along q."""
        return (TieRow((), scene.value(as_expression(self.coordinate)) - scene.value(self.value)),)
