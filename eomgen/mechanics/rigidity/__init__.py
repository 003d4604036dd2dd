"""Rigidity of a system at one configuration: structures with their mobility, and plans of possible velocities."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
