"""Loops: those in space that only redundant rows let move, starts that do not close yet, and change points."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from float_loops import Chain, Closing, Link, bricard
from scipy.integrate import solve_ivp
from slow_run import in_slow_run, sampled, usual

import eomgen
from eomgen.mechanics.start.assembly_modes import Branches
from eomgen.mechanics.start.state import Start
from eomgen.proof import branches_otherwise
from eomgen.study import Checked

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore:.*Statically indeterminate:RuntimeWarning")]
MODELS = Path(__file__).parents[2] / "models"


def model(name: str) -> eomgen.Model:
    return eomgen.load(MODELS / f"{name}.toml")


def bennett() -> Chain:
    a, b, h = 0.3, 0.4, 0.1
    A, B, C, D = (np.array(p) for p in ((a, 0, h), (0, b, -h), (-a, 0, h), (0, -b, -h)))
    axes = [np.cross(B - A, D - A), np.cross(C - B, A - B), np.cross(D - C, B - C), np.cross(A - D, C - D)]
    hinges, along = [A, B - A, C - B], [B - A, C - B, D - C]
    J = (0.02, 0.02, 0.02)
    signs = [np.sign(n @ e) for n, e in zip(axes[:3], ((0, 0, 1), (0, 0, 1), (0, 0, 1)), strict=True)]
    links = [
        Link(hinge, sign * n, d / 2, 2.0, J) for hinge, sign, n, d in zip(hinges, signs, axes[:3], along, strict=True)
    ]
    return Chain(links, Closing(D - C, axes[3]), (0, 0, -9.81))


CHAINS = {"bricard": (bricard, 1, 5), "bennett": (bennett, 3, 3)}


# -- redundant rows in space ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", CHAINS)
def test_a_loop_that_no_formula_lets_move_has_one_freedom(name):
    """nu - rank J = 1; the rows that follow from others are named."""
    _, redundant, speeds = CHAINS[name]
    found = eomgen.freedom_of(model(name))
    assert found.by_rank == 1 and found.by_formula == 1 - redundant
    assert len(found.redundant) == redundant and len(eomgen.derive(model(name)).speeds) == speeds


@sampled(2)
@pytest.mark.parametrize("target", ["numpy", "c"])
@pytest.mark.parametrize("name", CHAINS)
def test_accelerations_are_those_of_the_free_bodies_and_their_hinges(name, target):
    """M a = F + C^T lam over all bodies, redundant rows by least squares."""
    chain = CHAINS[name][0]()
    equations = eomgen.derive(model(name))
    run = eomgen.simulate(model(name), time=2, samples=9)
    rhs, n = equations.rhs(target), len(equations.coordinates)
    for t, x in zip(run.t, run.x, strict=True):
        a = rhs(t, x, rhs.p0)[n:]
        assert a == pytest.approx(chain.accelerations(x[:n], x[n:]), rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("name", usual([*CHAINS, "spatial_four_bar"], 2))
def test_energy_stays_and_the_loop_keeps_closed(name):
    """T + V, phi and J u over a few turns."""
    run = eomgen.simulate(model(name), time=5)
    assert run.ok and run.drift < 1e-6 and run.gap < 1e-9 and run.gap_rate < 1e-8


@sampled(2)
@pytest.mark.parametrize("name", [*CHAINS, "spatial_four_bar", "n_four_bar"])
def test_the_certificate_holds(name):
    assert eomgen.derive(model(name)).certify().ok


def test_bricard_turns_all_hinges_of_a_kind_alike():
    """q1 = q3 = q5 and q2 = q4: the three-fold symmetry that lets it move."""
    run = eomgen.simulate(model("bricard"), time=4)
    assert run["q3"] == pytest.approx(run["q1"], abs=1e-6) and run["q5"] == pytest.approx(run["q1"], abs=1e-6)
    assert run["q4"] == pytest.approx(run["q2"], abs=1e-6) and np.max(np.abs(run["q1"])) > 1


def test_a_hinge_that_is_there_twice_changes_nothing():
    """A second bearing on the crank's axis only shares the load."""
    text = (MODELS / "spatial_four_bar.toml").read_text()
    start = text.index("[constraints.bearing]")
    single = text[:start] + text[text.index("[forces.weight]") :]
    single = single.replace(', bearing = ["-w", 0, 0]', "").replace("w = {", "w_unused = {")
    single = "\n".join(line for line in single.splitlines() if not line.startswith("w_unused"))
    one, two = (eomgen.simulate(eomgen.loads(each), time=1) for each in (single, text))
    assert two.x == pytest.approx(one.x, abs=1e-7)


