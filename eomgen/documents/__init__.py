"""Texts for people and machines: derivation steps, tables, quantities; their formats; pictures; their proof."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
