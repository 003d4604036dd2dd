"""Editors: what they ask of a model file while it is typed, over the Language Server Protocol."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
