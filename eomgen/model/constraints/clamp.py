"""Clamp: a point of a body is built in."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.kinds import PointName, Points


@dataclass(frozen=True, kw_only=True)
class Clamp(Constraint):
    """A body is built into the ground at `point`, or bodies are welded together at `points`."""

    kind: ClassVar[str] = "clamp"
    point: PointName | None = None
    points: Points | None = None
