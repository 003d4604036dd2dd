"""Drawable elements of a model at a state, as data over the scalars of the graph."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
