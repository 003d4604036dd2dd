"""Everything that is derived of a model, once, by its name; its motion up to an instant."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
