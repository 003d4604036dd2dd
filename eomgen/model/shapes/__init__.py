"""Shapes: the seam of homogeneous bodies. Adding one is one file and one name here."""

from eomgen.model.shapes.annulus import Annulus
from eomgen.model.shapes.arc import Arc
from eomgen.model.shapes.base import MassProperties, Shape
from eomgen.model.shapes.box import Box
from eomgen.model.shapes.cone import Cone
from eomgen.model.shapes.conical_shell import ConicalShell
from eomgen.model.shapes.cylinder import Cylinder
from eomgen.model.shapes.cylindrical_shell import CylindricalShell
from eomgen.model.shapes.disc import Disc
from eomgen.model.shapes.ellipse import Ellipse
from eomgen.model.shapes.ellipsoid import Ellipsoid
from eomgen.model.shapes.frustum import Frustum
from eomgen.model.shapes.hemisphere import Hemisphere
from eomgen.model.shapes.hemispherical_shell import HemisphericalShell
from eomgen.model.shapes.hollow_sphere import HollowSphere
from eomgen.model.shapes.particle import Particle
from eomgen.model.shapes.polygon import Polygon
from eomgen.model.shapes.prism import Prism
from eomgen.model.shapes.pyramid import Pyramid
from eomgen.model.shapes.rectangle import Rectangle
from eomgen.model.shapes.ring import Ring
from eomgen.model.shapes.rod import Rod
from eomgen.model.shapes.sector import Sector
from eomgen.model.shapes.sphere import Sphere
from eomgen.model.shapes.spherical_shell import SphericalShell
from eomgen.model.shapes.tetrahedron import Tetrahedron
from eomgen.model.shapes.torus import Torus
from eomgen.model.shapes.triangle import Triangle
from eomgen.model.shapes.tube import Tube

ALL = (
    Particle,
    Rod,
    Arc,
    Disc,
    Annulus,
    Sector,
    Ellipse,
    Ring,
    Rectangle,
    Triangle,
    Polygon,
    Sphere,
    HollowSphere,
    SphericalShell,
    Hemisphere,
    HemisphericalShell,
    Cylinder,
    Tube,
    CylindricalShell,
    Box,
    Prism,
    Cone,
    ConicalShell,
    Frustum,
    Pyramid,
    Tetrahedron,
    Ellipsoid,
    Torus,
)

__all__ = [
    "ALL",
    "Annulus",
    "Arc",
    "Box",
    "Cone",
    "ConicalShell",
    "Cylinder",
    "CylindricalShell",
    "Disc",
    "Ellipse",
    "Ellipsoid",
    "Frustum",
    "Hemisphere",
    "HemisphericalShell",
    "HollowSphere",
    "MassProperties",
    "Particle",
    "Polygon",
    "Prism",
    "Pyramid",
    "Rectangle",
    "Ring",
    "Rod",
    "Sector",
    "Shape",
    "Sphere",
    "SphericalShell",
    "Tetrahedron",
    "Torus",
    "Triangle",
    "Tube",
]
