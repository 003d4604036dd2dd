"""Friction of a contact: Coulomb's `mu`, or a viscous coefficient."""

from typing import Annotated, ClassVar

from eomgen.model.fields import FormulaRule
from eomgen.model.kinds import Friction
from eomgen.model.part import Part, PartRule
from eomgen.records import dataclass
from eomgen.symbolic.expression.expressions import Expression

Viscosity = Annotated[Expression, FormulaRule("s/m", "nonnegative")]  # -c N v


@dataclass(frozen=True, kw_only=True)
class Resistance(Part):
    """`friction = mu`: mu |N| against the sliding velocity; `{ viscous = c }`: -c N v."""

    shorthand: ClassVar[str] = "coulomb"
    title: ClassVar[str] = "friction"
    coulomb: Friction | None = None
    viscous: Viscosity | None = None


FrictionLaw = Annotated[Resistance, PartRule(Resistance)]
