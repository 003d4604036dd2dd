"""Phases that follow one another in C are those of the interpreted run, one by one and many at once."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from motions_with_phases import NAMES, duration, model_with_phases
from slow_run import usual

import eomgen
from eomgen.runs import batch_of_runs
from eomgen.simulation import motion

pytestmark = pytest.mark.slow

VARIED = {
    "bouncing_ball": ("start", "y", 0.5, 1.5),
    "stick_slip": ("parameters", "v", 0.07, 0.2),
    "hopper": ("start", "y", 0.1, 0.5),
    "funnel": ("start", "x", 0.1, 0.4),
    "arm": ("parameters", "T", 0.5, 3.0),
    "pendulum_on_stop": ("start", "q", 0.5, 1.2),
}


@pytest.fixture
def in_c(monkeypatch):
    """No phase is made by the loop in Python."""

    def refused(*_):
        raise AssertionError("a phase was left to Python")

    monkeypatch.setattr(motion, "_until_rest", refused)


def phases_of(run):
    """[(what ended a phase, without the instant)], and the instants."""
    return [phase.ended_by.split(" at t =")[0] for phase in run.phases], [phase.end for phase in run.phases]


@pytest.mark.parametrize("name", usual(NAMES, 2))
def test_phases_and_instants_are_those_of_a_fine_interpreted_run(name, monkeypatch):
    """Against numpy, scipy's steps at rtol 1e-13 and the decisions in Python: the same phases, instants to 1e-9."""
    model, time = model_with_phases(name), duration(name)
    fine = eomgen.simulator(model, target="numpy", rtol=1e-13, atol=1e-13)(time)
    monkeypatch.setattr(motion, "_until_rest", None)
    found = eomgen.simulator(model, rtol=1e-11, atol=1e-11)(time)
    (ended, instants), (expected, exact) = phases_of(found), phases_of(fine)
    assert ended == expected and len(ended) > 1
    assert instants == pytest.approx(exact, abs=1e-9)
    assert found.x[-1] == pytest.approx(fine.x[-1], abs=1e-8)
    impacts = [[(each.impulses, each.loss) for each in run.impacts] for run in (found, fine)]
    for (one, lost), (other, loss) in zip(*impacts, strict=True):
        assert one == pytest.approx(other, abs=1e-8) and lost == pytest.approx(loss, abs=1e-8)


def test_a_ball_bounces_to_its_rest_as_the_closed_form_says(in_c):
    """t_k = sqrt(2 h/g) (1 + 2 (e + ... + e^k)), rest at sqrt(2 h/g) (1 + e)/(1 - e), lost m g h e^(2 k) (1 - e^2)."""
    run = eomgen.simulator(model_with_phases("bouncing_ball"))(3.0)
    fall, e = math.sqrt(2 / 9.81), 0.6
    expected = [fall * (1 + 2 * sum(e**i for i in range(1, k + 1))) for k in range(len(run.impacts))]
    assert len(expected) > 20 and [each.t for each in run.impacts] == pytest.approx(expected, abs=1e-11)
    assert run.phases[-2].end == pytest.approx(fall * (1 + e) / (1 - e), abs=1e-11)
    lost = [0.5 * 9.81 * e ** (2 * k) * (1 - e * e) for k in range(len(expected) - 1)]  # m = 0.5, h = 1
    assert [each.loss for each in run.impacts[:-1]] == pytest.approx(lost, abs=1e-10)


@pytest.mark.parametrize("name", usual([*VARIED], 2))
def test_many_runs_are_each_as_it_is_alone(name, in_c, monkeypatch):
    """Each of them in C; the states at all instants those of the run alone."""
    model, time, (kind, key, low, high) = model_with_phases(name), duration(name), VARIED[name]
    values = np.linspace(low, high, 7)
    simulate = eomgen.simulator(model)
    alone = [simulate(time, **{kind: {key: value}}, samples=11) for value in values.tolist()]
    monkeypatch.setattr(batch_of_runs, "_one_by_one", None)
    found = eomgen.simulate_many(model, time=time, **{kind: {key: values}}, samples=11, threads=2)
    assert set(found.status) == {"finished"}
    for row, run in zip(found.x, alone, strict=True):
        at = np.array([np.flatnonzero(run.t == t)[-1] for t in found.t])
        assert row == pytest.approx(run.x[at], abs=1e-12)


