"""Springs whose length is that of the start: slack where the motion starts, whoever placed the coordinates there."""

from __future__ import annotations

import math

import numpy as np
import pytest

import eomgen
from eomgen.mechanics.constraints.assembly import Assembly
from eomgen.mechanics.start.state import Start
from eomgen.symbolic.numeric.evaluation import FLOAT, evaluate

TIED = """
eomgen = 1
name = "Spring of the start's length"
space = "plane"
[parameters]
m = 1
k = 40
L = 0.3
[coordinates]
q = { start = 0.4, speed = 0.3 }
r = R
[bodies.one]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "q" }
[bodies.two]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", at = [0, 1], axis = [1, 0], displacement = "r" }
[constraints.tie]
kind = "equation"
gap = "GAP"
[points]
G = [-1, 0.5]
[forces.spring]
kind = "spring"
points = ["G", "two.center"]
stiffness = "k"
length = "start"
[outputs]
F = "pull(spring)"
"""
GAPS = {"linear": "r - q", "with a parameter": "r - q*L - L^2", "without a closed form": "r + 0.2*sin(3*r)*q - q^2"}
STARTS = {
    "dependent": "{ dependent = true, near = 0.45 }",
    "guessed": "{ near = 0.45 }",
    "not given": "{ }",
    "changed": "{ start = 0.45 }",
}


@pytest.mark.parametrize("gap", GAPS)
@pytest.mark.parametrize("start", STARTS)
def test_a_spring_of_the_starts_length_is_slack_where_the_ties_put_it(gap, start):
    """V(q_0) = 0 where phi(q_0) = 0; not at the guess, nor where a value given breaks the constraints."""
    text = TIED.replace("R\n", STARTS[start] + "\n", 1).replace("GAP", GAPS[gap])
    equations = eomgen.derive(eomgen.loads(text))
    symbols, begun = equations.graph.symbols, Start.of(equations.system).values
    state = {x: begun[x.name] for x in symbols.q} | {
        x: {"m": 1, "k": 40, "L": 0.3}[x.name] for x in symbols.parameters.values()
    }
    assert begun["r"] != pytest.approx(0.45, abs=1e-3)
    assert evaluate((equations.graph.V,), state, FLOAT)[0] == pytest.approx(0, abs=1e-25)
    beside = state | {x: state[x] + 0.1 for x in symbols.q}
    stretch = np.hypot(beside[symbols.q[1]] + 1, 0.5) - np.hypot(begun["r"] + 1, 0.5)
    assert evaluate((equations.graph.V,), beside, FLOAT)[0] == pytest.approx(20 * stretch**2)


def test_the_length_follows_the_parameters_where_the_start_has_a_closed_form():
    """r = q L + L^2 at the start: the length does not stay that of one value of L."""
    system = eomgen.derive(
        eomgen.loads(TIED.replace("R\n", STARTS["dependent"] + "\n", 1).replace("GAP", GAPS["with a parameter"]))
    ).system
    (place,) = Assembly(system.free.constraints).begun_places().values()
    (L,) = (x for x in system.symbols.parameters.values() if x.name == "L")
    assert evaluate((place,), {L: 0.5}, FLOAT)[0] == pytest.approx(0.4 * 0.5 + 0.25)


def test_a_start_without_closed_form_and_numbers_gives_no_length():
    """Neither the guess nor a number drawn stands in for it: the parameter that is missing is asked for."""
    text = (
        TIED.replace("R\n", STARTS["dependent"] + "\n", 1)
        .replace("L = 0.3", "L = {}")
        .replace("GAP", "r + 0.2*sin(3*r)*q - q^2*L")
    )
    with pytest.raises(eomgen.EomgenError, match="start of 'r' has no closed form"):
        eomgen.derive(eomgen.loads(text))


@pytest.mark.parametrize("gap", GAPS)
def test_what_is_zero_at_the_start_is_told_as_zero(gap):
    """k (l(q_0) - l_0) = 0, and no rounding of q_0, where the start has a closed form and where it has none."""
    text = TIED.replace("R\n", STARTS["dependent"] + "\n", 1).replace("GAP", GAPS[gap])
    assert eomgen.solve(eomgen.loads(text))["F"].value == 0


