"""Joints, strings, links and paths against what the file says of them: each wrong law is told by its own check."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

import eomgen
from eomgen.model.constraints import driven as gear
from eomgen.model.constraints import plane
from eomgen.model.constraints.link import Link
from eomgen.model.constraints.strand import Stop
from eomgen.model.constraints.string import String
from eomgen.model.joints.one_axis import Cylindrical, Screw
from eomgen.model.joints.path import Path, PathPiece
from eomgen.proof.answers import wrong_way
from eomgen.questions import outputs_answered as answers
from eomgen.study import MotionFromStart

pytestmark = pytest.mark.slow

SPACE = """
eomgen = 1
space = "space"
parameters = { m = 2, g = 9.81, h = 0.2 }
[coordinates]
d = 0.2
a = 0.4
b = 0.3
[bodies.sleeve]
shape = { kind = "box", mass = "m", size = [0.3, 0.4, 0.7] }
joint = { kind = "cylindrical", axis = [1, 2, 2], displacement = "d", angle = "a" }
[bodies.nut]
shape = { kind = "box", mass = "m", size = [0.3, 0.4, 0.7] }
joint = { kind = "screw", on = "sleeve", at = [0.1, 0, 0], pitch = "h", angle = "b" }
[forces.weight]
kind = "gravity"
acceleration = [0, 0, "-g"]
"""
STRING = """
eomgen = 1
space = "plane"
parameters = { m = 2, M = 3, g = 9.81 }
[coordinates]
x = 0.5
y = -0.6
[points]
E = [0, 1]
[bodies.a]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[bodies.b]
shape = { kind = "particle", mass = "M" }
joint = { kind = "prismatic", axis = [0, 1], displacement = "y", at = [0.2, 0] }
[constraints.s]
kind = "string"
path = ["a.center", "E", { at = [0.6, 0.8], radius = 0.1, turn = "ccw", slip = true }, "b.center"]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
CRANK = """
eomgen = 1
space = "plane"
parameters = { m = 2, l = 0.5, L = 1.2, g = 9.81 }
[coordinates]
p = { start = 1.4, unit = "rad" }
x = { near = 1.1, unit = "m" }
[bodies.crank]
shape = { kind = "rod", mass = "m", length = "l" }
joint = { kind = "revolute", angle = "p" }
[bodies.piston]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "x" }
[constraints.rod]
kind = "link"
points = ["crank.end", "piston.center"]
length = "L"
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
"""
BEAD = """
eomgen = 1
space = "plane"
parameters = { m = 1, R = 2, L = 3, g = 9.81 }
[coordinates]
s = { start = 0, speed = 8 }
[bodies.bead]
shape = { kind = "particle", mass = "m" }
[bodies.bead.joint]
kind = "path"
along = "s"
heading = "pi/6"
pieces = [ { line = "L" }, { arc = "R", turn = "cw", angle = "pi/3" }, { line = "L" } ]
[forces.weight]
kind = "gravity"
acceleration = [0, "-g"]
[outputs]
v = { value = "s'", at = "s = L + R*pi/6" }
"""


def failing(text: str) -> list[str]:
    return [check.name for check in eomgen.derive(eomgen.loads(text)).certify().checks if check.ok is False]


@pytest.mark.parametrize("text", [SPACE, STRING, CRANK])
def test_what_acts_as_it_is_declared_is_not_called_wrong(text):
    """No check fails, and one of them is of what the file says."""
    checks = eomgen.derive(eomgen.loads(text)).certify().checks
    assert [check.name for check in checks if check.ok is not True] == []
    assert {"joints are declared" in c.name or "strings and links" in c.name for c in checks} == {True, False}


def test_a_sleeve_that_turns_too_far_is_told(monkeypatch):
    """Pose and subspace agree; that the angle is not that of the file only the file tells."""
    monkeypatch.setattr(Cylindrical, "steps", lambda self, value: ((0, 1), (2, 0)))
    assert failing(SPACE) == ["bodies stand against one another as their joints are declared"]


def test_a_nut_that_advances_too_far_is_told(monkeypatch):
    """p = h a n, a in radians."""
    monkeypatch.setattr(Screw, "steps", lambda self, value: ((1, 2 * value(self.pitch)),))
    assert failing(SPACE) == ["bodies stand against one another as their joints are declared"]


def test_an_eyelet_that_holds_the_string_is_told(monkeypatch):
    """One tension through what slips: a string over an eyelet and a smooth peg has one row."""
    monkeypatch.setattr(String, "strand_rows", lambda self: tuple(range(1, len(self.path))))
    assert "strings and links touch their guides, keep their length and pull along it" in failing(STRING)


