"""The judge: is an equation that somebody derived by hand right for a model, and if not, why."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