DRIVEN = """
eomgen = 1
name = "What a driven block holds"
space = "plane"
[parameters]
m = 2
p = 0.3
[coordinates]
X = { DRIVE }
x = 1
y = 0.5
[bodies.a]
shape = { kind = "particle", mass = "m" }
joint = { kind = "prismatic", axis = [1, 0], displacement = "X" }
[bodies.b]
shape = { kind = "particle", mass = "m" }
joint = { kind = "planar", x = "x", y = "y", angle = "0" }
[forces.weight]
kind = "gravity"
acceleration = [0, -9.81]
[HOLDS]
points = ["a.center", "b.center"]
[outputs]
D = "drive(X)"
"""
SPRING = 'forces.l]\nkind = "spring"\nstiffness = 100\nlength = "start"\n#'
DRIVES = {
    "a formula": 'motion = "p + 0.1*t^2"',
    "a rate": 'rate = "0.2*t", start = "p"',
    "samples": "motion = { samples = [[0, 0.3], [1, 0.4], [2, 0.7]] }",
}


@pytest.mark.slow
@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("holds", ['constraints.l]\nkind = "link"\n#', SPRING], ids=["link", "spring"])
def test_what_stands_as_at_the_start_does_so_for_a_drive(drive: str, holds: str):
    """A link from (0.3, 0) to (1, 0.5): D + T e_x = m X'', T = -m (e_y g + e_x X''); a spring is slack: D = m X''."""
    model = eomgen.loads(DRIVEN.replace("DRIVE", DRIVES[drive]).replace("HOLDS", holds))
    a = eomgen.solve(model)["D"].value
    assert a == pytest.approx(eomgen.reactions(model)["drive(X)"].value, abs=1e-9)
    if drive != "samples":
        ex, ey = np.array([0.7, 0.5]) / np.hypot(0.7, 0.5)
        T = -2 * (ey * 9.81 + ex * 0.2) if "link" in holds else 0.0
        assert a == pytest.approx(2 * 0.2 - T * ex, abs=1e-9)


MEETING = """
eomgen = 1
name = "ends that meet"
space = "{space}"
[parameters]
k = 50
[coordinates]
x = {{ start = 0, speed = 1 }}
y = 0
[bodies.ball]
shape = {{ kind = "particle", mass = 2 }}
joint = {{ kind = "placed", at = {at} }}
[points]
O = {O}
[forces.rubber]
kind = "{kind}"
points = ["O", "ball.center"]
{law}
[outputs]
a = "x''"
P = {{ value = "power(rubber)", at = "t = 0" }}
"""


@pytest.mark.slow
@pytest.mark.parametrize("space", ["plane", "space"])
@pytest.mark.parametrize("length", ["0", '"start"'])
def test_a_spring_without_length_is_smooth_where_its_ends_meet(space, length):
    """F = -k r, V = k r.r/2: x'' = 0 there, omega^2 = k/m, x = sin(omega t)/omega, and every proof has its numbers."""
    two = space == "plane"
    at, O = ('["x", "y"]', "[0, 0]") if two else ('["x", "y", 0]', "[0, 0, 0]")
    law = f'stiffness = "k"\nlength = {length}'
    model = eomgen.loads(MEETING.format(space=space, at=at, O=O, kind="spring", law=law))
    answers, small = eomgen.solve(model), eomgen.linearize(model)
    assert (answers["a"].value, answers["P"].value) == (0, 0)
    assert sorted(abs(complex(*x)) for x in small.as_dict()["eigenvalues"]) == pytest.approx([5] * 4)
    assert eomgen.simulate(model, time=1, samples=2)["x"][-1] == pytest.approx(math.sin(5) / 5, abs=1e-8)
    for proof in (answers.certify(), small.certify()):
        assert all(check.status == "holds" for check in proof.checks)


def test_a_damper_whose_ends_meet_has_no_direction_and_is_named():
    """c l' along 0/0"""
    model = eomgen.loads(MEETING.format(space="plane", at='["x", "y"]', O="[0, 0]", kind="damper", law="damping = 3"))
    with pytest.raises(eomgen.EomgenError, match="force 'rubber' is 0/0 at x = 0, y = 0"):
        eomgen.linearize(model)
