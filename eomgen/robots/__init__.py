"""Files and objects of other programs <-> model files: URDF, MJCF, SDF, sympy.physics.mechanics."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
