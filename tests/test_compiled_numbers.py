"""Exact numbers and polynomials are those of quicktions and python-flint, met in one module each."""

from __future__ import annotations

import fractions
import pickle
import re
from pathlib import Path

import pytest
import sympy

from eomgen.symbolic.expression.formula import over, sqrt
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.rational import Fraction, fraction_of, known_to_sympy

pytestmark = pytest.mark.slow

PACKAGE = Path(__file__).parent.parent / "eomgen"


def test_a_fraction_of_the_standard_library_is_taken_as_the_exact_number_that_it_is():
    """x Fraction(1, 3) is x/3, by whichever class a user writes it; hashes and texts agree."""
    x, third = Graph().symbol("x"), fractions.Fraction(1, 3)
    assert third * x is Fraction(1, 3) * x
    assert (x + third) - Fraction(1, 3) is x
    assert hash(third) == hash(Fraction(1, 3)) and str(third) == str(Fraction(1, 3))
    assert sqrt(fractions.Fraction(4, 9)) == over(2, 3) == Fraction(2, 3)
    assert pickle.loads(pickle.dumps(Fraction(1, 3))) == third


def test_sympy_takes_our_rationals_as_exact_numbers():
    """x/3 with sympy's x holds the rational 1/3, not a float, once the package has met sympy."""
    known_to_sympy()
    form = sympy.Symbol("x") * Fraction(1, 3) + Fraction(1, 7)
    assert not form.atoms(sympy.Float) and form.atoms(sympy.Rational) == {sympy.Rational(1, 3), sympy.Rational(1, 7)}


def test_one_module_meets_the_rationals_and_one_the_polynomials():
    """Every other module takes them from there: two classes side by side would be two answers to `is exact`."""
    wrong = [
        str(path.relative_to(PACKAGE))
        for path in PACKAGE.rglob("*.py")
        for home, libraries in (
            ({"rational.py"}, "fractions|quicktions"),
            ({"polynomials.py"}, r"sympy\.polys"),
            ({"polynomials.py", "digits.py", "arithmetic.py"}, "flint"),
        )
        if path.name not in home and re.search(rf"^\s*(from|import) ({libraries})\b", path.read_text(), re.M)
    ]
    assert wrong == []


def test_text_of_one_character_is_a_number_and_changes_nothing_else():
    """quicktions 1.24 writes a lone digit over the interpreter's own b"\\0", by which GIFs written later are broken."""
    zero = b"\0after"
    assert [fraction_of(text) for text in ("7", "1/180", "0.1", "1e-3")] == [
        7,
        1 / Fraction(180),
        Fraction(1, 10),
        Fraction(1, 1000),
    ]
    assert zero[:1][0] == 0
