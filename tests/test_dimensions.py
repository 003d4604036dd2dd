"""Dimensions: every expression is an equation between them, by unification (no false alarm: test_warnings)."""

from __future__ import annotations

import re
import time
from fractions import Fraction
from itertools import product

import pytest
from each import each

import eomgen
from eomgen.errors import ModelError
from eomgen.model.catalog import Catalog
from eomgen.model.inference import BASE, Dimension, Inference, dimension_of_unit
from eomgen.model.quantities import Unit
from eomgen.model.units import Names, inferred
from eomgen.verbs.derive import derive_document

MODEL = """
eomgen = 1
space = "plane"
[parameters]
m = {{ value = 1, unit = "kg" }}
k = {{ value = 1, unit = "N/m" }}
l = {{ value = 1, unit = "m" }}
c = {{ value = 1, unit = "N*s/m" }}
C = {{ value = 1, unit = "N*m" }}
z = 3
w = 2
[coordinates]
x = {{ start = 0.1, unit = "m" }}
phi = {{ start = 1, unit = "deg" }}
psi = 0
[bodies.slider]
shape = {{ kind = "particle", mass = "m" }}
joint = {{ kind = "prismatic", axis = [1, 0], displacement = "x" }}
[bodies.wheel]
shape = {{ kind = "disc", mass = "m", radius = "l" }}
joint = {{ kind = "revolute", angle = "phi" }}
[bodies.other]
shape = {{ kind = "disc", mass = "m", radius = "l" }}
joint = {{ kind = "revolute", angle = "psi" }}
[forces.f]
{}
"""
PULL = 'kind = "force"\npoint = "slider.center"\nforce = ["{}", 0]'


def declared(force: str) -> eomgen.Model:
    return eomgen.loads(MODEL.format(force))


@each(
    "force, reported, fix",
    [
        ("-k*x^2", "'-k*x^2' is in N*m, but the force of force 'f' is in N", "write -k*x"),
        ("-k*x + m", "a force and a mass have no sum: '-k*x' is in N, 'm' in kg", ""),
        ("-k*x + C", "a force and a moment or an energy have no sum: '-k*x' is in N, 'C' in N*m", ""),
        ("-c*x", "'-c*x' is in kg*m/s", "write -c*x'"),
        ("k*x*sin(l)", "sin of a length: 'l' is in m", ""),
        ("k*x*exp(t*c)", "exp of", ""),
        ("k*x*x^(phi/2)", "a power of a length: 'x' is in m", ""),
        ("k*x*2^l", "an exponent of a length: 'l' is in m", ""),
        ("k*(x + phi)", "a length and a number have no sum: 'x' is in m, 'phi' a number", ""),
        ("k*max(x, m)", "a length and a mass do not fit together in max", ""),
        ("k*x*atan2(x, m)", "a length and a mass do not fit together in atan2", ""),
        (
            "k",
            "parameter 'k' is in N/m, but the force of force 'f' is in N",
            "give another parameter, or fix its unit",
        ),
        ("sqrt(k*l)", "'sqrt(k*l)' is in", ""),
    ],
)
def test_declared_units_that_do_not_fit_are_an_error_with_both_terms(force, reported, fix):
    """[a + b]: [a] = [b]; [f(a)] = 1; a field's own."""
    with pytest.raises(ModelError) as error:
        declared(PULL.format(force))
    (problem,) = error.value.problems
    assert reported in problem.what
    assert problem.fix == fix


def test_carets_stand_under_both_terms():
    """-k*x + m: the sum of a force and a mass."""
    with pytest.raises(ModelError) as error:
        declared(PULL.format("-k*x + m"))
    source, marks = error.value.problems[0].excerpt.split("\n")
    assert [source[k] for k, mark in enumerate(marks) if mark == "^"] == [*"-k*x", "m"]


@each(
    "force",
    [
        "-50*x",
        "9.81*m",
        "-k*x + 3",
        "z*x",
        "k*x/cos(phi)*exp(x/l)",
        "k*x*sin(t)",
        "k*x*sin(3*t)",
        "2*k*x",
        "1 - cos(phi)",
        "k*x + 3*sin(phi)^2",
        "-k*x^z",
    ],
)
def test_plain_numbers_and_names_without_a_unit_fit_anything(force):
    """Nothing is said of them."""
    found = inferred(Catalog(declared(PULL.format(force)), ()))
    assert (found.errors, found.warnings) == ((), ())


