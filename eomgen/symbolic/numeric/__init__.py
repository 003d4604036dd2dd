"""Values of expressions, in floats, intervals, the prime field or 50 digits, and their zeros."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
