"""Reactions, the forces that given motions need, and the test that bodies are in balance at a state."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
