"""Identification of masses, inertias, rotors, dampers and friction from measured motions."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
