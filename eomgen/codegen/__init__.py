"""Program: straight-line statements in any language; compiled, loaded, with right answers."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