# -- starts at which the constraints do not hold yet -----------------------------------------------------------


CRANKS = """
eomgen = 1
name = "three cranks"
space = "plane"
[parameters]
m = 1
r = 0.5
d = 1
[coordinates]
a = { start = 1.0, speed = 2 }
b = B
c = C
e = {}
[bodies.A]
shape = { kind = "rod", mass = "m", length = "r" }
joint = { kind = "revolute", at = [0, 0], angle = "a" }
[bodies.B]
shape = { kind = "rod", mass = "m", length = "r" }
joint = { kind = "revolute", at = ["d", 0], angle = "b" }
[bodies.C]
shape = { kind = "rod", mass = "m", length = "r" }
joint = { kind = "revolute", at = ["2*d", 0], angle = "c" }
[bodies.table]
shape = { kind = "rod", mass = "m", length = "2*d" }
joint = { kind = "revolute", on = "A.end", angle = "e - a" }
[constraints.P]
kind = "pin"
points = ["table.center", "B.end"]
[constraints.Q]
kind = "pin"
points = ["table.end", "C.end"]
"""


def begun(b: str, c: str, **start: float):
    text = CRANKS.replace("b = B", f"b = {b}").replace("c = C", f"c = {c}")
    return Start.of(eomgen.derive(eomgen.loads(text)).system, None, start)


def test_values_that_nobody_gave_move_before_those_that_somebody_gave():
    """b and c follow a; so do their speeds."""
    found = begun("{ near = 0.8 }", "{}")
    assert [found.values[q] for q in "abce"] == pytest.approx([1, 1, 1, 0])
    assert [found.values[f"{q}'"] for q in "abce"] == pytest.approx([2, 2, 2, 0])
    assert {change.name for change in found.changes} == {"b", "c", "b'", "c'"}
    assert found.words.startswith("completed so that 'P', 'Q' hold at the start: b = 1, c = 1, ")


def test_values_that_contradict_one_another_move_as_little_as_possible():
    """min 2 (a - 1)^2 + (b - 1)^2 + (c - 1.3)^2 over a = b = c: a moves the gaps of both pins."""
    found = begun("1.0", "1.3")
    assert [found.values[q] for q in "abc"] == pytest.approx([4.3 / 4] * 3, abs=1e-6)
    assert "changed so that 'Q', 'P' hold" in found.words and "c = 1.075 (not 1.3)" in found.words


def test_what_a_caller_gives_stays():
    """--start a=0.6: the model's own values follow."""
    found = begun("1.0", "1.0", a=0.6)
    assert [found.values[q] for q in "abce"] == pytest.approx([0.6, 0.6, 0.6, 0])


def test_nothing_changes_where_the_ties_hold():
    found = begun("{ start = 1.0, speed = 2 }", "{ start = 1.0, speed = 2 }")
    assert found.changes == () and found.words == ""


def test_a_start_that_is_far_off_is_refused():
    """Given angles would have to turn by more than 1 rad, or to where the links lie in line."""
    far = CRANKS.replace("b = B", "b = -1.0").replace("c = C", "c = 1.0").replace("start = 1.0", "start = 2.6")
    with pytest.raises(eomgen.DerivationError, match="does not close at the start"):
        Start.of(eomgen.derive(eomgen.loads(far)).system)


@in_slow_run
def test_a_start_that_was_changed_is_told(run_verb):
    """On stderr and in --json."""
    path = MODELS / "bennett.toml"
    out, err = run_verb("simulate", str(path), "--time", "0.1", "--json")
    assert "The start was completed so that 'D' holds at the start: beta' = -0.930260509, gamma' = 1." in err
    assert json.loads(out)["assembled"].startswith("completed so that 'D' holds")


@pytest.fixture
def run_verb(capsys):
    from eomgen.cli import main

    def run(*words: str) -> tuple[str, str]:
        with pytest.raises(SystemExit):
            main(list(words))
        captured = capsys.readouterr()
        return captured.out, captured.err

    return run


# -- singular positions ---------------------------------------------------------------------------------


