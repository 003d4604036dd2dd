"""Checks of everything that leaves, each by a method that shares nothing with the first."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
