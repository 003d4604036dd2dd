"""Universal: a Cardan joint. Read and checked; not derived yet."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

from eomgen.model.containers import ListRule
from eomgen.model.fields import CONFIGURATION, FormulaRule, VectorRule
from eomgen.model.joints.base import Joint
from eomgen.symbolic.expressions import Expression

TwoAxes = Annotated[
    tuple[tuple[Expression, ...], ...], ListRule(VectorRule(FormulaRule(), length=3, nonzero=True), 2, 2)
]
TwoAngles = Annotated[tuple[Expression, ...], ListRule(FormulaRule("rad", "", CONFIGURATION), 2, 2)]


@dataclass(frozen=True, kw_only=True)
class Universal(Joint):
    """Two turns: axes = [first, fixed in the parent; second, fixed in the child], angles = [a, b] [rad]."""

    kind: ClassVar[str] = "universal"
    works: ClassVar[bool] = False
    axes: TwoAxes
    angles: TwoAngles

    def turns(self) -> tuple[Expression, ...]:
        return self.angles
