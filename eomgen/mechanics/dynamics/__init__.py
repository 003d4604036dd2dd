"""Equations of motion: the system, the ways to derive them, accelerations, and properties known before any motion."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
