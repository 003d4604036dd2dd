"""Constraints: the seam of ties. Adding one is one file and one name here."""

from eomgen.model.constraints.base import Constraint
from eomgen.model.constraints.clamp import Clamp
from eomgen.model.constraints.equation import Equation
from eomgen.model.constraints.gear import Gear
from eomgen.model.constraints.guide import Guide
from eomgen.model.constraints.link import Link
from eomgen.model.constraints.motion import Motion
from eomgen.model.constraints.pin import Pin
from eomgen.model.constraints.rolling import Rolling
from eomgen.model.constraints.skate import Skate
from eomgen.model.constraints.slider import Slider
from eomgen.model.constraints.string import String
from eomgen.model.constraints.support import Support

ALL = (Pin, Support, Clamp, Guide, Slider, Link, Rolling, Skate, String, Gear, Equation, Motion)

__all__ = [
    "ALL",
    "Clamp",
    "Constraint",
    "Equation",
    "Gear",
    "Guide",
    "Link",
    "Motion",
    "Pin",
    "Rolling",
    "Skate",
    "Slider",
    "String",
    "Support",
]
