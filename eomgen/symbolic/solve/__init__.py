"""Exact solutions of equations: linear systems, and one equation in one unknown."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
