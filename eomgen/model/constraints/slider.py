"""Slider: a point stays on the line of a body."""

from dataclasses import dataclass
from typing import ClassVar

from eomgen.model.constraints.base import Constraint
from eomgen.model.friction import FrictionLaw
from eomgen.model.kinds import BodyName, Flag, PointName


@dataclass(frozen=True, kw_only=True)
class Slider(Constraint):
    """The point stays on the line (`line = ["A", "B"]`) of body `on`.

    Args:
        point: what slides.
        on: the body whose line it is.
        unilateral: it can only push.
        friction: in the contact.
    """

    kind: ClassVar[str] = "slider"
    point: PointName
    on: BodyName
    unilateral: Flag = False
    friction: FrictionLaw | None = None
