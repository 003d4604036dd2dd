"""[unknowns] in loads: forces that hold a system at rest, found from the balance of its bodies with the reactions."""

from __future__ import annotations

import pytest

import eomgen
from eomgen.mechanics.dynamics.system import System
from eomgen.mechanics.free_bodies.reactions import Reactions

LEVER = """
eomgen = 1
name = "lever"
space = "plane"
[parameters]
a = { positive = true }
b = { positive = true }
G = {}
[unknowns]
P = "the force that holds it"
[bodies.lever]
points = { O = [0, 0], A = ["-a", 0], B = ["b", 0] }
[constraints]
O = { kind = "pin", points = ["lever.O"] }
[forces]
load = { kind = "force", point = "lever.A", force = [0, "-G"] }
hand = { kind = "force", point = "lever.B", force = [0, "-P"] }
[outputs]
P = "P"
O_y = "reaction_y(O)"
both = "P + reaction_y(O)"
"""

PRESS = """
eomgen = 1
name = "toggle press"
space = "plane"
[parameters]
r = 2
G = {}
[coordinates]
a = "pi/6"
b = { dependent = true, near = "-pi/6" }
[unknowns]
P = "the force that holds it"
[bodies.one]
points = { end = ["r", 0] }
joint = { kind = "revolute", angle = "a" }
[bodies.two]
points = { end = ["r", 0] }
joint = { kind = "revolute", on = "one.end", angle = "b - a" }
[constraints]
B = { kind = "support", point = "two.end", normal = [0, 1], at = [0, 0] }
[forces]
g = { kind = "force", point = "one.end", force = [0, "-G"] }
p = { kind = "force", point = "two.end", force = ["-P", 0] }
[outputs]
P = "P"
"""


def solved(text: str) -> dict[str, eomgen.Answer]:
    return eomgen.solve(eomgen.loads(text))


def test_a_lever_is_held_by_the_ratio_of_its_arms():
    """P b = G a, the bearing carries both."""
    assert {name: answer.exact for name, answer in solved(LEVER).items()} == {
        "P": "a*G/b",
        "O_y": "a*G/b + G",
        "both": "2*a*G/b + G",
    }


def test_a_couple_at_a_joint_may_be_unknown():
    """A rod of weight m g, held at its hinge by M = m g l cos(theta)/2, wherever it is; so does the reaction."""
    text = """
eomgen = 1
name = "crank"
space = "plane"
[parameters]
m = {}
g = {}
l = {}
[coordinates]
theta = 1
[unknowns]
M = "the motor's couple"
[bodies.rod]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "theta", torque = "M" }
[forces.gravity]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
M = "M"
couple = "reaction_couple(rod)"
up = "reaction_y(rod)"
"""
    found = {name: answer.exact for name, answer in solved(text).items()}
    assert found == {"M": "1/2*m*g*l*cos(theta)", "couple": "1/2*m*g*l*cos(theta)", "up": "m*g"}


def test_a_press_is_held_where_its_ties_place_it():
    """Two bars r at the angle pi/6: 2 P tan(pi/6) = G; a function of the coordinates, and its value at the start."""
    (answer,) = solved(PRESS.replace("G = {}", "G = 4")).values()
    assert answer.exact == "G*cos(a)*cos(b)/sin(a - b)"
    assert answer.value == pytest.approx(4 * 3**0.5 / 2)


def test_an_unknown_that_nothing_fixes_is_named_with_what_it_shares():
    """Two unknown couples on one lever: only their sum is known."""
    text = LEVER.replace('it"', 'it"\nM = "a couple"\nN = "another"', 1).replace(
        "[outputs]", 'm = { kind = "couple", body = "lever", couple = "M + N" }\n[outputs]\nM = "M"\n'
    )
    answer = solved(text)["M"]
    assert answer.exact is None and "M is statically indeterminate" in answer.message and "N" in answer.message


WRONG = {
    "squared": ('"-P"', '"-P^2"', "not linear in the unknown 'P'"),
    "in the geometry": ('["b", 0]', '["P", 0]', "stands where no balance gives it (bodies.lever.points.B.0)"),
    "without a grip": ('[0, "-P"]', '["P", 0]', "not in balance at rest, whatever 'P' may be"),
}


@pytest.mark.parametrize(("old", "new", "reported"), WRONG.values(), ids=WRONG)
def test_what_no_balance_gives_is_said(old, new, reported):
    """Each in the answer that asks for it."""
    assert old in LEVER
    answer = solved(LEVER.replace(old, new))["P"]
    assert answer.exact is None and reported in answer.message


def test_friction_leaves_a_range_and_is_refused():
    """A rough support sticks beside the hinge, by anything up to mu N: what leaves P open is named."""
    text = LEVER.replace(
        "[forces]",
        'R = { kind = "support", point = "lever.A", normal = [0, 1], friction = { coulomb = 0.3 } }\n[forces]',
    )
    answer = solved(text)["P"]
    assert not answer.answered and "P is statically indeterminate" in answer.message
    assert "reaction_n(R)" in answer.message


def test_a_motion_does_not_follow_from_an_unknown_force():
    """derive names it and where it stands."""
    with pytest.raises(eomgen.DerivationError, match=r"the unknown 'P' stands in forces\.hand\.force"):
        eomgen.derive(eomgen.loads(LEVER))


def test_the_bodies_are_in_balance_with_what_was_found():
    """G rho + (d applied/dP) P + applied = 0 in every row."""
    reactions = Reactions.of(System.of(eomgen.loads(LEVER)))
    (P,) = reactions.unknowns
    assert reactions.unknown(P.name) is reactions.unknowns[P]
    assert reactions.indeterminate == ()
