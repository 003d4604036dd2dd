"""Runs of a model: one, one after the other from other values, many at once."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
