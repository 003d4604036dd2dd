"""Shapes: the seam of homogeneous bodies.

Adding one is one class, next to its kin or in a file of its own, and one name here.
"""

from eomgen.model.shapes.base import MassProperties, Shape
from eomgen.model.shapes.hollow import (
    ConicalShell,
    CylindricalShell,
    HemisphericalShell,
    HollowSphere,
    SphericalShell,
    Tube,
)
from eomgen.model.shapes.lines import Arc, Particle, Ring, Rod
from eomgen.model.shapes.plates import Annulus, Disc, Ellipse, Polygon, Rectangle, Sector, Triangle
from eomgen.model.shapes.solids import (
    Box,
    Cone,
    Cylinder,
    Ellipsoid,
    Frustum,
    Hemisphere,
    Prism,
    Pyramid,
    Sphere,
    Tetrahedron,
    Torus,
)

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
