"""A contact released: the coordinates keep their names, and what only the contact held becomes free."""

from __future__ import annotations

import pytest

import eomgen
from eomgen.errors import DerivationError
from eomgen.mechanics.constraints.rows import Row
from eomgen.mechanics.dynamics.system import System
from eomgen.simulation.phase_models import released, stays_straight
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

HEAD = """
eomgen = 1
space = "plane"
parameters = { m = 1, l = 1 }
"""
WIRE = """
coordinates = { s = 0, theta = 0.2 }
points.O = [0, 0]
constraints.wire = { kind = "link", points = ["ball.origin", "O"], length = "l", unilateral = true }
bodies.ball.shape = { kind = "particle", mass = "m" }
bodies.ball.joint = { kind = "placed", at = ["l*sin(theta)", "-l*cos(theta)"] }
bodies.other.shape = { kind = "particle", mass = "m" }
bodies.other.joint = { kind = "placed", at = ["s", 0] }
"""
WALL = """
coordinates = { theta = 0.2 }
constraints.floor = { kind = "support", point = "bar.start", normal = [0, 1], at = [0, 0], unilateral = true }
constraints.wall = { kind = "support", point = "bar.end", normal = [1, SLOPE], at = [0, 0], unilateral = true }
[bodies.bar]
shape = { kind = "rod", mass = "m", length = "2*l" }
joint = { kind = "placed", at = ["2*l*sin(theta) - 2*l*cos(theta)*SLOPE", 0], angle = "theta + pi/2" }
"""
CABLES = """
coordinates.theta = 0.5
points = { O1 = [0, 0], O2 = ["2*l", 0] }
constraints.left = { kind = "link", points = ["bar.start", "O1"], length = "l", unilateral = true }
constraints.right = { kind = "link", points = ["bar.end", "O2"], length = "l", unilateral = true }
[bodies.bar]
shape = { kind = "rod", mass = "m", length = "2*l" }
joint = { kind = "placed", at = ["l*cos(theta)", "-l*sin(theta)"] }
"""


def freed(text: str, constraint: str) -> tuple[System, System]:
    """The system before and after."""
    before = System.of(eomgen.loads(HEAD + text))
    model, modes = released(before, constraint)
    return before, System.of(model, modes)


def status(system: System, constraint: str) -> set[str]:
    return {row.status for row in system.constraints.rows if row.constraint == constraint}


def test_a_displacement_stands_last_and_its_rate_is_that_of_the_gap():
    """The coordinates of the model first, then wire_gap = L - |r|; the constraint's own gap is (L^2 - r^2)/(2 L)."""
    before, after = freed(WIRE, "wire")
    assert [q.name for q in before.symbols.q] == ["s", "theta"]
    assert [q.name for q in after.symbols.q] == ["s", "theta", "wire_gap"]
    (row,) = Row.of_constraint(after.motion, "wire")
    numbers = [0.3, 0.7, 0.2, 0.5, -0.4, 0.9]
    state = dict(zip(after.symbols.x, numbers, strict=True))
    state |= {node: 1.0 for node in after.symbols.parameters.values()}
    gap = (row.gap, *after.scope.time_derivative((row.gap,)))
    assert status(after, "wire") == set() and evaluate(gap, state, FLOAT) == pytest.approx([0.18, 0.8 * 0.9])


@pytest.mark.parametrize("slope", ["0", "0.3"])
def test_another_contact_of_the_body_still_holds(slope):
    """Away from the wall, upright or inclined, the ladder stays on the floor by its coordinates alone."""
    before, after = freed(WALL.replace("SLOPE", slope), "wall")
    assert status(before, "wall") == status(before, "floor") == status(after, "floor") == {"identical"}
    assert len(after.symbols.u) == 2 and stays_straight(before, "wall") == (slope == "0")


def test_a_body_on_parallel_wires_turns_as_it_leaves_one():
    """No shift along one wire leaves the other as it is: the body turns too, and the other wire closes."""
    _, after = freed(CABLES, "left")
    assert [q.name for q in after.symbols.q] == ["theta", "left_gap", "left_turn"]
    assert status(after, "right") == {"closing"}


def test_what_no_body_can_leave_is_said():
    """A crank on its hinge that rests on a stop all along: nothing placed can go away from it."""
    text = """
    coordinates.theta = 0.5
    constraints.rim = { kind = "link", points = ["bar.end", "O"], length = "l", unilateral = true }
    points.O = [0, 0]
    bodies.bar.shape = { kind = "rod", mass = "m", length = "l" }
    bodies.bar.joint = { kind = "revolute", angle = "theta" }
    """
    with pytest.raises(DerivationError, match="'rim' ends, and no body can leave it"):
        freed(text, "rim")
