"""Bodies cut free: their wrenches, their own equations, friction, and reactions by name."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
