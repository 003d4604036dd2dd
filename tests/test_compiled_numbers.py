"""Exact numbers and polynomials are compiled where quicktions and python-flint are installed: nothing else differs."""

from __future__ import annotations

import fractions
import pickle
import re
import subprocess
import sys
from pathlib import Path

import pytest
import sympy
from slow_run import usual

from eomgen.symbolic.expression.formula import over, sqrt
from eomgen.symbolic.expression.graph import Graph
from eomgen.symbolic.expression.rational import Fraction, fraction_of, known_to_sympy

pytestmark = pytest.mark.slow

MODELS = Path(__file__).parent.parent / "models"
VERBS = (
    ("derive", "double_pendulum.toml"),
    ("derive", "seeds/ch18_p2.toml", "--format", "json"),
    ("solve", "seeds/ch22_p1.toml"),
    ("linearize", "double_pendulum.toml"),
    ("kinematics", "slider_crank.toml"),
)
BLOCKED = """
import sys
if sys.argv.pop(1) == "without":
    sys.modules |= {"quicktions": None, "flint": None}
from eomgen.symbolic.exact.rational_polynomial import RationalPolynomial
from eomgen.symbolic.expression.rational import Fraction
RationalPolynomial.of({(1,): 2}).factors()
print(Fraction.__module__, "flint" in sys.modules and sys.modules["flint"] is not None, file=sys.stderr)
from eomgen.cli import main
main()
"""


def printed(how, verb, model, *more):
    """(what a verb prints, the module of its rationals and whether flint is there), with or without the libraries."""
    command = [sys.executable, "-c", BLOCKED, how, verb, str(MODELS / model), *more]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return done.stdout, done.stderr.splitlines()[0]


@pytest.mark.parametrize("words", usual(VERBS, 5, 1), ids=" ".join)
def test_the_same_bytes_come_out_with_and_without_compiled_numbers(words):
    """Every verb prints the same text, whatever its rationals and polynomials are made of."""
    pytest.importorskip("quicktions")
    pytest.importorskip("flint")
    (compiled, ours), (plain, theirs) = printed("with", *words), printed("without", *words)
    assert (ours, theirs) == ("quicktions True", "fractions False")
    assert compiled == plain


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


def test_one_module_chooses_the_rationals_and_one_the_polynomials():
    """Every other module takes them from there: two classes side by side would be two answers to `is exact`."""
    package = MODELS.parent / "eomgen"
    wrong = [
        str(path.relative_to(package))
        for path in package.rglob("*.py")
        for home, libraries in (
            ({"rational.py"}, "fractions|quicktions"),
            ({"rational_polynomial.py"}, r"sympy\.polys"),
            ({"rational_polynomial.py", "sure_digits.py"}, "flint"),
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
