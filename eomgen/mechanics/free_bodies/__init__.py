"""Bodies cut free: wrenches, equilibrium, friction; what supports hold; reactions, forces that given motions need."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
