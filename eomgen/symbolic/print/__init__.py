"""Printed forms of expressions: the order of a textbook, numbers, text that the grammar reads back, sympy."""

from eomgen.doors import door

__getattr__, __dir__, __all__ = door(__name__)
