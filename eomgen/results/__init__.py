"""Results of questions to one model: its statics, its motion at one instant, its masses, its small motions."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
