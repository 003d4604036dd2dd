"""What no verdict holds: a factor or a difference that is 0, a letter that means nothing, a start that is none."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

import eomgen
from eomgen.cli import main
from eomgen.judge.case import Case
from eomgen.judge.decision import is_zero_everywhere
from eomgen.symbolic.expression.expressions import parse

MODELS = Path(__file__).parent.parent / "models"

PENDULUM = r"""
eomgen = 1
space = "plane"
parameters = { m = 1, l = 1, g = 9.81 }
coordinates = { theta = 0.3 }
points = { O = [0, 0] }
[bodies.bob]
shape = { kind = "particle", mass = "m" }
joint = { kind = "placed", at = ["l*sin(theta)", "-l*cos(theta)"] }
[constraints.rope]
kind = "link"
points = ["O", "bob.center"]
length = "l"
symbol = 'S'
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
CART = """
eomgen = 1
space = "plane"
parameters = { M = 2, m = 1, l = 1, g = 9.81 }
coordinates = { x = 0, phi = 0.1 }
[bodies.cart]
mass = "M"
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[bodies.bob]
mass = "m"
inertia = 0
center = ["l", 0]
joint = { kind = "revolute", on = "cart", angle = "phi - pi/2" }
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
WINCH = """
eomgen = 1
space = "plane"
parameters = { m1 = 3, m2 = 1, g = 9.81, r = 0.3, J = 0.2 }
coordinates = { y1 = 0, phi = 0, y2 = 0 }
points = { A = [-1, 5], B = [1, 5] }
bodies.L.shape = { kind = "particle", mass = "m1" }
bodies.L.joint = { kind = "prismatic", axis = [0, -1], at = [-1, 0], displacement = "y1" }
bodies.R.shape = { kind = "particle", mass = "m2" }
bodies.R.joint = { kind = "prismatic", axis = [0, -1], at = [1, 0], displacement = "y2" }
bodies.W.mass = 1
bodies.W.inertia = "J"
bodies.W.joint = { kind = "revolute", angle = "phi" }
constraints.rope = { kind = "string", path = ["L.center", "A", "B", "R.center"] }
forces.g = { kind = "gravity", acceleration = [0, "-g"] }
"""


@pytest.mark.parametrize(
    ("model", "equation", "factor"),
    [
        ("elastic_pendulum", "r*theta'' + 2*r'*theta' + g*sin(theta) = 0", "the factor 1/(m*r)"),
        ("elastic_pendulum", "r'' - r*theta'^2 - g*cos(theta) + k/m*(r - l0) = 0", "the factor 1/m"),
        ("spherical_pendulum", "l*theta'' - l*sin(theta)*cos(theta)*phi'^2 + g*sin(theta) = 0", "the factor 1/(m*l)"),
    ],
)
def test_the_factor_of_an_equation_is_that_by_which_it_was_multiplied(model, equation, factor):
    """D = f E, where the first acceleration of E by its form has the coefficient sin^2 + cos^2 - 1."""
    found = eomgen.verify(MODELS / f"{model}.toml", equation)
    assert (found.verdict, found.up_to) == ("right", factor)


def test_a_factor_beside_ties_is_of_the_equation_alone():
    """D = f E + h (J a + gamma): f is the quotient of what the ties do not hold."""
    model = eomgen.loads(WINCH)
    for more in ("0", "5*(y1'' + y2'')", "phi*(y1'' + y2'')"):
        found = eomgen.verify(model, f"2*m1*y1'' + 2*lam(rope, 1) + {more} = 2*m1*g")
        assert found.verdict == "right" and "factor 2" in found.up_to


@pytest.mark.parametrize(
    "equation",
    [
        "y1'' + y2'' = g",
        "y1'' - y2'' = 0",
        "2*y1'' + y2'' = 0",
        "y1'' + y2'' + J*phi'' = g",
        "m1*y1'' - m2*y2'' = m1*g",
        "m1*y1'' = m1*g - 2*tension(rope)",
        "(m1 + m2)*y1'' = (m1 - 2*m2)*g",
    ],
)
def test_what_is_too_much_in_a_wrong_equation_is_not_zero(equation):
    """A difference that vanishes along every motion is none."""
    model = eomgen.loads(WINCH)
    found = eomgen.verify(model, equation)
    case = Case(model)
    assert found.verdict == "wrong" and found.difference
    left = case.phase.eliminated(case.value(parse(found.difference, references=True)))
    assert not is_zero_everywhere(case.system, left).holds


@pytest.mark.parametrize(
    ("equation", "verdict", "unknown"),
    [
        ("S = m*g*cos(theta) + m*l*theta'^2", "right", ()),
        (r"S - m g \cos\theta = m l \dot\theta^2", "right", ()),
        ("S = m*g*cos(theta) - m*l*theta'^2", "wrong", ()),
        ("F_S = m*g*cos(theta) + m*l*theta'^2", "undecided", ("F_S",)),
        ("Q7 = m*g*cos(theta) + m*l*theta'^2", "undecided", ("Q7",)),
        ("m*l^2*theta'^2/2 + m*g*l*cos(theta) = Z + Y", "undecided", ("Y", "Z")),
        ("m*l^2*theta'^2/2 - m*g*l*cos(theta) = Z", "right", ()),  # it is a first integral, whatever Z is
        ("m*l^2*theta'^2/2 + m*g*l*cos(theta) = C", "wrong", ()),  # C is what authors call a constant
    ],
)
def test_a_letter_that_means_nothing_is_no_constant(equation, verdict, unknown):
    """The symbol that a tie declares for its force is that force; F_S, Q7 are nobody's."""
    found = eomgen.verify(eomgen.loads(PENDULUM), equation)
    assert (found.verdict, found.unknown) == (verdict, unknown)


def test_an_unknown_name_stays_in_the_list_with_exit_code_2():
    """5 before 2 before 3 before 0; the entry of the only equation is there, too."""

    def judged(*equations: str) -> tuple[int, list[dict[str, object]]]:
        result = CliRunner().invoke(main, ["verify", "-", "--no-certify", "--json", *equations], input=PENDULUM)
        return result.exit_code, json.loads(result.stdout)["equations"]

    code, (entry,) = judged("F_S = m*g*cos(theta)")
    assert (code, entry["verdict"], entry["unknown"]) == (2, "undecided", ["F_S"])
    assert judged("F_S = m*g*cos(theta)", "l*theta'' = -g*sin(theta)")[0] == 2
    assert judged("F_S = m*g*cos(theta)", "l*theta'' = g*sin(theta)")[0] == 5


@pytest.mark.parametrize(
    ("equation", "verdict"),
    [
        ("omega = sqrt((M + m)*g/(M*l))", "right"),
        ("omega_1^2 = (M + m)*g/(M*l)", "right"),
        ("omega_2 = sqrt((M + m)*g/(M*l))", "right"),
        ("frequency(1) = 0", "right"),
        ("omega = sqrt(g/l)", "wrong"),
    ],
)
def test_the_frequency_of_a_body_that_also_moves_as_a_whole_is_that_of_its_swinging(equation, verdict):
    """det(K - omega^2 M) = 0 has the root 0 of the cart that rolls away: by its letter omega it is not counted."""
    assert eomgen.verify(eomgen.loads(CART), equation).verdict == verdict
