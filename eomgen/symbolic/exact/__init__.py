"""Exact forms of expressions: sums of terms, quotients and factors, equality, and results as a person writes them."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
