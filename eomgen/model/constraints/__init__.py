"""Constraints: the seam of constraints.

Adding one is one class, next to its kin or in a file of its own, and one name here.
"""

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.capstan import Capstan
from eomgen.model.constraints.driven import Gear, Motion
from eomgen.model.constraints.equation import Equation
from eomgen.model.constraints.held import Clamp, Guide, Limit, Skate, Slider, Support
from eomgen.model.constraints.link import Link
from eomgen.model.constraints.pin import Pin
from eomgen.model.constraints.rolling import Rolling
from eomgen.model.constraints.string import String

ALL = (Pin, Support, Clamp, Guide, Slider, Link, Rolling, Skate, String, Capstan, Gear, Equation, Motion)

MADE = (Limit,)
"""Those that other parts of a model make."""

__all__ = [
    "ALL",
    "MADE",
    "Capstan",
    "Clamp",
    "Constraint",
    "Equation",
    "Gear",
    "Guide",
    "Limit",
    "Link",
    "Motion",
    "Pin",
    "Rolling",
    "Skate",
    "Slider",
    "String",
    "Support",
]