def test_n_four_bars_pass_their_change_points_as_one_pendulum():
    """T = 3 m L^2 a'^2 / 2, V = 7/2 m g L sin a: 3 L a'' = -7/2 g cos a, through every position in line."""
    run = eomgen.simulate(model("n_four_bar"), time=6, samples=601)
    oracle = solve_ivp(
        lambda t, x: [x[1], -7 / 6 * 9.81 * math.cos(x[0])],
        (0, 6),
        [math.pi / 2, -1],
        method="DOP853",
        rtol=1e-12,
        atol=1e-12,
        t_eval=run.t,
    )
    assert run.ok and len(run.carried) == 6 and run.drift < 1e-7
    for q in ("a0", "a1", "a2"):
        assert run[q] == pytest.approx(oracle.y[0], abs=1e-6)
    assert run["b1"] == pytest.approx(0, abs=1e-8) and run.gap < 1e-8


def test_an_event_in_a_singular_position_is_met():
    """The links are in line: there the run ends, not beyond."""
    with pytest.warns(RuntimeWarning, match="No single value in singular positions"):
        run = eomgen.simulate(model("n_four_bar"), time=6, until="a0 = 0")
    assert run.status == "event" and run["a0"][-1] == pytest.approx(0, abs=1e-9)


# -- branches -------------------------------------------------------------------------------------------


def test_a_four_bar_closes_in_two_ways():
    """The triangle of coupler and rocker over the diagonal from the crank's end, and its mirror image."""
    system = eomgen.derive(model("four_bar")).system
    found = Branches.of(system, Start.of(system).values)
    (other,) = found.others
    end, foot = 0.4 * np.exp(1j), 1.1
    for branch in (found.here, other):
        angles = branch.values
        assert abs(end + np.exp(1j * angles["beta"]) - foot - 0.8 * np.exp(1j * angles["gamma"])) < 1e-9
    diagonal = np.angle(foot - end)
    assert other.values["beta"] - diagonal == pytest.approx(diagonal - found.here.values["beta"])
    assert found.kept == ("alpha",) and {found.here.sign, other.sign} == {1, -1}


def test_a_side_that_is_told_the_other_way_round_is_contradicted():
    """The pin of coupler and rocker is on the left in one branch and on the right in the other, by poses alone."""
    checked = Checked.of(model("four_bar"))
    found = checked.start.branches
    assert found is not None and branches_otherwise(checked) == ""
    (side,) = found.here.sides
    turned = replace(found, here=replace(found.here, sides=(replace(side, left=not side.left),)))
    assert "'B' is on the left" in branches_otherwise(replace(checked, start=replace(checked.start, branches=turned)))


@pytest.mark.parametrize("other", [False, True])
def test_a_branch_is_picked_by_a_guess_near_it(other):
    """Whatever `near` says first, each branch of those found is the nearest to itself."""
    system = eomgen.derive(model("spatial_four_bar")).system
    found = Branches.of(system, Start.of(system).values)
    branch = found.others[0] if other else found.here
    again = Start.of(system, start=dict(branch.values)).values
    assert {q: again[q] for q in branch.values} == pytest.approx(branch.values)


def test_check_tells_the_branches(run_verb):
    out, _ = run_verb("check", str(MODELS / "four_bar.toml"))
    assert "loops at the start: beta = 0.481838, gamma = 1.56796 (-)" in out
    assert "they also close with the same alpha at beta = -1.20954, gamma = 3.98752 (+)" in out


RSSR = """eomgen = 1
name = "RSSR"
space = "space"
[coordinates]
a = 0.4
b = { near = 1 }
[bodies.crank]
mass = 1
inertia = [0.1, 0.1, 0.1]
points = { end = [0.2, 0, 0] }
joint = { kind = "revolute", axis = [0, 1, 0], angle = "a" }
[bodies.rocker]
mass = 2
inertia = [0.1, 0.1, 0.1]
points = { end = [0.5, 0, 0] }
joint = { kind = "revolute", at = [0.1, 0.8, 0], axis = [0, 1, 1], angle = "b" }
[constraints.coupler]
kind = "link"
points = ["crank.end", "rocker.end"]
length = 0.8
"""


@pytest.mark.parametrize("guess", [-2, -1, 0.3, 1, 2.5, 8])
def test_a_loop_closes_at_the_place_nearest_to_the_guess(guess):
    """of two ways and all whole turns of them, wherever Newton's method leaps"""

    def found(near: float) -> float:
        model = eomgen.loads(RSSR.replace("near = 1", f"near = {near}"))
        return Start.of(eomgen.derive(model).system).values["b"]

    start, ways = found(guess), [found(-0.2), found(2.9)]
    every = [way + 2 * np.pi * turns for way in ways for turns in (-1, 0, 1)]
    assert abs(start - guess) == pytest.approx(min(abs(way - guess) for way in every), abs=1e-9)
