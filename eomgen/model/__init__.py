"""The declared model: Model and its parts, and the reader of model files. Computes nothing."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
