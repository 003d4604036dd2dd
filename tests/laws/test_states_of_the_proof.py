"""Equations are proved at the model's own start and numbers, inside each piece of what they hold, at random."""

from __future__ import annotations

from dataclasses import replace

import pytest

import eomgen
from eomgen.mechanics.free_bodies.friction import SystemFriction
from eomgen.model.joints.path import Stretch
from eomgen.proof.check import Certificate
from eomgen.proof.trials import NOWHERE, Trials
from eomgen.symbolic.expression import derivatives as derivative
from eomgen.symbolic.expression.splines import Spline

HEAD = """
eomgen = 1
space = "plane"
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
"""
PATH = """
[coordinates]
s = { start = 1.2, speed = 1 }
[bodies.bead]
shape = { kind = "particle", mass = 2 }
[bodies.bead.joint]
kind = "path"
along = "s"
at = [0, 0]
heading = 0.3
pieces = [{ line = LENGTH }, { arc = 2, turn = "ccw", angle = 1.5 }]
"""
LATE = """
[coordinates]
s = { motion = { samples = [[10, 0], [11, 0.2], [12, 0.1], [13, 0.4], [14, 0]] } }
th = 0.3
[bodies.cart]
mass = 1
joint = { kind = "prismatic", axis = [1, 0], displacement = "s" }
[bodies.p]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", on = "cart", angle = "th - pi/2" }
"""
WIRE = """
[coordinates]
x = { start = START, speed = 1 }
[bodies.b]
shape = { kind = "particle", mass = 1 }
joint = { kind = "placed", at = ["x", "HEIGHT"] }
"""


def wire(height: str, start: float = 0.5) -> str:
    return HEAD + WIRE.replace("HEIGHT", height).replace("START", str(start))


def certificate(text: str) -> Certificate:
    return eomgen.derive(eomgen.loads(text)).certify()


def turned_twice_as_fast(self: Stretch, s):
    return self.heading if self.bend is None else self.heading + 2 * (s - self.start) / self.bend


@pytest.mark.parametrize("line", [0.3, 1, 40])
def test_an_error_in_one_piece_of_a_path_is_seen_wherever_the_path_begins(monkeypatch, line):
    """The heading of an arc turns twice as fast: pose and twist contradict each other there, and only there."""
    text = HEAD + PATH.replace("LENGTH", str(line))
    assert certificate(text).ok
    monkeypatch.setattr(Stretch, "turned", turned_twice_as_fast)
    assert certificate(text).ok is False


def wrong_in_the_last_piece(self: Spline) -> Spline:
    right = own_derivative(self)
    *pieces, last = right.pieces
    return replace(right, pieces=(*pieces[:-1], tuple(2 * c for c in pieces[-1]), last))


own_derivative = Spline.derivative


def test_an_error_between_two_samples_is_seen_however_late_they_come(monkeypatch):
    """The rate is wrong between t = 13 and 14 alone; the motion starts at t = 0."""
    assert certificate(HEAD + LATE).ok
    monkeypatch.setattr(Spline, "derivative", wrong_in_the_last_piece)
    assert certificate(HEAD + LATE).ok is False


PIECEWISE = {
    "max": ("max(0, x - 7)^2", "max", lambda g, x, a, b: g.select(g.call("less_equal", b, a), 0, 2)),
    "min": ("min(4, x)^2", "min", lambda g, x, a, b: 1),
    "abs": ("abs(x - 9)^3", "abs", lambda g, x, a: g.select(g.call("less_equal", a, 0), -1, 2)),
}


@pytest.mark.parametrize("op", PIECEWISE)
def test_an_error_beyond_a_threshold_is_seen(monkeypatch, op):
    """The slope of max, min or abs is wrong on the side on which the motion does not begin."""
    height, name, wrong = PIECEWISE[op]
    assert certificate(wire(height)).ok
    partials = derivative.PARTIALS[name]
    k = len(partials) - 1
    monkeypatch.setitem(derivative.PARTIALS, name, (*partials[:k], wrong, *partials[k + 1 :]))
    assert certificate(wire(height)).ok is False


@pytest.mark.parametrize(("height", "start"), [("sqrt(x - 7)", 12), ("log(x/3 - 1)", 6), ("sqrt(x - 7000)", 7000.5)])
def test_what_has_values_near_the_start_only_is_proved_there(height, start):
    """Lagrange by hand for y(x): (1 + y'^2) x'' + y' y'' x'^2 + g y' = 0; no random state has values."""
    found = certificate(wire(height, start))
    assert found.ok, str(found)
    assert all(check.status == "holds" for check in found.checks)


def test_where_nothing_has_values_nothing_is_called_wrong():
    """No state is a contradiction: the words are that it could not be checked."""
    found = certificate(wire("sqrt(-1 - x^2)"))
    assert found.ok is not False
    left = [check for check in found.checks if check.status == "unchecked"]
    assert left and {check.detail for check in left} <= {
        NOWHERE,
        *(c.detail for c in left if "no real state" in c.detail),
    }


def test_every_piece_of_a_function_is_entered():
    """x goes through -5, 2 and 9: four pieces, each with a state of its own, and the start in one of them."""
    equations = eomgen.derive(eomgen.loads(wire("max(0, x - 9) + max(0, x - 2) + abs(x + 5)")))
    states = Trials(equations.graph).states
    (switch,) = [switch for switch in states.switches if switch.quantity is equations.system.symbols.q[0]]
    entered = [switch.piece(next(iter(supply)).state) for where, supply in states.supplies if where == "in a piece"]
    assert sorted(entered) == [0, 1, 2, 3]


def test_friction_that_is_planted_to_drive_is_seen_beside_a_start_at_rest(monkeypatch):
    """At rest friction takes no power: the proof goes to a state near the start, in which something slides."""
    text = HEAD + PATH.replace("LENGTH", "0.3, friction = 0.2").replace("start = 1.2, speed = 1", "start = 0.1")
    assert certificate(text).ok

    class Turned(SystemFriction):
        @property
        def named(self):
            return [(name, -factor, v) for name, factor, v in super().named]

    monkeypatch.setattr("eomgen.proof.trials.SystemFriction", Turned)
    assert certificate(text).ok is False
