"""First integrals, speeds as functions of the coordinates, and laws of motion in closed form."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
