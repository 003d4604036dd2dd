"""What [outputs] asks is answered exactly and as a number, or it says why not."""

from __future__ import annotations

import math

import pytest

import eomgen
from eomgen import Answer
from eomgen.symbolic.expression.text import parse

pytestmark = pytest.mark.slow

PENDULUM = """
eomgen = 1
name = "pendulum"
space = "plane"
[parameters]
m = 2.0
l = { value = 50, unit = "cm" }
g = 9.81
[coordinates]
theta = { start = "pi/6", speed = 2 }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["l*sin(theta)", "-l*cos(theta)"] }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
"""


def answers(outputs: str, model: str = PENDULUM) -> dict[str, Answer]:
    return eomgen.solve(eomgen.loads(model + outputs))


def answer(output: str, model: str = PENDULUM) -> Answer:
    return answers(f"asked = {output}\n", model)["asked"]


def test_a_function_of_coordinates_and_rates_is_exact_and_valued_at_the_start():
    """T = m l^2 theta'^2 / 2 = 2 * 0.25 * 4 / 2"""
    found = answer('"kinetic_energy()"')
    assert found.exact == "1/2*m*l^2*theta'^2"
    assert (found.value, found.unit, found.message) == (pytest.approx(1.0), "J", None)


def test_accelerations_are_replaced_by_the_equations():
    """theta'' = -g/l sin theta: the mass cancels, and its value is not needed."""
    found = answer("\"theta''\"", PENDULUM.replace("m = 2.0", "m = {}"))
    assert (found.exact, found.method) == ("-g*sin(theta)/l", "equations of motion")
    assert found.value == pytest.approx(-9.81)


def test_exact_is_an_equation_between_quantities_and_the_number_is_in_the_unit():
    """theta = 30 deg, l sin(theta) = 25 cm: the number is the formula in SI over the unit in SI."""
    found = answers('a = { value = "theta", unit = "deg" }\nx = { value = "x(bob.center)", unit = "cm" }\n')
    assert found["a"].value == pytest.approx(30)
    assert (found["x"].exact, found["x"].value, found["x"].unit) == ("l*sin(theta)", pytest.approx(25), "cm")
    assert found["a"].exact == "theta"


def test_a_missing_value_leaves_the_exact_answer():
    """value is null while a value is missing, and the message names it."""
    found = answer('"kinetic_energy()"', PENDULUM.replace("m = 2.0", "m = {}"))
    assert (found.exact, found.value) == ("1/2*m*l^2*theta'^2", None)
    assert found.message is not None and "'m'" in found.message


@pytest.mark.parametrize(
    ("output", "word"),
    [
        ('"reaction_n(bob)"', "no normal reaction"),
        ('"frequency(2)"', "one small motion oscillates"),
        ('"frequency(1)*x(bob.center)"', "function of the state"),
        ('{ value = "mass(theta, theta)", from = "rest" }', "the state of [linearize]"),
        ('{ value = "theta\'", at = "theta = 100" }', "is not met"),
        ('{ value = "theta\'", at = "t = -1" }', "before the start"),
        ('"drive(theta)"', "moves freely"),
        ('"1/(theta - theta)"', "division by zero"),
    ],
)
def test_what_cannot_be_answered_says_so_and_the_others_are_given(output, word):
    """Nulls and a message; never a wrong answer."""
    bob = '["l*sin(theta)", "-l*cos(theta)"]'
    model = PENDULUM.replace(f'"placed", at = {bob}', '"revolute", angle = "theta - pi/2"')
    model = model.replace('"particle", mass = "m"', '"rod", mass = "m", length = "l"')
    found = answers(f'asked = {output}\nother = "2*theta"\n', model)
    assert (found["asked"].exact, found["asked"].value) == (None, None)
    assert found["asked"].message is not None and word in found["asked"].message
    assert found["other"].exact == "2*theta"


