"""Derivatives by parameters and starts: of the right-hand side, outputs, runs, small motions and equilibria."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
