"""Joints: the seam of the connections of bodies to their parents.

Adding one is one class, next to its kin or in a file of its own, and one name here.
"""

from eomgen.model.joints.ball import Spherical, Universal
from eomgen.model.joints.base import Effort, Joint, Turned
from eomgen.model.joints.free import Fixed, Free, Planar
from eomgen.model.joints.one_axis import Cylindrical, Prismatic, Revolute, Screw
from eomgen.model.joints.path import Path, PathPiece
from eomgen.model.joints.placed import Placed

ALL = (Fixed, Revolute, Prismatic, Cylindrical, Screw, Universal, Planar, Spherical, Free, Placed, Path)

__all__ = [
    "ALL",
    "Cylindrical",
    "Effort",
    "Fixed",
    "Free",
    "Joint",
    "Path",
    "PathPiece",
    "Placed",
    "Planar",
    "Prismatic",
    "Revolute",
    "Screw",
    "Spherical",
    "Turned",
    "Universal",
]
