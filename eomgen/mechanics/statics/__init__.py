"""Structures at rest: the velocity plan, released mechanisms, virtual work, section forces, influence lines."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
