"""Kinematics and loads of bodies: the symbols of a derivation, poses and twists, masses, applied loads."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
