"""Shapes: the seam of homogeneous bodies. Adding one is one file and one name here."""

from eomgen.model.shapes.base import MassProperties, Shape
from eomgen.model.shapes.box import Box
from eomgen.model.shapes.cone import Cone
from eomgen.model.shapes.cylinder import Cylinder
from eomgen.model.shapes.disc import Disc
from eomgen.model.shapes.ellipsoid import Ellipsoid
from eomgen.model.shapes.particle import Particle
from eomgen.model.shapes.polygon import Polygon
from eomgen.model.shapes.rectangle import Rectangle
from eomgen.model.shapes.ring import Ring
from eomgen.model.shapes.rod import Rod
from eomgen.model.shapes.sphere import Sphere
from eomgen.model.shapes.triangle import Triangle

ALL = (Particle, Rod, Disc, Ring, Rectangle, Triangle, Polygon, Sphere, Cylinder, Box, Cone, Ellipsoid)

__all__ = [
    "ALL", "Box", "Cone", "Cylinder", "Disc", "Ellipsoid", "MassProperties", "Particle", "Polygon", "Rectangle", "Ring",
    "Rod", "Shape", "Sphere", "Triangle",
]  # fmt: skip