def test_threads_do_not_know_of_one_another(in_c):
    """One simulator, called from two threads at once."""
    simulate = eomgen.simulator(model_with_phases("stick_slip"))
    starts = [0.05, 0.1, 0.15, 0.2] * 4

    def run(v):
        return simulate(4.0, {"v": v}).x

    expected = {v: run(v) for v in set(starts)}
    with ThreadPoolExecutor(2) as pool:
        found = list(pool.map(run, starts))
    assert all(np.array_equal(x, expected[v]) for x, v in zip(found, starts, strict=True))


CORNER = """
eomgen = 1
space = "plane"
coordinates = { x = 0, y = 1 }
bodies.ball = { shape = { kind = "particle", mass = 2 }, joint = { kind = "placed", at = ["x", "y"] } }
[constraints]
left = { kind = "support", point = "ball.center", normal = [1, 1], at = [0, 0], unilateral = true, restitution = 0.5 }
right = { kind = "support", point = "ball.center", normal = [-1, 1], at = [0, 0], unilateral = true, restitution = 0.5 }
[forces]
weight = { kind = "gravity", acceleration = [0, -9.81] }
"""


@pytest.mark.parametrize("law", ["", 'law = "poisson"', 'order = "sequential"'])
def test_a_ball_in_a_corner_rebounds_from_both_walls_at_once(law, monkeypatch):
    """Normals at right angles: impulses m (1 + e) v/sqrt(2) each, by every law; Newton's at once is decided in C."""
    left, usual_way = [], motion._until_rest
    monkeypatch.setattr(motion, "_until_rest", lambda *args: left.append(args) or usual_way(*args))
    run = eomgen.simulator(eomgen.loads(CORNER + f"[impact]\n{law}" * bool(law)))(0.8)
    v = math.sqrt(2 * 9.81)
    assert run.impacts[0].impulses == pytest.approx(dict.fromkeys(("left", "right"), 3 * v / math.sqrt(2)), rel=1e-9)
    assert run.impacts[0].loss == pytest.approx(v * v * 0.75, rel=1e-9)
    assert run["y"][-1] == pytest.approx(
        v / 2 * (run.t[-1] - v / 9.81) - 9.81 / 2 * (run.t[-1] - v / 9.81) ** 2, abs=1e-9
    )
    assert bool(left) == bool(law)


LIMBS = """
eomgen = 1
space = "plane"
repeat = { i = "n" }
parameters = { n = 4, g = 9.81 }
forces.weight = { kind = "gravity", acceleration = [0, "-g"] }
points.O = [0, 0]
coordinates."q{i}" = { start = "1 - 0.2*{i}" }
[bodies."limb{i}"]
shape = { kind = "rod", mass = 1, length = 1 }
joint = { kind = "revolute", on = ["limb{i-1}.end", "O"], angle = "q{i}", friction = { torque = "3/{i}^2" } }
"""


def test_of_many_combinations_of_stick_and_slip_only_those_that_come_again_are_compiled():
    """Four joints have 81: the first and the second time of each other one; the motion is that of Python alone.

    Slow: phases are derived and compiled.
    """
    model = eomgen.loads(LIMBS)
    found, due = (eomgen.simulate(model, time=2.0, target=target) for target in (None, "numpy"))
    assert phases_of(found)[0] == phases_of(due)[0]
    assert phases_of(found)[1] == pytest.approx(phases_of(due)[1], abs=1e-7)
    seen: dict[object, list[str]] = {}
    for phase in found.phases:
        seen.setdefault(phase.model.configuration, []).append(phase.model.functions.rhs.target)
    first, *later = seen.values()
    assert first[0] == "c" and len(later) > 5
    assert all(targets[0] == "numpy" and set(targets[1:]) <= {"c"} for targets in later)