def test_the_message_of_one_output_does_not_depend_on_another():
    """The outputs are answered one by one, in the order of the file."""
    rope = '[constraints.rope]\nkind = "link"\npoints = ["O", "bob.center"]\n[points]\nO = [0, 0]\n[outputs]'
    requested = 'c = "reaction_n(rope)"\nb = "tension(rope)"\nd = "multiplier(rope)"\n'
    found = answers(requested, PENDULUM.replace("[outputs]", rope))
    assert not found["c"].answered and "no normal reaction" in (found["c"].message or "")
    assert list(found) == ["c", "b", "d"]
    assert found["b"].exact == found["d"].exact == "m*(l*theta'^2 + g*cos(theta))"


def test_a_body_that_is_placed_is_held_by_nothing_and_its_reactions_are_not_given():
    """`placed` is geometry: which body nothing holds is said, and the others are still answered."""
    support = '[constraints.wall]\nkind = "support"\npoint = "bob.center"\nnormal = [1, 0]\n[outputs]'
    model = PENDULUM.replace("[outputs]", support).replace('["l*sin(theta)", "-l*cos(theta)"]', '[0, "-l*theta"]')
    found = answers('b = "reaction_n(wall)"\n', model)
    assert found["b"].exact == "0"
    frame = '[bodies.frame]\nshape = { kind = "particle", mass = 1 }\njoint = { kind = "placed", at = [0, "theta"] }\n'
    frame += '[bodies.arm]\nshape = { kind = "particle", mass = 1 }\njoint = { kind = "placed", at = [1, 0] }\n'
    model = model.replace("[constraints.wall]", frame + "[constraints.wall]")
    found = answers('b = "reaction_n(wall)"\na = "theta"\n', model)
    assert not found["b"].answered and "'arm' is unsupported along y" in (found["b"].message or "")
    assert found["a"].exact == "theta"


CART = """
eomgen = 1
name = "cart"
space = "plane"
[parameters]
g = 9.81
[coordinates]
x = {X}
phi = 0.4
[bodies.cart]
mass = 3
inertia = 1
joint = {{ kind = "placed", at = ["x", 0], angle = 0 }}
points = {{ A = [0.3, 0] }}
[bodies.arm]
mass = 2
inertia = 0.1
center = [0.4, 0]
joint = {{ kind = "revolute", on = "cart.A", angle = "phi" }}
[constraints.post]
kind = "support"
point = "cart.origin"
normal = [0, 1]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
a = {{ value = "reaction_y(arm)", at = "t = 0" }}
"""


def test_at_an_instant_too_nothing_follows_of_a_body_that_nothing_holds():
    """The cart's free coordinate moves it, and nothing keeps it from turning: not 0 = R for the hinge on it."""
    found = answers("", CART.format(X=0))
    assert not found["a"].answered and "'cart' is unsupported against rotation" in (found["a"].message or "")


def test_what_is_placed_by_a_driven_coordinate_is_held_as_it_is_moved_where_nothing_else_holds_it():
    """Of the cart that moves as given R_x = sum of m a_x; N is the post's alone, the couple holds the hinge's force."""
    found = answers(
        """b = { value = "reaction_y(arm)", at = "t = 0" }
N = "reaction_n(post)"
X = { value = "reaction_x(cart)", at = "t = 0" }
M = "reaction_couple(cart)"
D = { value = "drive(x)", at = "t = 0" }
P = "reaction_y(cart)"
""",
        CART.format(X='{ motion = "0.2*t^2", unit = "m" }'),
    )
    I, r, m, g, a = 0.1 + 2 * 0.4**2, 0.4, 2.0, 9.81, 0.4
    turn = (m * r * a * math.sin(0.4) - m * g * r * math.cos(0.4)) / I
    hinge = m * g + m * r * turn * math.cos(0.4)
    drive = 3 * a + m * a - m * r * turn * math.sin(0.4)
    assert (found["a"].value, found["b"].value) == (pytest.approx(hinge), pytest.approx(hinge))
    assert found["N"].value == pytest.approx(3 * g + hinge)
    assert (found["X"].value, found["D"].value) == (pytest.approx(drive), pytest.approx(drive))
    assert (found["M"].value, found["P"].value) == (pytest.approx(0.3 * hinge), 0)


