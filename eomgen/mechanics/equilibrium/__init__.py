"""Equilibria of systems with degrees of freedom: their places, their stability, the reactions there."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
