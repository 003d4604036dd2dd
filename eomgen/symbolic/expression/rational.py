"""Exact rationals: those of quicktions, compiled, with the values, texts and hashes of Python's own.

Every module takes its Fraction from here. Text becomes one by fraction_of alone: of
one character quicktions 1.24 writes over the interpreter's own b"\\0", and GIFs and zips written after it are broken.
"""

from __future__ import annotations

import fractions
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fractions import Fraction
else:
    from quicktions import Fraction

__all__ = ["EXACT", "Fraction", "fraction_of", "known_to_sympy"]

EXACT = (int, Fraction, fractions.Fraction)  # what is taken as an exact number; what is made is an int or a Fraction


def fraction_of(text: str) -> Fraction:
    """The number that a text spells ("3", "0.1", "1e-6", "1/180")."""
    return Fraction(f"{text} ")


def known_to_sympy() -> None:
    """Has sympy take the compiled rationals as the exact numbers that they are: it would make floats of them."""
    from sympy import Rational
    from sympy.core.sympify import converter

    converter[Fraction] = lambda x: Rational(int(x.numerator), int(x.denominator))


if "sympy" in sys.modules:  # else where this package imports it
    known_to_sympy()