OSCILLATOR = """
eomgen = 1
name = "oscillator"
space = "plane"
[parameters]
w = 2.0
t1 = 1.5
[coordinates]
x = { start = 1, speed = 0.5 }
s = { acceleration = "w", start = 0.1, speed = 3 }
[inputs]
F = "w*t"
[bodies.block]
mass = 1
joint = { kind = "prismatic", axis = [1, 0], displacement = "x", stiffness = "w^2" }
[bodies.lift]
mass = 1
joint = { kind = "prismatic", axis = [0, 1], displacement = "s", force = "F" }
[outputs]
"""


def test_at_a_time_an_oscillator_is_where_its_law_of_motion_says():
    """x(t) = cos(w t) + 0.5 sin(w t)/w, also as velocity and acceleration; from rest without the sine."""
    found = answers(
        "".join(
            f'{name} = {{ value = "{value}", at = "{at}"{more} }}\n'
            for name, value, at, more in (
                ("x", "x", "t = 1.5", ""),
                ("v", "vx(block.center)", "t1 = t", ""),
                ("a", "x''", "t = t1", ""),
                ("r", "x", "t = t1", ', from = "rest"'),
                ("zero", "x'", "t = 0", ""),
            )
        ),
        OSCILLATOR,
    )
    cos, sin = math.cos(3), math.sin(3)
    expected = {"x": cos + sin / 4, "v": -2 * sin + cos / 2, "a": -4 * cos - sin, "r": cos, "zero": 0.5}
    assert {name: found[name].value for name in expected} == pytest.approx(expected, abs=1e-10)
    names = {"w": 2.0, "t1": 1.5, "t": 1.5, "pi": math.pi}
    exact = {name: parse(found[name].exact or "").evaluate(names) for name in expected}
    assert exact == pytest.approx(expected, abs=1e-12)
    assert {found[name].method for name in ("x", "v", "a", "r")} == {"law of motion"}


def test_a_given_motion_is_exact_at_a_time():
    """s(t) = 0.1 + 3 t + w t^2/2; its rate 3 + w t; an input by its own expression."""
    requested = 's = { value = "s", at = "t = t1" }\nv = { value = "vy(lift.center)", at = "t = 2" }\n'
    requested += 'f = { value = "F", at = "t = t1" }\nt = { value = "t", at = "t = 2*t1" }\n'
    found = answers(requested, OSCILLATOR)
    exact = {name: parse(a.exact or "").evaluate({"w": 2.0, "t1": 1.5, "pi": math.pi}) for name, a in found.items()}
    assert exact == pytest.approx({"s": 0.1 + 4.5 + 2.25, "v": 7, "f": 3, "t": 3})
    assert {name: a.value for name, a in found.items()} == pytest.approx(exact)