@each(
    "force, reported",
    [
        (PULL.format("z*x + z*x'"), "'z*x' is in m*[z], 'z*x'' in m*[z]/s"),
        (PULL.format("k*psi"), "'k*psi' is in N/m"),
        (PULL.format("-2*k*x^2"), "'-2*k*x^2' is in N*m"),
        ('kind = "potential"\nenergy = "1/2*k*x"', "'1/2*k*x' is in N"),
        (PULL.format("2*k"), "'2*k' is in N/m"),
    ],
)
def test_what_only_inference_knows_is_a_warning(force, reported):
    """z has no unit, psi is an angle by its joint, 2 may be a coefficient."""
    (warning,) = inferred(Catalog(declared(force), ())).warnings
    assert reported in warning.what


@each(
    "force, name, unit",
    [(PULL.format("-z*x"), "z", "N/m"), (PULL.format("m*w*x'"), "w", "1/s"), (PULL.format("k*x"), "psi", "1")],
)
def test_what_stands_beside_a_name_says_its_dimension(force, name, unit):
    """[z x] = N: [z] = N/m."""
    assert str(inferred(Catalog(declared(force), ())).found[name]) == unit


def test_equations_between_dimensions_are_solved_in_any_order():
    """[a] = [b c], [c] = m, [a] = m/s: [b] = 1/s; then [b] = m is refused."""
    inference = Inference()
    a, b, c = map(Inference.named, "abc")
    metre, second = Dimension({"m": 1}), Dimension({"s": 1})
    assert inference.equal(a, b.times(c))
    assert inference.equal(c, metre)
    assert inference.equal(a, metre.times(second, -1))
    assert str(inference.reduced(b)) == "1/s"
    assert not inference.equal(b, metre)


def test_equations_reactions_and_outputs_have_their_unit():
    """Along x': N; along phi': N*m; omega^2 m l of an output: N."""
    text = MODEL.format('kind = "generalized"\ncoordinate = "x"\nvalue = "-z*x"') + '[outputs]\nP = "m*phi\'^2*l"\n'
    found = derive_document(eomgen.loads(text), method="lagrange", certify=False, units=True).entries()["units"]
    assert found["equations"] == {"x'": "N", "phi'": "N*m", "psi'": "N*m"}
    assert (found["outputs"]["P"], found["names"]["z"], found["names"]["phi"]) == ("N", "N/m", "deg")
    assert found["reactions"] == {}  # a generalized force has no place
    held = derive_document(declared(PULL.format("-z*x")), method="lagrange", certify=False, units=True).entries()[
        "units"
    ]
    assert held["reactions"]["reaction_n(slider)"] == "N"


MECHANICAL = list(product((-2, -1, 0, 1, 2), (-2, -1, 0, 1, 2, 3), (-3, -2, -1, 0, 1, 2), (0,), (0,)))
OTHERS = list(product((-1, 0, 1), (-2, 0, 1, 2), (-4, -3, -2, 0, 3, 4), (-2, -1, 1, 2), (0, -1)))


@each("powers", MECHANICAL + OTHERS)
def test_a_dimension_reads_back_as_the_unit_that_it_is_told_as(powers):
    """dimension(unit(str(d))) = d: kg*m/s is told as itself, not as N*s/m, which is kg/s."""
    dimension = Dimension({base: Fraction(n) for base, n in zip(BASE, powers, strict=True) if n})
    unit = Unit.parse(str(dimension))
    assert dimension_of_unit(unit) == dimension and unit.factor == 1


@pytest.mark.slow
def test_a_name_among_thousands_is_looked_up_as_fast_as_among_few():
    """Else models of n parameters with units are checked in n^2: 50 000 of them were not in five minutes."""

    def seconds(count: int) -> float:
        many = "".join(f'p{k} = {{ value = 1, unit = "N/m" }}\n' for k in range(count))
        text = f'eomgen = 1\nspace = "plane"\nbodies.b.mass = 1\n[parameters]\n{many}'
        names = Names(Catalog(eomgen.loads(text), ()))
        taken = []
        for _ in range(5):
            begun = time.process_time()
            for _ in range(500):
                names.of("p1")
            taken.append(time.process_time() - begun)
        return min(taken)

    assert seconds(3000) < 8 * seconds(3)


@each(
    "text, reported",
    [
        ('o = { value = "x", unit = "mm", at = "phi = l" }', "is in m, but the left side is in radians"),
        ('o = "max(x, k)"', "a length and N/m do not fit together in max: 'x' is in m, 'k' in N/m"),
    ],
)
def test_what_stands_beside_another_is_told_by_how_it_stands_there(text, reported):
    """Sides of an equation are no value of the output, and what is compared is not added."""
    with pytest.raises(ModelError, match=re.escape(reported)):
        eomgen.loads(MODEL.format(PULL.format("-k*x")) + f"[outputs]\n{text}\n")
