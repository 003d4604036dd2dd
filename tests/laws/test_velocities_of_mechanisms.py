"""Mechanisms as a stranger writes them: their velocities are those of the bodies, and what is wrong is said."""

from __future__ import annotations

import math
import re
from fractions import Fraction

import pytest

import eomgen
from eomgen.errors import DerivationError
from eomgen.symbolic.expression.graph import Graph

pytestmark = pytest.mark.slow

PLANE = 'eomgen = 1\nspace = "plane"\n'

FOUR_BAR = (
    PLANE
    + """
[parameters]
a = 0.1
b = 0.3
c = 0.25
d = 0.35
w = {}
[coordinates]
th = "pi/3"
be = { dependent = true, near = 0.3 }
ga = { dependent = true, near = 1.5 }
[bodies.crank]
points = { A = ["a", 0] }
joint = { kind = "revolute", angle = "th" }
[bodies.coupler]
points = { B = ["b", 0] }
joint = { kind = "revolute", on = "crank.A", angle = "be - th" }
[bodies.rocker]
points = { B = ["c", 0] }
joint = { kind = "revolute", at = ["d", 0], angle = "ga" }
[constraints]
B = { kind = "pin", points = ["coupler.B", "rocker.B"] }
[given]
velocity = "th' = w"
acceleration = "th'' = 0"
[outputs]
w2 = "omega(coupler)"
w3 = "omega(rocker)"
be = "be"
ga = "ga"
"""
)


def test_a_given_mechanism_is_answered_by_its_coordinates_where_their_closed_form_is_long():
    """b w2 sin(be - ga) = - a w sin(th - ga), c w3 sin(ga - be) = a w sin(th - be): a formula, not a page."""
    answers = eomgen.solve(eomgen.loads(FOUR_BAR.replace("w = {}", "w = 2")))
    a, b, c, w, th = 0.1, 0.3, 0.25, 2, math.pi / 3
    be, ga = answers["be"].value, answers["ga"].value
    assert a * math.cos(th) + b * math.cos(be) == pytest.approx(0.35 + c * math.cos(ga))
    assert b * answers["w2"].value * math.sin(be - ga) == pytest.approx(-a * w * math.sin(th - ga))
    assert c * answers["w3"].value * math.sin(ga - be) == pytest.approx(a * w * math.sin(th - be))
    assert all(len(answers[name].exact) < 80 for name in ("w2", "w3"))


def test_a_rate_without_a_value_stays_a_symbol_where_the_places_are_numbers():
    """w2/w does not depend on w."""
    open_rate = eomgen.solve(eomgen.loads(FOUR_BAR))
    assert "w" in open_rate["w2"].exact and open_rate["w2"].value is None


def test_a_rate_that_is_asked_by_its_name_is_the_one_that_is_given():
    """A skate at F = (2, 0) of a cart at psi: y' cos(psi) - x' sin(psi) + 2 psi' = 0."""
    cart = (
        PLANE
        + """
[coordinates]
x = 0
y = 0
psi = "pi/6"
[bodies.cart]
points = { F = [2, 0] }
joint = { kind = "planar", x = "x", y = "y", angle = "psi" }
[given]
velocity = ["vy(cart.F, ground, cart) = 0", "psi' = 0.5", "x' = 1"]
acceleration = ["psi'' = 3", "x'' = 0", "y'' = 0"]
[outputs]
v = "y'"
e = "2*psi''"
"""
    )
    answers = eomgen.solve(eomgen.loads(cart))
    assert answers["v"].value == pytest.approx((math.sin(math.pi / 6) - 2 * 0.5) / math.cos(math.pi / 6))
    assert answers["e"].exact == "6"


CHANGE_POINT = (
    PLANE
    + """
[bodies]
a = { points = { O = [0, 0], A = [1, 0] } }
b = { points = { A = [1, 0], B = [4, 0] } }
c = { points = { C = [3, 0], B = [4, 0] } }
[constraints]
O = { kind = "pin", points = ["a.O"] }
A = { kind = "pin", points = ["a.A", "b.A"] }
B = { kind = "pin", points = ["b.B", "c.B"] }
C = { kind = "pin", points = ["c.C"] }
[given]
velocity = ["omega(a) = 1", "omega(c) = RATE"]
[outputs]
w = "omega(b)"
"""
)


@pytest.mark.parametrize(("rate", "spin"), [("1", 0), ("-2", -1), ("2", None)])
def test_at_a_change_point_only_the_velocities_of_a_motion_are_answered(rate, spin):
    """w_a + 3 w_b = w_c along y, and w_a^2 + 3 w_b^2 = w_c^2 along x: w_b (w_a + w_b) = 0."""
    answer = eomgen.solve(eomgen.loads(CHANGE_POINT.replace("RATE", rate)))["w"]
    if spin is None:
        assert "no motion has these velocities" in answer.message
    else:
        assert answer.value == pytest.approx(spin)


PLATE = (
    PLANE
    + """
[unknowns]
k = "a speed"
[bodies.plate]
points = { A = [0, 0], B = [1, 0] }
[given]
GIVEN
[outputs]
k = "k"
w = "omega(plate)"
e = "epsilon(plate)"
"""
)


