"""Mechanisms at one instant: freed bodies under their constraints, given velocities, centres of rotation."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
