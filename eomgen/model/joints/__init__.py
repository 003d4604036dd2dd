"""Joints: the seam of how a body hangs on its parent. Adding one is one file and one name here."""

from eomgen.model.joints.base import Effort, Joint, Turned
from eomgen.model.joints.cylindrical import Cylindrical
from eomgen.model.joints.fixed import Fixed
from eomgen.model.joints.free import Free
from eomgen.model.joints.path import Path, PathPiece
from eomgen.model.joints.placed import Placed
from eomgen.model.joints.planar import Planar
from eomgen.model.joints.prismatic import Prismatic
from eomgen.model.joints.revolute import Revolute
from eomgen.model.joints.screw import Screw
from eomgen.model.joints.spherical import Spherical
from eomgen.model.joints.universal import Universal

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