CARTESIAN = """
eomgen = 1
name = "pendulum in x and y"
space = "plane"
[parameters]
m = 2.0
l = 0.5
g = 9.81
[coordinates]
x = 0.3
y = -0.4
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["x", "y"] }
[constraints.rod]
kind = "equation"
gap = "x^2 + y^2 - l^2"
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
AGAIN = '[constraints.again]\nkind = "equation"\ngap = "2*x^2 + 2*y^2 - 2*l^2"\n'


@pytest.mark.parametrize("more", ["", AGAIN], ids=["one rod", "the same rod twice"])
def test_closing_ties_bear_on_the_accelerations(more):
    """x'' = g x y / l^2 - x (x'^2 + y'^2)/l^2 and y'' = -g + (g y^2 - y v^2)/(x^2 + y^2), redundant rows or not."""
    found = answers("[outputs]\nx_dd = \"x''\"\ny_dd = \"y''\"\n", CARTESIAN + more)
    assert found["x_dd"].value == pytest.approx(9.81 * 0.3 * -0.4 / 0.25)
    state = {"x": 0.7, "y": 0.2, "x'": 1.1, "y'": -0.4, "g": 9.81, "m": 2.0, "l": 0.5, "pi": math.pi}
    r2, v2 = 0.7**2 + 0.2**2, 1.1**2 + 0.4**2
    assert parse(found["x_dd"].exact or "").evaluate(state) == pytest.approx(0.7 * (9.81 * 0.2 - v2) / r2)
    assert parse(found["y_dd"].exact or "").evaluate(state) == pytest.approx(-9.81 + 0.2 * (9.81 * 0.2 - v2) / r2)


def test_a_coordinate_that_moves_no_mass_is_an_error_of_the_model_only_where_accelerations_are_asked():
    """M has a zero row."""
    frame = '[bodies.frame]\njoint = { kind = "revolute", angle = "idle" }\n'
    model = PENDULUM.replace("[bodies.bob]", frame + "[bodies.bob]")
    model = model.replace("[coordinates]", "[coordinates]\nidle = 0.2")
    assert answer('"angle(frame)"', model).exact == "idle"
    with pytest.raises(eomgen.ModelError, match="idle"):
        answer("\"theta''\"", model)


def test_substituted_accelerations_leave_none_behind():
    """No theta'' is left in an exact answer."""
    found = answer('"ax(bob.center)^2 + ay(bob.center)"')
    assert found.exact is not None and "''" not in found.exact


EPICYCLIC = """
eomgen = 1
name = "planetary gear whose ring is free"
space = "plane"
parameters = { rs = 0.1, rp = 0.05, rr = 0.2, Js = 0.02, Jp = 0.001, mp = 0.3, Jr = 0.5, Jc = 0.1, T = 3, L = -2 }
coordinates = { s = 0, c = 0, p = 0, r = 0 }
[bodies]
sun = { mass = 1, inertia = "Js", joint = { kind = "revolute", angle = "s", torque = "T" } }
carrier = { mass = 1, inertia = "Jc", joint = { kind = "revolute", angle = "c", torque = "L" } }
ring = { mass = 1, inertia = "Jr", joint = { kind = "revolute", angle = "r" } }
[bodies.planet]
mass = "mp"
inertia = "Jp"
joint = { kind = "revolute", on = "carrier", at = ["rs + rp", 0], angle = "p" }
[constraints]
a = { kind = "rolling", body = "planet", radius = "rp", on = "sun", circle = { at = [0, 0], radius = "rs" } }
[constraints.b]
kind = "rolling"
body = "planet"
radius = "rp"
on = "ring"
circle = { at = [0, 0], radius = "rr", inside = true }
[outputs]
sun = "s''"
ring = "r''"
force = "reaction_t(a)"
"""


def test_gears_have_formulas_that_a_person_reads():
    """s' = c' - rp/rs p', r' = c' + rp/rr p': two rates c', p', whose two equations are solved by hand."""
    found = answers("", EPICYCLIC)
    state = {
        "rs": 0.3,
        "rp": 0.07,
        "rr": 0.44,
        "Js": 0.5,
        "Jp": 0.03,
        "mp": 0.9,
        "Jr": 2,
        "Jc": 0.8,
        "T": 1.7,
        "L": -0.6,
    }
    rs, rp, rr, Js, Jp, mp, Jr, Jc, T, L = state.values()
    sun, ring = -rp / rs, rp / rr
    m11, m12, m22 = Js + Jr + Jp + Jc + mp * (rs + rp) ** 2, Jp + Js * sun + Jr * ring, Jp + Js * sun**2 + Jr * ring**2
    c, p = (
        (m22 * (T + L) - m12 * T * sun) / (m11 * m22 - m12**2),
        (m11 * T * sun - m12 * (T + L)) / (m11 * m22 - m12**2),
    )
    by_hand = {"sun": c + sun * p, "ring": c + ring * p}
    for name, value in by_hand.items():
        exact = found[name].exact or ""
        assert 0 < len(exact) < 1000 and parse(exact).evaluate(state) == pytest.approx(value), name
    force = parse(found["force"].exact or "").evaluate(state)
    assert abs(force) * rs == pytest.approx(abs(T - Js * by_hand["sun"]))
