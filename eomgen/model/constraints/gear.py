"""Gear: two bodies turn in a fixed ratio."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.kinds import Pure, TwoBodies


@dataclass(frozen=True, kw_only=True)
class Gear(Constraint):
    """The rates of the two bodies' angles are in the ratio: omega of the first = ratio * omega of the second."""

    kind: ClassVar[str] = "gear"
    bodies: TwoBodies
    ratio: Pure
