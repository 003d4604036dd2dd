"""Guide: a body slides without turning."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.kinds import Direction, PointName


@dataclass(frozen=True, kw_only=True)
class Guide(Constraint):
    """The point moves along `along` and its body does not turn: a normal force and a couple."""

    kind: ClassVar[str] = "guide"
    point: PointName
    along: Direction
