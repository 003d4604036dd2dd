"""Impacts: what jumps where contacts close, in numbers and as equations."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
