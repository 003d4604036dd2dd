"""The commands of the command line, one a file: each gives a document. No physics, no printing."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
