"""Answers to the outputs of a model."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
