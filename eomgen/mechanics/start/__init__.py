"""Start of a motion, the same for every verb, and the ways in which loops can be assembled there."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
