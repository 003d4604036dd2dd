"""Motion: a coordinate is driven through a tie, which gives its driving force."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.kinds import CoordinateName, TimeLaw


@dataclass(frozen=True, kw_only=True)
class Motion(Constraint):
    """coordinate = value(t)."""

    kind: ClassVar[str] = "motion"
    coordinate: CoordinateName
    value: TimeLaw
