"""Link: a massless rod or wire of constant length."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.kinds import Flag, Length, TwoPoints


@dataclass(frozen=True, kw_only=True)
class Link(Constraint):
    """Two points keep their distance; tension positive.

    Args:
        points: the two ends.
        length: their distance [m] (None: the one at the start).
        unilateral: a wire, which can only pull.
    """

    kind: ClassVar[str] = "link"
    points: TwoPoints
    length: Length | None = None
    unilateral: Flag = False