@pytest.mark.parametrize(
    ("given", "output", "said"),
    [
        ('acceleration = "omega(plate) = 1"', "e", "says nothing of accelerations; put it under `velocity`"),
        ('velocity = "x(plate.A) = 2"', "w", "says nothing of velocities"),
        ('velocity = "epsilon(plate) = 2"', "w", "put it under `acceleration`"),
        ('velocity = "omega(plate) = 2"', "k", "the unknown 'k' stands in no load and in no equation of [given]"),
        (
            'velocity = ["vx(plate.A) = k", "vx(plate.B) = k"]',
            "k",
            "3 degrees of freedom and 1 unknown, 1 equation given",
        ),
    ],
)
def test_an_equation_in_the_wrong_place_is_said_so(given, output, said):
    """What is given is of velocities under `velocity`, of accelerations under `acceleration`."""
    assert said in eomgen.solve(eomgen.loads(PLATE.replace("GIVEN", given)))[output].message


SLIDING_SEAT = (
    PLANE
    + """
[parameters]
h = { positive = true }
v = { positive = true }
[coordinates]
x = { motion = "v*t" }
phi = { dependent = true, near = 1.5 }
[points]
C = [0, "h"]
[bodies.bar]
points = { B = [1.5, 0] }
line = ["origin", "B"]
joint = { kind = "revolute", at = ["x", 0], angle = "phi" }
[constraints.pin]
kind = "slider"
point = "C"
on = "bar"
"""
)


def test_a_hinge_on_a_seat_that_moves_is_no_centre_of_rotation():
    """The seat moves with v along x, so the centre is above it; the drawing says nothing else."""
    values = SLIDING_SEAT.replace("h = { positive = true }", "h = 0.5").replace("v = { positive = true }", "v = 0.5")
    found = eomgen.kinematics(eomgen.loads(values), "t = 1")
    assert found.certify().ok
    (center,) = found.as_dict()["centers"]
    assert center["place"][0]["value"] == pytest.approx(0.5)
    assert center["place"][1]["value"] == pytest.approx(0.5 + 0.5**2 / 0.5)


SLIDER_CRANK = (
    PLANE
    + """
[parameters]
r = 0.1
l = 0.3
e = 0.05
[coordinates]
theta = { start = "pi/3", speed = 10 }
phi = { dependent = true, near = 0.2 }
s = { dependent = true, near = 0.3 }
[bodies.crank]
shape = { kind = "rod", mass = 1, length = "r" }
joint = { kind = "revolute", angle = "theta" }
[bodies.rod]
shape = { kind = "rod", mass = 1, length = "l" }
joint = { kind = "revolute", on = "crank.end", angle = "phi - theta" }
[bodies.piston]
mass = 1
joint = { kind = "prismatic", at = [0, "-e"], axis = [1, 0], displacement = "s" }
[constraints.pin]
kind = "pin"
points = ["rod.end", "piston.origin"]
"""
)


def test_no_number_is_shown_as_a_fraction_and_no_formula_is_longer_than_a_line():
    """Accelerations that are known as doubles never stand in a formula as if they were exact."""
    found = eomgen.kinematics(eomgen.loads(SLIDER_CRANK))
    spin, text = found.as_dict()["angular_accelerations"]["crank"], found.render("text")
    assert spin["exact"] is None and spin["value"] == pytest.approx(-14.2696, rel=1e-5)
    assert not re.search(r"\d{10}", text)
    assert max(len(block) for block in text.split("\n\n")) < 1500


def test_where_all_is_at_rest_no_table_is_empty():
    """Nothing that rests has a centre or a pole."""
    rod = (
        PLANE
        + """
[coordinates]
a = "pi/4"
b = 0.1
[bodies.l1]
shape = { kind = "rod", mass = 1, length = 2 }
joint = { kind = "revolute", angle = "a" }
[bodies.l2]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", on = "l1.end", angle = "b" }
"""
    )
    text = eomgen.kinematics(eomgen.loads(rod)).render("text")
    assert "rest at this instant" in text and "poles" not in text


def test_nodes_of_a_truss_have_no_kind_of_motion():
    """A point does not translate, it moves."""
    truss = (
        PLANE
        + """
[trusses.T]
nodes = { a = [0, 0], b = [2, 0], c = [2, 1], d = [0, 1] }
members = ["a-b", "b-c", "c-d", "d-a"]
[constraints]
A = { kind = "pin", points = ["T.a"] }
E = { kind = "support", point = "T.b", normal = [0, 1] }
[given]
velocity = "vx(T.d) = 1"
"""
    )
    found = eomgen.kinematics(eomgen.loads(truss))
    assert found.as_dict()["velocities"]["T.c"]["x"]["value"] == 1
    assert "translation" not in found.render("text")


def test_letters_stand_in_the_heads_of_tables():
    """v_x is set as a letter with an index, not as a word."""
    found = eomgen.kinematics(eomgen.loads(CHANGE_POINT.replace("RATE", "1")))
    assert "$v_{x}$" in found.render("latex") and r"$\omega$" in found.render("latex")
    assert "v_x" in found.render("text") and r"$\vert v\vert $" in found.render("markdown")


def test_sine_and_cosine_of_one_angle_have_one_form():
    """sin(3 pi/10) = cos(pi/5), and |sin(pi/5)| = sin(pi/5)."""
    graph = Graph()
    assert graph.call("sin", Fraction(3, 10) * graph.pi) is graph.call("cos", Fraction(1, 5) * graph.pi)


def test_contradicting_velocities_end_in_an_error():
    """v_A and v_B of one body have the same component along AB."""
    plate = PLATE.replace("GIVEN", 'velocity = ["vx(plate.A) = 2", "vx(plate.B) = 3"]')
    with pytest.raises(DerivationError, match="contradicts"):
        eomgen.kinematics(eomgen.loads(plate))