def test_a_string_on_the_wrong_side_of_its_peg_is_told(monkeypatch):
    """It touches at c + a n x d, a > 0 where one travels round clockwise."""
    real = Stop.__init__

    def mirrored(self, scene, place, offset=0, axis=(0, 0, 1)):
        real(self, scene, place, -offset if type(offset) is not int else offset, axis)

    monkeypatch.setattr(Stop, "__init__", mirrored)
    assert "strings and links touch their guides, keep their length and pull along it" in failing(STRING)


def test_a_link_of_another_length_is_told(monkeypatch):
    """|r_2 - r_1| = L where the start is sought, and so closes for any length."""
    monkeypatch.setattr(Link, "_length", lambda self, scene, r: scene.value(self.length) * Fraction(9, 10))
    assert "strings and links touch their guides, keep their length and pull along it" in failing(CRANK)


def test_a_path_that_bends_the_other_way_is_told_at_an_instant_behind_two_phases(monkeypatch):
    """A piece is walked by its chords, 2 r sin a/2 at half the angle; the run that led there is proven."""
    solved = answers.solve(eomgen.loads(BEAD))
    assert solved["v"].value == pytest.approx((64 - 2 * 9.81 * (1.5 + 2 * (1 - 3**0.5 / 2))) ** 0.5, rel=1e-10)
    checks = {check.name: check for check in solved.certify().checks}
    assert checks["a run in time leads to the requested instants"].detail == "of 1"
    stretches = Path.stretches

    def bent(self, value):
        pieces = tuple(replace(p, turn="ccw") if p.arc is not None else p for p in self.pieces)
        return stretches(_with(self, pieces), value)

    monkeypatch.setattr(Path, "stretches", bent)
    wrong = {check.name: check for check in answers.solve(eomgen.loads(BEAD)).certify().checks if check.ok is False}
    assert "bodies stand in every phase" in wrong["a run in time leads to the requested instants"].detail


def _with(path: Path, pieces: tuple[PathPiece, ...]) -> Path:
    found = object.__new__(type(path))
    for name, value in {**vars(path), "pieces": pieces}.items():
        object.__setattr__(found, name, value)
    return found


def test_an_instant_that_the_run_does_not_reach_is_told():
    """Behind phases the state is that at the end of the run."""
    model = eomgen.loads(BEAD)
    motion, output = MotionFromStart(model, at_rest=False), model.outputs["v"]
    moment = motion.until(output.at)
    assert wrong_way(motion, output, moment) == ""
    (s,) = moment.phase.system.symbols.q
    moved = replace(moment, numbers={**moment.numbers, s: moment.numbers[s] + 1e-4})
    assert wrong_way(motion, output, moved) == f"s is {moved.numbers[s]:.10g} there"


def test_a_condition_that_held_before_is_told():
    """left - right changes its sign within a phase of the run that was followed."""
    model = eomgen.loads(BEAD)
    motion, output = MotionFromStart(model, at_rest=False), model.outputs["v"]
    earlier = eomgen.loads(BEAD.replace("s = L + R*pi/6", "s = L/2")).outputs["v"]
    moment = motion.until(output.at)
    motion.runs_to(earlier.at)[:] = motion.runs_to(output.at)
    assert wrong_way(motion, earlier, moment).startswith("'s = L/2' holds before t = ")


GEARS = """
eomgen = 1
space = "plane"
parameters = { m = 2, R = 0.3 }
coordinates = { phi = { start = 0.4, speed = 1 }, psi = { near = 0.1 } }
[bodies.one]
shape = { kind = "disc", mass = "m", radius = "R" }
joint = { kind = "revolute", angle = "phi" }
[bodies.two]
shape = { kind = "disc", mass = "2*m", radius = "R" }
joint = { kind = "revolute", angle = "psi", at = ["2*R", 0] }
[constraints.teeth]
kind = "gear"
bodies = ["one", "two"]
ratio = -1
"""


def test_gears_that_do_not_mesh_where_they_start_are_told(monkeypatch):
    """theta_1 - ratio theta_2 stays what it is at the start, whatever that is."""
    assert failing(GEARS) == []
    real = plane.same_turn

    def off(scene, first, second, ratio=1):
        row = real(scene, first, second, ratio)
        return replace(row, gap=row.gap - Fraction(1, 10))

    monkeypatch.setattr(gear, "same_turn", off)
    assert "constraints that keep a start value are satisfied at the start" in failing(GEARS)
