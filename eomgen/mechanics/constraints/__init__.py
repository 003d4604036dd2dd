"""Constraints: their rows, their rank, the elimination of dependent speeds, and the states that satisfy them."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
